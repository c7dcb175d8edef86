"""The stored numbers of oracles/."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from foreign.stored import read_table
from make_pushed_disc_oracles import DRAWN, STUCK
from pushed_disc_runs import Forces, forces

FOLDER = Path(__file__).parent / "oracles"
Key = tuple[int, int, int]  # rings of the disc, rows of squares in the block, load steps for 0.1 R


@dataclass
class Stored:
    """Samples by GetFEM on meshes; the finest is last. Coarser load steps are there of what sticks alone."""

    samples: dict[Key, np.ndarray]  # [pushes x 3] push, along, across

    @property
    def meshes(self) -> list[Key]:
        """With the shortest load steps."""
        shortest = max(key[2] for key in self.samples)
        return [key for key in self.samples if key[2] == shortest]

    @property
    def finest(self) -> np.ndarray:
        return self.samples[self.meshes[-1]]

    def of(self, key: Key) -> Forces:
        return forces(*self.samples[key].T)

    @property
    def forces(self) -> Forces:
        return self.of(self.meshes[-1])

    def errors(self) -> Forces:
        """Relative: the change from half as fine a mesh, the largest of what sticks and of what slips, as at a single
        push it may be small by accident, and that from load steps twice as long, of first order."""
        coarse, fine = self.of(self.meshes[0]), self.forces
        rings, rows, steps = self.meshes[0]
        found = []
        for name in ("along", "across"):
            last = getattr(fine, name)
            change = np.abs(getattr(coarse, name) / last - 1)
            first = 1 if name == "along" else 0  # there is next to no force along before the push
            change[:len(STUCK)], change[len(STUCK):] = change[first:len(STUCK)].max(), change[len(STUCK):].max()
            column = 1 if name == "along" else 2
            long, short = (self.samples[rings, rows, n][:len(STUCK), column] for n in (steps // 2, steps))
            change[:len(STUCK)] += np.abs(long / short - 1)[first:].max()
            found.append(change)
        return Forces(*found)


def read_stored() -> Stored:
    table = read_table(FOLDER / "pushed_disc_getfem.csv")
    keys = dict.fromkeys(tuple(int(value) for value in row[:3]) for row in table)
    return Stored({key: table[(table[:, :3] == key).all(axis=1), 3:] for key in keys})


def read_surfaces() -> dict[float, np.ndarray]:
    """[nodes x 2] of the block's top by push."""
    table = read_table(FOLDER / "pushed_disc_surfaces.csv")
    return {push: table[:, 2 * i:2 * i + 2] for i, push in enumerate(DRAWN)}
