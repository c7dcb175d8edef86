"""A bond that wears and tears: driven, against an integration of its law; pulled by a compliant block, both solvers."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest
from matplotlib.axes import Axes

from order_study import Quantity, Study, check_differences, run_study
from pictures import COLOURS, MARKERS, describe, draw_both, draw_differences, legend, panels, save
from verification import Case, Label, Run

CASE = Case(__file__)

# Values of driven.toml. The bonded face of the block has length 1.
STRENGTH, STIFFNESS, RANGE, THRESHOLD, RATE_OF_WEAR = 1.0, 1000.0, 0.01, 0.3, 0.4
CRITICAL = STRENGTH / STIFFNESS
LENGTH = 1.0
# Twice out and back, to 0.8 and to 0.9 of the critical opening, then torn off: corners of the velocity, m/s.
WEARING = [(0, 0), (0.1, 0.002), (0.4, 0.002), (0.6, -0.002), (0.9, -0.002), (1.0, 0), (1.1, 0.00225), (1.4, 0.00225),
           (1.6, -0.00225), (1.9, -0.00225)]
TEARING = [(2.0, 0), (2.1, 0.02), (2.7, 0.02)]
DRIVEN_STEPS = [0.01, 0.005, 0.0025, 0.00125]

WEAR_ORDER = 0.05
WEAR_SOURCE = ("a step's wear uses the damage at its start: first order; the coarsest step is 2 % of the critical "
               "opening, the share of the next order")

STEPS = [0.02, 0.01, 0.005]
FINEST = 0.0025
TIMES = 0.12 * np.arange(1, 101)
POSITIONS = Quantity("positions", ["block.position_y", "corner.position_y"])
FORCE = Quantity("force on the bench", ["force.force_y"])
DISSIPATION = Quantity("work of damage", ["works.dissipated_by_bonds"])


@dataclass(eq=False)
class Drive:
    """Motion of the block, and the bond's ratio of strengths, tension over shear."""

    name: str
    ratio: float
    up: list[tuple[float, float]]  # corners of the velocity, m/s
    along: list[tuple[float, float]]  # none: free
    wear_by_shear: float = RATE_OF_WEAR  # 1/Pa

    def __str__(self) -> str:
        return self.name

    def scene(self, dt: float) -> str:
        along = f"{{ velocity = {table(self.along)} }}" if self.along else '"free"'
        return CASE.scene("driven.toml", dt=dt, up=table(self.up), along=along, cohesion=STRENGTH / self.ratio,
                          shear_stiffness=STIFFNESS / self.ratio**2, shear_rate=self.wear_by_shear)

    def ways(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Gap and slip, m."""
        return way_at(self.up, times), way_at(self.along, times) if self.along else np.zeros_like(times)


def table(corners: list[tuple[float, float]]) -> str:
    return str([list(corner) for corner in corners])


def aslant(ratio: float) -> Drive:
    """Worn by shear alone, with displacements proportional to the ratio; torn off by 0.8 of tension, 0.6 of shear."""
    up, along = ([(t, share * v) for t, v in TEARING] for share in (0.8, 0.6 * ratio))
    return Drive(f"ratio {ratio:g}, worn by shear, torn aslant", ratio, [(0.0, 0.0), *up],
                 [*((t, ratio * v) for t, v in WEARING), *along], 0.5 * ratio)


DRIVES = [Drive("ratio 1, lifted", 1.0, [*WEARING, *TEARING], []), aslant(2.0), aslant(0.5)]


def way_at(corners: list[tuple[float, float]], times: np.ndarray) -> np.ndarray:
    """Integral of the velocity between its corners."""
    fine = np.unique(np.concatenate([times, [t for t, _ in corners]]))
    speed = np.interp(fine, *zip(*corners))
    way = np.concatenate([[0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(fine))])
    return way[np.searchsorted(fine, times)]


def opened(opening: np.ndarray) -> np.ndarray:
    """Immediate damage of an opening."""
    return RANGE / (RANGE - CRITICAL) * (1 - CRITICAL / np.maximum(opening, CRITICAL))


@dataclass
class Law:
    """The bond's resisting tractions along a path, N/m."""

    pull: np.ndarray
    shear: np.ndarray
    tears: np.ndarray  # whether the damage is that of the opening


def worn(rate: float, stiffness: float, before: float, after: float, ratio: float) -> float:
    """Wear of an intact bond: rate (p - threshold)+ / (strength - threshold) dp as p = stiffness x displacement grows.
    The limits of tension apply to `ratio` times p."""
    load, step = ratio * stiffness * 0.5 * (before + after), stiffness * max(after - before, 0.0)
    return rate * max(load - THRESHOLD, 0.0) / (STRENGTH - THRESHOLD) * step


def integrate(drive: Drive, gap: np.ndarray, slip: np.ndarray) -> Law:
    """Fine steps by the midpoint rule; p and dp of a bond with damage D are 1 - D times those of an intact bond."""
    shear_stiffness = STIFFNESS / drive.ratio**2
    by_opening = opened(np.hypot(gap, slip / drive.ratio))
    damage, now = np.zeros_like(gap), 0.0

    def growth(d: float, i: int) -> float:
        return (worn(RATE_OF_WEAR, (1 - d) * STIFFNESS, gap[i - 1], gap[i], 1.0)
                + worn(drive.wear_by_shear, (1 - d) * shear_stiffness, slip[i - 1], slip[i], drive.ratio))

    for i in range(1, len(gap)):
        half = now + 0.5 * growth(now, i)
        now = min(max(now + growth(half, i), by_opening[i]), 1.0)
        damage[i] = now
    intact = LENGTH * (1 - damage)
    return Law(intact * STIFFNESS * gap, intact * shear_stiffness * slip, damage == np.minimum(by_opening, 1.0))


FINE = np.linspace(0, TEARING[-1][0], 54001)


@cache
def law_of(drive: Drive) -> Law:
    """Tractions at the times FINE."""
    return integrate(drive, *drive.ways(FINE))


@cache
def driven_runs(drive: Drive) -> dict[str, dict[float, Run]]:
    runs: dict[str, dict[float, Run]] = {"engine": {}, "reference": {}}
    for dt in DRIVEN_STEPS:
        scene, name = drive.scene(dt), f"{drive.ratio:g}_{dt:g}"
        runs["engine"][dt] = CASE.engine(f"driven_engine_{name}", scene)
        runs["reference"][dt] = CASE.reference(f"driven_reference_{name}", scene, "--dt", repr(dt))
    return runs


def force_error(drive: Drive, run: Run) -> np.ndarray:
    """[times] force error over the strength; the shear force is scaled by the strength in shear."""
    times, law = run.times("force.force_y"), law_of(drive)
    off_y = run.probe("force.force_y") + np.interp(times, FINE, law.pull)
    off_x = run.probe("force.force_x") + np.interp(times, FINE, law.shear)
    return np.hypot(off_y, drive.ratio * off_x) / (STRENGTH * LENGTH)


@pytest.mark.parametrize("solver", ["engine", "reference"])
@pytest.mark.parametrize("drive", DRIVES, ids=str)
def test_driven_bond_follows_the_law(drive: Drive, solver: str) -> None:
    """Wear is integrated with first order; the prescribed displacements are exact."""
    errors, name = [], f"driven, {drive}, {solver}"
    for dt, run in driven_runs(drive)[solver].items():
        gap, slip = drive.ways(run.times("block.position_y"))
        off = np.hypot(run.probe("block.position_y") - 0.2 - gap, run.probe("block.position_x") - slip)
        CASE.check(Label.EXACT, f"{name}: way, dt {dt:g}", off.max() / CRITICAL, 0, 1e-10,
                   "imposed motion; rounding of positions near 0.2 over 0.001")
        errors.append(force_error(drive, run))
    times = driven_runs(drive)[solver][DRIVEN_STEPS[-1]].times("force.force_y")
    tears = np.interp(times, FINE, law_of(drive).tears) == 1
    wears = [float(error[~tears].max()) for error in errors]
    CASE.check_rate(f"{name}: force while it wears", DRIVEN_STEPS, wears, 1, WEAR_ORDER, WEAR_SOURCE)
    CASE.check(Label.INDEPENDENT, f"{name}: force while it wears, finest step", wears[-1], 0, wears[-2] / 1.7,
               "half of the error at twice the step: no residual")
    CASE.check(Label.EXACT, f"{name}: force while it tears, finest step", errors[-1][tears].max(), 0, 1e-9,
               "damage of the opening, independent of earlier wear; rounding of displacements")


@pytest.mark.parametrize("solver", ["engine", "reference"])
@pytest.mark.parametrize("drive", DRIVES, ids=str)
def test_work_of_the_driven_bond(drive: Drive, solver: str) -> None:
    """The integral of the tractions over the displacements is dissipated entirely."""
    work = sum(float((0.5 * (force[1:] + force[:-1]) * np.diff(way)).sum())
               for force, way in zip((law_of(drive).pull, law_of(drive).shear), drive.ways(FINE)))
    errors = [abs(run.probe("energy.dissipated")[-1] / work - 1) for run in driven_runs(drive)[solver].values()]
    name = f"driven, {drive}, {solver}: work to tear the bond off"
    CASE.check_rate(name, DRIVEN_STEPS, errors, 1.5, 0.6,
                    "wear is of first order, work sums of second: between them, 0.1 for scatter")
    CASE.check(Label.INDEPENDENT, f"{name}, finest step", 1 + errors[-1], 1, errors[-2],
               "at most the error at twice the step: no residual")


@pytest.mark.parametrize("drive", DRIVES, ids=str)
def test_driven_solvers_agree(drive: Drive) -> None:
    runs = {solver: by_step[DRIVEN_STEPS[-1]] for solver, by_step in driven_runs(drive).items()}
    late = runs["engine"].times("force.force_y") > 0.1
    differences = [(runs["engine"].probe(f"force.force_{axis}") - runs["reference"].probe(f"force.force_{axis}"))[late]
                   for axis in "xy"]
    CASE.check(Label.INDEPENDENT, f"driven, {drive}: engine - reference, force",
               np.abs(differences).max() / (STRENGTH * LENGTH), 0, 1e-9,
               "same steps, except for the engine's first ones without wear; rounding of displacements")


@pytest.fixture(scope="module")
def pulled() -> Study:
    return run_study(CASE, "pulled", STEPS, FINEST, TIMES, template="pulled.toml")


@pytest.mark.parametrize("quantity", [POSITIONS, FORCE, DISSIPATION], ids=lambda q: q.name)
def test_pulled_bond_converges(pulled: Study, quantity: Quantity) -> None:
    check_differences(CASE, "pulled", pulled, quantity, 2, 1.2,
                      "between the first order of wear, in which solvers may differ, and the apparent third order of "
                      "the rest at coarse steps; 0.2 for scatter")


def draw_driven(axes: Axes) -> None:
    for drive, colour, marker in zip(DRIVES, COLOURS, MARKERS):
        gap, slip = drive.ways(FINE)
        law = law_of(drive)
        axes.plot(np.hypot(gap, slip / drive.ratio) / CRITICAL, np.hypot(law.pull, drive.ratio * law.shear),
                  color=colour, linewidth=1.1, label=drive.name)
        run = driven_runs(drive)["engine"][DRIVEN_STEPS[-1]]
        gap, slip = drive.ways(run.times("force.force_y"))
        axes.plot(np.hypot(gap, slip / drive.ratio) / CRITICAL,
                  np.hypot(run.probe("force.force_y"), drive.ratio * run.probe("force.force_x")), marker, color=colour,
                  markersize=3)
    axes.set_xlim(-0.05, 3)
    describe(axes, "driven rigid block: law (lines), engine (marks)", "opening over the critical one",
             "root of pull^2 + (ratio x shear)^2 [N/m]")


def test_picture(pulled: Study) -> None:
    figure, axes = panels(3, "Bond that wears and tears", across=True)
    draw_driven(axes[0])
    draw_both(axes[1], pulled.finest_runs(), "force.force_y", 1e3)
    describe(axes[1], "pulled compliant block", "time [s]", "pull on the bench [mN/m]")
    for panel in axes[:2]:
        legend(panel)
    draw_differences(axes[2], pulled, [POSITIONS, FORCE, DISSIPATION])
    save(CASE, figure, "fatigue_bond")
