"""Prescribed motions of scenes, as tables over time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def speeds(places: Sequence[float], pause: float, ramp: float) -> list[list[float]]:
    """[[time, velocity], ...] triangular pulses from each of these places to the next, at the start of each pause."""
    corners = []
    for i, way in enumerate(np.diff(places).tolist()):
        start = i * pause
        corners += [[start, 0.0], [start + ramp / 2, 2 * way / ramp], [start + ramp, 0.0]]
    return corners


def smooth_rises(heights: Sequence[float], pause: float, ramp: float, points: int) -> list[list[float]]:
    """[[time, height], ...] from 0 to each height in turn, at the start of each pause."""
    share = np.linspace(0, 1, points + 1)
    table, before = [[0.0, 0.0]], 0.0
    for i, height in enumerate(heights):
        table += [[float(pause * i + ramp * s), float(before + (height - before) * s**2 * (3 - 2 * s))]
                  for s in share[1:]] if height != before else []
        table.append([float(pause * (i + 1)), height])
        before = height
    return table
