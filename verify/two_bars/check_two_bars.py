"""Two equal bars meet head-on: wave theory against both solvers."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.axes import Axes

from pictures import COLOURS, MARKERS, describe, draw_rate, legend, panels, save, set_ticks
from verification import FULL, Case, Label, Run

CASE = Case(__file__)

LENGTH, HEIGHT, SPEED = 4.0, 0.5, 1e-3  # of a bar; closing speed
WAVE = np.sqrt(2.0)  # sqrt(E/rho), E = 2, rho = 1, nu = 0
STRESS = WAVE * SPEED / 2  # rho c v/2: each bar changes its velocity by v/2 behind its front, the face is at rest
FORCE = STRESS * HEIGHT
CONTACT_TIME = 2 * LENGTH / WAVE
SPACINGS = [1 / 8, 1 / 12, 1 / 16, 1 / 24, 1 / 32, *([1 / 64] if FULL else [])]
MASSES = ["lumped", "corrected"]
CLOCK = 0.01
# A front in a chain of lumped masses, w = c k (1 - (k h)^2/24), spreads to (h^2 s/8)^(1/3) over a distance s, here
# 2 L = 8: h^(2/3).
FRONT = "fronts of a lattice spread to (h^2 s/8)^(1/3) over a distance s"

# Chatter at the faces and the phase of ringing scatter errors. Values are standard deviations of their logarithms about
# a straight line in a chain with the same penalty (chain.py), with lumped masses and corrected ones.
SCATTER = {"stress": 0.080, "lumped": 0.129, "corrected": 0.065}


def order_of_two(first: float, second: float, scatter: float) -> tuple[float, float]:
    """Mean of the orders of two terms, and half their difference plus twice the scatter of a slope over SPACINGS."""
    width = np.log(SPACINGS) - np.log(SPACINGS).mean()
    return (first + second) / 2, abs(second - first) / 2 + 2 * scatter / float(np.sqrt((width**2).sum()))


def front_width(h: float) -> float:
    return (h**2 * 2 * LENGTH / 8) ** (1 / 3)


def scene(h: float, mass: str) -> str:
    return CASE.scene(spacing=h, mass=mass, clock=CLOCK)


@pytest.fixture(scope="module")
def runs() -> dict[str, dict[float, Run]]:
    return {mass: {h: CASE.engine(f"engine_{mass}_{1 / h:.0f}", scene(h, mass)) for h in SPACINGS} for mass in MASSES}


def mean_stress(t: np.ndarray) -> np.ndarray:
    """Mean stress of a bar during contact: fronts travel to the free end, and back as release waves."""
    return -STRESS * np.clip(np.minimum(t * WAVE / LENGTH, 2 - t * WAVE / LENGTH), 0, None)


def stress_error(run: Run) -> float:
    """Largest error of the mean stress of a bar during contact, over rho c v/2."""
    t = run.times("stress.stress_xx")
    off = np.abs(run.probe("stress.stress_xx") - mean_stress(t))
    return float(off[t < CONTACT_TIME].max() / STRESS)


def mean_force(run: Run) -> tuple[float, float]:
    """Mean force over FORCE while fronts travel, and its duration; from momentum, as samples of ringing alias."""
    t, speed = run.times("right.velocity_x"), run.probe("right.velocity_x")
    first, last = np.flatnonzero((t > 0.5) & (t < CONTACT_TIME - 0.7))[[0, -1]]
    lasts = float(t[last] - t[first])
    return float(abs(speed[last] - speed[first])) / lasts * LENGTH * HEIGHT / FORCE, lasts


def lost_velocity(run: Run) -> float:
    """1 less the ratio of final and initial mean velocity; wave theory: 0."""
    return 1 - float(run.probe("right.velocity_x")[-1]) / (SPEED / 2)


@pytest.mark.parametrize("mass", MASSES)
def test_stress_and_time(runs: dict[str, dict[float, Run]], mass: str) -> None:
    for h, run in runs[mass].items():
        t, force = run.times("force.force_x"), run.probe("force.force_x")
        name = f"{mass}, h = 1/{1 / h:.0f}"
        mean, lasts = mean_force(run)
        CASE.check(Label.EXACT, f"{name}: mean force over rho c v/2 x height", mean, 1, h / WAVE / lasts,
                   "wave theory; one period of the faces' ringing, h/c, at the ends of the averaging interval")
        CASE.check(Label.EXACT, f"{name}: end of contact less 2 L/c", t[force > 0].max() - CONTACT_TIME, 0,
                   2 * front_width(h) / WAVE + CLOCK, f"wave theory; {FRONT}, two widths of which lie ahead")


def test_order_of_the_stress(runs: dict[str, dict[float, Run]]) -> None:
    """With lumped masses; corrected ones have 1.7, then 1.2, and are outside the asymptotic range."""
    CASE.check_rate("lumped: largest error of a bar's mean stress", SPACINGS,
                    [stress_error(runs["lumped"][h]) for h in SPACINGS], *order_of_two(2 / 3, 1, SCATTER["stress"]),
                    "h^(2/3) of spreading fronts, h of the penalty and of half a spacing at the faces; twice the "
                    "chain's scatter")


@pytest.mark.parametrize("mass", MASSES)
def test_order_of_the_velocity(runs: dict[str, dict[float, Run]], mass: str) -> None:
    second = 2 / 3 if mass == "lumped" else 1
    CASE.check_rate(f"{mass}: velocity not exchanged", SPACINGS, [lost_velocity(runs[mass][h]) for h in SPACINGS],
                    *order_of_two(2 / 3, second, SCATTER[mass]),
                    "energy left as ringing behind fronts, h^(2/3); with corrected masses these ring less, and h of "
                    "the faces matters; twice the chain's scatter")


def test_balances(runs: dict[str, dict[float, Run]]) -> None:
    run = runs["lumped"][SPACINGS[-1]]
    total = np.abs(run.probe("left.velocity_x") + run.probe("right.velocity_x")).max() / SPEED
    CASE.check(Label.EXACT, "sum of the velocities over v", total, 0, 1e-11, "momentum; rounding of sums over 1e4 "
                                                                             "steps and 1e3 nodes")
    CASE.check(Label.EXACT, "energy balance", run.balance_error, 0, 8.5e-4, "docs/notes/impacts.md: 1.7e-4 of a "
                                                                            "bounce at most; five of them")


def test_both_solvers() -> None:
    """On the coarsest mesh, over the whole run."""
    text = scene(SPACINGS[0], "lumped")
    reference = CASE.reference("reference_8", text, "--dt", repr(CLOCK))
    engine = Run(CASE.out / "engine_lumped_8")
    a, b = (run.probe("left.velocity_x") for run in (engine, reference))
    CASE.check(Label.INDEPENDENT, "h = 1/8: largest difference of mean velocities over v", np.abs(a - b).max() / SPEED,
               0,
               SPACINGS[0] / (2 * LENGTH), "chatter of faces: one bounce is rho c v/2 over a period h/c, on the mass "
                                           "rho L")


def draw_force(axes: Axes, runs: dict[str, dict[float, Run]]) -> None:
    for h, colour in list(zip(SPACINGS, COLOURS))[::2]:
        run = runs["lumped"][h]
        axes.plot(run.times("force.force_x"), run.probe("force.force_x") / FORCE, color=colour, linewidth=0.6,
                  label=f"h = 1/{1 / h:.0f}")
    axes.plot([0, 0, CONTACT_TIME, CONTACT_TIME, 8], [0, 1, 1, 0, 0], color=COLOURS[7], linewidth=1.4,
              label="wave theory")
    axes.set_title("force between the bars / (rho c v/2 x height)", fontsize=9, loc="left")


def draw_errors(axes: Axes, runs: dict[str, dict[float, Run]]) -> None:
    curves = [(f"{what}, {mass}", [error(runs[mass][h]) for h in SPACINGS])
              for what, error in (("mean stress", stress_error), ("velocity lost", lost_velocity)) for mass in MASSES]
    for (name, values), colour, marker in zip(curves, COLOURS, MARKERS):
        draw_rate(axes, SPACINGS, values, name, colour, marker)
    h = np.array([SPACINGS[0], SPACINGS[-1]])
    for order, style, name in ((2 / 3, "--", "2/3"), (1, ":", "1")):
        axes.loglog(h, 0.004 * (h / h[-1]) ** order, style, color=COLOURS[6], linewidth=1.0, label=f"slope {name}")
    set_ticks(axes, SPACINGS, [f"1/{1 / h:.0f}" for h in SPACINGS])
    describe(axes, "errors", "spacing")
    legend(axes)


def test_picture(runs: dict[str, dict[float, Run]]) -> None:
    figure, axes = panels(3, "Two equal bars head-on", across=True)
    t = np.linspace(0, 8, 801)
    draw_force(axes[0], runs)
    axes[1].plot(t, np.where(t < CONTACT_TIME, mean_stress(t), 0) / STRESS, color=COLOURS[7], linewidth=1.4,
                 label="wave theory")
    axes[1].plot(t, np.clip(1 - 2 * t / CONTACT_TIME, -1, 1), color=COLOURS[7], linewidth=1.4)
    for h, colour in zip(SPACINGS, COLOURS):
        run = runs["lumped"][h]
        times = run.times("stress.stress_xx")
        axes[1].plot(times, run.probe("stress.stress_xx") / STRESS, color=colour, linewidth=0.9,
                     label=f"h = 1/{1 / h:.0f}")
        axes[1].plot(times, run.probe("left.velocity_x") / (SPEED / 2), color=colour, linewidth=0.9)
    axes[1].set_title("left bar: mean velocity / (v/2), mean stress / (rho c v/2)", fontsize=9, loc="left")
    for panel in axes[:2]:
        panel.set_xlabel("time")
        legend(panel)
    draw_errors(axes[2], runs)
    save(CASE, figure, "two_bars")
