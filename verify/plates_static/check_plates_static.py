"""Equilibrium of a squeezed disc: the reference's statics against the engine's damped motion."""

from __future__ import annotations

import numpy as np
import pytest

from histories import speeds
from pictures import COLOURS, legend, panels, save
from squeeze import NEWTON, force_of_motion
from verification import FULL, Case, Label, Run

CASE = Case(__file__, fast=True)
NODES = 340 if FULL else 168
APPROACHES = [0.05, 0.1, 0.15, 0.2, 0.25, 0.3]
STIFFNESS = 3e3  # of contact, as in the scene
GAP = 0.001  # of either plate at the start
PAUSE = 100.0  # s between steps
RAMP = 6.0  # s of motion in each
STEP = 1.0  # of the statics, s
# Bearings: springs of 1 mu/R on the two segments at each end of both axes, parallel to the plates at the poles and
# normal to them at the sides. With a symmetric outline and mesh, all nodes there would stay on their axes.
BEARINGS = [(0.0, "y"), (np.pi, "y"), (np.pi / 2, "x"), (-np.pi / 2, "x")]
REACH = 0.1  # rad to either side: middles of segments lie at 0.065 (168 nodes), 0.046 (340)
# 1/s: of the mass; decay of the slowest motion, creep along the plates: w^2 over the damping.
DAMPING, SLOWEST = 1.0, 0.165
# Share of a segment: within it of a bisector, a node belongs to the following segment (docs/method.md 4).
TIES = 1e-9
SOURCE = "force of residual motion, from its kinetic energy by Cauchy and Schwarz; Newton's method"
# Frictionless: dolfinx 0.5.2, quadratic triangles, infinite penalty, error 1e-4; lambda = 4 mu.
FINITE_ELEMENTS = [0.1051389406525349, 0.258472983976877, 0.4545345427439884, 0.6990259315023695, 1.0026247766513285,
                   1.3811043025520182]
# Height of the poles of the equal-area polygon of 48 or 68 sides: an approach, with an effect of at least 1.15 / D.
POLES = (2 * np.pi / (68 if FULL else 48)) ** 2 / 12
REST_TIMES = PAUSE * np.arange(1, len(APPROACHES) + 1)
REST = 0.005  # 0.15 % of the penalty and the second-order error of the mesh


def bearings() -> str:
    return "\n".join(f"""[[boundary]]
of = "disc"
part = {{ angles = [{direction - REACH!r}, {direction + REACH!r}] }}
{axis} = "fixed"
stiffness = 1
""" for direction, axis in BEARINGS)


def scene(held: bool) -> str:
    up = speeds([-GAP, *APPROACHES], PAUSE, RAMP)
    down = [[t, -v] for t, v in up]
    return CASE.scene(nodes=NODES, end=PAUSE * len(APPROACHES), rest=PAUSE, up=up, down=down,
                      bearings=bearings() if held else "")


@pytest.fixture(scope="module")
def runs() -> dict[str, Run]:
    reference = CASE.reference("reference", scene(held=True), "--static", "--dt", str(STEP))
    return {"engine": CASE.engine("engine", scene(held=True)), "reference": reference}


@pytest.fixture(scope="module")
def free() -> Run:
    return CASE.reference("free", scene(held=False), "--static", "--dt", str(STEP))


def unrest(engine: Run) -> np.ndarray:
    """[approaches] relative bound of the difference between its forces and those at rest."""
    force, gap, kinetic = (engine.at(name, REST_TIMES)
                           for name in ("upper.force_y", "plate.position_y", "energy.kinetic"))
    return force_of_motion(force, 2 * gap, kinetic, DAMPING / SLOWEST) / force


def rounding(force: np.ndarray) -> np.ndarray:
    """[approaches] relative rounding error of the balance. A position on the outline is a sum of some ten products
    about 1, off by ten halves of eps at most. The error changes when a node alternates between two numbers, and
    contacts move the disc by as much, at worst all in one direction. Contact faces are at most as long as the chords
    cut off by the plates."""
    in_touch = 2 * np.sqrt(1 - (1 - np.array(APPROACHES)) ** 2)
    return 2 * STIFFNESS * in_touch * 5 * np.finfo(float).eps / force


def ties(force: np.ndarray) -> np.ndarray:
    """[approaches] relative error of the force of a plate node on a bisector of the disc. It alternates between two
    segments, whose lines are TIES times the turn of the outline apart there."""
    side = 2 * np.pi / (68 if FULL else 48)
    return 2 * 0.5 * STIFFNESS * side * TIES * side * side / force


@pytest.mark.parametrize("number", range(len(APPROACHES)), ids=lambda i: f"{100 * APPROACHES[i]:g}")
def test_force_on_the_plates(runs: dict[str, Run], number: int) -> None:
    at = REST_TIMES[number:number + 1]
    engine, reference = (float(runs[name].at("upper.force_y", at)[0]) for name in ("engine", "reference"))
    percent = f"{100 * APPROACHES[number]:g} %"
    CASE.check(Label.INDEPENDENT, f"force at {percent}: engine over reference", engine / reference, 1,
               unrest(runs["engine"])[number] + NEWTON, SOURCE)
    expected = FINITE_ELEMENTS[number]
    CASE.check(Label.INDEPENDENT, f"force at {percent}: engine over finite elements", engine / expected, 1,
               1.15 * POLES / APPROACHES[number] + REST, "dolfinx 0.5.2; poles of the polygon, penalty, mesh")
    gap = float((runs["engine"].at("plate.position_y", at) - (1 - APPROACHES[number]))[0])
    CASE.check(Label.EXACT, f"plate at {percent}", gap, 0, 1e-12, "imposed motion; rounding")


def test_at_rest_and_balanced(runs: dict[str, Run], free: Run) -> None:
    engine = runs["engine"]
    kinetic, strain = (engine.at(f"energy.{name}", REST_TIMES) for name in ("kinetic", "strain"))
    creep = 1e-4 * SLOWEST * np.exp(-SLOWEST * (PAUSE - RAMP))
    CASE.check(Label.EXACT, "engine: kinetic over strain energy at rest", (kinetic / strain).max(), 0,
               0.5 * np.pi * creep**2 / strain[0], "slowest motion: creep along the plates, from 1e-4 R after the ramp")
    upper, lower = (engine.at(f"{plate}.force_y", REST_TIMES) for plate in ("upper", "lower"))
    off = np.abs(upper + lower - engine.at("bearings.applied_force_y", REST_TIMES)) / upper
    allowed = (DAMPING + SLOWEST) * np.sqrt(2 * np.pi * kinetic) / upper + rounding(upper) + ties(upper)
    worst = (off / allowed).argmax()
    CASE.check(Label.EXACT, "engine: upper, lower and bearings' force, over the upper", off[worst], 0, allowed[worst],
               "damping and inertia of residual motion: the momentum is at most the root of 2 mass x kinetic energy; "
               "rounding of positions; nodes on a bisector")
    upper, lower = (free.at(f"{plate}.force_y", REST_TIMES) for plate in ("upper", "lower"))
    CASE.check(Label.EXACT, "free: upper and lower force", np.abs((upper + lower) / upper).max(), 0, NEWTON,
               "balance; Newton's 1e-10 of the forces that cancel at each of some ten nodes in contact")


@pytest.mark.parametrize("number", range(len(APPROACHES)), ids=lambda i: f"{100 * APPROACHES[i]:g}")
def test_free_disc(free: Run, number: int) -> None:
    force = float(free.at("upper.force_y", REST_TIMES[number:number + 1])[0])
    CASE.check(Label.INDEPENDENT, f"free at {100 * APPROACHES[number]:g} %: reference over finite elements",
               force / FINITE_ELEMENTS[number], 1, 1.15 * POLES / APPROACHES[number] + REST,
               "dolfinx 0.5.2; facets or corners at the poles, penalty, mesh")


def test_picture(runs: dict[str, Run], free: Run) -> None:
    figure, axes = panels(3, f"Disc of {NODES} nodes between frictionless plates", across=True)
    force = {name: run.at("upper.force_y", REST_TIMES)
             for name, run in {**runs, "reference, free to spin": free}.items()}
    for (name, values), colour, style in zip(force.items(), COLOURS, ("o-", "s--", "x:")):
        axes[0].plot(100 * np.array(APPROACHES), values, style, color=colour, linewidth=1.1, markersize=4, label=name)
    percent = 100 * np.array(APPROACHES)
    axes[0].plot(percent, FINITE_ELEMENTS, ":", color=COLOURS[6], linewidth=1.5, label="finite elements")
    axes[0].set_ylabel("force on a plate over mu R")
    legend(axes[0])
    axes[1].semilogy(percent, np.abs(force["engine"] / force["reference"] - 1), "o-", color=COLOURS[0], linewidth=1.1)
    axes[1].semilogy(percent, unrest(runs["engine"]) + NEWTON, ":", color=COLOURS[6], linewidth=1.0)
    axes[1].set_ylabel("|engine over reference - 1|, in bearings")
    for (name, values), colour, style in zip(force.items(), COLOURS, ("o-", "s--", "x:")):
        axes[2].plot(percent, 100 * (values / FINITE_ELEMENTS - 1), style, color=colour, linewidth=1.1, markersize=4,
                     label=name)
    allowed = 100 * (1.15 * POLES / np.array(APPROACHES) + REST)
    for sign in (1, -1):
        axes[2].plot(percent, sign * allowed, ":", color=COLOURS[6], linewidth=1.0)
    axes[2].set_ylabel("force over finite elements, less 1 [%]")
    legend(axes[2])
    for panel in axes:
        panel.set_xlabel("approach over the diameter [%]")
    save(CASE, figure, "plates_static")
