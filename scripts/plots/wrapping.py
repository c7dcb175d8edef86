"""Puts bodies of a periodic scene where a picture shows them: whole, and as often as they reach into it."""

import numpy as np

from pliant.frames import Box


def extents(points: np.ndarray, owner: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Who owns any of the points, and the lower and upper corner [owners x 2] of what each owns."""
    order = np.argsort(owner, kind="stable")
    owners, starts = np.unique(owner[order], return_index=True)
    return owners, np.minimum.reduceat(points[order], starts), np.maximum.reduceat(points[order], starts)


def images(low: np.ndarray, high: np.ndarray, periods: np.ndarray, box: Box) -> tuple[np.ndarray, np.ndarray]:
    """Which of the things that reach from `low` to `high` [n x 2] stand in the box, and how far they are moved there
    [m x 2]: once for every whole number of periods [periods x 2] that brings them there."""
    if len(periods) == 2:
        return _images_in_cell(low, high, periods, box)
    seen = (high[:, 1] > box[2]) & (low[:, 1] < box[3])
    if len(periods) == 0:
        index = np.flatnonzero(seen & (high[:, 0] > box[0]) & (low[:, 0] < box[1]))
        return index, np.zeros((len(index), 2))
    period = periods[0, 0]
    first = np.floor((box[0] - high[:, 0]) / period).astype(int) + 1
    last = np.ceil((box[1] - low[:, 0]) / period).astype(int) - 1
    count = np.where(seen, np.maximum(last - first + 1, 0), 0)
    shifts = runs(first, count) * period
    return np.repeat(np.arange(len(count)), count), np.column_stack([shifts, np.zeros(len(shifts))])


def _images_in_cell(low: np.ndarray, high: np.ndarray, periods: np.ndarray, box: Box) -> tuple[np.ndarray, np.ndarray]:
    """The same along both vectors of a cell: around the image whose middle is nearest to that of the box."""
    if len(low) == 0:
        return np.empty(0, dtype=int), np.empty((0, 2))
    corner, other = np.array([box[0], box[2]]), np.array([box[1], box[3]])
    counted = np.linalg.inv(periods)
    nearest = np.round((0.5 * (corner + other) - 0.5 * (low + high)) @ counted)
    reach = 0.5 * (other - corner) + 0.5 * (high - low).max(axis=0)
    most = np.ceil(np.abs(counted).T @ reach).astype(int) + 1
    around = np.array([(i, j) for i in range(-most[0], most[0] + 1) for j in range(-most[1], most[1] + 1)])
    shifts = (nearest[:, None] + around[None]) @ periods
    seen = ((high[:, None] + shifts > corner) & (low[:, None] + shifts < other)).all(axis=2)
    index, which = np.nonzero(seen)
    return index, shifts[index, which]


def runs(first: np.ndarray, count: np.ndarray) -> np.ndarray:
    """first[0], first[0] + 1, ... `count[0]` of them, then those of first[1], and so on."""
    return np.repeat(first - np.cumsum(count) + count, count) + np.arange(count.sum())


def shortened(segments: np.ndarray, period: float) -> np.ndarray:
    """Segments [n x 2 x 2] of a wall, where the one that closes it across the period spans no longer all of it."""
    result = segments.copy()
    jump = result[:, 1, 0] - result[:, 0, 0]
    result[:, 1, 0] -= np.round(jump / period) * period
    return result
