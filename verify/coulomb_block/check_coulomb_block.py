"""Coulomb friction with stick, slip and reversal: a driven block against closed forms, a pulled one in both solvers."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest

from order_study import Quantity, Study, check_differences, run_study
from pictures import COLOURS, describe, draw_both, draw_differences, legend, panels, save
from verification import Case, Label, Run

CASE = Case(__file__)

WEIGHT, FRICTION, STIFFNESS = 1.0, 0.3, 1000.0
SETTLED = 1.0  # s, start of the drive
LENGTH = 1.05  # contact length at nodes: (1.1 of the block + 1 of the floor)/2
RESIDUE = np.exp(-30 * SETTLED)  # of the first oscillation: damping 60 /s, frequency 32.4 /s, so it decays by 30 /s
ROUNDING = 1e-9  # positions near 1 with 2e-16 of rounding, stiffness 1000, forces of 0.3; Newton stops at 1e-10

STEPS = [0.01, 0.005, 0.0025]
FINEST = 0.00125
QUADRATURES = ["nodes", "segments"]
TIMES = 0.08 * np.arange(1, 101)
POSITIONS = Quantity("positions", ["block.position_x", "corner.position_x"])
DISSIPATION = Quantity("dissipation", ["energy.dissipated"])
FORCE = Quantity("force on the floor", ["force.force_x"])


def friction_force(x: np.ndarray) -> np.ndarray:
    """Force on the floor of a spring that slips at friction times weight, displaced by x (the play operator)."""
    limit, force = FRICTION * WEIGHT, np.zeros_like(x)
    for i in range(1, len(x)):
        force[i] = np.clip(force[i - 1] + STIFFNESS * LENGTH * (x[i] - x[i - 1]), -limit, limit)
    return force


def friction_work(x: np.ndarray, force: np.ndarray) -> float:
    """Sum of each step's mean force times its slip, as required by the energy balance."""
    slipped = np.diff(x) - np.diff(force) / (STIFFNESS * LENGTH)
    return float((0.5 * (force[1:] + force[:-1]) * slipped).sum())


@pytest.fixture(scope="module")
def driven() -> dict[str, Run]:
    scene = CASE.scene("driven.toml", dt=0.01)
    reference = CASE.reference("driven_reference", scene, "--dt", "0.01")
    return {"engine": CASE.engine("driven_engine", scene), "reference": reference}


@pytest.mark.parametrize("solver", ["engine", "reference"])
def test_driven_block_follows_the_closed_form(driven: dict[str, Run], solver: str) -> None:
    run = driven[solver]
    after = run.times("clock.force_x") >= SETTLED
    x, force = run.probe("drive.position_x")[after], run.probe("clock.force_x")[after]
    expected = friction_force(x)
    error = np.abs(force - expected).max() / (FRICTION * WEIGHT)
    CASE.check(Label.EXACT, f"driven, {solver}: friction force", error, 0, RESIDUE + ROUNDING,
               "play operator; residue of the first oscillation plus rounding")
    CASE.check(Label.EXACT, f"driven, {solver}: slip force over weight", force.max() / WEIGHT, FRICTION,
               RESIDUE + ROUNDING, "Coulomb")
    lost = run.probe("energy.dissipated")[-1] - run.at("energy.dissipated", np.array([SETTLED]))[0]
    damped = run.probe("works.dissipated_by_damping")
    damped = damped[-1] - run.at("works.dissipated_by_damping", np.array([SETTLED]))[0]
    CASE.check(Label.EXACT, f"driven, {solver}: friction work", (lost - damped) / friction_work(x, expected), 1,
               RESIDUE + ROUNDING, "mean friction force times sliding distance, summed over steps")


def study_of(quadrature: str) -> Study:
    return run_study(CASE, f"pulled_{quadrature}", STEPS, FINEST, TIMES, template="pulled.toml", quadrature=quadrature)


def title_of(quadrature: str) -> str:
    return "pulled" if quadrature == "nodes" else "pulled, integrated"


@pytest.fixture(scope="module")
def pulled() -> Callable[[str], Study]:
    return cache(study_of)


@pytest.mark.parametrize("quadrature", QUADRATURES)
@pytest.mark.parametrize("quantity", [POSITIONS, DISSIPATION, FORCE], ids=lambda q: q.name)
def test_pulled_block_converges(pulled: Callable[[str], Study], quantity: Quantity, quadrature: str) -> None:
    check_differences(CASE, title_of(quadrature), pulled(quadrature), quantity, 1.5, 0.8,
                      "stick and slip begin within steps: between first and second order; 0.3 for scatter")


@pytest.mark.parametrize("quadrature", QUADRATURES)
def test_pulled_block_slips_at_the_friction_angle(pulled: Callable[[str], Study], quadrature: str) -> None:
    """Mean friction factor during slip in one direction. Normals of the deformed block turn by some 1e-4."""
    for name, run in pulled(quadrature).finest_runs().items():
        times = run.times("force.force_x")
        slips = (times > 4.0) & (times < 5.5)
        ratio = np.abs(run.probe("force.force_x")[slips] / run.probe("force.force_y")[slips])
        CASE.check(Label.EXACT, f"{title_of(quadrature)}, {name}: friction factor in slip", ratio.mean(), FRICTION, 1e-3 * FRICTION,
                   "Coulomb; normals turn by the face's slope, 1e-3 at most")


def test_picture(driven: dict[str, Run], pulled: Callable[[str], Study]) -> None:
    nodes = pulled("nodes")
    figure, axes = panels(3, "Block with Coulomb friction", across=True)
    for (name, run), colour, style in zip(driven.items(), COLOURS, ("-", "--")):
        after = run.times("clock.force_x") >= SETTLED
        x = run.probe("drive.position_x")[after]
        force = run.probe("clock.force_x")[after]
        axes[0].plot((x - x[0]) * 1e3, force, style, color=colour, linewidth=1.1, label=name)
    describe(axes[0], "driven rigid block, weight 1 N/m", "position [mm]", "force on the floor [N/m]")
    draw_both(axes[1], nodes.finest_runs(), "force.force_x", 1e3)
    limit = FRICTION * np.abs(nodes.engine[FINEST].probe("force.force_y")) * 1e3
    times = nodes.engine[FINEST].times("force.force_y")
    axes[1].plot(times, limit, ":", color=COLOURS[6], linewidth=1.0, label="friction x normal force")
    axes[1].plot(times, -limit, ":", color=COLOURS[6], linewidth=1.0)
    describe(axes[1], "pulled compliant block", "time [s]", "force on the floor [mN/m]")
    for panel in axes[:2]:
        legend(panel)
    draw_differences(axes[2], nodes, [POSITIONS, DISSIPATION, FORCE])
    save(CASE, figure, "coulomb_block")
