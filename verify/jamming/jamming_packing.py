"""Packings at rest between four walls, and their jamming point."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from contact_network import Box, Network, Outlines, Touching, filled, network, touching
from verification import Run

DISCS = 400
BOTTOM, RIGHT, TOP, LEFT = WALLS = range(DISCS, DISCS + 4)  # numbers of their bodies
FORCES = ["bottom.force_y", "right.force_x", "top.force_y", "left.force_x"]


@dataclass(eq=False)
class Stage:
    """A packing at rest; lengths in small diameters, pressures in E."""

    outlines: Outlines
    touching: Touching
    half: float  # of the square between the walls
    margin: float  # from the walls to the evaluated region
    reference_areas: np.ndarray  # [bodies] at the start
    pressure: float  # of the walls

    @cached_property
    def network(self) -> Network:
        """All contacts."""
        return network(self.touching, DISCS + len(WALLS))

    @cached_property
    def moment_of_walls(self) -> float:
        """Sum of the walls' forces times their points of action: twice pressure times area."""
        return float(self.touching.moments(DISCS + len(WALLS))[DISCS:].sum())

    @cached_property
    def unbalanced(self) -> float:
        """Sum of the discs' resultants times their centres: the share of moving discs in the moment of the walls."""
        return float((self.network.resultants() * self.outlines.centres())[:DISCS].sum())

    @property
    def nodes_at_walls(self) -> int:
        return int((np.maximum(self.touching.own, self.touching.partner) >= DISCS).sum())

    @cached_property
    def solid_fraction(self) -> float:
        """Solid fraction of the region, by initial areas, so that a disc's compression counts as excess."""
        reach = self.half - self.margin
        return float(self.shares((-reach, reach, -reach, reach)) @ self.reference_areas[:DISCS]) / (2 * reach) ** 2

    def shares(self, box: Box) -> np.ndarray:
        """[discs] shares of their areas that lie in the box."""
        return filled(self.outlines, np.arange(DISCS), box)

    @cached_property
    def backbone(self) -> Network:
        return self.network.without_rattlers(np.array(WALLS))

    @cached_property
    def counted(self) -> np.ndarray:
        """[discs] whether the centre is in the region and the disc is no rattler."""
        inside = (np.abs(self.outlines.centres()[:DISCS]) < self.half - self.margin).all(axis=1)
        return inside & (self.backbone.counts()[:DISCS] > 0)

    @cached_property
    def counts(self) -> np.ndarray:
        """Contacts of each counted disc."""
        return self.backbone.counts()[:DISCS][self.counted]

    def by_square(self, across: int) -> tuple[np.ndarray, np.ndarray]:
        """Sums of those contacts, and numbers of discs, in each of across^2 squares of the region."""
        reach = self.half - self.margin
        column, row = ((self.outlines.centres()[:DISCS][self.counted] / reach + 1) / 2 * across).astype(int).T
        square = row * across + column
        return np.bincount(square, self.counts, across**2), np.bincount(square, minlength=across**2)

    @property
    def coordination(self) -> float:
        return float(self.counts.mean()) if len(self.counts) else 0.0

    @property
    def obliquity(self) -> float:
        """Root mean square of the forces across over those along the line of two discs' centres."""
        between = (self.network.pairs < DISCS).all(axis=1)
        centres, pairs = self.outlines.centres(), self.network.pairs[between]
        force, line = self.network.forces[between], centres[pairs[:, 1]] - centres[pairs[:, 0]]
        line /= np.linalg.norm(line, axis=1)[:, None]
        across = force[:, 0] * line[:, 1] - force[:, 1] * line[:, 0]
        return float(np.sqrt((across**2).mean() / (np.einsum("ij,ij->i", force, line) ** 2).mean()))


@dataclass
class Packing:
    """A packing that is compressed and released in stages."""

    run: Run
    stages: list[Stage]
    closing: int  # stages of closing, which come first

    def opened(self, onset: float) -> list[Stage]:
        """Stages from the densest on while the pressure exceeds `onset`."""
        return [stage for stage in self.stages[self.closing - 1 :] if stage.pressure > onset]

    def jamming_fraction(self, onset: float) -> float:
        """Solid fraction at which the pressure of opening vanishes: a parabola of the pressure, at 0."""
        opened = self.opened(onset)
        return float(np.polyfit([s.pressure for s in opened], [s.solid_fraction for s in opened], 2)[-1])


def read_packing(run: Run, frames: list[Outlines], stiffness: float, margin: float, closing: int) -> Packing:
    """Packing from the outlines at the start and at each state of rest."""
    start, *rests = frames
    tributary, areas = start.tributary_lengths(), start.areas()
    forces = np.abs(np.stack([run.probe(name) for name in FORCES], axis=1))
    stages = []
    for outlines, force in zip(rests, forces[1:], strict=True):
        half = outlines.of_body(TOP)[:, 1].min()
        pressure = float(force.mean() / (2 * half))
        stages.append(Stage(outlines, touching(outlines, tributary, stiffness), half, margin, areas, pressure))
    return Packing(run, stages, closing)
