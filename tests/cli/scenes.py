"""Small scenes for tests of the command line."""

# Two compliant discs that meet within a few nanoseconds; small enough to run in about a second.
TWO_DISCS = """\
title = "Two discs"

[domain]
period = "8 um"

[time]
end = "20 ns"

[materials.soft]
law = "neo-hookean"
density = "1200 kg/m3"
young = "2 GPa"
poisson = 0.4

[shapes.disc]
kind = "disc"
diameter = "1 um"
nodes = 60

[[grains]]
shape = "disc"
body = "compliant"
material = "soft"
packing = { kind = "positions", positions = [["2 um", "0 um"]] }
velocity = { uniform = ["20 m/s", "0 m/s"] }

[[grains]]
shape = "disc"
body = "compliant"
material = "soft"
packing = { kind = "positions", positions = [["3.02 um", "0.1 um"]] }

[[contacts]]
between = ["soft", "soft"]
law = "frictionless"

[[probes]]
name = "energies"
quantity = "energy"
period = "2 ns"

[frames]
period = "10 ns"
fields = ["velocity", "von_mises"]
"""

# Compliant and rigid discs, with friction and cohesion, in a shear across the period.
LAYER = """\
[domain]
period = 6
[time]
end = 4
[materials.soft]
law = "neo-hookean"
density = 1
young = 2.8
poisson = 0.4
[materials.hard]
law = "rigid"
density = 1
[shapes.disc]
kind = "disc"
diameter = 2
nodes = 40
[[grains]]
shape = "disc"
packing = { kind = "grid", columns = 3, rows = 3, pitch = 2, row_pitch = 2.01, origin = [1, 0] }
species = [{ body = "compliant", material = "soft", share = 0.5 }, { body = "rigid", material = "hard", share = 0.5 }]
angle = "random"
seed = 3
velocity = { uniform = [0.4, 0], rotation = 0.1 }
[[walls]]
name = "lower"
material = "hard"
solid = "below"
level = -1.02
[[walls]]
name = "upper"
material = "hard"
solid = "above"
level = 5.04
thickness = 1
x = { velocity = [[0, 0.3], [1, 0.6]] }
y = { pressure = [[0, 0], [2, 0.1]] }
[[contacts]]
between = "all"
law = "mohr-coulomb"
friction = 0.4
[[contacts]]
between = ["soft", "hard"]
law = "cohesive"
strength = 0.1
[[probes]]
name = "push"
quantity = "force"
of = "upper"
period = 0.01
[[probes]]
name = "where"
quantity = "position"
of = "grains"
period = 0.015
[[probes]]
name = "balance"
quantity = "energy"
period = 0.5
[frames]
period = 0.5
fields = ["velocity", "von_mises", "contact_pressure"]
contacts = true
"""

# The same for a few steps, with as many frames and probes as LAYER.
SHORT_LAYER = LAYER.replace("end = 4", "end = 0.001").replace("period = 0.5", "period = 0.0005").replace(
    "period = 0.01\n", "period = 0.0002\n").replace("period = 0.015", "period = 0.0003")


def line_of(text: str, part: str) -> int:
    """Number of the first line that contains `part`, from 1."""
    return next(number for number, line in enumerate(text.splitlines(), 1) if part in line)
