"""A hexagon pressed into a disc: runs of engine and reference, their forces and outlines."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fields import frames_of
from make_polygon_on_disc_oracles import DEPTHS, MODULI, corners, height
from squeeze import force_of_motion
from verification import Case, Run

PAUSE, RAMP = 24.0, 8.0  # s from one depth to the next; of them in motion
LONG_PAUSE = 60.0  # for what is compared on the same nodes
STORED = 2.0  # over the kinetic energy left: damping over the rate of the slowest motion
# Outlines of discs with a corner and with a facet at the top, nodes of either; outlines of hexagons whose sides have an
# even and an odd number of segments, nodes of either.
SIZES = {10: ((48, 50), 168, (48, 54), 140), 14: ((68, 70), 340, (72, 66), 290), 20: ((100, 102), 700, (96, 102), 590),
         28: ((140, 142), 1400, (144, 138), 1180)}
NAMES = tuple(MODULI)
HELD = {"corner": [np.pi / 6, 5 * np.pi / 6], "face": [0.0, np.pi]}  # directions of the hexagon's upper sides


@dataclass(frozen=True)
class Press:
    """Of a size of SIZES, with a corner or a face first and either disc and hexagon."""

    first: str
    size: int
    facet: bool = True
    odd: bool = False
    stiffness: float = 3e3  # of contact, mu / R
    law: str = "neo-hookean"
    pause: float = PAUSE

    @property
    def rests(self) -> np.ndarray:
        """[depths] the ends of all pauses, s."""
        return self.pause * np.arange(1, len(DEPTHS) + 1)

    @property
    def spacing(self) -> float:
        """Of the disc's outline, R."""
        return 2 * np.pi / float(np.mean(SIZES[self.size][0]))

    def name(self) -> str:
        way = ("facet" if self.facet else "corner") + ("_odd" if self.odd else "_even")
        return f"{self.law}_{self.first}_{self.size}_{way}_{self.stiffness:g}_{self.pause:g}"

    def ways(self) -> list[Press]:
        """With other discs and hexagons."""
        return [replace(self, facet=facet, odd=odd) for facet in (True, False) for odd in (False, True)]

    def scene(self, case: Case) -> str:
        discs, disc_nodes, hexagons, hexagon_nodes = SIZES[self.size]
        return case.scene(levels=DEPTHS, end=float(self.rests[-1]), rest=self.pause, law=self.law,
                          stiffness=self.stiffness, disc_nodes=disc_nodes, disc_outline=discs[self.facet],
                          hexagon_nodes=hexagon_nodes, hexagon_outline=hexagons[self.odd],
                          corners=corners(self.first).tolist(), height=height(self.first),
                          held=[float(angle) for angle in HELD[self.first]], down=self.way())

    def way(self) -> list[list[float]]:
        """[[time, displacement], ...] of the hexagon's upper sides: smooth from each depth to the next."""
        share, before, table = np.linspace(0, 1, 13), 0.0, [[0.0, 0.0]]
        for i, depth in enumerate(DEPTHS):
            table += [[float(self.pause * i + RAMP * s), float(-before - (depth - before) * s**2 * (3 - 2 * s))]
                      for s in share[1:]]
            table.append([self.pause * (i + 1), -depth])
            before = depth
        return table


class Rests:
    """What a run shows at the end of each pause."""

    def __init__(self, press: Press, run: Run) -> None:
        self.run, self.times = run, press.rests
        self.force = -run.at("disc.force_y", self.times)
        self.kinetic = run.at("energy.kinetic", self.times)

    def unrest(self) -> np.ndarray:
        """How far forces may be from those without motion, relative."""
        return force_of_motion(self.force, -np.array(DEPTHS), self.kinetic, STORED) / self.force

    def outline(self, name: str, level: int) -> np.ndarray:
        """[nodes x 2] of a body."""
        frames = frames_of(self.run)
        there = frames.grids["outlines"].point_body == NAMES.index(name)
        return frames.positions("outlines", frames.nearest(self.times[level]))[there, :2]


def by_engine(case: Case, press: Press) -> Rests:
    return Rests(press, case.engine(press.name(), press.scene(case)))


def by_reference(case: Case, press: Press) -> Rests:
    """Statics: load steps end at the points of the histories."""
    run = case.reference(press.name() + "_reference", press.scene(case), "--static", "--dt", repr(RAMP))
    return Rests(press, run)
