"""A bond that wears and tears: driven, against an integration of its law; pulled by a compliant block, both solvers."""

from __future__ import annotations

import numpy as np
import pytest

from order_study import Quantity, Study, check_differences, run_study
from pictures import COLOURS, draw_both, draw_differences, legend, panels, save
from verification import Case, Label, Run

CASE = Case(__file__)

# Of driven.toml; nodes in touch: eleven of the block and ten of the bench, 0.1 each, a pass counts half.
STRENGTH, STIFFNESS, RANGE, THRESHOLD, RATE_OF_WEAR = 1.0, 1000.0, 0.01, 0.3, 0.4
CRITICAL = STRENGTH / STIFFNESS
LENGTH = 0.5 * (11 + 10) * 0.1
# Up and down twice, to 0.8 and to 0.9 of the critical gap, then off: corners of the velocity, m/s.
CORNERS = [(0, 0), (0.1, 0.002), (0.4, 0.002), (0.6, -0.002), (0.9, -0.002), (1.0, 0), (1.1, 0.00225), (1.4, 0.00225),
           (1.6, -0.00225), (1.9, -0.00225), (2.0, 0), (2.1, 0.02), (2.7, 0.02)]
DRIVEN_STEPS = [0.01, 0.005, 0.0025, 0.00125]

STEPS = [0.02, 0.01, 0.005]
FINEST = 0.0025
TIMES = 0.12 * np.arange(1, 101)
POSITIONS = Quantity("positions", ["block.position_y", "corner.position_y"])
FORCE = Quantity("force on the bench", ["force.force_y"])
DISSIPATION = Quantity("work of damage", ["works.dissipated_by_contact"])


def gap_at(times: np.ndarray) -> np.ndarray:
    """Integral of the velocity between its corners."""
    fine = np.unique(np.concatenate([times, [t for t, _ in CORNERS]]))
    speed = np.interp(fine, *zip(*CORNERS))
    gap = np.concatenate([[0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(fine))])
    return gap[np.searchsorted(fine, times)]


def opened(damage: float, gap: float) -> float:
    """Damage that an opening brings at once."""
    return RANGE / (RANGE - CRITICAL) * (1 - CRITICAL / gap) if gap > CRITICAL else 0.0


def bond(gap: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Damage and pull of the law, per area, along gaps in fine steps, by the midpoint rule: as p grows,
    dD = rate (p - threshold)+ / (strength - threshold) dp, with dp = stiffness (1 - D) dg."""
    damage, pull, now = np.zeros_like(gap), np.zeros_like(gap), 0.0

    def growth(d: float, g: float) -> float:
        return RATE_OF_WEAR * max(STIFFNESS * (1 - d) * g - THRESHOLD, 0) / (STRENGTH - THRESHOLD) * STIFFNESS * (1 - d)

    for i in range(1, len(gap)):
        way = gap[i] - gap[i - 1]
        if way > 0 and now < 1:
            half = now + 0.5 * way * growth(now, gap[i - 1])
            now += way * growth(half, 0.5 * (gap[i] + gap[i - 1]))
        now = min(max(now, opened(now, gap[i])), 1.0)
        damage[i], pull[i] = now, STIFFNESS * (1 - now) * gap[i]
    return damage, pull


@pytest.fixture(scope="module")
def driven() -> dict[str, dict[float, Run]]:
    velocity = str([list(corner) for corner in CORNERS])
    runs: dict[str, dict[float, Run]] = {"engine": {}, "reference": {}}
    for dt in DRIVEN_STEPS:
        scene = CASE.scene("driven.toml", dt=dt, velocity=velocity)
        runs["engine"][dt] = CASE.engine(f"driven_engine_{dt:g}", scene)
        runs["reference"][dt] = CASE.reference(f"driven_reference_{dt:g}", scene, "--dt", repr(dt))
    return runs


def law_on(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """Gap and pull (N/m) by the law, when the force was measured."""
    times = run.times("force.force_y")
    fine = np.linspace(0, times[-1], 54001)
    return gap_at(times), LENGTH * np.interp(times, fine, bond(gap_at(fine))[1])


@pytest.mark.parametrize("solver", ["engine", "reference"])
def test_driven_bond_follows_the_law(driven: dict[str, dict[float, Run]], solver: str) -> None:
    """Wear in steps is of first order; the gap itself is exact."""
    worn, torn = [], []
    for dt, run in driven[solver].items():
        gap, pull = law_on(run)
        missed = np.abs(run.probe("block.position_y") - 0.2 - gap).max() / CRITICAL
        CASE.check(Label.EXACT, f"driven, {solver}: gap, dt {dt:g}", missed, 0, 1e-10,
                   "imposed motion; rounding of positions near 0.2 over 0.001")
        error = np.abs(run.probe("force.force_y") + pull) / (STRENGTH * LENGTH)
        wears = gap < (1 + 1e-6) * CRITICAL
        worn.append(float(error[wears].max()))
        torn.append(float(error[~wears].max()))
    CASE.check_rate(f"driven, {solver}: force while it wears", DRIVEN_STEPS, worn, 1, 0.2,
                    "a step's wear counts the damage at its start: first order")
    CASE.check(Label.INDEPENDENT, f"driven, {solver}: force while it wears, finest step", worn[-1], 0, worn[-2] / 1.7,
               "half of that at twice the step: nothing stays")
    CASE.check(Label.EXACT, f"driven, {solver}: force while it tears, finest step", torn[-1], 0, 1e-9,
               "the damage of the opening, whatever was worn before; rounding of gaps")


@pytest.mark.parametrize("solver", ["engine", "reference"])
def test_work_of_the_driven_bond(driven: dict[str, dict[float, Run]], solver: str) -> None:
    """All of it is dissipated: the integral of the pull over the gap."""
    fine = np.linspace(0, CORNERS[-1][0], 54001)
    gap = gap_at(fine)
    pull = bond(gap)[1]
    work = LENGTH * float((0.5 * (pull[1:] + pull[:-1]) * np.diff(gap)).sum())
    errors = [abs(run.probe("energy.dissipated")[-1] / work - 1) for run in driven[solver].values()]
    CASE.check_rate(f"driven, {solver}: work to tear the bond off", DRIVEN_STEPS, errors, 1.5, 0.6,
                    "wear is of first order, sums over the way of second: between them, 0.1 for scatter")
    CASE.check(Label.INDEPENDENT, f"driven, {solver}: work to tear the bond off, finest step", 1 + errors[-1], 1,
               errors[-2], "no more than at twice the step: nothing stays")


def test_driven_solvers_agree(driven: dict[str, dict[float, Run]]) -> None:
    dt = DRIVEN_STEPS[-1]
    engine, reference = (driven[solver][dt].probe("force.force_y") for solver in ("engine", "reference"))
    late = driven["engine"][dt].times("force.force_y") > 0.1
    difference = np.abs(engine - reference)[late].max() / (STRENGTH * LENGTH)
    CASE.check(Label.INDEPENDENT, "driven: engine - reference, force", difference, 0, 1e-6,
               "same steps but for the engine's first ones, when nothing wears")


@pytest.fixture(scope="module")
def pulled() -> Study:
    return run_study(CASE, "pulled", STEPS, FINEST, TIMES, template="pulled.toml")


@pytest.mark.parametrize("quantity", [POSITIONS, FORCE, DISSIPATION], ids=lambda q: q.name)
def test_pulled_bond_converges(pulled: Study, quantity: Quantity) -> None:
    check_differences(CASE, "pulled", pulled, quantity, 1.25, 0.45,
                      "the engine's dashpots and wear are of first order, the rest of second: little above the first")


def test_picture(driven: dict[str, dict[float, Run]], pulled: Study) -> None:
    figure, axes = panels(3, "Bond that wears and tears", across=True)
    dt = DRIVEN_STEPS[-1]
    fine = gap_at(np.linspace(0, CORNERS[-1][0], 5401))
    axes[0].plot(fine / CRITICAL, LENGTH * bond(fine)[1], color=COLOURS[6], linewidth=2.5, alpha=0.5, label="law")
    for solver, colour, style in zip(driven, COLOURS, ("-", "--")):
        run = driven[solver][dt]
        gap = (run.probe("block.position_y") - 0.2) / CRITICAL
        axes[0].plot(gap, -run.probe("force.force_y"), style, color=colour, linewidth=1.1, label=solver)
    axes[0].set_title("driven rigid block", fontsize=10, loc="left")
    axes[0].set_xlabel("gap over the critical one")
    axes[0].set_ylabel("pull [N/m]")
    draw_both(axes[1], pulled.finest_runs(), "force.force_y", 1e3)
    axes[1].set_title("pulled compliant block", fontsize=10, loc="left")
    axes[1].set_xlabel("time [s]")
    axes[1].set_ylabel("pull on the bench [mN/m]")
    for panel in axes[:2]:
        legend(panel)
    draw_differences(axes[2], pulled, [POSITIONS, FORCE, DISSIPATION])
    save(CASE, figure, "fatigue_bond")
