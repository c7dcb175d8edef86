"""The stored numbers of oracles/."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from foreign.stored import read_table
from make_pushed_disc_oracles import (CALCULIX_MESHES, DOWN, DRAWN, FINEST, LAWS, LONG, MELODY, SHORT, SOFT, STIFF,
                                      STUCK)
from pushed_disc_runs import Forces, forces

FOLDER = Path(__file__).parent / "oracles"
KINDS = ("along", "across")
Mesh = tuple[int, int]  # rings of the disc, rows of squares in the block
Key = tuple[int, int, int]  # rings of the disc, rows of squares in the block, load steps for 0.1 R


def by_group(values: np.ndarray, first: int) -> np.ndarray:
    """[places] the largest of what sticks, from that place on, and of what slips: at a single place it may be small by
    accident."""
    found = np.array(values, dtype=float)
    found[:len(STUCK)], found[len(STUCK):] = found[first:len(STUCK)].max(), found[len(STUCK):].max()
    return found


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
        """Relative: the largest change from meshes half as fine and finer, of what sticks and of what slips, as from a
        single one or at a single push it may be small by accident; and that from load steps twice as long, of first
        order."""
        coarser = [self.of(key) for key in self.meshes[:-1] if 2 * key[0] >= self.meshes[-1][0]]
        rings, rows, steps = self.meshes[0]
        found = []
        for name in ("along", "across"):
            last = getattr(self.forces, name)
            first = 1 if name == "along" else 0  # there is next to no force along before the push
            change = by_group(np.abs([getattr(other, name) / last - 1 for other in coarser]).max(axis=0), first)
            column = 1 if name == "along" else 2
            long, short = (self.samples[rings, rows, n][:len(STUCK), column] for n in (steps // 2, steps))
            change[:len(STUCK)] += np.abs(long / short - 1)[first:].max()
            found.append(change)
        return Forces(*found)


def read_stored(law: str = LAWS[0]) -> Stored:
    table = read_table(FOLDER / f"pushed_disc_getfem{MELODY * (law == 'melody')}.csv")
    keys = dict.fromkeys(tuple(int(value) for value in row[:3]) for row in table)
    return Stored({key: table[(table[:, :3] == key).all(axis=1), 3:] for key in keys})


@dataclass
class Penalised:
    """By CalculiX, law `melody`, with a penalty: rows of slave, rings, rows, stiffness, increments down and along,
    push, forces along and across."""

    rows: np.ndarray

    def samples(self, mesh: Mesh, stiffness: float, increment: float, slave: int = 0, down: float = DOWN) -> np.ndarray:
        """[pushes x 3] push, along, across."""
        key = [slave, *mesh, stiffness, down, increment]
        return self.rows[np.isclose(self.rows[:, :6], key).all(axis=1), 6:]

    def of(self, mesh: Mesh, stiffness: float, increment: float, slave: int = 0) -> np.ndarray:
        """[2 x places] forces along and across."""
        found = forces(*self.samples(mesh, stiffness, increment, slave).T)
        return np.array([found.along, found.across])

    def lag(self, mesh: Mesh, stiffness: float, short: float, slave: int = 0) -> np.ndarray:
        """[2 x places] over forces with an increment of LONG, those without it, of first order in the increment, from
        this one and one twice as long."""
        without = 2 * self.of(mesh, stiffness, short, slave) - self.of(mesh, stiffness, 2 * short, slave)
        return without / self.of(mesh, stiffness, LONG, slave)

    def still(self, mesh: Mesh, stiffness: float, slave: int = 0) -> np.ndarray:
        """[2 x places] without the lag."""
        return self.of(mesh, stiffness, LONG, slave) * self.lag(mesh, stiffness, SHORT, slave)

    def rigid(self, mesh: Mesh) -> np.ndarray:
        """[2 x places] of rigid contact, from two penalties: their error is of order 1 / K."""
        soft, stiff = (self.still(mesh, stiffness) for stiffness in (SOFT, STIFF))
        return (STIFF * stiff - SOFT * soft) / (STIFF - SOFT)

    def share(self, mesh: Mesh) -> np.ndarray:
        """[2 x places] of rigid contact without lag over forces with SOFT and LONG, which the finest mesh has alone."""
        return self.rigid(mesh) / self.of(mesh, SOFT, LONG)

    @property
    def force(self) -> np.ndarray:
        """[2 x places] along and across, of the finest mesh."""
        return self.of(FINEST, SOFT, LONG) * self.share(CALCULIX_MESHES[-1])

    def changes(self) -> dict[str, np.ndarray]:
        """[2 x places] each, relative: from the mesh before, times what is left of errors of first order; of the share
        of penalty and lag from half as fine a mesh; the product of both penalties' losses, as their second order is;
        half of what the other body as slave changes; what increments half as long change on the way down; what the lag
        is by increments twice as long."""
        coarse, fine = CALCULIX_MESHES
        left = 1 / (FINEST[0] / fine[0] - 1)
        rigid, usual = self.rigid(fine), self.still(coarse, STIFF)
        losses = [self.still(fine, stiffness) / rigid - 1 for stiffness in (SOFT, STIFF)]
        found = {"mesh": left * (self.of(fine, SOFT, LONG) / self.of(FINEST, SOFT, LONG) - 1),
                 "share": self.share(coarse) / self.share(fine) - 1, "penalty": losses[0] * losses[1],
                 "slave": (self.still(coarse, STIFF, 1) / usual - 1) / 2,
                 "down": np.pad(self.down(), [(0, 0), (0, rigid.shape[1] - len(STUCK))]),
                 "lag": self.lag(fine, SOFT, LONG) / self.lag(fine, SOFT, SHORT) - 1}
        return {name: np.abs(change) for name, change in found.items()}

    def down(self) -> np.ndarray:
        """[2 x pushes that stick] what increments half as long on the way down change, relative."""
        half, whole = (self.samples(CALCULIX_MESHES[0], SOFT, LONG, down=way)[:len(STUCK), 1:].T
                       for way in (DOWN / 2, DOWN))
        return half / whole - 1

    @property
    def error(self) -> np.ndarray:
        """[2 x places] relative: the sum of the largest of each."""
        return np.array([sum(by_group(change[k], 1 - k) for change in self.changes().values()) for k in range(2)])


def read_calculix() -> Penalised:
    return Penalised(read_table(FOLDER / "pushed_disc_calculix_melody.csv"))


def read_surfaces() -> dict[float, np.ndarray]:
    """[nodes x 2] of the block's top by push."""
    table = read_table(FOLDER / "pushed_disc_surfaces.csv")
    return {push: table[:, 2 * i:2 * i + 2] for i, push in enumerate(DRAWN)}
