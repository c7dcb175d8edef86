"""A rigid disc of many sides with Coulomb friction: transition from sliding to rolling, and inclines with rolling or
sliding."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest

from pictures import COLOURS, MARKERS, describe, legend, panels, save
from verification import FULL, Case, Label, Run

CASE = Case(__file__)

FRICTION = 0.2
MASS = np.pi  # of a disc of radius and density 1; gravity 1
SOLVERS = ["engine", "reference"]
# The reference solver compares every node with every segment, so it has fewer sides, and a softer floor for as many
# sides in contact.
STIFFNESS, SIDES = {"engine": 1e5, "reference": 1e3}, {"engine": 2000, "reference": 250}
SOFT_TO_STIFF = [1e4, 1e5, 1e6]
MANY_SIDES = [350, 500, 800, 1250]
SLIDES_UNTIL = 1.6  # s: the disc rolls from 5/3 on
SOFTER = 20  # normal over tangential stiffness for the delay of friction
STEP = 0.01  # of the reference, s: eleven sides pass per time unit
ANGLES = [10.0, 20.0, 25.0, 28.0, 35.0, 40.0]  # degrees; the disc rolls up to atan(3 x 0.2) = 31
END, PERIOD = 4.0, 0.01  # of a run, and of its probes
REFERENCE_ANGLES = [20.0, 25.0, 28.0] if FULL else [20.0]
DESCENTS = [("engine", angle) for angle in ANGLES] + [("reference", angle) for angle in REFERENCE_ANGLES]
SETTLED = 1.0  # s of rolling down, after the start from rest


def depth(stiffness: float, pressing: float = 1.0) -> float:
    """d over R of a disc that carries `pressing` times its weight, 4/3 kn d sqrt(2 d R): half the width of contact
    times 4/3 of the depth."""
    return float((3 * MASS * pressing / (4 * stiffness * np.sqrt(2)))**(2 / 3))


def tolerance(stiffness: float, sides: int, pressing: float = 1.0) -> float:
    """Relative, of an acceleration or a velocity: the next order after d, d^(3/2), plus the effect of m sides in
    contact on either side of the middle."""
    d = depth(stiffness, pressing)
    touching = np.sqrt(2 * d) * sides / (2 * np.pi)
    return float(d * (np.sqrt(2 * d) + 1 / touching**2))


def run(solver: str, name: str, stiffness: float, sides: int, speed: float = 0.0, degrees: float = 0.0,
        **others: float) -> Run:
    sine, cosine = float(np.sin(np.radians(degrees))), float(np.cos(np.radians(degrees)))
    values = {"shear_stiffness": stiffness, "end": END, "angle": 0.0, **others}
    scene = CASE.scene(sides=sides, spacing=2 * np.pi / sides, stiffness=stiffness, period=PERIOD, speed=speed,
                       along=sine, across=-cosine, height=1 - depth(stiffness, cosine), **values)
    return CASE.engine(name, scene) if solver == "engine" else CASE.reference(name, scene, "--dt", str(STEP))


# ---- sliding turns to rolling: u = u0 - mu g t, w R = 2 mu g t meet at t = u0 / (3 mu g), u = 2 u0 / 3

# A floor deflection d shifts these. Friction acts below the centre by R less a mean depth: on the disc's nodes d/5, on
# the floor's, along the disc's tangent, 3 d/5. Each counts half: 2 d/5. The rim of a disc that rolls without force is
# faster than its centre by d/3, so that the mean of the elastic slip, whose rate is parabolic over the contact, is 0.
# Friction develops after the elastic slip mu z at depth z, which delays it by 2/5 mu d / u0.
LEVER, RIM, DELAY = 2 / 5, 1 / 3, 2 / 5
SPEED_LOST = (LEVER + RIM) / 3  # of 2 u0 / 3, in units of d
TIME_GAINED = 2 / 3 * LEVER + 3 * FRICTION**2 * DELAY  # of u0 / (3 mu g)
LOSS_GAINED = 2 * 2 * SPEED_LOST - 2 * 2 / 3 * RIM  # of m u0^2 / 6: 1/2 - 1/3 (1 - 2 SPEED_LOST d) (1 + 2/3 RIM d)


@dataclass
class Turn:
    """Motion of a disc that starts in sliding."""

    run: Run
    slowing: float  # du/dt
    spinning: float  # R dw/dt
    time: float  # of the intersection of both lines
    speed: float  # mean, later


@cache
def turn(solver: str, stiffness: float, sides: int) -> Turn:
    of = run(solver, f"turn_{solver}_{stiffness:g}_{sides}", stiffness, sides, speed=1.0)
    t, u, rim = of.times("disc.velocity_x"), of.probe("disc.velocity_x"), -of.probe("disc.angular_velocity")
    slides = (t > 0.1) & (t < 1.6)
    (slowing, start), (spinning, offset) = np.polyfit(t[slides], u[slides], 1), np.polyfit(t[slides], rim[slides], 1)
    return Turn(of, slowing, spinning, (start - offset) / (spinning - slowing), float(u[t > 2.0].mean()))


def usual_turn(solver: str) -> tuple[Turn, float, float]:
    """The turn with d and the relative tolerance."""
    stiffness, sides = STIFFNESS[solver], SIDES[solver]
    return turn(solver, stiffness, sides), depth(stiffness), tolerance(stiffness, sides)


@pytest.mark.parametrize("solver", SOLVERS)
def test_sliding(solver: str) -> None:
    found, d, small = usual_turn(solver)
    # The normal force oscillates about the weight as the polygon's depth varies, and so does friction: a mean over 1.5
    # with 11 oscillations.
    source = "Coulomb; next order in the depth d, sides in contact"
    CASE.check(Label.EXACT, f"{solver}, sliding: deceleration over mu g", -found.slowing / FRICTION, 1, small, source)
    CASE.check(Label.EXACT, f"{solver}, sliding: spin over 2 mu g / R, and friction's lever",
               found.spinning / (2 * FRICTION), 1 - LEVER * d,
               2 * small, source)
    CASE.check(Label.EXACT, f"{solver}, turn: time over u0 / (3 mu g)", found.time * 3 * FRICTION, 1 + TIME_GAINED * d,
               2 * small + (3 * FRICTION * STEP / 2 if solver == "reference" else 0),
               "u = w R; lever and delayed friction in first order of d; half a step at the onset of friction")


@pytest.mark.parametrize("solver", SOLVERS)
def test_rolling_after_the_turn(solver: str) -> None:
    found, d, small = usual_turn(solver)
    CASE.check(Label.EXACT, f"{solver}, turn: speed over 2 u0 / 3", 1.5 * found.speed, 1 - SPEED_LOST * d, 2 * small,
               "angular momentum about the contact; lever and rim in first order of d")
    lost = found.run.probe("works.dissipated_by_contact")[-1]
    swing = 3 * FRICTION**2 * DELAY * 2 * d  # elastic energy at the turn, mu^2 (2/5) d of m g R, over 1/6
    CASE.check(Label.EXACT, f"{solver}, turn: dissipated over m u0^2 / 6", 6 * lost / MASS,
               1 + LOSS_GAINED * d - swing / 2, 4 * small + swing / 2,
               "from the speeds; none to all of the elastic energy at the turn remains as oscillation")


def test_stiffer_floors() -> None:
    error = [1 - 1.5 * turn("engine", stiffness, SIDES["engine"]).speed for stiffness in SOFT_TO_STIFF]
    CASE.check_rate("turn: 2 u0 / 3 over the contact stiffness", [1 / k for k in SOFT_TO_STIFF], error, 2 / 3, 0.04,
                    "d scales as stiffness^(-2/3); the next order, d^(3/2), is 0.08 of it at the softest")


@pytest.mark.parametrize("axis, source", [("velocity_x", "u = u0 - mu g (t - delay)"),
                                          ("angular_velocity", "R w = 2 mu g (t - delay), friction's lever")])
def test_friction_comes_late(axis: str, source: str) -> None:
    """The elastic slip delays friction; a contact softer in shear makes the delay measurable."""
    stiffness = STIFFNESS["engine"]
    d, small = depth(stiffness), tolerance(stiffness, SIDES["engine"])
    of = run("engine", "late", stiffness, SIDES["engine"], speed=1.0, shear_stiffness=stiffness / SOFTER,
             end=SLIDES_UNTIL)
    t = of.times(f"disc.{axis}")
    at = (t > 0.1) & (t < 1.3)  # while sliding is fast enough for nodes to slip at first contact
    start, slope = (1, -FRICTION) if axis == "velocity_x" else (0, -2 * FRICTION * (1 - LEVER * d))
    late = float(np.mean(of.probe(f"disc.{axis}")[at] - start - slope * t[at])) / -slope
    expected = DELAY * FRICTION * SOFTER * d
    CASE.check(Label.EXACT, f"engine, kt = kn / {SOFTER}: delay of friction over closed form, by {axis}",
               late / expected, 1, small * t[at].mean() / expected + (FRICTION * SOFTER * d)**2 / (2 * d),
               f"{source}; mu g as above, plus the square of slip over half width")


def lever(sides: int, quarter: int) -> float:
    """Lever of friction, half of dw / du during sliding, as R is 1 and the radius of gyration sqrt(1/2). Starts are
    turned by quarters of a side; six sides touch the floor on either side of the middle."""
    of = run("engine", f"sides_{sides}_{quarter}", stiffness_for(sides), sides, speed=1.0, end=SLIDES_UNTIL,
             angle=quarter * np.pi / 2 / sides)
    t, u, w = of.times("disc.velocity_x"), of.probe("disc.velocity_x"), of.probe("disc.angular_velocity")
    slides = t > 0.1
    return float(np.polyfit(u[slides], w[slides], 1)[0]) / 2


def stiffness_for(sides: int) -> float:
    return 1e4 * (sides / 500)**3


@cache
def lever_added(sides: int) -> float:
    """Increase of the lever by the sides, mean over quarters."""
    return float(np.mean([lever(sides, quarter) for quarter in range(4)])) - 1 + LEVER * depth(stiffness_for(sides))


# A polygon of the disc's area has its corners at 1 + 2 x and its sides at 1 in the mean, x = pi^2 / (6 n^2). Its centre
# is at 1 + x - d. Its nodes sink in by d + x and the floor's by d - x, and they carry 1 +- 3 x / (2 d) of half the
# weight. Levers of 1 + 2 x - (d + x)/5 and 1 - 3/5 (d - x) have the mean 1 - 2/5 d + 3/2 x.
SIDES_LEVER = np.pi**2 / 4


def lever_error(sides: int) -> float:
    """Relative error of lever_added. As sides pass, nodal sums instead of integrals vary the mean of (x/a)^2 under the
    pressure by +-0.15 / m^2 at most. The disc's lever varies by d times that, the floor's by twice as much, and their
    mean by the root of both squares over two, d / (6 m^2) = 4/3 SIDES_LEVER / n^2. The first side passes slowly, until
    mu g t^2 = 2 pi / n, and has the weight 3/2 at the end of a straight line; quarters of sides cancel half of it."""
    share = np.sqrt(2 * np.pi / sides / FRICTION) / SLIDES_UNTIL
    return float(4 / 3 * 1.5 * share / 2)


def test_more_sides() -> None:
    added = [lever_added(sides) for sides in MANY_SIDES]
    errors = [lever_error(sides) for sides in MANY_SIDES]
    x = np.log(MANY_SIDES) - np.log(MANY_SIDES).mean()
    CASE.check_rate("sliding: lever over the number of sides", [1 / n for n in MANY_SIDES], added, 2,
                    float((np.abs(x) * errors).sum() / (x**2).sum()),
                    "corners protrude by pi^2 / (3 n^2); the result depends on the first side's position as it passes")
    CASE.check(Label.EXACT, "sliding: what sides add to the lever, over pi^2 / (4 n^2)",
               np.mean([a * n**2 for a, n in zip(added, MANY_SIDES)]) / SIDES_LEVER, 1, np.mean(errors),
               "polygon of the disc's area; the result depends on the first side's position as it passes")


# ---- inclines: rolling with a = 2/3 g sin(theta) if tan(theta) <= 3 mu, else sliding with a = g (sin - mu cos),
# dw/dt = 2 mu g cos / R


@dataclass
class Incline:
    """Angle in degrees, and closed forms with d the depth over R."""

    degrees: float
    stiffness: float = STIFFNESS["engine"]

    @property
    def sine(self) -> float:
        return float(np.sin(np.radians(self.degrees)))

    @property
    def cosine(self) -> float:
        return float(np.cos(np.radians(self.degrees)))

    @property
    def used(self) -> float:
        """Share of the available friction that rolling needs."""
        return self.sine / self.cosine / (3 * FRICTION)

    @property
    def d(self) -> float:
        return depth(self.stiffness, self.cosine)

    @property
    def creep(self) -> float:
        """Creep of rolling over the speed: kt = kn, so that slip grows from the front edge up to the limit mu p / kt.

        With q = creep A / (mu d) of a half width A = sqrt(2 d R), the force is (3/4) (2 q - q^2 + q^3/6) of mu N, so
        q = 2 - 2 (1 - used)^(1/3).
        """
        return FRICTION * np.sqrt(2 * self.d) * (1 - (1 - self.used)**(1 / 3))

    @property
    def acceleration(self) -> float:
        if self.used > 1:
            return self.sine - FRICTION * self.cosine
        return 2 / 3 * self.sine * (1 - ((LEVER + RIM) * self.d - self.creep) / 3)

    @property
    def spin(self) -> float:
        """R dw/dt"""
        if self.used > 1:
            return 2 * FRICTION * self.cosine * (1 - LEVER * self.d)
        return self.acceleration * (1 + RIM * self.d - self.creep)

    @property
    def friction(self) -> float:
        return FRICTION * self.cosine * min(1.0, self.used)


@cache
def descent(solver: str, degrees: float) -> Run:
    return run(solver, f"incline_{solver}_{degrees:g}", STIFFNESS[solver], SIDES[solver], degrees=degrees)


def slopes(of: Run) -> tuple[float, float]:
    """du/dt and R dw/dt, fitted after settling."""
    t = of.times("disc.velocity_x")
    late = t > SETTLED
    return tuple(float(np.polyfit(t[late], sign * of.probe(f"disc.{name}")[late], 1)[0])
                 for name, sign in (("velocity_x", 1), ("angular_velocity", -1)))


@pytest.mark.parametrize("solver, degrees", DESCENTS)
def test_incline(solver: str, degrees: float) -> None:
    incline, (acceleration, spin) = Incline(degrees, STIFFNESS[solver]), slopes(descent(solver, degrees))
    small = tolerance(STIFFNESS[solver], SIDES[solver], incline.cosine)
    name = f"{solver}, {degrees:g} degrees, {'rolls' if incline.used <= 1 else 'slides'}"
    source = "lever, rim and creep in first order of d; next order, sides in contact"
    CASE.check(Label.EXACT, f"{name}: acceleration over closed form", acceleration / incline.acceleration, 1, small,
               source)
    CASE.check(Label.EXACT, f"{name}: spin over closed form", spin / incline.spin, 1, small, source)
    if solver == "engine" and incline.used <= 1:
        CASE.check(Label.EXACT, f"{name}: creep", acceleration / spin - 1, incline.creep - RIM * incline.d, 2 * small,
                   "springs on a parabola of pressure, slipping behind; tolerance as for accelerations")


@pytest.mark.parametrize("degrees", ANGLES)
def test_dissipation_down_the_incline(degrees: float) -> None:
    """Friction times the slip distance of the lever's end on the floor."""
    incline, of = Incline(degrees), descent("engine", degrees)
    t, lost = of.times("disc.velocity_x"), of.probe("works.dissipated_by_contact")
    late = t >= SETTLED
    way = float(np.trapz(of.probe("disc.velocity_x")[late], t[late]))
    turned = -float(np.trapz(of.probe("disc.angular_velocity")[late], t[late]))
    rolling = way * (incline.creep + (LEVER - RIM) * incline.d)
    slipped = rolling if incline.used <= 1 else way - (1 - LEVER * incline.d) * turned
    expected = MASS * incline.friction * slipped
    small = tolerance(STIFFNESS["engine"], SIDES["engine"], incline.cosine)
    CASE.check(Label.EXACT, f"engine, {degrees:g} degrees: dissipated over friction times slip",
               (lost[-1] - lost[late][0]) / expected, 1,
               3 * small * way / slipped, "closed form of the slip; next order in d over the small slip")


@pytest.mark.parametrize("degrees", REFERENCE_ANGLES)
def test_both_solvers_on_the_same_disc(degrees: float) -> None:
    """The disc of few sides on the soft floor, where creep is a large part of the slip and closed forms err by it."""
    reference, incline = descent("reference", degrees), Incline(degrees, STIFFNESS["reference"])
    engine = run("engine", f"incline_soft_{degrees:g}", STIFFNESS["reference"], SIDES["reference"], degrees=degrees)
    # Nodes accumulate slip from a step's end instead of from the edge: it starts late by the travel of one step.
    late = float(reference.probe("disc.velocity_x").max()) * STEP / np.sqrt(2 * incline.d)
    (a, spin), (own_a, own_spin) = slopes(reference), slopes(engine)
    source = "travel in one step over the half width of contact, times the creep"
    creep = own_a / own_spin - 1
    CASE.check(Label.INDEPENDENT, f"both, {degrees:g} degrees: creep, reference over engine", (a / spin - 1) / creep, 1,
               late, source)
    CASE.check(Label.INDEPENDENT, f"both, {degrees:g} degrees: acceleration, reference over engine", a / own_a, 1,
               late * creep, source)
    lost = [float(np.diff(of.at("works.dissipated_by_contact", np.array([SETTLED, END])))[0]) for of in (reference,
                                                                                                         engine)]
    CASE.check(Label.INDEPENDENT, f"both, {degrees:g} degrees: dissipated, reference over engine", lost[0] / lost[1], 1,
               late, source)


def test_picture() -> None:
    figure, axes = panels(3, f"Rigid disc of {SIDES['engine']} sides, friction {FRICTION}", across=True)
    found, _, _ = usual_turn("engine")
    t = found.run.times("disc.velocity_x")
    meeting = 1 / (3 * FRICTION)
    for name, sign, label, exact, colour in (
            ("velocity_x", 1, "speed", np.where(t < meeting, 1 - FRICTION * t, 2 / 3), COLOURS[0]),
            ("angular_velocity", -1, "angular velocity x R", np.where(t < meeting, 2 * FRICTION * t, 2 / 3),
             COLOURS[1])):
        axes[0].plot(t, sign * found.run.probe(f"disc.{name}"), color=colour, linewidth=2.0, label=label)
        axes[0].plot(t, exact, "--", color=COLOURS[6], linewidth=1.0, label="closed form" if sign < 0 else None)
    describe(axes[0], "starts to slide, turns to rolling", "time over sqrt(R / g)", "over u0")
    draw_inclines(axes[1], axes[2])
    for panel in axes:
        legend(panel)
    save(CASE, figure, "rolling")


def draw_inclines(left, right) -> None:
    angles = np.linspace(8, 42, 200)
    for index, (label, colour,
                marker) in enumerate(zip(("acceleration", "R x angular acceleration"), COLOURS, MARKERS)):
        exact = [(Incline(a).acceleration, Incline(a).spin)[index] for a in angles]
        left.plot(angles, exact, color=colour, linewidth=1.0, label=f"{label}, closed form")
        left.plot(ANGLES, [slopes(descent("engine", a))[index] for a in ANGLES], marker, color=colour, markersize=5,
                  label="engine")
    describe(left, "inclines: rolls up to atan(3 x 0.2) = 31 degrees", y="over g")
    rolls = [a for a in ANGLES if Incline(a).used <= 1]
    inner = angles[[Incline(a).used <= 1 for a in angles]]
    right.plot(inner, [100 * (Incline(a).creep - RIM * Incline(a).d) for a in inner], color=COLOURS[0], linewidth=1.0,
               label="closed form")
    right.plot(rolls, [100 * (slopes(descent("engine", a))[0] / slopes(descent("engine", a))[1] - 1) for a in rolls],
               "o", color=COLOURS[0], label="engine")
    describe(right, "creep of rolling", y="u / (w R) - 1 [%]")
    for panel in (left, right):
        panel.set_xlabel("incline [degrees]")
