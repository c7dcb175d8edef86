"""The stored numbers of oracles/."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from foreign.stored import read_table
from make_polygon_on_disc_oracles import BETWEEN, COARSE, FINE, FIRST, MELODY, MODULI, RINGS, SOFT, STIFF

FOLDER = Path(__file__).parent / "oracles"


@dataclass
class Stored:
    """By GetFEM at all depths."""

    rings: np.ndarray  # [meshes] of triangles in the disc
    by_rings: np.ndarray  # [meshes x depths] forces over mu R
    swap: np.ndarray  # [depths] what the hexagon as slave changes, relative, on the finest mesh that has both

    @property
    def force(self) -> np.ndarray:
        """[depths] of the finest mesh."""
        return self.by_rings[-1]

    @property
    def error(self) -> np.ndarray:
        """[depths] relative: the largest change from a mesh half as fine at this depth and deeper ones, as at one it
        may be small by accident (the smaller the contact, the worse is it resolved); of first order at least, half of
        what the other body as slave changes on that mesh."""
        change = np.abs(self.by_rings[-2] / self.force - 1) + np.abs(self.swap) / 2
        return largest_from_here(change)


def largest_from_here(values: np.ndarray) -> np.ndarray:
    """[..., depths] the largest of this depth and deeper ones."""
    return np.maximum.accumulate(values[..., ::-1], axis=-1)[..., ::-1]


def read_stored(first: str, law: str = "neo-hookean") -> Stored:
    table = read_table(FOLDER / f"polygon_on_disc_getfem{MELODY * (law == 'melody')}.csv")
    table = table[table[:, 0] == FIRST.index(first), 1:]
    disc, hexagon = table[table[:, 0] == 0, 1:], table[table[:, 0] == 1, 1:]
    same = disc[disc[:, 0] == hexagon[-1, 0], 1:][0]
    halves = disc[np.isin(disc[:, 0], RINGS)]
    return Stored(halves[:, 0], halves[:, 1:], hexagon[-1, 1:] / same - 1)


@dataclass
class Penalised:
    """By CalculiX, law `melody`, with a penalty: rows of slave, rings, stiffness and forces."""

    rows: np.ndarray

    def of(self, slave: int, rings: int, stiffness: float) -> np.ndarray:
        """[depths]"""
        there = (self.rows[:, :3] == [slave, rings, stiffness]).all(axis=1)
        return self.rows[there, 3:][0]

    def rigid(self, slave: int, rings: int, soft: float = SOFT, stiff: float = STIFF) -> np.ndarray:
        """[depths] force of rigid contact, from two penalties: its error is of order 1 / K."""
        return (stiff * self.of(slave, rings, stiff) - soft * self.of(slave, rings, soft)) / (stiff - soft)

    @property
    def force(self) -> np.ndarray:
        """[depths] of the finest mesh."""
        return self.rigid(0, FINE)

    @property
    def mesh(self) -> np.ndarray:
        """[depths] relative change from half the rings."""
        return np.abs(self.rigid(0, COARSE) / self.force - 1)

    @property
    def swap(self) -> np.ndarray:
        """[depths] half of what the other body as slave changes, relative."""
        return np.abs(self.rigid(1, COARSE) / self.rigid(0, COARSE) - 1) / 2

    @property
    def penalty(self) -> np.ndarray:
        """[depths] relative: beside sharp corners the pressure is singular and the order below one, so what a penalty
        between both would make of rigid contact in place of the stiff one."""
        return np.abs(self.rigid(0, COARSE, SOFT, BETWEEN) / self.rigid(0, COARSE) - 1)

    @property
    def error(self) -> np.ndarray:
        """[depths] relative: the largest of this depth and deeper ones."""
        return largest_from_here(self.mesh + self.swap + self.penalty)


def read_calculix(first: str) -> Penalised:
    table = read_table(FOLDER / "polygon_on_disc_calculix_melody.csv")
    return Penalised(table[table[:, 0] == FIRST.index(first), 1:])


def read_outlines(first: str) -> dict[str, np.ndarray]:
    """By body [depths x nodes x 2] of the halves x >= 0, from the lowest point up."""
    table = read_table(FOLDER / f"polygon_on_disc_{first}_outlines.csv")
    halves = [table[table[:, 0] == i, 1:] for i in range(len(MODULI))]
    return {name: half.reshape(len(half), -1, 2).transpose(1, 0, 2) for name, half in zip(MODULI, halves)}
