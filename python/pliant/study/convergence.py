"""Observed order, extrapolated value and grid convergence index.

Three sizes h1 < h2 < h3 and their values f1, f2, f3 (Celik et al. 2008, J. Fluids Eng. 130, 078001; Roache 1994).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

SAFETY = 1.25  # Roache's, of three and more sizes
LEAST_ORDER, LARGEST_ORDER = 0.1, 10.0  # others are scatter
ASYMPTOTIC = 0.1  # how far the ratio of two indices may be from the order's own power of the ratio of sizes


@dataclass
class Order:
    order: float | None  # None: values do not approach anything in order
    limit: float | None  # Richardson's, at size 0
    index: float | None  # of the finest: a bound of |f1 - limit|
    asymptotic: bool | None  # whether the sizes agree on the order; None: only three
    note: str

    def words(self) -> str:
        """The verdict first: an order that the sizes do not agree on tells less than how far their values differ."""
        found = (f"order {self.order:.2f}, limit {self.limit:.5g}, index {self.index:.2g}"
                 if self.order is not None else "")
        parts = (self.note, found and f"the three finest alone: {found}") if self.asymptotic is False else (found, self.note)
        return "; ".join(part for part in parts if part)


def observed_order(h: tuple[float, float, float], f: tuple[float, float, float]) -> float | None:
    """p with (f3 - f2)/(f2 - f1) = (h3^p - h2^p)/(h2^p - h1^p), sizes ascending; None: none from LEAST_ORDER to
    LARGEST_ORDER."""
    (h1, h2, h3), (f1, f2, f3) = h, f
    if f2 == f1 or (f3 - f2) / (f2 - f1) <= 0:
        return None
    wanted = (f3 - f2) / (f2 - f1)

    def excess(p: float) -> float:
        return (h3**p - h2**p) / (h2**p - h1**p) - wanted  # grows with p

    low, high = LEAST_ORDER, LARGEST_ORDER
    if excess(low) > 0 or excess(high) < 0:
        return None
    for _ in range(80):
        middle = (low + high) / 2
        low, high = (middle, high) if excess(middle) < 0 else (low, middle)
    return (low + high) / 2


def analyse(sizes: list[float], values: list[float]) -> Order:
    """Of the three finest; a fourth tells whether they are in the asymptotic range."""
    pairs = sorted(zip(sizes, values))
    if not all(math.isfinite(h) and h > 0 and math.isfinite(f) for h, f in pairs):
        return Order(None, None, None, False, "a size or a value is no number")
    if len({h for h, _ in pairs}) < len(pairs):
        return Order(None, None, None, False, "two sizes are equal")
    if len(pairs) < 3:
        return Order(None, None, None, None, "fewer than three sizes finished")
    h, f = [list(column) for column in zip(*pairs)]
    p = observed_order((h[0], h[1], h[2]), (f[0], f[1], f[2]))
    if p is None and math.isclose(f[0], f[1], rel_tol=1e-12):
        return Order(None, None, None, None, "the two finest values are equal")
    apart = f"the three finest differ by {100 * (max(f[:3]) - min(f[:3])) / max(map(abs, f[:3])):.2g} %"
    if p is None:
        return Order(None, None, None, False, f"no order: the values do not approach a limit in order; {apart}")
    ratio = (h[1] / h[0])**p
    limit = f[0] + (f[0] - f[1]) / (ratio - 1)
    index = SAFETY * abs(f[0] - f[1]) / (ratio - 1)
    if len(h) < 4:
        return Order(p, limit, index, None, "a fourth size would tell whether this is the asymptotic range")
    coarser = observed_order((h[1], h[2], h[3]), (f[1], f[2], f[3]))
    agrees = coarser is not None and math.isclose(ratio, (h[1] / h[0])**coarser, rel_tol=ASYMPTOTIC)
    of_coarser = "have no order" if coarser is None else f"say order {coarser:.2f}"
    note = "" if agrees else f"not in the asymptotic range: the three sizes after the finest {of_coarser}; {apart}"
    return Order(p, limit, index, agrees, note)
