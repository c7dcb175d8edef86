"""Puts bodies of a periodic scene where a picture shows them: whole, and as often as they reach into it."""

import numpy as np

from pliant.frames import Box


def extents(points: np.ndarray, owner: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Who owns any of the points, and the lower and upper corner [owners x 2] of what each owns."""
    order = np.argsort(owner, kind="stable")
    owners, starts = np.unique(owner[order], return_index=True)
    return owners, np.minimum.reduceat(points[order], starts), np.maximum.reduceat(points[order], starts)


def images(low: np.ndarray, high: np.ndarray, period: float | None, box: Box) -> tuple[np.ndarray, np.ndarray]:
    """Which of the things that reach from `low` to `high` [n x 2] stand in the box, and how far in x: once for every
    whole number of periods that brings them there."""
    seen = (high[:, 1] > box[2]) & (low[:, 1] < box[3])
    if period is None:
        index = np.flatnonzero(seen & (high[:, 0] > box[0]) & (low[:, 0] < box[1]))
        return index, np.zeros(len(index))
    first = np.floor((box[0] - high[:, 0]) / period).astype(int) + 1
    last = np.ceil((box[1] - low[:, 0]) / period).astype(int) - 1
    count = np.where(seen, np.maximum(last - first + 1, 0), 0)
    return np.repeat(np.arange(len(count)), count), runs(first, count) * period


def runs(first: np.ndarray, count: np.ndarray) -> np.ndarray:
    """first[0], first[0] + 1, ... `count[0]` of them, then those of first[1], and so on."""
    return np.repeat(first - np.cumsum(count) + count, count) + np.arange(count.sum())


def shortened(segments: np.ndarray, period: float) -> np.ndarray:
    """Segments [n x 2 x 2] of a wall, where the one that closes it across the period spans no longer all of it."""
    result = segments.copy()
    jump = result[:, 1, 0] - result[:, 0, 0]
    result[:, 1, 0] -= np.round(jump / period) * period
    return result
