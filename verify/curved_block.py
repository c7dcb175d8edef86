"""A block of 2 x 1 whose upper side is an arc: cylinders in contact, for the cases cattaneo_mindlin and hertz.

Units mu = density = 1, lambda = 4.
"""

from __future__ import annotations

import numpy as np

RADIUS = 50.0  # of the arc
YOUNG, POISSON = 2.8, 0.4
STIFF = YOUNG / (1 - POISSON**2)  # plane strain
NODES = {50: 450, 70: 850, 100: 1500, 140: 2900, 200: 5200}  # by segments of the arc
# Curvature of the finite block's face per load: cattaneo_mindlin/block_curvature.py, own runs of dolfinx 0.5.2,
# biquadratic squares, error 0.001.
ACROSS = -0.170  # 1/(Pa m2)


def block(segments: int) -> list[list[float]]:
    """Corners: the upper side is an arc (to the fourth order of 1/50)."""
    x = np.linspace(1, -1, segments + 1)
    return [[-1.0, -0.5], [1.0, -0.5], *np.stack([x, 0.5 - x**2 / (2 * RADIUS)], axis=1).tolist()]


def top_above_centroid(points: list[list[float]]) -> float:
    """Distance from the centroid to the top of a polygon whose top is at y = 0.5."""
    (x, y), (u, v) = np.transpose(points), np.roll(points, -1, axis=0).T
    cross = x * v - y * u
    return float(0.5 - ((y + v) * cross).sum() / (3 * cross.sum()))


def levels(heights: list[float], rest: float, rise: float) -> list[list[float]]:
    """Smooth rises from each level to the next, one per state of rest. [[time, height], ...]."""
    share = np.linspace(0, 1, 13)
    table, before = [[0.0, 0.0]], 0.0
    for i, level in enumerate(heights):
        shape = share**2 * (3 - 2 * share)
        table += [[float(i * rest + rise * t), float(before + (level - before) * s)] for t, s in zip(share[1:],
                                                                                                     shape[1:])]
        table += [[float((i + 1) * rest), level]] if level == before else []
        before = level
    return sorted(table)


def spread(load: float, half_width: float, x: np.ndarray) -> np.ndarray:
    """Hertz's distribution of a load, Pa."""
    return 2 * load / (np.pi * half_width**2) * np.sqrt(np.clip(half_width**2 - x**2, 0, None))
