"""Two discs between plates: runs of engine and reference, their forces and outlines."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fields import frames_of
from squeeze import force_of_motion
from verification import Case, Run

APPROACHES = [0.1, 0.2, 0.3, 0.4]  # over the sum of both diameters, 4
PAUSE, RAMP = 24.0, 8.0  # s from one to the next; of them in motion
LONG_PAUSE = 40.0  # for what is compared on the same nodes
GAP = 0.001  # of either plate at the start, as in discs.toml
HOLD = 20.0  # mu: of the springs at each pole, whatever their length
STORED = 8.0  # over the kinetic energy left: damping over the rate of the slowest motion
SIZES = {96: (36, 126, 42), 168: (48, 220, 56), 340: (68, 450, 80), 700: (100, 900, 116)}
NAMES = ("soft", "stiff")


@dataclass(frozen=True)
class Squeeze:
    """Of a soft disc of so many nodes, with corners or facets at all poles."""

    nodes: int
    facets: bool = True
    stiffness: float = 3e3  # of contact, mu / R
    law: str = "neo-hookean"
    pause: float = PAUSE

    @property
    def rests(self) -> np.ndarray:
        """[approaches] the ends of all pauses, s."""
        return self.pause * np.arange(1, len(APPROACHES) + 1)

    @property
    def outlines(self) -> tuple[int, int]:
        soft, _, stiff = SIZES[self.nodes]
        return soft, stiff

    @property
    def spacing(self) -> float:
        """Of both outlines, R."""
        return 2 * np.pi * np.mean(1 / np.array(self.outlines))

    def name(self) -> str:
        return f"{self.law}_{self.nodes}_{'facets' if self.facets else 'corners'}_{self.stiffness:g}_{self.pause:g}"

    def both_ways(self) -> list[Squeeze]:
        return [replace(self, facets=facets) for facets in (True, False)]

    def scene(self, case: Case) -> str:
        up = self.speeds()
        soft, stiff = self.outlines
        turns = [np.pi / count if self.facets else 0.0 for count in self.outlines]
        return case.scene("discs.toml", levels=APPROACHES, end=float(self.rests[-1]), rest=self.pause, law=self.law,
                          soft_nodes=self.nodes, stiff_nodes=SIZES[self.nodes][1], soft_outline=soft,
                          stiff_outline=stiff, soft_angle=turns[0], stiff_angle=turns[1], stiffness=self.stiffness,
                          bearings=self.bearings(), up=up, down=[[t, -v] for t, v in up])

    def bearings(self) -> str:
        """On the segment at each pole, or on the two whose corner is there."""
        return "\n".join(f"""[[boundary]]
of = "{name}"
part = {{ angles = [{pole - 1.2 * np.pi / count!r}, {pole + 1.2 * np.pi / count!r}] }}
x = "fixed"
stiffness = {HOLD * count / (2 * np.pi * (1 if self.facets else 2))!r}
""" for name, count in zip(NAMES, self.outlines) for pole in (np.pi / 2, -np.pi / 2))

    def speeds(self) -> list[list[float]]:
        """Of the lower plate: triangles in time, one an approach; both plates go as far."""
        corners, closed = [], -GAP
        for i, approach in enumerate(APPROACHES):
            start, way = i * self.pause, 2 * approach - closed
            corners += [[start, 0.0], [start + RAMP / 2, 2 * way / RAMP], [start + RAMP, 0.0]]
            closed = 2 * approach
        return corners


class Rests:
    """What a run shows at the end of each pause."""

    def __init__(self, squeeze: Squeeze, run: Run) -> None:
        self.run, self.times = run, squeeze.rests
        self.upper, self.lower = run.at("upper.force_y", self.times), -run.at("lower.force_y", self.times)
        self.force = (self.upper + self.lower) / 2
        self.gap = 2 * run.at("plate.position_y", self.times)
        self.kinetic = run.at("energy.kinetic", self.times)

    def unrest(self) -> np.ndarray:
        """How far forces may be from those without motion, relative."""
        return force_of_motion(self.force, self.gap, self.kinetic, STORED) / self.force

    def outline(self, name: str, level: int) -> np.ndarray:
        """[nodes x 2] of a body, about the axis of both."""
        frames = frames_of(self.run)
        there = frames.grids["outlines"].point_body == NAMES.index(name)
        frame = frames.nearest(self.times[level])
        return frames.positions("outlines", frame)[there, :2] - [3, 0]


def by_engine(case: Case, squeeze: Squeeze) -> Rests:
    return Rests(squeeze, case.engine(squeeze.name(), squeeze.scene(case)))


def by_reference(case: Case, squeeze: Squeeze) -> Rests:
    """Statics, one load step an approach: it halves them where Newton's method fails."""
    run = case.reference(squeeze.name() + "_reference", squeeze.scene(case), "--static", "--dt", repr(RAMP))
    return Rests(squeeze, run)
