"""A packing of soft discs at rest between four walls, from the outlines of a frame and the forces on the walls."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contact_network import Network, Outlines, filled, network, touching
from fields import frames_of
from verification import Run

WALLS = 4
FORCES = ["bottom.force_y", "right.force_x", "top.force_y", "left.force_x"]


@dataclass
class Stage:
    """Lengths in small diameters, pressures in E."""

    box: float  # area between the walls
    solid_fraction: float  # away from the walls, of the deformed discs; overlaps count once
    overlap: float  # share of overlaps in their area: with a penalty, the sum of normal forces over stiffness
    pressure: float  # of the walls
    network: Network  # all contacts, their normal forces
    centres: np.ndarray  # [discs x 2]
    counted: np.ndarray  # [discs] whether away from the walls and no rattler
    counts: np.ndarray  # [discs] contacts in the network without rattlers
    kinetic: float  # over stored energy

    @property
    def coordination(self) -> float:
        return float(self.counts[self.counted].mean()) if self.counted.any() else 0.0

    def drawn_anew(self, across: int, weights: np.ndarray) -> np.ndarray:
        """[samples] coordination with each square of the box counted `weights` [squares x samples] times."""
        half = np.sqrt(self.box) / 2
        column, row = ((self.centres[self.counted] / half + 1) / 2 * across).astype(int).T
        square, counts = row * across + column, self.counts[self.counted]
        sums, discs = np.bincount(square, counts, across**2), np.bincount(square, minlength=across**2)
        return (sums @ weights) / np.maximum(discs @ weights, 1)


def read_stages(run: Run, discs: int, stiffness: float, margin: float) -> list[Stage]:
    """Stages at all states of rest. Discs within the margin from a wall are not counted."""
    frames = frames_of(run)
    grid = frames.grids["outlines"]
    every = [Outlines.of(frames.positions("outlines", i), grid.cells, grid.body) for i in range(len(frames.times))]
    forces = np.abs(np.stack([run.probe(name) for name in FORCES], axis=1))
    kinetic = run.probe("energy.kinetic") / np.maximum(run.probe("energy.strain") + run.probe("energy.contact"), 1e-300)
    tributary = every[0].tributary_lengths()
    return [_stage(outlines, tributary, discs, stiffness, margin, force, float(moving))
            for outlines, force, moving in zip(every[1:], forces[1:], kinetic[1:], strict=True)]


def _stage(outlines: Outlines, tributary: np.ndarray, discs: int, stiffness: float, margin: float, force: np.ndarray,
           kinetic: float) -> Stage:
    half = float(outlines.of_body(discs + 2)[:, 1].min())
    nodes, areas = touching(outlines, tributary, stiffness), outlines.areas()[:discs]
    found, overlap = network(nodes, discs + WALLS), np.linalg.norm(nodes.forces, axis=1).sum() / stiffness / areas.sum()
    counts = found.without_rattlers(np.arange(discs, discs + WALLS)).counts()[:discs]
    centres, reach = outlines.centres()[:discs], half - margin
    inside = filled(outlines, np.arange(discs), (-reach, reach, -reach, reach)) @ areas / (2 * reach) ** 2
    counted = (np.abs(centres) < reach).all(axis=1) & (counts > 0)
    return Stage((2 * half) ** 2, float(inside * (1 - overlap)), float(overlap), float(force.mean() / (2 * half)),
                 found, centres, counted, counts, kinetic)
