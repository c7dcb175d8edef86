"""Where bodies are: a shape for each, its motion in each frame, and what compliant ones add to it in their own axes."""

from __future__ import annotations

import numpy as np

from pliant.frames import COMPLIANT, WALL, BadFolder, Frames

SEGMENT_STEPS = 256  # of positions: a step is this part of the outlines' median segment
FINE = 16  # steps of the shapes themselves are finer by this factor
SAME_POINT = 0.04  # steps between a point of an outline and the one of a grid of bodies that it is
# Distance, in steps, of a point shown from that of the frame: half a step in both directions, and SAME_POINT.
ERROR = 0.75
_RIGID = 0.5**0.5


def by_body(values: np.ndarray, body: np.ndarray, count: int) -> np.ndarray:
    return np.bincount(body, values, minlength=count)


def rotated(points: np.ndarray, angle: np.ndarray) -> np.ndarray:
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.column_stack([cosine * points[:, 0] - sine * points[:, 1], sine * points[:, 0] + cosine * points[:, 1]])


class Points:
    """All points once: those of the bodies' triangles, then those of outlines that are none of them, as walls' are."""

    def __init__(self, frames: Frames, chosen: list[int]) -> None:
        if "bodies" not in frames.grids:
            raise BadFolder(f"{frames.path}: holds no bodies")
        self.frames, self.cells = frames, frames.grids["bodies"]
        self.outlines = frames.grids.get("outlines")
        inner = self.cells.point_body
        self.step = self._step(chosen[0])
        self.of_outline, self.extra = self._shared(chosen)
        outer = np.empty(0, dtype=int) if self.outlines is None else self.outlines.point_body[self.extra]
        self.body = np.concatenate([inner, outer])
        self.bodies = int(self.body.max(initial=-1)) + 1
        self.kind = np.full(self.bodies, WALL)
        for grid in (self.outlines, self.cells):
            if grid is not None:
                self.kind[grid.body] = grid.kind

    def _step(self, index: int) -> float:
        grid, name = (self.cells, "bodies") if self.outlines is None else (self.outlines, "outlines")
        ends = self.frames.positions(name, index)[grid.cells[:, :2]]
        return float(np.median(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1))) / SEGMENT_STEPS

    def _shared(self, chosen: list[int]) -> tuple[np.ndarray, np.ndarray]:
        """For each point of the outlines its number among all; and which ones the bodies' triangles lack."""
        if self.outlines is None:
            return np.empty(0, dtype=int), np.empty(0, dtype=int)
        count, outer = len(self.cells.point_body), len(self.outlines.point_body)
        bodies = np.concatenate([self.cells.point_body, self.outlines.point_body])
        place = np.concatenate(self._both(chosen[0]))
        keys = np.column_stack([bodies, np.rint(place / self.step)])
        _, first, group = np.unique(keys, axis=0, return_index=True, return_inverse=True)
        partner = first[group][count:]
        same = partner < count
        for index in chosen:
            inner, outline = self._both(index)
            apart = np.linalg.norm(outline[same] - inner[partner[same]], axis=1)
            same[same] = apart <= SAME_POINT * self.step
        extra = np.flatnonzero(~same)
        number = np.where(same, partner, 0)
        number[extra] = count + np.arange(len(extra))
        assert len(number) == outer
        return number, extra

    def _both(self, index: int) -> tuple[np.ndarray, np.ndarray]:
        """Of the points that a cell uses."""
        assert self.outlines is not None
        return (self.frames.positions("bodies", index)[: len(self.cells.point_body)],
                self.frames.positions("outlines", index)[: len(self.outlines.point_body)])

    def positions(self, index: int) -> np.ndarray:
        """[points x 2], m; in a cell with two periods each body with its centre in the cell."""
        place = self._where_they_are(index)
        if not self.frames.in_cell:
            return place
        count = np.maximum(np.bincount(self.body, minlength=self.bodies), 1)
        centres = np.column_stack([by_body(column, self.body, self.bodies) for column in place.T]) / count[:, None]
        return place + (self.frames.wrapped(centres, index) - centres)[self.body]

    def _where_they_are(self, index: int) -> np.ndarray:
        """[points x 2], m, not put into one cell."""
        if self.outlines is None:
            return self.frames.positions("bodies", index)[: len(self.cells.point_body)]
        inner, outline = self._both(index)
        return np.concatenate([inner, outline[self.extra]])


class Shapes:
    """Shapes as whole numbers of steps about the mean of their points in the first frame, and motions of all bodies."""

    def __init__(self, points: Points, first: int) -> None:
        self.points, self.step = points, points.step
        self.count = np.maximum(np.bincount(points.body, minlength=points.bodies), 1)
        place = points.positions(first)
        self.codes = np.rint((place - self._centre(place)[points.body]) / (self.step / FINE)).astype(np.int64)
        self.shape = self.codes * (self.step / FINE)
        self.rigid = points.kind != COMPLIANT

    def _centre(self, place: np.ndarray) -> np.ndarray:
        sums = [by_body(place[:, axis], self.points.body, self.points.bodies) for axis in (0, 1)]
        return np.column_stack(sums) / self.count[:, None]

    def motion(self, place: np.ndarray) -> np.ndarray:
        """[bodies x 3] in single precision: the mean of the points, m, and the angle that fits best, rad."""
        body, bodies = self.points.body, self.points.bodies
        centre = self._centre(place)
        arm = place - centre[body]
        along = by_body((self.shape * arm).sum(axis=1), body, bodies)
        across = by_body(self.shape[:, 0] * arm[:, 1] - self.shape[:, 1] * arm[:, 0], body, bodies)
        return np.column_stack([centre, np.arctan2(across, along)]).astype(np.float32)

    def apart(self, place: np.ndarray, motion: np.ndarray) -> np.ndarray:
        """[points x 2] what moved shapes lack, in the axes of each body, m."""
        of_point = motion.astype(float)[self.points.body]
        return rotated(place - of_point[:, :2], -of_point[:, 2]) - self.shape

    def judge(self, place: np.ndarray) -> None:
        """Bodies that do not move as rigid ones to the accuracy of the page are none."""
        apart = np.linalg.norm(self.apart(place, self.motion(place)), axis=1)
        self.rigid[self.points.body[apart > _RIGID * self.step]] = False

    @property
    def soft(self) -> np.ndarray:
        """Points that need more than their body's motion."""
        return np.flatnonzero(~self.rigid[self.points.body])
