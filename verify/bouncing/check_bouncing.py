"""Rigid blocks that bounce flat on a floor: heights against restitution, with the dashpot's end rule stated."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from pictures import COLOURS, describe, legend, panels, save
from verification import Case, Label, Run

CASE = Case(__file__)

RESTITUTION = {"elastic": 1.0, "lively": 0.9, "fair": 0.6, "dull": 0.3}
DAMPED = ["lively", "fair", "dull"]
STIFFNESS, MASS, HALF = 1e5, 0.5, 0.25
LENGTH = 1.0  # of contact: the block's face
FREQUENCY = float(np.sqrt(STIFFNESS * LENGTH / MASS))  # w, of the block on its contact
SAFETIES = [0.2, 0.1, 0.05]
# The time of first touch within a step is random: over twelve starts, 2e-3 apart, logarithms of the balance error have
# standard deviations of 0.23 to 0.40 at these safeties, 0.3 in the mean. The tolerance is three times that of a slope
# through means of three.
STARTS = [0, 2e-3, 4e-3]
SLOPE_SCATTER = float(3 * np.sqrt(2) * 0.3 / np.sqrt(len(STARTS)) / np.log(SAFETIES[0] / SAFETIES[-1]))
CLEAR = 0.03  # blocks above this height do not touch in two consecutive samples
LEAST = 0.05  # heights compared
FIRST_OVER = 1.9  # all blocks hit the floor once, at sqrt(2); the dullest then flies for 2 x 0.3 sqrt(2) = 0.85


def restitution_of(z: float | np.ndarray, pull: bool) -> float | np.ndarray:
    """Ratio of the speeds after and before, without gravity, for x'' = -(w^2 x + 2 z w x'), x depth, x(0) = 0; z < 1.

    With pull, contact ends at x = 0 after half a period: exp(-pi z / sqrt(1 - z^2)). Without pull, the force vanishes
    earlier, at tan(w_d t) = -2 z w_d / (w (1 - 2 z^2)); with z = cos(alpha), w_d t = 2 alpha. There x' is -exp(-z w t)
    times the initial speed: exp(-2 z acos(z) / sqrt(1 - z^2)).
    """
    return np.exp(-(np.pi if pull else 2 * np.arccos(z)) * z / np.sqrt(1 - z * z))


def damping_ratio(e: float, pull: bool) -> float:
    return 0.0 if e == 1 else float(brentq(lambda z: restitution_of(z, pull) - e, 0, 1 - 1e-9, xtol=1e-15))


def floor_force(depth: float, rate: float, z: float, pull: bool) -> float:
    """Force of the floor on a block at this depth and rate, N/m.

    The block's face, of length L, lies at the depth d in the floor. Its two flanks have length d and depths from 0 to
    d. The floor lies in the block over the length L. The part d beside the flanks is pressed sideways, by the distance
    to them, and has no rate; the rest is d deep. Each pass counts half: L - d is d deep, and d has depths from 0 to d,
    integrated by two Gauss points of a segment. The contact length is L + d; the dashpot is 2 z sqrt(kn m / (L + d))
    per unit length.
    """
    gauss = 1 / 2 - 1 / np.sqrt(12)
    depths = depth * np.array([1, gauss, 1 - gauss])
    lengths = np.array([LENGTH - depth, depth / 2, depth / 2])
    pressures = STIFFNESS * depths + dashpot(depth, z) * rate
    return lengths @ (pressures if pull else np.maximum(pressures, 0))


def dashpot(depth: float, z: float) -> float:
    """Pa s/m."""
    return 2 * z * np.sqrt(STIFFNESS * MASS / (LENGTH + depth))


@cache
def impact(height: float, z: float, pull: bool) -> tuple[float, float]:
    """Rebound height and largest depth of an impact from a height: m x'' = m g - floor_force(x, x'), g = 1."""
    def motion(_: float, state: np.ndarray) -> list[float]:
        return [state[1], 1 - floor_force(*state, z, pull) / MASS]

    def left(_: float, state: np.ndarray) -> float:
        """The quantity that vanishes at the end: the depth, or the pressure of the face (flanks unload earlier)."""
        return state[0] if pull else STIFFNESS * state[0] + dashpot(state[0], z) * state[1]

    def deepest(_: float, state: np.ndarray) -> float:
        return state[1]

    left.terminal, left.direction = True, -1
    solution = solve_ivp(motion, [0, 2 * np.pi / FREQUENCY], [0, np.sqrt(2 * height)], method="DOP853",
                         events=[left, deepest], rtol=1e-12, atol=1e-16)
    (depth, rate), = solution.y_events[0]
    return rate**2 / 2 - depth, solution.y_events[1][0, 0]


@cache
def heights(name: str, pull: bool) -> list[float]:
    """Heights after each impact, from height 1 down to LEAST."""
    z, found = damping_ratio(RESTITUTION[name], pull), [1.0]
    while len(found) < 4 and (next_one := impact(found[-1], z, pull)[0]) > LEAST:
        found.append(next_one)
    return found[1:]


@cache
def run(pull: bool, safety: float, raised: float = 0) -> Run:
    scene = CASE.scene(pull=str(pull).lower(), safety=safety, stiffness=STIFFNESS, end=6.5, period=0.01,
                       top=1 + HALF + raised)
    return CASE.engine(f"{'pull' if pull else 'no_pull'}_{safety:g}_{1000 * raised:g}", scene)


def measured(name: str, pull: bool, safety: float) -> list[float]:
    """Heights of the flights: y + v^2 / 2 of one sample in each.

    Velocities increase between samples only in impacts.
    """
    of = run(pull, safety)
    height, speed = of.probe(f"{name}.position_y") - HALF, of.probe(f"{name}_motion.velocity_y")
    impacts = np.flatnonzero((np.diff(speed) > 0) & (height[1:] < CLEAR))
    firsts = [i for k, i in enumerate(impacts) if k == 0 or i > impacts[k - 1] + 1]
    return [float(height[i + 3] + speed[i + 3]**2 / 2) for i in firsts if i + 3 < len(speed)]


@cache
def step(pull: bool, safety: float) -> float:
    """w dt: nearly all steps have the largest size."""
    return FREQUENCY * float(np.median(run(pull, safety).steps("dt")))


def bound(name: str, pull: bool, safety: float, impacts: int) -> float:
    """Relative error bound of the height after some impacts.

    The dashpot's force jumps by 2 z w v at first touch, at any time within a step, and with pull also at the end. The
    impulse there is uncertain by the change of the rate in a step, a share 2 z w dt: (2 z w dt)^2 of the speed per
    jump. In between, the rate is off by dt^2 / 2 times its second derivative, at most (1 + 4 z^2) w^2 of it, for
    2 z w v times pi / w. The spring contributes (w dt)^2 / 2 of the energy (tests/closed_forms/bounce_test.cpp).
    Flanks contribute x / L of each, 0.3 % at most.
    """
    z, jumps = damping_ratio(RESTITUTION[name], pull), 2 if pull else 1
    speed = jumps * (2 * z)**2 + np.pi * z * (1 + 4 * z * z)
    return impacts * (2 * speed + 0.5) * step(pull, safety)**2


@pytest.mark.parametrize("pull", [False, True], ids=["no pull", "pull"])
def test_end_rules(pull: bool) -> None:
    """Closed forms without gravity against x'' = -(x + 2 z x'), integrated until the force or the depth vanishes."""
    for z in (0.1, 0.5):
        def force(_: float, state: np.ndarray) -> float:
            return state[0] + 2 * z * state[1]

        def end(_: float, state: np.ndarray) -> float:
            return state[0] if pull else force(_, state)

        end.terminal, end.direction = True, -1
        after = solve_ivp(lambda t, state: [state[1], -force(t, state)], [0, 10], [0, 1], events=end, rtol=1e-12,
                          atol=1e-14).y[1, -1]
        CASE.check(Label.EXACT, f"restitution of z = {z}, {'may' if pull else 'may not'} pull",
                   -after / restitution_of(z, pull), 1, 1e-9, "impact integrated numerically, to 1e-12 per step")


@pytest.mark.parametrize("pull", [False, True], ids=["no pull", "pull"])
@pytest.mark.parametrize("name", RESTITUTION)
def test_heights(name: str, pull: bool) -> None:
    finest, rule = SAFETIES[-1], "may pull" if pull else "may not pull"
    e, exact = RESTITUTION[name], heights(name, pull)
    found = measured(name, pull, finest)
    for k, (height, expected) in enumerate(zip(found, exact), 1):
        tolerance = bound(name, pull, finest, k)
        CASE.check(Label.EXACT, f"e = {e}, {rule}: height {k} over the impact's with weight", height / expected, 1,
                   tolerance,
                   "equation of motion with face, flanks and weight; first touch and end lie within a step")
        CASE.check(Label.EXACT, f"e = {e}, {rule}: height {k} over e^{2 * k} h", height / e**(2 * k), 1,
                   tolerance + abs(expected / e**(2 * k) - 1), "instant impact; integration error, flanks and weight")


@pytest.mark.parametrize("pull", [False, True], ids=["no pull", "pull"])
def test_depth(pull: bool) -> None:
    """Each rule has its own damping ratio for the same restitution, so the depth distinguishes them."""
    finest, rule, period = SAFETIES[-1], "may pull" if pull else "may not pull", 5e-5
    scene = CASE.scene(pull=str(pull).lower(), safety=finest, stiffness=STIFFNESS, end=1.5, period=period, top=1 + HALF)
    of = CASE.engine(f"depth_{'pull' if pull else 'no_pull'}", scene)
    for name in DAMPED:
        z, deepest = damping_ratio(RESTITUTION[name], pull), HALF - of.probe(f"{name}.position_y").min()
        other = impact(1.0, damping_ratio(RESTITUTION[name], not pull), not pull)[1]
        exact = impact(1.0, z, pull)[1]
        tolerance = bound(name, pull, finest, 1) / 2 + (FREQUENCY * period)**2 / 8  # as a speed
        CASE.check(Label.EXACT, f"e = {RESTITUTION[name]}, {rule}: depth ({other / exact:.3f} by the other rule)",
                   deepest / exact, 1,
                   tolerance, "equation of motion; first touch within a step, sampling period")


@pytest.mark.parametrize("pull", [False, True], ids=["no pull", "pull"])
def test_dissipation(pull: bool) -> None:
    """The dissipated energy is the weight times the heights lost by all blocks."""
    rule = "may pull" if pull else "may not pull"
    error = [np.sqrt(np.mean([run(pull, safety, raised).balance_error**2 for raised in STARTS])) for safety in SAFETIES]
    CASE.check_rate(f"{rule}: balance of energy, rms of three starts", SAFETIES, error, 2, SLOPE_SCATTER,
                    "second order; the time of first touch within the step scatters the error of each impact")
    of = run(pull, SAFETIES[-1])
    lost = MASS * sum(1 - heights(name, pull)[0] for name in DAMPED)
    first = of.at("energy.dissipated", np.array([FIRST_OVER]))[0]
    # The energy lost exceeds the remaining one.
    tolerance = max(bound(name, pull, SAFETIES[-1], 1) for name in DAMPED) + of.balance_error
    CASE.check(Label.EXACT, f"{rule}: dissipated in the first impacts", first / lost, 1, tolerance,
               "weight times heights lost, by the equation of motion; error bound of heights plus energy balance error")


def test_picture() -> None:
    figure, axes = panels(2, "Rigid blocks that fall flat on a floor", across=True)
    of = run(False, SAFETIES[-1])
    for (name, e), colour in zip(RESTITUTION.items(), COLOURS):
        axes[0].plot(of.times(f"{name}.position_y"), of.probe(f"{name}.position_y") - HALF, color=colour, linewidth=1.1,
                     label=f"e = {e:g}")
        for k in range(1, 4):
            axes[0].hlines(e**(2 * k), 0, 6.5, color=colour, linestyle=":", linewidth=0.8)
    describe(axes[0], "no pull; dotted: e^2k h", "time over sqrt(L / g)", "height over L")
    axes[0].set_xlim(-0.3, 8.4)  # room for the legend
    legend(axes[0])
    z = np.linspace(0, 0.7, 200)
    for pull, style in ((False, "-"), (True, "--")):
        axes[1].plot(z, restitution_of(z, pull), style, color=COLOURS[6], linewidth=1.1,
                     label="may pull until g = 0" if pull else "may not pull")
        found = [np.sqrt(measured(name, pull, SAFETIES[-1])[0]) for name in DAMPED]
        axes[1].plot([damping_ratio(RESTITUTION[name], pull) for name in DAMPED], found, "s" if pull else "o",
                     color=COLOURS[1 if pull else 0], markersize=5, label=f"engine, {'pull' if pull else 'no pull'}")
    describe(axes[1], "closed forms and first impacts", "damping ratio z", "restitution e")
    legend(axes[1])
    save(CASE, figure, "bouncing")
