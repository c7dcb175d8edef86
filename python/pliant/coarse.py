"""Fields of a frame as means over the cells of a regular grid: the sister of probes over a box.

    fields = coarse_fields(run.frames, 10, cell=2e-6)
    fields.solid_fraction, fields.velocity, fields.stress      # [rows x columns ...]
    layers = profile(run.frames, (0.2, 0.4), height=5e-3)      # means over x and over these times
    layers.y, layers.velocity[:, 0]
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pliant.frames import BadFolder, Box, Frames
from pliant.network import of_frame

SAMPLES = 16  # of an arm, each with its share of the force's moment
FINE = 4  # pieces of a triangle in a cell's width


@dataclass
class CoarseFields:
    """Rows go up from the box's least y, columns right from its least x; a periodic one has whole cells in its period."""

    box: Box
    solid_fraction: np.ndarray  # [rows x columns] area of grains over that of the cell
    velocity: np.ndarray | None  # [rows x columns x 2] m/s, mean over the area of grains; NaN without any
    stress: np.ndarray | None  # [rows x columns x 2 x 2] Pa, tension positive, over the cell; of contacts alone

    @property
    def pressure(self) -> np.ndarray | None:
        """[rows x columns] Pa, in the plane."""
        return None if self.stress is None else -0.5 * np.trace(self.stress, axis1=2, axis2=3)


@dataclass
class Profile:
    """Means over x and time, in layers from the box's least y up."""

    y: np.ndarray  # [layers] m, of their middles
    solid_fraction: np.ndarray  # [layers]
    velocity: np.ndarray | None  # [layers x 2] m/s, mean over the area of grains; NaN without any
    stress: np.ndarray | None  # [layers x 2 x 2] Pa, as in CoarseFields


@dataclass
class Cells:
    box: Box
    rows: int
    columns: int
    period: float | None

    @property
    def area(self) -> float:
        x0, x1, y0, y1 = self.box
        return (x1 - x0) * (y1 - y0) / (self.rows * self.columns)

    def sums(self, points: np.ndarray, values: np.ndarray) -> np.ndarray:
        """[rows x columns] of values [n] at points [n x 2]; outside of the box they count nowhere."""
        x0, x1, y0, y1 = self.box
        x = points[:, 0] if self.period is None else x0 + (points[:, 0] - x0) % self.period
        column = np.floor((x - x0) / (x1 - x0) * self.columns).astype(int)
        row = np.floor((points[:, 1] - y0) / (y1 - y0) * self.rows).astype(int)
        if self.period is not None:
            column = np.minimum(column, self.columns - 1)  # of a place just below the period, by rounding
        inside = (column >= 0) & (column < self.columns) & (row >= 0) & (row < self.rows)
        flat = np.bincount((row * self.columns + column)[inside], values[inside], self.rows * self.columns)
        return flat.reshape(self.rows, self.columns)


def coarse_fields(frames: Frames, index: int, cell: float, box: Box | None = None) -> CoarseFields:
    """Means over cells about as wide as `cell`, m, that fill the box: by default the period, or all grains.

    Solid fraction and velocity are sums over pieces of triangles a quarter of a cell wide or less. Stress is Love and
    Weber's, each force times its arm spread evenly along the arm (Goldhirsch 2010), so that whole grains give theirs;
    of bodies that move fast it lacks their momentum's part. None where the run lacks velocities or contacts.
    """
    cells = _cells(frames, index, cell, box)
    points, areas, velocities = _pieces(frames, index, cell / FINE)
    area = cells.sums(points, areas)
    velocity = None
    if velocities is not None:
        momentum = np.stack([cells.sums(points, areas * velocities[:, i]) for i in range(2)], axis=2)
        velocity = momentum / np.where(area > 0, area, np.nan)[:, :, None]
    stress = None if frames.contacts(index) is None else _stress(frames, index, cells)
    return CoarseFields(cells.box, area / cells.area, velocity, stress)


def profile(frames: Frames, window: tuple[float, float], height: float, box: Box | None = None) -> Profile:
    """Means over the frames in a window of time, s, in layers about as high as `height`, m, that fill the box: by
    default all that grains reach in these frames. ValueError: no frame is in the window."""
    slack = 1e-9 * (window[1] - window[0])
    indices = np.flatnonzero((frames.times >= window[0] - slack) & (frames.times <= window[1] + slack))
    if len(indices) == 0:
        raise ValueError(f"no frame from {window[0]:g} to {window[1]:g} s; allowed: times from {frames.times[0]:g} to "
                         f"{frames.times[-1]:g} s")
    if box is None:
        left, right, low, high = np.transpose([_cells(frames, i, height, None).box for i in indices])
        box = (left.min(), right.max(), low.min(), high.max())
    fields = [coarse_fields(frames, i, height, box) for i in indices]
    solid = np.mean([f.solid_fraction for f in fields], axis=(0, 2))
    y = box[2] + (np.arange(len(solid)) + 0.5) * (box[3] - box[2]) / len(solid)
    velocity = None
    if all(f.velocity is not None for f in fields):
        flux = np.mean([f.solid_fraction[:, :, None] * np.nan_to_num(f.velocity) for f in fields], axis=(0, 2))
        velocity = flux / np.where(solid > 0, solid, np.nan)[:, None]
    stress = None
    if all(f.stress is not None for f in fields):
        stress = np.mean([f.stress for f in fields], axis=(0, 2))
    return Profile(y, solid, velocity, stress)


def _cells(frames: Frames, index: int, cell: float, box: Box | None) -> Cells:
    if frames.in_cell:
        raise BadFolder(f"{frames.path}: fields over a box are for domains of one period at most; this one has two")
    if box is None:
        points = frames.positions("bodies", index)
        (left, low), (right, high) = points.min(axis=0), points.max(axis=0)
        box = (left, right, low, high) if frames.period is None else (0.0, frames.period, low, high)
    x0, x1, y0, y1 = box
    if not (cell > 0 and x1 > x0 and y1 > y0):
        raise ValueError(f"cells of {cell:g} m in the box {box}; allowed: a positive width and x0 < x1, y0 < y1")
    whole = frames.period is not None and np.isclose(x1 - x0, frames.period)
    return Cells(box, max(1, round((y1 - y0) / cell)), max(1, round((x1 - x0) / cell)),
                 frames.period if whole else None)


def _pieces(frames: Frames, index: int, width: float) -> tuple[np.ndarray, np.ndarray, np.ndarray | None]:
    """Centroids [n x 2], areas [n] and velocities [n x 2] of equal pieces of the grains' triangles."""
    triangles = frames.positions("bodies", index)[frames.grids["bodies"].cells]
    velocity = frames.field("bodies", index, "velocity")
    corners = None if velocity is None else velocity[frames.grids["bodies"].cells][:, :, :2].astype(float)
    edges = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2).max(axis=1)
    counts = np.maximum(1, np.ceil(edges / width).astype(int))
    points, areas, velocities = [], [], []
    for count in np.unique(counts):
        chosen, weights = counts == count, _centroids(count)
        (ax, ay), (bx, by) = (np.moveaxis(triangles[chosen, k] - triangles[chosen, 0], 1, 0) for k in (1, 2))
        points.append(np.einsum("pk,tki->tpi", weights, triangles[chosen]).reshape(-1, 2))
        areas.append(np.repeat(0.5 * np.abs(ax * by - ay * bx) / count**2, count**2))
        if corners is not None:
            velocities.append(np.einsum("pk,tki->tpi", weights, corners[chosen]).reshape(-1, 2))
    return np.concatenate(points), np.concatenate(areas), np.concatenate(velocities) if velocities else None


def _centroids(count: int) -> np.ndarray:
    """[count^2 x 3] barycentric coordinates of the centroids of a triangle's equal pieces, count along an edge."""
    i, j = np.meshgrid(np.arange(count), np.arange(count), indexing="ij")
    upright, upset = i + j < count, i + j < count - 1
    first = np.concatenate([i[upright] + 1 / 3, i[upset] + 2 / 3]) / count
    second = np.concatenate([j[upright] + 1 / 3, j[upset] + 2 / 3]) / count
    return np.column_stack([1 - first - second, first, second])


def _stress(frames: Frames, index: int, cells: Cells) -> np.ndarray:
    network = of_frame(frames, index)
    along = (np.arange(SAMPLES) + 0.5) / SAMPLES
    total = np.zeros((cells.rows, cells.columns, 2, 2))
    for side, sign in ((0, -1), (1, 1)):  # the force acts on the second, and oppositely on the first
        grains = ~network.walls[:, side]
        arms, forces = network.arms[grains, side], sign * network.contacts.force[grains]
        points = network.contacts.point[grains][:, None] - arms[:, None] * along[None, :, None]
        for i in range(2):
            for j in range(2):
                moments = np.repeat(forces[:, i] * arms[:, j] / SAMPLES, SAMPLES)
                total[:, :, i, j] += cells.sums(points.reshape(-1, 2), moments)
    return total / cells.area
