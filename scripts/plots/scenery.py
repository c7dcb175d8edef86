"""One frame as polygons in one picture, ready to be drawn."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from plots.wrapping import Box, extents, images, runs, shortened
from pliant.frames import WALL, Frames
from pliant.results import Run


@dataclass
class Scenery:
    """One frame: bodies that reach into one picture, all lengths in metres."""

    triangles: np.ndarray  # [triangles x 3 x 2]
    cells: np.ndarray  # [triangles] cell of the grid each is a picture of
    kind: np.ndarray  # [triangles]
    edges: np.ndarray  # [segments x 2 x 2] outlines of grains
    edge_cells: np.ndarray  # [segments] cell of the outlines' grid each is a picture of
    edge_body: np.ndarray  # [segments]
    walls: np.ndarray  # [segments x 2 x 2]
    wall_below: np.ndarray  # [segments] whether the grains are above
    cell: np.ndarray  # [4 x 2] corners of a cell with two periods; none without


def scenery(run: Run, index: int, box: Box | None = None, origin: Sequence[float] = (0.0, 0.0)) -> Scenery:
    """What is to be seen in `box`, which is placed at `origin`: all of it, in one period, without a box."""
    frames = run.frames
    if box is None:
        box = (0.0, run.period, -np.inf, np.inf) if run.period is not None else (-np.inf, np.inf, -np.inf, np.inf)
        box = whole_box(run, [index]) if frames.in_cell else box
    periods = frames.periods(index)
    points = frames.positions("bodies", index) - origin
    triangles, cells = _polygons(frames, "bodies", points, periods, box)
    edges, edge_cells, edge_body, walls = np.empty((0, 2, 2)), np.empty(0, int), np.empty(0, int), np.empty((0, 2, 2))
    if "outlines" in frames.grids:
        outline_points = frames.positions("outlines", index) - origin
        edges, edge_cells = _polygons(frames, "outlines", outline_points, periods, box)
        edge_body = frames.grids["outlines"].body[edge_cells]
        walls = _walls(frames, outline_points, run.period, box)
    middle = points[:, 1].mean() if len(points) else walls[:, :, 1].mean()
    kind = frames.grids["bodies"].kind[cells]
    below = walls[:, :, 1].mean(axis=1) < middle
    cell = cell_corners(periods) - origin if frames.in_cell else np.empty((0, 2))
    return Scenery(triangles, cells, kind, edges, edge_cells, edge_body, walls, below, cell)


def cell_corners(periods: np.ndarray) -> np.ndarray:
    """[4 x 2] of a cell at the origin, counter-clockwise."""
    a, b = periods
    return np.array([np.zeros(2), a, a + b, b])


def _polygons(
    frames: Frames, grid: str, points: np.ndarray, periods: np.ndarray, box: Box
) -> tuple[np.ndarray, np.ndarray]:
    """Cells of grains as polygons [n x corners x 2], and the cell each is a picture of."""
    topology = frames.grids[grid]
    used = len(topology.point_body)
    bodies, low, high = extents(points[:used], topology.point_body)
    grains = ~np.isin(bodies, topology.body[topology.kind == WALL])
    bodies, low, high = bodies[grains], low[grains], high[grains]
    index, shifts = images(low, high, periods, box)
    order, starts = topology.cells_by_body
    first, count = starts[bodies[index]], np.diff(starts)[bodies[index]]
    cells = order[runs(first, count)]
    polygons = points[topology.cells[cells]]
    polygons += np.repeat(shifts, count, axis=0)[:, None]
    return polygons, cells


def _walls(frames: Frames, points: np.ndarray, period: float | None, box: Box) -> np.ndarray:
    """Segments of walls [n x 2 x 2] at any height: what is solid behind them may be seen where they are not."""
    topology = frames.grids["outlines"]
    segments = points[topology.cells[topology.kind == WALL]]
    if period is not None:
        segments = shortened(segments, period)
    periods = np.empty((0, 2)) if period is None else np.array([[period, 0.0]])
    index, shifts = images(segments.min(axis=1), segments.max(axis=1), periods, (*box[:2], -np.inf, np.inf))
    return segments[index] + shifts[:, None]


def extent(run: Run, index: int) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper corner of all grains and walls, where they are: not put into one period. Of a cell with two
    periods its own."""
    frames = run.frames
    if frames.in_cell:
        corners = cell_corners(frames.periods(index))
        return corners.min(axis=0), corners.max(axis=0)
    points = [frames.positions("bodies", index)]
    if "outlines" in frames.grids:
        grid = frames.grids["outlines"]
        points.append(frames.positions("outlines", index)[np.unique(grid.cells[grid.kind == WALL])])
    together = np.concatenate(points)
    return together.min(axis=0), together.max(axis=0)


def whole_box(run: Run, indices: Sequence[int]) -> Box:
    """Room for all that these frames show."""
    lows, highs = zip(*(extent(run, index) for index in indices))
    return with_margin(np.min(lows, axis=0), np.max(highs, axis=0), run.period)


def with_margin(low: np.ndarray, high: np.ndarray, period: float | None) -> Box:
    left, right = (low[0], high[0]) if period is None else (0.0, period)
    margin = 0.04 * max(high[1] - low[1], 0.25 * (right - left))
    # Neither a thread nor a needle: at most 6 to 1.
    above = max(margin, 0.5 * ((right - left) / 6 - (high[1] - low[1])))
    beside = 0.0 if period is not None else max(margin, 0.5 * ((high[1] - low[1]) / 6 - (right - left)))
    return left - beside, right + beside, low[1] - above, high[1] + above


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
