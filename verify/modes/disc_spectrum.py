"""Exact natural frequencies of a free elastic disc in plane strain; units mu = R = rho = 1, lambda = 2 nu / (1 - 2 nu).

Displacements have potentials, u = grad phi + curl psi, with phi = A J_n(a r) cos(n t), psi = B J_n(b r) sin(n t),
a = w / c_p, b = w / c_s: u_r = phi_r + psi_t / r, u_t = phi_t / r - psi_r. On the rim r = 1 the tractions vanish:
    s_rr: A [2 a^2 J_n''(a) - lambda a^2 J_n(a)] + B 2 n [b J_n'(b) - J_n(b)] = 0,
    s_rt: A (-2 n) [a J_n'(a) - J_n(a)] + B [b J_n'(b) - n^2 J_n(b) - b^2 J_n''(b)] = 0.
Bessel's equation eliminates the second derivatives: z^2 J'' = (n^2 - z^2) J - z J'. For n = 0 the two decouple: s_rr =
0 is radial, s_rt = 0 torsion, J_2(b) = 0. Frequencies of n >= 1 are double (cos and sin), those of n = 0 single.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq
from scipy.special import jv, jvp

GRID = 4e-3  # of the search for changes of sign


@dataclass(frozen=True)
class Mode:
    """A root of the frequency equation."""

    order: int  # n, waves around the rim
    kind: str  # "mixed", "radial", "torsion"
    frequency: float  # w R / c_s

    @property
    def multiplicity(self) -> int:
        return 1 if self.order == 0 else 2


def lame_ratio(poisson: float) -> float:
    """lambda / mu."""
    return 2 * poisson / (1 - 2 * poisson)


def rim_tractions(order: int, poisson: float, w: np.ndarray) -> np.ndarray:
    """[2 x 2 x ...]: s_rr and s_rt over mu by A and B, at frequencies that may be complex."""
    ratio, n, b = lame_ratio(poisson), order, w
    a = w / np.sqrt(ratio + 2)
    j_a, zj_a, j_b, zj_b = jv(n, a), a * jvp(n, a), jv(n, b), b * jvp(n, b)
    curved_a, curved_b = (n**2 - a**2) * j_a - zj_a, (n**2 - b**2) * j_b - zj_b
    return np.array([[2 * curved_a - ratio * a**2 * j_a, 2 * n * (zj_b - j_b)],
                     [-2 * n * (zj_a - j_a), zj_b - n**2 * j_b - curved_b]])


def frequency_functions(order: int, poisson: float) -> dict[str, Callable[[np.ndarray], np.ndarray]]:
    """By kind: entire functions of w that vanish at the frequencies, and at 0."""
    def entry(i: int, j: int) -> Callable[[np.ndarray], np.ndarray]:
        return lambda w: rim_tractions(order, poisson, w)[i, j]

    def determinant(w: np.ndarray) -> np.ndarray:
        m = rim_tractions(order, poisson, w)
        return m[0, 0] * m[1, 1] - m[0, 1] * m[1, 0]

    return {"radial": entry(0, 0), "torsion": entry(1, 1)} if order == 0 else {"mixed": determinant}


def roots(function: Callable[[np.ndarray], np.ndarray], first: float, last: float) -> list[float]:
    """Sign changes of the function on a fine grid, to rounding."""
    grid = np.linspace(first, last, int(np.ceil((last - first) / GRID)) + 1)
    values = function(grid)
    change = np.flatnonzero(np.sign(values[:-1]) * np.sign(values[1:]) < 0)
    return [brentq(function, grid[i], grid[i + 1], xtol=1e-14, rtol=1e-14) for i in change]


def count_in_the_plane(function: Callable[[np.ndarray], np.ndarray], first: float, last: float, height: float = 1.0,
                       points: int = 4000) -> int:
    """Number of zeros in a rectangle about [first, last], with multiplicity: the winding number of the value along the
    boundary (argument principle)."""
    corners = [first - 1j * height, last - 1j * height, last + 1j * height, first + 1j * height, first - 1j * height]
    edge = np.concatenate([np.linspace(p, q, points) for p, q in zip(corners, corners[1:])])
    values = function(edge)
    turns = np.angle(values[1:] / values[:-1])
    if np.abs(turns).max() > 1:
        raise ValueError(f"{points} points a side are too few: the value turns by {np.abs(turns).max():.2g} a step")
    return int(round(turns.sum() / (2 * np.pi)))


def disc_modes(poisson: float, last: float, first: float = 0.3) -> list[Mode]:
    """All modes with first < w < last, in ascending order.

    Orders increase until none has a root below `last`, as the lowest root increases with the order.
    """
    found: list[Mode] = []
    order = 0
    while True:
        here = [Mode(order, kind, w) for kind,
                f in frequency_functions(order, poisson).items() for w in roots(f, first, last)]
        if order > 2 and not here:
            return sorted(found, key=lambda mode: mode.frequency)
        found += here
        order += 1


def frequencies(poisson: float, count: int) -> np.ndarray:
    """[count] lowest frequencies, multiple ones repeated."""
    last = 6.0
    while True:
        values = np.repeat(*np.array([(mode.frequency, mode.multiplicity) for mode in disc_modes(poisson,
                                                                                                 last)]).T.tolist())
        if len(values) >= count:
            return values[:count]
        last *= 1.3
