"""The stored numbers of oracles/."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from foreign.stored import read_table

FOLDER = Path(__file__).parent / "oracles"
BODIES = ("soft", "stiff")


@dataclass
class Stored:
    """By GetFEM at all approaches."""

    rings: np.ndarray  # [meshes] of triangles in the soft disc
    by_rings: np.ndarray  # [meshes x approaches] forces over mu R

    @property
    def force(self) -> np.ndarray:
        """[approaches] of the finest mesh."""
        return self.by_rings[-1]

    @property
    def error(self) -> np.ndarray:
        """[approaches] relative: its largest change from a mesh half as fine, as at one approach it may be small by
        accident."""
        change = np.abs(self.by_rings[-2] / self.force - 1)
        return np.full_like(change, change.max())


def read_stored(law: str) -> Stored:
    table = read_table(FOLDER / f"discs_getfem_{law}.csv")
    return Stored(table[:, 0], table[:, 1:])


@dataclass
class Penalised:
    """By CalculiX up to 30 %: rows of rings, penalty and forces, a soft and a stiff penalty on each mesh."""

    rows: np.ndarray

    @property
    def rings(self) -> np.ndarray:
        return self.rows[::2, 0]

    @property
    def by_rings(self) -> np.ndarray:
        """[meshes x approaches] forces of rigid contact: the penalty's error is of order 1 / K."""
        soft, stiff = self.rows[::2, 1:], self.rows[1::2, 1:]
        return (stiff[:, :1] * stiff[:, 1:] - soft[:, :1] * soft[:, 1:]) / (stiff[:, :1] - soft[:, :1])

    @property
    def force(self) -> np.ndarray:
        """[approaches] of the finest mesh."""
        return self.by_rings[-1]

    @property
    def error(self) -> np.ndarray:
        """[approaches] relative: the largest change from half the rings; the product of both losses, as the penalty's
        second order is."""
        losses = 1 - self.rows[-2:, 2:] / self.force
        return np.abs(self.by_rings[0] / self.force - 1).max() + losses.prod(axis=0)


def read_calculix() -> Penalised:
    return Penalised(read_table(FOLDER / "discs_calculix_melody.csv"))


def read_outlines(law: str) -> dict[str, np.ndarray]:
    """By body [approaches x nodes x 2] of the halves x >= 0, from the lowest point up."""
    table = read_table(FOLDER / f"discs_outlines_{law}.csv")
    halves = [table[table[:, 0] == i, 1:] for i in range(len(BODIES))]
    return {name: half.reshape(len(half), -1, 2).transpose(1, 0, 2) for name, half in zip(BODIES, halves)}
