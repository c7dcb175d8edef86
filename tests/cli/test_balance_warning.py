"""A run whose energy balance is off by more than 1 % says so, and what to change: tested by doing what it says."""

from __future__ import annotations

import re

# Two blocks whose facing sides are flat roofs, pressed together: node after node comes in touch, each facing its like.
ROOFS = """\
[time]
end = 6
{time}

[discretisation]
method = "es-t3"

[materials.soft]
law = "neo-hookean"
density = 1
young = 2.8
poisson = 0.4
mass_damping = 1

[shapes.block]
kind = "polygon"
points = [[-0.5, -0.25], [0.5, -0.25], [0.5, 0.249], [0, 0.25], [-0.5, 0.249]]
spacing = 0.1

[[grains]]
name = "lower"
shape = "block"
body = "compliant"
material = "soft"
packing = {{ kind = "positions", positions = [[0, -0.25]] }}

[[grains]]
name = "upper"
shape = "block"
body = "compliant"
material = "soft"
packing = {{ kind = "positions", positions = [[0, {place}]] }}
angle = "180 deg"

[[boundary]]
of = "lower"
part = {{ side = "bottom" }}
x = "fixed"
y = "fixed"

[[boundary]]
of = "upper"
part = {{ side = "top" }}
x = "fixed"
y = {{ displacement = [[0, 0], [3, {displacement}]] }}

[[contacts]]
between = "all"
law = "mohr-coulomb"
friction = 0.3
stiffness = 900
shear_stiffness = 900

# The energy correction would remove the error of which this warns.
[contact]
energy_consistent = false
"""


def run(desk, time: str, displacement: float, place: float = 0.25) -> tuple[str, float]:
    """Warnings and balance error."""
    desk.write(ROOFS.format(time=time, displacement=displacement, place=place))
    result = desk.run("--out", "out", "--threads", "1", "--force")
    assert result.returncode == 0, result.stderr
    warned = "".join(line for line in result.stderr.splitlines() if line.startswith("warning"))
    return warned, desk.summary("out")["energy"]["balance_error"]


# Nodes go on and off the other side in time with the steps, or by rounding they do not: of eight ways and two compilers
# one run made 0.04 %, all others 3 to 11 %. So of some ways the one that heats most.
WAYS = [-1.8e-3, -2.2e-3, -2.5e-3]


def test_heating_contacts_are_told_of(desk) -> None:  # EXACT
    said, error = max((run(desk, "tolerance = 1\nsafety = 1", way) for way in WAYS), key=lambda found: found[1])
    assert error > 0.01
    assert said.count("warning") == 1, said
    assert "energy balance at t = 6 s" in said and "gained without cause" in said, said
    assert f"{100 * error:.3g} % of what came in" in said, said
    assert "may feed vibrations" in said and "safety = 0.4 instead of 1" in said, said


def test_what_is_advised_helps(desk) -> None:  # EXACT: 0.5 to 0.6 %, whatever the rounding
    for way in WAYS:
        said, error = run(desk, "tolerance = 1\nsafety = 0.4", way)
        assert error < 0.01 and said == "", way


def test_step_doubling_is_told_to_leave_it(desk) -> None:  # EXACT; the means is that of test_what_is_advised_helps
    said, error = run(desk, 'integrator = "step-doubling"\ntarget = 0.01', -2e-3)
    assert error > 0.01 and 'integrator = "verlet" with safety = 0.4' in said, said


def test_rounding_of_bodies_at_rest_is_no_imbalance(desk) -> None:  # EXACT
    said, error = run(desk, "tolerance = 1\nsafety = 0.9", 0, place=0.3)
    assert error > 0.01, "of energies some 1e-17 of modulus times area"
    assert said == ""


def told(desk, text: str) -> tuple[str, float]:
    """What a run warns of the balance, and its error."""
    desk.write(text)
    result = desk.run("--out", "out", "--threads", "1", "--force")
    assert result.returncode == 0, result.stderr
    warned = [line for line in result.stderr.splitlines() if "energy balance" in line]
    assert len(warned) <= 1
    for line in warned:
        assert "vibrations" not in line or ("feed" in line) == ("gained" in line), line
    return "".join(warned), desk.summary("out")["energy"]["balance_error"]


# A soft disc falls on a floor, slowly. Units mu = R = rho = 1.
BOUNCE = """\
[time]
end = 12
{time}
[domain]
period = 4
[materials]
hard = {{ law = "rigid", density = 1 }}
soft = {{ law = "neo-hookean", density = 1, young = 2.8, poisson = 0.4 }}
[shapes.disc]
kind = "disc"
diameter = 2
nodes = 60
[[grains]]
shape = "disc"
body = "compliant"
material = "soft"
packing = {{ kind = "positions", positions = [[2, 1.02]] }}
velocity = {{ uniform = [0, -0.05] }}
[[walls]]
name = "floor"
material = "hard"
solid = "below"
level = 0
[[contacts]]
between = "all"
law = "frictionless"
"""


def test_a_smaller_target_of_step_doubling_is_no_cure(desk) -> None:  # EXACT
    """RATE that is none: 2.8e-4 at 1e-3 of this scene's own, 1.3e-2 at a tenth of it."""
    said, error = told(desk, BOUNCE.format(time='integrator = "step-doubling"\ntarget = 1e-5'))
    assert error > 0.01 and "at a smaller one than 1e-05 often more" in said, said
    advised = re.search(r'integrator = "verlet" with (safety = [\d.]+)', said)[1]
    said, error = told(desk, BOUNCE.format(time=advised))
    assert said == "" and error < 0.01


# A coarse viscous disc that spins, its rim at 1.2 times the speed of shear waves; nothing is near it.
SPIN = """\
[time]
end = 100
{time}
[materials.soft]
law = "neo-hookean"
density = 1
young = 2.8
poisson = 0.4
viscosity = 0.05
[shapes.disc]
kind = "disc"
diameter = 2
nodes = 20
[[grains]]
shape = "disc"
body = "compliant"
material = "soft"
packing = {{ kind = "positions", positions = [[0, 0]] }}
velocity = {{ rotation = 1.2 }}
[[contacts]]
between = "all"
law = "frictionless"
"""


def test_contacts_are_not_blamed_where_nothing_touches(desk) -> None:  # EXACT
    said, error = told(desk, SPIN.format(time=""))
    assert error > 0.01, "2.6 % when written, of second order in the step: a step turns the disc by up to 0.2"
    assert "no contact had a part in it" in said and "viscosity" in said, said
    advised = re.search(r"safety = [\d.]+", said)[0]
    said, error = told(desk, SPIN.format(time=advised))
    assert said == "" and error < 0.01


# Two rigid squares that meet aslant.
SQUARES = """\
[time]
end = 12
{time}
[materials.stone]
law = "rigid"
density = 1
[shapes.square]
kind = "polygon"
points = [[-0.8, -0.8], [0.8, -0.8], [0.8, 0.8], [-0.8, 0.8]]
spacing = 0.2
[[grains]]
shape = "square"
body = "rigid"
material = "stone"
packing = {{ kind = "positions", positions = [[0, 0]] }}
velocity = {{ uniform = [{speed}, 0], rotation = {spin} }}
[[grains]]
shape = "square"
body = "rigid"
material = "stone"
angle = "{angle} deg"
packing = {{ kind = "positions", positions = [[{x}, {y}]] }}
velocity = {{ uniform = [-{speed}, 0] }}
[[contacts]]
between = "all"
law = "frictionless"
stiffness = {stiffness}

# As above; over segments these keep their energy.
[contact]
energy_consistent = false
quadrature = "nodes"
"""


def squares(stiffness: float, time: str = "", speed: float = 0.2, x: float = 2.4) -> str:
    return SQUARES.format(stiffness=stiffness, time=time, speed=speed, spin=0.5, angle=20, x=x, y=0.2)


def test_deep_contacts_are_told_of_stiffness(desk) -> None:  # EXACT
    said, error = told(desk, squares(80))
    assert error > 0.01 and "of a segment deep" in said, said
    factor = float(re.search(r"stiffness ([\d.e+]+) times as high", said)[1])
    said, error = told(desk, squares(80 * factor, re.search(r"safety = [\d.]+", said)[0]))
    assert said == "" and error < 0.01


def test_overlap_at_the_start_is_told_of(desk) -> None:  # EXACT
    """A corner 0.17 below the other's right face, next to its top: 12 % lost when written, at any safety."""
    def at_rest(x: float) -> str:
        return SQUARES.format(stiffness=80, time="", speed=0, spin=0, angle=70, x=x, y=0.45)

    said, error = told(desk, at_rest(1.66))
    assert error > 0.01 and "overlapped by 0.83 of a segment at the start" in said, said
    apart = float(re.search(r"apart by ([\d.e-]+) m", said)[1])
    assert told(desk, at_rest(1.66 + apart)) == ("", 0)


# A block at rest on a floor so stiff that what it stores is rounding of its weight's moment.
RESTING = """\
[time]
end = "{end}"
[domain]
period = 1
gravity = [0, -9.81]
[materials.stone]
law = "rigid"
density = 2000
mass_damping = {damping}
[shapes.block]
kind = "polygon"
points = [[0, 0], [0.1, 0], [0.1, 0.1], [0, 0.1]]
spacing = 0.01
[[grains]]
shape = "block"
body = "rigid"
material = "stone"
packing = {{ kind = "positions", positions = [[0.3, 0.05]] }}
[[walls]]
name = "floor"
material = "stone"
solid = "below"
level = 0
x = "fixed"
y = "fixed"
[[contacts]]
between = "all"
law = "mohr-coulomb"
friction = 0.3
stiffness = 1e20
"""


def test_rounding_of_rigid_bodies_at_rest_is_no_imbalance(desk) -> None:  # EXACT
    said, error = told(desk, RESTING.format(end="1 us", damping=0))
    assert error > 0.01, "of energies of 5e-13 J, of a block whose weight's moment is 10 J"
    assert said == ""


# A C whose lips are glued by cohesion, corner to corner.
GLUED = """\
[time]
end = "0.14 ms"
safety = {safety}
[domain]
period = "60 mm"
[materials.rubber]
law = "neo-hookean"
density = "1000 kg/m3"
young = "1 MPa"
poisson = 0.4
viscosity = "1 Pa s"
[shapes.c]
kind = "polygon"
points = [["5.01 mm", "8 mm"], ["5.01 mm", "10 mm"], ["10 mm", "10 mm"], ["10 mm", "0 mm"], ["0 mm", "0 mm"], ["0 mm", "10 mm"],
          ["4.99 mm", "10 mm"], ["4.99 mm", "8 mm"], ["2 mm", "8 mm"], ["2 mm", "2 mm"], ["8 mm", "2 mm"], ["8 mm", "8 mm"]]
spacing = "{spacing} mm"
[[grains]]
name = "c"
shape = "c"
body = "compliant"
material = "rubber"
packing = {{ kind = "positions", positions = [["30 mm", "30 mm"]] }}
[contact]
self_contact = true
[[contacts]]
between = "all"
law = "cohesive"
strength = "500 kPa"
"""


def test_cohesion_at_corners_is_a_matter_of_steps(desk) -> None:
    """RATE: what is advised mends it, and half the step leaves less than half of the error."""
    coarse = GLUED.format(safety=0.8, spacing=0.5)
    said, error = told(desk, coarse)
    assert error > 0.01 and "take a smaller [time] tolerance" in said, said
    said, error = told(desk, coarse.replace("safety = 0.8", "safety = 0.8\ntolerance = 1e-3"))
    assert said == "" and error < 0.01
    errors = [told(desk, GLUED.format(safety=safety, spacing=0.5))[1] for safety in (0.1, 0.05)]
    assert errors[1] < errors[0] / 2
