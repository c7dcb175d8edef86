"""A rigid block on an incline: Coulomb's law in slip up and down, the stop, and the dissipated energy."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest

from pictures import COLOURS, describe, legend, panels, save
from verification import Case, Label, Run

CASE = Case(__file__, fast=True)

FRICTION, MASS, STIFFNESS = 0.3, 0.5, 1e4
LENGTH = 1  # of the block's face
FREQUENCY = np.sqrt(STIFFNESS * LENGTH / MASS)  # of the block on its contact, both normal and tangential
STEP = 0.002
# Accelerations are differences of velocities of 0.1 to 1 over at least a second. Newton's method stops at 1e-10 of the
# forces.
ROUNDING = {"engine": 1e-12, "reference": 1e-9}


@dataclass(frozen=True)
class Start:
    """State of a block at t = 0, with intervals of slip in one direction."""

    name: str
    degrees: float
    speed: float  # downhill
    down: tuple[float, float] | None = None
    up: tuple[float, float] | None = None

    @property
    def sine(self) -> float:
        return float(np.sin(np.radians(self.degrees)))

    @property
    def cosine(self) -> float:
        return float(np.cos(np.radians(self.degrees)))

    def acceleration(self, down: bool = True, lost: float = 0.0) -> float:
        """Downhill acceleration in slip, with a share of friction lost."""
        return self.sine - (1 - lost) * FRICTION * self.cosine * (1 if down else -1)

    @property
    def depth(self) -> float:
        """Depth at which contact carries the weight N: kn (d L - d^2/2) = N. One pass has the face at depth d and on
        either side a flank of length d, kn/2 (d L + d^2). The other has the floor under the face except for d at either
        end, which is nearer to a flank, kn/2 (L - 2 d) d."""
        return float(LENGTH - np.sqrt(LENGTH**2 - 2 * self.cosine * MASS / STIFFNESS))

    def lost_share(self, floor: Floor) -> tuple[float, float]:
        """Share of friction lost at the flanks, and its error. A floor node with the length w_h under the face and w_v
        beside a flank has the limit mu kn (w_h d + integral of N x over w_v), x from the corner, over both. Along the
        floor it acts on w_h alone. The deficit at w_v << w_h is mu kn integral of N (d - x): in total mu kn d^2/2 for
        both corners and one pass. A node that has just come into contact has w_v of up to 2 d/s of its length, with s
        the floor's segments; so has one about to leave."""
        share = self.depth / (2 * LENGTH)
        return share, 4 * self.depth / floor.spacing * share


@dataclass(frozen=True)
class Floor:
    """Node spacing, and the block's initial position."""

    name: str
    spacing: float
    place: float


FLOORS = [Floor("aligned nodes", 0.25, 22.0), Floor("nodes anywhere", 0.25, 22.0437), Floor("finer nodes", 0.11, 22.0437)]
STARTS = [Start("from rest", 30, 0.0, down=(0.2, 3.9)),
          Start("kicked uphill", 30, -1.0, down=(2.0, 3.9), up=(0.2, 1.2)),
          Start("too flat", 10, 0.2, down=(0.2, 1.5))]
# Heights of 0.25 round to 5e-17, over depths of 5e-5, for some ten nodes; errors accumulate over steps.
NORMAL_ROUNDING = 1e-10
SOLVERS = ["engine", "reference"]


@cache
def run(start: Start, solver: str, floor: Floor = FLOORS[0]) -> Run:
    scene = CASE.scene(degrees=start.degrees, along=start.sine, across=-start.cosine, height=0.25 - start.depth,
                       speed=start.speed, dt=STEP,
                       spacing=floor.spacing, place=floor.place)
    name = f"{start.name}_{floor.name}_{solver}".replace(" ", "_")
    return CASE.engine(name, scene) if solver == "engine" else CASE.reference(name, scene, "--dt", str(STEP))


def change(of: Run, column: str, times: tuple[float, float]) -> float:
    before, after = of.at(column, np.array(times))
    return float(after - before)


def kicks(of: Run, start: Start, floor: Floor) -> float:
    """Bound of the spread of the normal force, over it. Shear beside the two flanks acts upwards and downwards. The
    difference is mu kn/2 d^3/s for each floor node whose length is w_v beside a flank and N^2 s/2 under the face (see
    lost_share). It appears and disappears abruptly with a node, and the block oscillates undamped by as much."""
    way = np.abs(np.diff(of.probe("block.displacement_x"))).sum()
    nodes = 2 * (way / floor.spacing + 1)
    return float(2 * nodes * FRICTION / 2 * start.depth**2 / (floor.spacing * LENGTH))


def within_steps(of: Run, times: tuple[float, float], start: Start, floor: Floor) -> float:
    """Bound of the error of frictional work in the energy balance, over the work. The contact length of a leaving node,
    (v dt)^2/(4 s) at most, slides for half of its last step without being counted, once per s. The share of a node's
    length beside a flank changes in a step, while its motion is that of the step's end: at either end, d v dt for each
    node times the integral of N dw/w, 2.4."""
    when = of.times("motion.velocity_x")
    speed = np.abs(of.probe("motion.velocity_x")[(when >= times[0]) & (when <= times[1])])
    leaving = (speed**4).mean() * STEP**3 / (8 * floor.spacing**2)
    flanks = 2.4 * start.depth * (speed**2).mean() * STEP / floor.spacing
    return float((leaving + flanks) / speed.mean() / LENGTH)


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("floor", FLOORS, ids=lambda floor: floor.name)
@pytest.mark.parametrize("start", STARTS, ids=lambda start: start.name)
def test_slip(start: Start, floor: Floor, solver: str) -> None:
    """a = g (sin - mu cos) downhill, g (sin + mu cos) during upward motion; frictional work is the friction force times
    the sliding distance."""
    of = run(start, solver, floor)
    for way, times in (("down", start.down), ("up", start.up)):
        if times is None:
            continue
        mean = change(of, "motion.velocity_x", times) / (times[1] - times[0])
        lost, error = start.lost_share(floor)
        friction = FRICTION * start.cosine
        CASE.check(Label.EXACT, f"{start.name}, {floor.name}, {solver}: acceleration {way}", mean,
                   start.acceleration(way == "down", lost), ROUNDING[solver] + friction * error,
                   "Coulomb, less the friction lost at flanks; nodes at the block's ends")
        work = (1 - lost) * friction * MASS * abs(change(of, "block.displacement_x", times))
        CASE.check(Label.EXACT, f"{start.name}, {floor.name}, {solver}: friction work {way}",
                   change(of, "works.dissipated_by_contact", times) / work, 1,
                   ROUNDING[solver] + error + within_steps(of, times, start, floor),
                   "force times sliding distance; nodes at the block's ends, and the last step of each")
        force = of.probe("floor.force_y")[(of.times("floor.force_y") > times[0]) & (of.times("floor.force_y") < times[1])]
        CASE.check(Label.EXACT, f"{start.name}, {floor.name}, {solver}: spread of the normal force {way}",
                   np.ptp(force) / np.abs(force).mean(), 0, NORMAL_ROUNDING + kicks(of, start, floor),
                   "an integral is independent of node positions, except for shear at the flanks; rounding of depths")


@pytest.mark.parametrize("solver", SOLVERS)
def test_stop(solver: str) -> None:
    """For tan(theta) < mu the block stops after v^2 / (2 a). It then oscillates on its tangential spring with the
    velocity a / w, about a / w^2 before that position."""
    start, of = STARTS[2], run(STARTS[2], solver)
    slow, since = -start.acceleration(lost=start.lost_share(FLOORS[0])[0]), start.down[0]
    speed = float(of.at("motion.velocity_x", np.array([since]))[0])
    stopped = of.times("block.displacement_x") > since + speed / slow + 0.1
    # The period is 0.056 s, so a mean over 2.2 s errs by the amplitude times 0.056 / (2.2 pi).
    way = of.probe("block.displacement_x")[stopped].mean() - float(of.at("block.displacement_x", np.array([since]))[0])
    swing = slow / FREQUENCY**2
    # The stop occurs within a step, whose end velocity differs from 0 by up to half of its change, slow x dt / 2.
    late = 0.5 * slow * STEP**2 + slow * STEP / FREQUENCY
    CASE.check(Label.EXACT, f"stop, {solver}: way", way, speed**2 / (2 * slow) - swing, 0.01 * swing + late,
               "v^2 / (2 a) less a / w^2; a hundredth of the amplitude from the mean, and the step of the stop")
    speeds = of.probe("motion.velocity_x")[stopped]
    CASE.check(Label.EXACT, f"stop, {solver}: largest speed after it, over a / w",
               np.abs(speeds).max() * FREQUENCY / slow, 1,
               FREQUENCY * STEP / 2 + 0.03, "spring released at its limit; the step of the stop, dt w / 2; sampling")


@pytest.mark.parametrize("solver", SOLVERS)
def test_energy_balance(solver: str) -> None:
    for start in STARTS:
        of = run(start, solver)
        CASE.check(Label.EXACT, f"{start.name}, {solver}: balance of energy", of.balance_error, 0,
                   1e-5 + within_steps(of, start.down, start, FLOORS[0]),
                   "elastic energies are 1e-4 of the total, and Verlet errs by less than a tenth of them; friction as "
                   "above")


def test_picture() -> None:
    figure, axes = panels(2, "Rigid block on an incline, friction 0.3", across=True)
    for start, colour in zip(STARTS, COLOURS):
        of = run(start, "engine")
        times, speed = of.times("motion.velocity_x"), of.probe("motion.velocity_x")
        axes[0].plot(times, speed, color=colour, linewidth=1.4, label=f"{start.name}, {start.degrees:g} degrees")
        axes[0].plot(times, coulomb(start, times), "--", color=COLOURS[6], linewidth=1.0,
                     label="Coulomb" if start is STARTS[-1] else None)
        lost = of.probe("works.dissipated_by_contact")
        axes[1].plot(times, lost, color=colour, linewidth=1.4, label=start.name)
        way = np.concatenate([[0], np.cumsum(np.abs(np.diff(of.probe("block.displacement_x"))))])
        axes[1].plot(times, FRICTION * MASS * start.cosine * way, "--", color=COLOURS[6], linewidth=1.0,
                     label="friction x distance" if start is STARTS[-1] else None)
    for panel, label in zip(axes, ("speed downhill over sqrt(g L)", "dissipated; density, g, L: 1")):
        describe(panel, x="time over sqrt(L / g)", y=label)
        legend(panel)
    save(CASE, figure, "sliding")


def coulomb(start: Start, times: np.ndarray) -> np.ndarray:
    """Speed of a block without a spring in its contact."""
    up = np.minimum(start.speed + start.acceleration(False) * times, 0) if start.speed < 0 else np.zeros_like(times)
    turned = -start.speed / start.acceleration(False) if start.speed < 0 else 0.0
    down = np.maximum(max(start.speed, 0.0) + start.acceleration() * (times - turned), 0)
    return np.where(times < turned, up, down)
