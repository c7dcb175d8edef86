"""Puts bodies of a periodic scene into one period: whole bodies, each by its centroid."""

import numpy as np


def body_shifts(points: np.ndarray, point_body: np.ndarray, movable: np.ndarray, period: float) -> np.ndarray:
    """[points] to be added to x, so that every movable body has its centroid in [0, period)."""
    count = np.bincount(point_body, minlength=len(movable))
    mean = np.bincount(point_body, points[:, 0], minlength=len(movable)) / np.maximum(count, 1)
    shift = np.where(movable, -np.floor(mean / period) * period, 0.0)
    return shift[point_body]


def edge_copies(polygons: np.ndarray, bodies: np.ndarray, period: float) -> tuple[np.ndarray, np.ndarray]:
    """Bodies that stand out of [0, period] enter again at the other side: polygons [n x corners x 2] with their copies,
    and the index of the original of each."""
    x = polygons[:, :, 0]
    lowest, highest = np.full(bodies.max(initial=-1) + 1, np.inf), np.full(bodies.max(initial=-1) + 1, -np.inf)
    np.minimum.at(lowest, bodies, x.min(axis=1))
    np.maximum.at(highest, bodies, x.max(axis=1))
    left, right = np.flatnonzero(lowest[bodies] < 0), np.flatnonzero(highest[bodies] > period)
    step = np.array([period, 0.0])
    index = np.concatenate([np.arange(len(polygons)), left, right])
    return np.concatenate([polygons, polygons[left] + step, polygons[right] - step]), index


def wrapped_segments(segments: np.ndarray, period: float) -> np.ndarray:
    """Segments [n x 2 x 2] of a wall over one period, each put into [0, period) by its first point, with copies of
    those that stand out. A segment that was closed across the period is made short first."""
    result = segments.copy()
    jump = result[:, 1, 0] - result[:, 0, 0]
    result[:, 1, 0] -= np.round(jump / period) * period
    result[:, :, 0] -= (np.floor(result[:, :, 0].min(axis=1) / period) * period)[:, None]
    out = result[result[:, :, 0].max(axis=1) > period]
    return np.concatenate([result, out - np.array([period, 0.0])])
