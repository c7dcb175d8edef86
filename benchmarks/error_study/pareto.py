"""Fronts of cost and error, and cost at equal error."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TypeVar

Point = TypeVar("Point")


def front(points: Sequence[Point], cost: Callable[[Point], float], error: Callable[[Point], float]) -> list[Point]:
    """Those that no other one beats in both, by growing cost. Of equals the first."""
    best: list[Point] = []
    for point in sorted(points, key=lambda p: (cost(p), error(p))):
        if not best or error(point) < error(best[-1]):
            best.append(point)
    return best


def cost_at(error: float, curve: Sequence[tuple[float, float]]) -> float | None:
    """Least cost at which a curve of (cost, error) points reaches an error, between points by logarithms: None when it
    does not, and the cheapest point, so too much, when that already does."""
    points = front(curve, cost=lambda p: p[0], error=lambda p: p[1])
    if points and points[0][1] <= error:
        return points[0][0]
    for (c0, e0), (c1, e1) in zip(points, points[1:]):
        if e1 <= error:
            return c0 * (c1 / c0) ** (math.log(e0 / error) / math.log(e0 / e1))
    return None
