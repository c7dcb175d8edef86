"""The stored numbers of oracles/."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from foreign.stored import read_table
from make_polygon_on_disc_oracles import FIRST, MODULI

FOLDER = Path(__file__).parent / "oracles"


@dataclass
class Stored:
    """By GetFEM at all depths."""

    rings: np.ndarray  # [meshes] of triangles in the disc
    by_rings: np.ndarray  # [meshes x depths] forces over mu R
    swapped: np.ndarray  # [depths] with the hexagon as slave, on the finest mesh but one

    @property
    def force(self) -> np.ndarray:
        """[depths] of the finest mesh."""
        return self.by_rings[-1]

    @property
    def error(self) -> np.ndarray:
        """[depths] relative: the largest change from a mesh half as fine at this depth and deeper ones, as at one it
        may be small by accident (the smaller the contact, the worse is it resolved); of first order at least, half of
        what the other body as slave changes on that mesh."""
        change = np.abs(self.by_rings[-2] / self.force - 1) + np.abs(self.swapped / self.by_rings[-2] - 1) / 2
        return largest_from_here(change)


def largest_from_here(values: np.ndarray) -> np.ndarray:
    """[..., depths] the largest of this depth and deeper ones."""
    return np.maximum.accumulate(values[..., ::-1], axis=-1)[..., ::-1]


def read_stored(first: str) -> Stored:
    table = read_table(FOLDER / "polygon_on_disc_getfem.csv")
    table = table[table[:, 0] == FIRST.index(first), 1:]
    disc, hexagon = table[table[:, 0] == 0, 1:], table[table[:, 0] == 1, 1:]
    return Stored(disc[:, 0], disc[:, 1:], hexagon[-1, 1:])


def read_outlines(first: str) -> dict[str, np.ndarray]:
    """By body [depths x nodes x 2] of the halves x >= 0, from the lowest point up."""
    table = read_table(FOLDER / f"polygon_on_disc_{first}_outlines.csv")
    halves = [table[table[:, 0] == i, 1:] for i in range(len(MODULI))]
    return {name: half.reshape(len(half), -1, 2).transpose(1, 0, 2) for name, half in zip(MODULI, halves)}
