"""Equilibrium of a squeezed disc: the reference's statics against the engine's damped motion."""

from __future__ import annotations

import numpy as np
import pytest

from pictures import COLOURS, legend, panels, save
from verification import FULL, Case, Label, Run

CASE = Case(__file__, fast=True)
NODES = 340 if FULL else 168
APPROACHES = [0.05, 0.1, 0.15, 0.2, 0.25, 0.3]
GAP = 0.001  # of either plate at the start
PAUSE = 25.0  # s from one step to the next
RAMP = 6.0  # s of them in motion
STEP = 0.25  # of the statics, s
# Motion decays by exp(-1.5 t), half the mass damping, over the rest of the pause: forces to 1e-12. What differs is
# where nodes first touch, which the tangential springs remember: in statics at the end of a step, in which the plates
# come nearer by up to 0.004. Springs 1000 times as stiff make a difference of 1.7e-4.
SOURCE = "the tangential springs remember where nodes touched first, within a step of statics"
# Frictionless: dolfinx 0.5.2, quadratic triangles, infinite penalty, error 1e-4; lambda = 4 mu.
FINITE_ELEMENTS = [0.1051389406525349, 0.258472983976877, 0.4545345427439884, 0.6990259315023695, 1.0026247766513285,
                   1.3811043025520182]
POLES = 1.4e-3  # by which poles of the equal-area polygon of 168 nodes stand out: approach, worth 1.15 / D of the force
REST = 0.005  # 0.15 % of the penalty and the second-order error of the mesh


def speeds() -> list[list[float]]:
    """Of the lower plate: triangles in time, one an approach."""
    corners: list[list[float]] = []
    closed = -GAP
    for i, approach in enumerate(APPROACHES):
        start, way = i * PAUSE, approach - closed
        corners += [[start, 0.0], [start + RAMP / 2, 2 * way / RAMP], [start + RAMP, 0.0]]
        closed = approach
    return corners


@pytest.fixture(scope="module")
def runs() -> dict[str, Run]:
    up = speeds()
    down = [[t, -v] for t, v in up]
    scene = CASE.scene(nodes=NODES, end=PAUSE * len(APPROACHES), rest=PAUSE, up=up, down=down)
    reference = CASE.reference("reference", scene, "--static", "--dt", str(STEP))
    return {"engine": CASE.engine("engine", scene), "reference": reference}


@pytest.mark.parametrize("number", range(len(APPROACHES)), ids=lambda i: f"{100 * APPROACHES[i]:g}")
def test_force_on_the_plates(runs: dict[str, Run], number: int) -> None:
    at = np.array([PAUSE * (number + 1)])
    engine, reference = (float(runs[name].at("upper.force_y", at)[0]) for name in ("engine", "reference"))
    percent = f"{100 * APPROACHES[number]:g} %"
    CASE.check(Label.INDEPENDENT, f"force at {percent}: engine over reference", engine / reference, 1, 1e-4, SOURCE)
    expected = FINITE_ELEMENTS[number]
    CASE.check(Label.INDEPENDENT, f"force at {percent}: engine over finite elements", engine / expected, 1,
               1.15 * POLES / APPROACHES[number] + REST, "dolfinx 0.5.2; poles of the polygon, penalty, mesh")
    gap = float((runs["engine"].at("plate.position_y", at) - (1 - APPROACHES[number]))[0])
    CASE.check(Label.EXACT, f"plate at {percent}", gap, 0, 1e-12, "imposed motion; rounding")


def test_at_rest_and_balanced(runs: dict[str, Run]) -> None:
    at = PAUSE * np.arange(1, len(APPROACHES) + 1)
    kinetic, strain = (runs["engine"].at(f"energy.{name}", at) for name in ("kinetic", "strain"))
    CASE.check(Label.EXACT, "engine: kinetic over strain energy at rest", (kinetic / strain).max(), 0, 1e-8,
               "the slowest, spin on the tangential springs, decays by exp(-0.5 x 19) at least, energies by the square")
    for name, run in runs.items():
        upper, lower = (run.at(f"{plate}.force_y", at) for plate in ("upper", "lower"))
        CASE.check(Label.EXACT, f"{name}: upper less lower force", np.abs((upper + lower) / upper).max(), 0, 1e-6,
                   "balance of what is at rest: engine by decay, reference by Newton's 1e-10 of what cancels in a node")


def test_picture(runs: dict[str, Run]) -> None:
    figure, axes = panels(2, f"Disc of {NODES} nodes between plates", across=True)
    at = PAUSE * np.arange(1, len(APPROACHES) + 1)
    force = {name: run.at("upper.force_y", at) for name, run in runs.items()}
    for (name, values), colour, style in zip(force.items(), COLOURS, ("o-", "s--")):
        axes[0].plot(100 * np.array(APPROACHES), values, style, color=colour, linewidth=1.1, markersize=4, label=name)
    percent = 100 * np.array(APPROACHES)
    axes[0].plot(percent, FINITE_ELEMENTS, ":", color=COLOURS[6], linewidth=1.5, label="finite elements, frictionless")
    axes[0].set_ylabel("force on a plate over mu R")
    legend(axes[0])
    axes[1].plot(percent, 1e5 * (force["engine"] / force["reference"] - 1), "o-", color=COLOURS[0], linewidth=1.1)
    axes[1].set_ylabel("engine over reference, less 1 [1e-5]")
    for panel in axes:
        panel.set_xlabel("approach over the diameter [%]")
    save(CASE, figure, "plates_static")
