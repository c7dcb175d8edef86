"""Damping by mass, by viscosity and in moving supports, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from pictures import COLOURS, describe, draw_orders, legend, panels, save
from verification import Case, Label, Run

CASE = Case(__file__, fast=True)

STEPS = [0.02, 0.01, 0.005, 0.0025]
END = 1.6
FLIGHTS = {"hard": (1.5, 0.3), "soft": (0.8, -0.3)}  # mass damping, 1/s, and the initial velocity along x

VISCOSITY, MU, PULL = 4.0, 1.0, 1e-4
REFERENCE_STEP = 0.01

SPEED, STIFFNESS, DASHPOT, LENGTH, MASS, YOUNG = 0.2, 1.0, 0.4, 4.0, 1.0, 1000.0


@pytest.fixture(scope="module")
def flights() -> dict[str, dict[float, Run]]:
    scenes = {dt: CASE.scene("mass.toml", dt=dt) for dt in STEPS}
    return {"engine": {dt: CASE.engine(f"mass_engine_{dt:g}", scene) for dt, scene in scenes.items()},
            "reference": {dt: CASE.reference(f"mass_reference_{dt:g}", scene, "--dt", repr(dt))
                          for dt, scene in scenes.items()}}


def flight_errors(runs: dict[float, Run], body: str) -> list[float]:
    """Errors of the distance at all times, v (1 - exp(-c t)) / c, over its largest value."""
    damping, speed = FLIGHTS[body]
    errors = []
    for run in runs.values():
        t, x = run.times(f"{body}.position_x"), run.probe(f"{body}.position_x")
        way = speed * (1 - np.exp(-damping * t)) / damping
        errors.append(float(np.abs(x - x[0] - way).max() / np.abs(way).max()))
    return errors


@pytest.mark.parametrize("body", FLIGHTS)
def test_flights_slow_down(flights: dict[str, dict[float, Run]], body: str) -> None:
    CASE.check(Label.EXACT, f"mass damping, {body}: way, engine", max(flight_errors(flights["engine"], body)), 0, 1e-10,
               "the engine integrates mass damping by its exponential; rounding of some hundred steps and of output")
    CASE.check_rate(f"mass damping, {body}: way, reference", STEPS, flight_errors(flights["reference"], body), 2, 0.15,
                    "Newmark: second order, with a tenth of the next order")


def test_what_flights_lose_is_booked(flights: dict[str, dict[float, Run]]) -> None:
    """The lost kinetic energy equals the dissipated energy at any time."""
    mass = flights["engine"][STEPS[0]].probe("energy.kinetic")[0] / (0.5 * 0.3**2 + 0.5 * (0.3**2 + 0.1**2))
    speeds = {"hard": 0.3**2, "soft": 0.3**2 + 0.1**2}
    expected = sum(0.5 * mass * speeds[body] * (1 - np.exp(-2 * FLIGHTS[body][0] * END)) for body in FLIGHTS)
    for name, runs in flights.items():
        errors = [abs(run.probe("energy.dissipated")[-1] / expected - 1) for run in runs.values()]
        share = STEPS[-1] * FLIGHTS["hard"][0]  # of the speed lost per step
        CASE.check(Label.EXACT, f"mass damping: dissipated energy, {name}", errors[-1], 0,
                   1e-10 if name == "engine" else share**2 / 6,
                   "rounding; in the reference second order: the trapezoidal rule of the power exp(-2 c t) errs by "
                   "(2 c dt)^2/12 of it, and the exponent by (c dt)^2/12")


@pytest.fixture(scope="module")
def creep() -> dict[str, Run]:
    scene = CASE.scene("viscous.toml", viscosity=VISCOSITY, pressure=-PULL)
    return {"engine": CASE.engine("viscous_engine", scene),
            "reference": CASE.reference("viscous_reference", scene, "--dt", repr(REFERENCE_STEP))}


def way_of_centre(t: np.ndarray) -> np.ndarray:
    """Mean of u by modes: rho u_tt = 2 mu u_xx + 2 viscosity u_xxt on a bar of length 1, held at x = 0, with the
    traction PULL at x = 1."""
    k = (np.arange(400)[:, None] + 0.5) * np.pi
    rate, square = VISCOSITY * k**2, 2 * MU * k**2
    root = np.sqrt((rate**2 - square).astype(complex))
    slow, fast = -square / (rate + root), -(rate + root)  # roots of s^2 + 2 rate s + square, without cancellation
    answer = ((1 - (fast * np.exp(slow * t) - slow * np.exp(fast * t)) / (fast - slow)) / square).real
    return 2 * PULL * (np.sin(k) / k * answer).sum(axis=0)


def creep_error(run: Run) -> float:
    t, x = run.times("square.position_x"), run.probe("square.position_x")
    late = t >= 1
    return float(np.abs((x - x[0])[late] / way_of_centre(t[late]) - 1).max())


def test_creep(creep: dict[str, Run]) -> None:
    late = {"engine": creep["engine"].steps("dt").max()**2, "reference": REFERENCE_STEP**2}
    for name, run in creep.items():
        CASE.check(Label.EXACT, f"viscosity: creep, {name}", creep_error(run), 0, 0.002 + late[name],
                   "Kelvin-Voigt bar, by modes; both solvers are of second order; the support's compliance is 2e-4 of "
                   "the bar's, and the rest is mesh error during the diffusion in the first second")


def test_what_creep_loses_is_booked(creep: dict[str, Run]) -> None:
    rate = MU / VISCOSITY  # of the slow part of all modes, which carries the energy
    allowed = {"engine": 0.5 * creep["engine"].steps("dt").max() * rate, "reference": (REFERENCE_STEP * rate)**2 / 12}
    for name, run in creep.items():
        CASE.check(Label.EXACT, f"viscosity: balance of energy, {name}", run.balance_error, 0, allowed[name],
                   "a twelfth of (rate x step)^2, rate mu/viscosity; in the engine, whose steps begin during the "
                   "diffusion of the first second, the first-order bound rate x step / 2")


@pytest.fixture(scope="module")
def towed() -> dict[str, Run]:
    scene = CASE.scene("towed.toml", speed=SPEED, stiffness=STIFFNESS, damping=DASHPOT, young=YOUNG)
    return {"engine": CASE.engine("towed_engine", scene), "reference": CASE.reference("towed_reference", scene, "--dt", "0.01")}


def lag(t: np.ndarray) -> np.ndarray:
    """m y'' + c L y' + k L y = 0 with y = x - v t from y(0) = 0, y'(0) = -v."""
    rate, square = DASHPOT * LENGTH / (2 * MASS), STIFFNESS * LENGTH / MASS
    damped = np.sqrt(square - rate**2)
    return -SPEED / damped * np.exp(-rate * t) * np.sin(damped * t)


def test_a_towed_square_comes_along(towed: dict[str, Run]) -> None:
    for name, run in towed.items():
        t = run.times("square.position_x")
        error = np.abs(run.probe("square.position_x") - SPEED * t - lag(t)).max() / np.abs(lag(t)).max()
        CASE.check(Label.EXACT, f"support: lag behind the far end, {name}", error, 0, STIFFNESS * LENGTH / YOUNG,
                   "the square deforms by k L / E of its side at most, and so does the lag; errors of 10 ms steps are "
                   "smaller")


def test_picture(flights: dict[str, dict[float, Run]], creep: dict[str, Run], towed: dict[str, Run]) -> None:
    figure, axes = panels(3, "Damping", across=True)
    curves = [(f"{body}, {name}", STEPS, flight_errors(runs, body)) for body in FLIGHTS for name, runs in flights.items()]
    draw_orders(axes[0], "mass damping: distance", curves, [1, 2])
    for (name, run), colour, style in zip(creep.items(), COLOURS, ("-", "--")):
        t, x = run.times("square.position_x"), run.probe("square.position_x")
        axes[1].plot(t, (x - x[0]) / PULL, style, color=colour, linewidth=1.1, label=name)
    axes[1].plot(t, way_of_centre(t) / PULL, ":", color=COLOURS[6], linewidth=1.5, label="closed form")
    describe(axes[1], "viscosity: creep of a square over the pull", "time [s]")
    for (name, run), colour, style in zip(towed.items(), COLOURS, ("-", "--")):
        t = run.times("square.position_x")
        axes[2].plot(t, run.probe("square.position_x") - SPEED * t, style, color=colour, linewidth=1.1, label=name)
    axes[2].plot(t, lag(t), ":", color=COLOURS[6], linewidth=1.5, label="closed form")
    describe(axes[2], "support that moves: lag", "time [s]")
    for panel in axes[1:]:
        legend(panel)
    save(CASE, figure, "damping")
