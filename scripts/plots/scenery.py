"""One frame as polygons in one period, ready to be drawn."""

from dataclasses import dataclass

import numpy as np

from plots.wrapping import body_shifts, edge_copies, wrapped_segments
from pliant.frames import WALL, Frames
from pliant.results import Run


@dataclass
class Scenery:
    """One frame: bodies in one period, all lengths in metres."""

    triangles: np.ndarray  # [triangles x 3 x 2]
    cells: np.ndarray  # [triangles] cell of the grid each is a picture of
    kind: np.ndarray  # [triangles]
    edges: np.ndarray  # [segments x 2 x 2] outlines of grains
    edge_cells: np.ndarray  # [segments] cell of the outlines' grid each is a picture of
    walls: np.ndarray  # [segments x 2 x 2]
    box: tuple[float, float, float, float]  # x and y limits

    @property
    def width(self) -> float:
        return self.box[1] - self.box[0]

    @property
    def height(self) -> float:
        return self.box[3] - self.box[2]


def scenery(run: Run, index: int) -> Scenery:
    frames = run.frames
    assert frames is not None
    triangles, cells = _polygons(frames, "bodies", index, run.period)
    kind = frames.grids["bodies"].kind[cells]
    edges, walls, edge_cells = np.empty((0, 2, 2)), np.empty((0, 2, 2)), np.empty(0, dtype=int)
    if "outlines" in frames.grids:
        segments, originals = _polygons(frames, "outlines", index, run.period)
        of_wall = frames.grids["outlines"].kind[originals] == WALL
        edges, edge_cells, walls = segments[~of_wall], originals[~of_wall], segments[of_wall]
        if run.period is not None:
            walls = wrapped_segments(walls, run.period)
    return Scenery(triangles, cells, kind, edges, edge_cells, walls, _box(triangles[kind != WALL], walls, run.period))


def _polygons(frames: Frames, grid: str, index: int, period: float | None) -> tuple[np.ndarray, np.ndarray]:
    """Cells of a grid as polygons [n x corners x 2], grains wrapped, and the cell each is a picture of."""
    topology = frames.grids[grid]
    points = frames.positions(grid, index)
    if period is None:
        return points[topology.cells], np.arange(len(topology.cells))
    movable = np.zeros(topology.body.max(initial=-1) + 1, dtype=bool)
    movable[topology.body[topology.kind != WALL]] = True
    used = len(topology.point_body)
    points[:used, 0] += body_shifts(points[:used], topology.point_body, movable, period)
    if grid == "outlines":
        return _copied_grains(points[topology.cells], topology.body, topology.kind != WALL, period)
    return edge_copies(points[topology.cells], topology.body, period)


def _copied_grains(
    polygons: np.ndarray, bodies: np.ndarray, grain: np.ndarray, period: float
) -> tuple[np.ndarray, np.ndarray]:
    """Copies at the edges for grains alone: walls are wrapped segment by segment."""
    copies, index = edge_copies(polygons[grain], bodies[grain], period)
    walls = np.flatnonzero(~grain)
    return np.concatenate([copies, polygons[walls]]), np.concatenate([np.flatnonzero(grain)[index], walls])


def _box(grains: np.ndarray, walls: np.ndarray, period: float | None) -> tuple[float, float, float, float]:
    corners = np.concatenate([grains.reshape(-1, 2), walls.reshape(-1, 2)])
    (left, low), (right, high) = corners.min(axis=0), corners.max(axis=0)
    if period is not None:
        left, right = 0.0, period
    margin = 0.04 * max(high - low, 0.25 * (right - left))
    # Neither a thread nor a needle: at most 6 to 1.
    above = max(margin, 0.5 * ((right - left) / 6 - (high - low)))
    beside = 0.0 if period is not None else max(margin, 0.5 * ((high - low) / 6 - (right - left)))
    return left - beside, right + beside, low - above, high + above


def common_box(sceneries: list[Scenery]) -> tuple[float, float, float, float]:
    boxes = np.array([s.box for s in sceneries])
    return boxes[:, 0].min(), boxes[:, 1].max(), boxes[:, 2].min(), boxes[:, 3].max()


def refined(triangles: np.ndarray, values: np.ndarray, length: float) -> tuple[np.ndarray, np.ndarray]:
    """Triangles [n x 3 x 2] and values at their corners [n x 3 x m], longest edges halved until none exceeds `length`.

    Values are linear over a triangle, so the halves have the same field. A rigid body's triangles span all of it:
    without this, a quantity that is not linear, as the norm of its velocity, could not be drawn from its corners.
    """
    whole_triangles, whole_values = [], []
    while len(triangles) > 0:
        edges = np.linalg.norm(triangles - np.roll(triangles, -1, axis=1), axis=2)  # of corner i: to corner i + 1
        longest = edges.argmax(axis=1)
        done = edges[np.arange(len(edges)), longest] <= length
        whole_triangles.append(triangles[done])
        whole_values.append(values[done])
        order = (longest[~done, None] + np.arange(3)) % 3
        triangles, values = (_halved(part[~done], order) for part in (triangles, values))
    return np.concatenate([np.empty((0, *triangles.shape[1:])), *whole_triangles]), np.concatenate(
        [np.empty((0, *values.shape[1:])), *whole_values]
    )


def _halved(corners: np.ndarray, order: np.ndarray) -> np.ndarray:
    """[2 n x 3 x m]: each entry cut at the middle of the edge from its first to its second corner in `order`."""
    first, second, third = np.take_along_axis(corners, order[:, :, None], axis=1).transpose(1, 0, 2)
    middle = 0.5 * (first + second)
    return np.concatenate([np.stack([first, middle, third], axis=1), np.stack([middle, second, third], axis=1)])
