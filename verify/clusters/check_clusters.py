"""Clusters of glued grains at rest: the reference's statics against the engine's damped motion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from hexagons import SIDES, Grain, cluster, facing, glued, grain_tables, probes, shapes
from pictures import COLOURS, describe, draw_orders, legend, panels, save
from pliant.frames import Frames
from verification import FULL, Case, Label, Run

CASE = Case(__file__, cost=2)
NODES = 168 if FULL else 60
RAMP = 320.0 if FULL else 80.0  # s, of the push; in the engine a rest of twice that time follows
FASTER = [RAMP / 4, RAMP / 2]
STEPS = 48  # of the statics; all numbers are even, so that a step ends where the push is fastest
FEWER = [6, 12, 24]
DIAMETER = 2.0
CLUSTERS = {"7 compliant": (1, False), "7 mixed": (1, True)}
if FULL:
    CLUSTERS |= {"19 compliant": (2, False), "19 mixed": (2, True)}
# Slip is the sum of length times d(xi). Two paths to one end point differ by the area between them: the facets'
# stretch, 0.01 to 0.1, times the engine's lag, some 1e-3 R, plus half a load step. Doubling the time halves the lag;
# doubling the steps halves the load step.
FORCES = 1e-4
SOURCE = ("slip depends on the path: stretch of facets times lag of the engine plus half a load step, 1e-4 R of slip "
          "at most; tolerance of positions 1e-6, of forces 1e-4")


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
    pushes: dict[float, Rest]  # of the engine, by the time of the push
    reference: dict[int, Rest]  # by load steps

    @property
    def engine(self) -> Rest:
        return self.pushes[RAMP]


def scene_of(grains: list[Grain], ramp: float) -> str:
    return CASE.scene(shapes=shapes(NODES), grains=grain_tables(grains, NODES, ramp), end=3 * ramp, ramp=ramp,
                      probes=probes(grains, NODES, ramp))


def solve(name: str) -> Result:
    rings, mixed = CLUSTERS[name]
    grains, folder, few = cluster(rings, mixed), name.replace(" ", "_"), rings == 1
    engine = {ramp: CASE.engine(f"{folder}_engine_{ramp:g}", scene_of(grains, ramp))
              for ramp in [*(FASTER if few else []), RAMP]}
    reference = {}
    for steps in [*(FEWER if few else []), STEPS]:
        # Statics need no rest after the push.
        run = CASE.reference(f"{folder}_{steps}", scene_of(grains, RAMP), "--static", "--dt", f"{RAMP / steps} s",
                             "--until", f"{RAMP} s")
        reference[steps] = Rest.of(run, grains)
    result = Result(grains, engine[RAMP], {ramp: Rest.of(run, grains) for ramp, run in engine.items()}, reference)
    check_premise(result)
    return result


@pytest.fixture(scope="module")
def results() -> dict[str, Result]:
    return {name: solve(name) for name in CLUSTERS}


@pytest.mark.parametrize("name", CLUSTERS)
def test_both_solvers_come_to_rest_alike(results: dict[str, Result], name: str) -> None:
    result = results[name]
    positions, centres, forces = result.engine.difference(result.reference[STEPS])
    CASE.check(Label.INDEPENDENT, f"{name}: positions over the diameter", positions, 0, 1e-6, SOURCE)
    CASE.check(Label.INDEPENDENT, f"{name}: centres over the diameter", centres, 0, 1e-6, SOURCE)
    CASE.check(Label.INDEPENDENT, f"{name}: forces over the largest", forces, 0, FORCES, SOURCE)
    kinetic, strain = (result.run.probe(f"energy.{part}")[-1] for part in ("kinetic", "strain"))
    CASE.check(Label.EXACT, f"{name}: kinetic over strain energy", kinetic / strain, 0, 1e-12,
               "state of rest: damping forces, 2 m v, are then below some 1e-6 of the others")


@pytest.mark.parametrize("name", CLUSTERS)
def test_forces_balance(results: dict[str, Result], name: str) -> None:
    """Contact forces balance on all grains together, and on each grain without other loads."""
    result = results[name]
    for solver, rest in (("engine", result.engine), ("reference", result.reference[STEPS])):
        owner = np.repeat(np.arange(len(result.grains)), [SIDES[NODES][g.sort] for g in result.grains])
        sums = np.array([rest.force[owner == i].sum(axis=0) for i in range(len(result.grains))])
        inner = [sums[i] for i, grain in enumerate(result.grains) if not grain.outer]
        worst = max(largest(np.array(inner)), largest(sums.sum(axis=0))) / largest(rest.force)
        CASE.check(Label.EXACT, f"{name}, {solver}: balance of forces", worst, 0, 1e-8,
                   "Newton's 1e-10 of the forces that cancel at a node, some ten nodes in contact; the engine's rest")


def check_premise(result: Result) -> None:
    """Facet ends stay inside the longer facets. Around a corner a bond's force turns abruptly, and two equilibria may
    exist. At 1 an end lies over a corner; at 0.96 it passes the bisector there, 8e-3 deep."""
    for rest in (result.engine, result.reference[STEPS]):
        if (share := used_up(rest, result.grains)) > 0.96:
            raise RuntimeError(f"facet ends have moved {share:.2f} of the distance to the opposite corners: not valid")


def used_up(rest: Rest, grains: list[Grain]) -> float:
    """Largest share that facet ends have travelled of the initial distance to the ends of the opposite facets."""
    sides = [SIDES[NODES][grain.sort] for grain in grains]
    outlines = np.split(rest.outline, np.cumsum(sides)[:-1])
    shares = []
    for long, short, direction in glued(grains):
        first, last = outlines[long][facing(sides[long], direction)]
        ends = outlines[short][facing(sides[short], (direction + 3) % 6)]
        along = (last - first) / np.linalg.norm(last - first)
        left = min(((ends - first) @ along).min(), ((last - ends) @ along).min())
        shares.append(1 - left / (np.tan(np.pi / sides[long]) - np.tan(np.pi / sides[short])))
    return max(shares)


@pytest.mark.parametrize("name", ["7 compliant", "7 mixed"])
def test_slower_pushes_converge(results: dict[str, Result], name: str) -> None:
    """The engine's positions converge to the limit of small load steps."""
    CASE.check_rate(f"{name}: positions over the speed of the push", *lags(results[name]), 1, 0.1,
                    "lag is proportional to speed; its share of the push and the limit's error add 0.05")


def lags(result: Result) -> tuple[list[float], list[float]]:
    """Speeds, 1/s, and the distance of the engine's positions from the reference's limit, over the diameter."""
    limit = 2 * result.reference[STEPS].displacement - result.reference[STEPS // 2].displacement
    errors = [largest(rest.displacement - limit) / DIAMETER for rest in result.pushes.values()]
    return [1 / ramp for ramp in result.pushes], errors


@pytest.mark.parametrize("name", ["7 compliant", "7 mixed"])
def test_load_steps_converge(results: dict[str, Result], name: str) -> None:
    CASE.check_rate(f"{name}: forces of the reference over load steps", *refinements(results[name]), 1, 0.15,
                    "backward sums of slip: first order, with a tenth of the second at five steps")


def refinements(result: Result) -> tuple[list[float], list[float]]:
    """Load steps, and changes of the reference's forces when they are halved, over the largest."""
    counts = sorted(result.reference)
    forces = [result.reference[count].force for count in counts]
    changes = [largest(a - b) / largest(result.engine.force) for a, b in zip(forces, forces[1:])]
    return [1 / count for count in counts[:-1]], changes


def test_picture(results: dict[str, Result]) -> None:
    figure, axes = panels(4, f"Glued clusters at rest, {NODES} nodes a grain", across=True)
    drawn = list(CLUSTERS)[-1]
    draw_forces(axes[0], drawn, results[drawn])
    for (name, result), colour in zip(results.items(), COLOURS):
        rest = result.reference[STEPS]
        size = np.linalg.norm(rest.force, axis=1) / largest(rest.force)
        error = np.linalg.norm(rest.force - result.engine.force, axis=1) / largest(rest.force)
        touching = size > 0
        axes[1].loglog(size[touching], error[touching], ".", color=colour, markersize=4, label=name)
    axes[1].axhline(FORCES, linestyle=":", color=COLOURS[6], linewidth=1.2)
    describe(axes[1], x="force on a node over the largest", y="engine - reference, over the largest")
    axes[1].set_ylim(top=3e-3)
    legend(axes[1])
    small = list(CLUSTERS)[:2]
    draw_orders(axes[2], "reference: changes of forces by half the load step",
                [(name, *refinements(results[name])) for name in small], [1])
    describe(axes[2], x="load step, thousandths of the push", y="change over the largest force")
    draw_orders(axes[3], "engine: positions, from the reference's limit",
                [(name, *lags(results[name])) for name in small], [1])
    describe(axes[3], x="1000 s over the time of the push", y="difference over the diameter")
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
                                      (result.reference[STEPS], COLOURS[1], 0.003, "reference")):
        axes.quiver(*rest.outline[:count].T, *rest.force.T, color=colour, width=width, label=solver,
                    scale=8 * largest(rest.force), zorder=3)
    axes.set_aspect("equal")
    axes.grid(False)
    axes.set_title(f"{name}: contact forces on nodes; dark grains are rigid", fontsize=10, loc="left")
    room = 1.1 * largest(result.engine.outline)
    axes.set_xlim(-room, room)
    axes.set_ylim(-room, 1.3 * room)  # for the legend
    legend(axes)
