"""Frames of a run, read one by one."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import h5py
import numpy as np

COMPLIANT, RIGID, WALL = 0, 1, 2
KINDS = {"compliant": [COMPLIANT], "rigid": [RIGID], "wall": [WALL], "grain": [COMPLIANT, RIGID]}
TOPOLOGY = {"cells", "kind", "body"}  # of a grid, beside its frames
Box = tuple[float, float, float, float]  # least and largest x, least and largest y, m


class BadFolder(Exception):
    """The folder is no result folder, or one of its files cannot be read; the message names it."""


@dataclass
class Grid:
    """Topology of "bodies" (triangles) or "outlines" (segments), with what kind and which body each cell is of."""

    cells: np.ndarray  # [cells x points a cell]
    kind: np.ndarray  # [cells]
    body: np.ndarray  # [cells]

    def closed_across(self) -> Grid:
        """With one more segment for each wall, from its last point to its first: a wall is an open line that goes on in
        the next period."""
        uses = np.bincount(self.cells.ravel())
        extra = []
        for wall in np.unique(self.body[self.kind == WALL]):
            points = np.unique(self.cells[self.body == wall])
            ends = points[uses[points] == 1]
            if len(ends) == 2:
                extra.append((ends, wall))
        cells = np.array([ends for ends, _ in extra], dtype=int).reshape(-1, 2)
        bodies = np.array([wall for _, wall in extra], dtype=int)
        return Grid(
            np.concatenate([self.cells, cells]),
            np.concatenate([self.kind, np.full(len(extra), WALL)]),
            np.concatenate([self.body, bodies]),
        )

    @cached_property
    def point_body(self) -> np.ndarray:
        """[points] body of each point."""
        bodies = np.zeros(self.cells.max(initial=-1) + 1, dtype=int)
        bodies[self.cells] = self.body[:, None]
        return bodies

    @cached_property
    def cells_by_body(self) -> tuple[np.ndarray, np.ndarray]:
        """Cells, those of body 0 first, and where in them those of each body begin; one more entry ends the last."""
        starts = np.concatenate([[0], np.cumsum(np.bincount(self.body))])
        return np.argsort(self.body, kind="stable"), starts


@dataclass
class Contacts:
    """Pairs of bodies in touch in one frame; forces are those of the contact laws (lib/results/contact_network.hpp)."""

    bodies: np.ndarray  # [pairs x 2]
    images: np.ndarray  # [pairs] periods to add to the second to see it from the first; of a cell [pairs x 2], along both
    point: np.ndarray  # [pairs x 2] m, where the first body sees it
    force: np.ndarray  # [pairs x 2] N/m, on the second body
    length: np.ndarray  # [pairs] m

    def of(self, bodies: np.ndarray) -> Contacts:
        """Between two of these bodies."""
        chosen = np.isin(self.bodies, bodies).all(axis=1)
        return Contacts(*(getattr(self, name)[chosen] for name in ("bodies", "images", "point", "force", "length")))


class Frames:
    """frames.h5, read frame by frame. Frames that a killed run did not finish are not listed, so not seen.

    Bodies are numbered as in the grids; positions are not wrapped into the period or the cell.
    """

    def __init__(self, file: Path, period: float | None) -> None:
        self.path, self.period = file, period
        try:
            self._file = h5py.File(file, "r")
            self.times: np.ndarray = self._file["times"][()]
            self.grids = {name: self._grid(name) for name in ("bodies", "outlines") if name in self._file}
            self.constants = {name: self._constants(name) for name in self.grids}
        except (OSError, KeyError) as error:
            raise BadFolder(f"{file}: not a file of frames: {error}") from error
        if period is not None and "outlines" in self.grids:
            self.grids["outlines"] = self.grids["outlines"].closed_across()

    @property
    def in_cell(self) -> bool:
        """Whether the domain has two periods."""
        return "cell" in self._file

    def periods(self, index: int) -> np.ndarray:
        """[periods x 2] m, vectors of the periods in this frame: none, one, or the two of a cell that is deformed. The
        second one of a cell leans by half of the first at most: a multiple of the first is taken from it."""
        if not self.in_cell:
            return np.empty((0, 2)) if self.period is None else np.array([[self.period, 0.0]])
        a, b = self._cell_vectors(index)
        return np.array([a, b - np.round(b @ a / (a @ a)) * a])

    def _cell_vectors(self, index: int) -> np.ndarray:
        """[2 x 2] m, those that images count."""
        path = f"cell/{index:06}"
        try:
            return np.concatenate([self._file[f"{path}/a"][()], self._file[f"{path}/b"][()]]).astype(float)
        except (OSError, KeyError) as error:
            raise BadFolder(f"{self.path}: {path} cannot be read: {error}") from error

    def shifts(self, images: np.ndarray, index: int) -> np.ndarray:
        """[pairs x 2] m, of the images of contacts."""
        if self.in_cell:
            return images @ self._cell_vectors(index)
        return np.column_stack([images * (self.period or 0), np.zeros(len(images))])

    def _grid(self, name: str) -> Grid:
        group = self._file[name]
        return Grid(group["cells"][()], group["kind"][()].astype(int), group["body"][()].astype(int))

    def _constants(self, grid: str) -> set[str]:
        """Names of the fields that are written once, beside the topology."""
        group = self._file[grid]
        return {name for name in group if group.get(name, getclass=True) is h5py.Dataset} - TOPOLOGY

    def positions(self, grid: str, index: int) -> np.ndarray:
        """[points x 2], m."""
        values = self.field(grid, index, "position")
        if values is None:
            raise BadFolder(f"{self.path}: frame {index} of '{grid}' has no positions")
        return values.astype(float)

    def field(self, grid: str, index: int, name: str) -> np.ndarray | None:
        """[points or cells (x 3)], also of what is written once (with kind and body); None when the run did not store
        it."""
        once = name in TOPOLOGY or name in self.constants.get(grid, ())
        path = f"{grid}/{name}" if once else f"{grid}/{index:06}/{name}"
        try:
            return self._file[path][()] if path in self._file else None
        except OSError as error:
            raise BadFolder(f"{self.path}: {path} cannot be read: {error}") from error

    def stored(self, grid: str, index: int) -> set[str]:
        """Names of what a frame holds, its positions among them."""
        return set(self._file[f"{grid}/{index:06}"])

    def names(self, grid: str) -> list[str]:
        """Fields that the first frame has, and those that are written once for all."""
        if grid not in self.grids:
            return []
        return [name for name in self._file[f"{grid}/{0:06}"] if name != "position"] + sorted(self.constants[grid])

    def nearest(self, time: float) -> int:
        """Index of the frame nearest to a time, s. BadFolder: the time is further from all than two frames are apart."""
        if len(self.times) == 0:
            raise BadFolder(f"{self.path}: the run has no frame yet")
        apart = max(np.diff(self.times).max(initial=0.0), 1e-9 * abs(self.times[-1]))
        if not self.times[0] - apart <= time <= self.times[-1] + apart:
            raise BadFolder(f"{self.path}: no frame near {time:g} s; they are from {self.times[0]:g} to {self.times[-1]:g} s")
        return int(np.abs(self.times - time).argmin())

    @cached_property
    def kinds(self) -> np.ndarray:
        """[bodies] COMPLIANT, RIGID or WALL."""
        outlines = self.grids["outlines"]
        kinds = np.zeros(outlines.body.max(initial=-1) + 1, dtype=int)
        kinds[outlines.body] = outlines.kind
        return kinds

    def bodies(self, kind: str = "grain", index: int = 0, box: Box | None = None) -> np.ndarray:
        """Numbers of the bodies of a kind ("compliant", "rigid", "wall", "grain"), with their centres in a box."""
        if kind not in KINDS:
            raise ValueError(f"no kind '{kind}'; there are {', '.join(KINDS)}")
        chosen = np.isin(self.kinds, KINDS[kind])
        if box is not None:
            x, y = self.wrapped(self.centres(index), index).T
            chosen &= (x >= box[0]) & (x <= box[1]) & (y >= box[2]) & (y <= box[3])
        return np.flatnonzero(chosen)

    def centres(self, index: int) -> np.ndarray:
        """[bodies x 2] m, means of the outlines' points."""
        of = self.grids["outlines"].point_body
        points = self.positions("outlines", index)[: len(of)]
        sums = np.stack([np.bincount(of, column) for column in points.T], axis=1)
        return sums / np.bincount(of)[:, None]

    def wrapped(self, points: np.ndarray, index: int = 0) -> np.ndarray:
        """Points [n x 2] in the period, [0, period), if there is one, or in the cell of a frame."""
        if self.in_cell:
            periods = self.periods(index)
            return (points @ np.linalg.inv(periods) % 1) @ periods
        if self.period is None:
            return points
        return np.column_stack([points[:, 0] % self.period, points[:, 1]])

    def polygons(self, index: int, bodies: np.ndarray) -> list[np.ndarray]:
        """Outlines [points x 2], m, counter-clockwise, not closed; for matplotlib's PolyCollection, say."""
        of = self.grids["outlines"].point_body
        points = self.positions("outlines", index)[: len(of)]
        first = np.searchsorted(of, np.arange(of.max(initial=-1) + 2))
        return [points[first[body] : first[body + 1]] for body in bodies]

    def cells(self, grid: str, bodies: np.ndarray) -> np.ndarray:
        """[cells of the grid] whether they are of one of these bodies: picks values of fields at cells."""
        return np.isin(self.grids[grid].body, bodies)

    def contacts(self, index: int) -> Contacts | None:
        """None when the run did not store them ([frames] contacts = true)."""
        path = f"contacts/{index:06}"
        try:
            if path not in self._file:
                return None
            of = {name: values[()].astype(float) for name, values in self._file[path].items()}
            return Contacts(of["bodies"].astype(int), of["images"].astype(int), of["point"], of["force"], of["length"])
        except (OSError, KeyError) as error:
            raise BadFolder(f"{self.path}: {path} cannot be read: {error}") from error
