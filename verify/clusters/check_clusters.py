"""Clusters of bonded grains at rest: the reference's statics against the engine's damped motion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from hexagons import SIDES, Grain, cluster, grain_tables, probes, shapes
from pictures import COLOURS, describe, legend, panels, save
from pliant.frames import Frames
from verification import FULL, Case, Label, Run

CASE = Case(__file__, cost=2)
NODES = 168 if FULL else 60
RAMP = 80.0  # s, of the push; in the engine a rest of twice that time follows
STEPS = [6, 24]  # of the statics
DIAMETER = 2.0
CLUSTERS = {"7 compliant": (1, False), "7 mixed": (1, True)}
if FULL:
    CLUSTERS |= {"19 compliant": (2, False), "19 mixed": (2, True)}
REST = 1e-12  # kinetic over strain energy of the engine at the end
TOLERANCE = 1e-6
SOURCE = ("one equilibrium: bonds store energy and nothing slips; what is left of the engine's motion displaces by the root "
          "of kinetic over strain energy, 1e-6 of a deformation of 0.03 R, and changes forces by 1e-6")


@dataclass
class Rest:
    """Final state of a run."""

    displacement: np.ndarray  # [points x 2] of all grains' nodes
    centre: np.ndarray  # [grains x 2]
    force: np.ndarray  # [outline nodes x 2], of contacts
    outline: np.ndarray  # [outline nodes x 2], positions

    @classmethod
    def of(cls, run: Run, grains: list[Grain]) -> Rest:
        frames = Frames(run.folder / "frames.h5", period=None)
        last = len(frames.times) - 1
        displacement = frames.field("bodies", last, "displacement")[:, :2].astype(float)
        outline = frames.positions("outlines", last)
        names = [f"{grain.name}-{k}.force" for grain in grains for k in range(SIDES[NODES][grain.sort])]
        return cls(displacement, last_pair(run, [f"{grain.name}.position" for grain in grains]),
                   last_pair(run, names), outline)

    def difference(self, other: Rest) -> tuple[float, float, float]:
        """Differences of all positions and of centres, over the diameter; of forces, over the largest."""
        return (largest(self.displacement - other.displacement) / DIAMETER,
                largest(self.centre - other.centre) / DIAMETER,
                largest(self.force - other.force) / largest(other.force))


def last_pair(run: Run, names: list[str]) -> np.ndarray:
    return np.array([[run.probe(f"{name}_{axis}")[-1] for axis in "xy"] for name in names])


def largest(values: np.ndarray) -> float:
    return float(np.abs(values).max())


@dataclass
class Result:
    grains: list[Grain]
    run: Run  # of the engine
    engine: Rest
    reference: dict[int, Rest]  # by load steps


def solve(name: str) -> Result:
    rings, mixed = CLUSTERS[name]
    grains, folder = cluster(rings, mixed), name.replace(" ", "_")
    scene = CASE.scene(shapes=shapes(NODES), grains=grain_tables(grains, NODES, RAMP), end=3 * RAMP, ramp=RAMP,
                       probes=probes(grains, NODES, RAMP))
    run = CASE.engine(f"{folder}_engine", scene)
    # Statics need no rest after the push.
    reference = {steps: Rest.of(CASE.reference(f"{folder}_{steps}", scene, "--static", "--dt", f"{RAMP / steps} s",
                                               "--until", f"{RAMP} s"), grains) for steps in STEPS}
    return Result(grains, run, Rest.of(run, grains), reference)


@pytest.fixture(scope="module")
def results() -> dict[str, Result]:
    return {name: solve(name) for name in CLUSTERS}


@pytest.mark.parametrize("name", CLUSTERS)
def test_both_solvers_come_to_rest_alike(results: dict[str, Result], name: str) -> None:
    result = results[name]
    positions, centres, forces = result.engine.difference(result.reference[STEPS[-1]])
    CASE.check(Label.INDEPENDENT, f"{name}: positions over the diameter", positions, 0, 0.03 * TOLERANCE, SOURCE)
    CASE.check(Label.INDEPENDENT, f"{name}: centres over the diameter", centres, 0, 0.03 * TOLERANCE, SOURCE)
    CASE.check(Label.INDEPENDENT, f"{name}: forces over the largest", forces, 0, TOLERANCE, SOURCE)
    kinetic, strain = (result.run.probe(f"energy.{part}")[-1] for part in ("kinetic", "strain"))
    CASE.check(Label.EXACT, f"{name}: kinetic over strain energy", kinetic / strain, 0, REST,
               "state of rest: damping forces, 2 m v, are then below some 1e-6 of the others")


@pytest.mark.parametrize("name", CLUSTERS)
def test_load_steps_do_not_count(results: dict[str, Result], name: str) -> None:
    few, many = (results[name].reference[steps] for steps in STEPS)
    positions, _, forces = few.difference(many)
    source = "equilibria do not depend on the path; Newton's iterations end at 1e-10 of the forces"
    CASE.check(Label.EXACT, f"{name}: positions after {STEPS[0]} and {STEPS[1]} load steps", positions, 0, 1e-9, source)
    CASE.check(Label.EXACT, f"{name}: forces after {STEPS[0]} and {STEPS[1]} load steps", forces, 0, 1e-8, source)


@pytest.mark.parametrize("name", CLUSTERS)
def test_forces_balance(results: dict[str, Result], name: str) -> None:
    """Contact forces balance on all grains together, and on each grain without other loads."""
    result = results[name]
    for solver, rest in (("engine", result.engine), ("reference", result.reference[STEPS[-1]])):
        owner = np.repeat(np.arange(len(result.grains)), [SIDES[NODES][g.sort] for g in result.grains])
        sums = np.array([rest.force[owner == i].sum(axis=0) for i in range(len(result.grains))])
        inner = [sums[i] for i, grain in enumerate(result.grains) if not grain.outer]
        worst = max(largest(np.array(inner)), largest(sums.sum(axis=0))) / largest(rest.force)
        CASE.check(Label.EXACT, f"{name}, {solver}: balance of forces", worst, 0, 1e-8,
                   "Newton's 1e-10 of the forces that cancel at a node, some ten nodes in contact; the engine's rest")


def test_picture(results: dict[str, Result]) -> None:
    figure, axes = panels(2, f"Bonded clusters at rest, {NODES} nodes a grain", across=True)
    drawn = list(CLUSTERS)[-1]
    draw_forces(axes[0], drawn, results[drawn])
    for (name, result), colour in zip(results.items(), COLOURS):
        rest = result.reference[STEPS[-1]]
        size = np.linalg.norm(rest.force, axis=1) / largest(rest.force)
        error = np.linalg.norm(rest.force - result.engine.force, axis=1) / largest(rest.force)
        touching = size > 0
        axes[1].loglog(size[touching], error[touching], ".", color=colour, markersize=4, label=name)
    axes[1].axhline(TOLERANCE, linestyle=":", color=COLOURS[6], linewidth=1.2)
    describe(axes[1], x="force on a node over the largest", y="engine - reference, over the largest")
    legend(axes[1])
    save(CASE, figure, "clusters")


def draw_forces(axes, name: str, result: Result) -> None:
    first = 0
    for grain in result.grains:
        last = first + SIDES[NODES][grain.sort]
        x = result.engine.outline[first:last]
        axes.fill(*x.T, facecolor="0.75" if grain.rigid else "0.93", edgecolor="0.4", linewidth=0.6)
        first = last
    count = first
    for rest, colour, width, solver in ((result.engine, COLOURS[0], 0.009, "engine"),
                                      (result.reference[STEPS[-1]], COLOURS[1], 0.003, "reference")):
        axes.quiver(*rest.outline[:count].T, *rest.force.T, color=colour, width=width, label=solver,
                    scale=8 * largest(rest.force), zorder=3)
    axes.set_aspect("equal")
    axes.grid(False)
    axes.set_title(f"{name}: contact forces on nodes; dark grains are rigid", fontsize=10, loc="left")
    room = 1.1 * largest(result.engine.outline)
    axes.set_xlim(-room, room)
    axes.set_ylim(-room, 1.3 * room)  # for the legend
    legend(axes)
