"""A face pressed against a rigid flat through springs: penalty contact on an elastic half-plane.

Under a load P, x^2/(2 R) + u(x) + p(x)/k is constant over the contact. The half-plane's u is -2/(pi E') times the
integral of ln|x - s| p(s), less the finite block's ACROSS P x^2. Without springs this is Hertz's problem; the solution
is numerical for any k.
"""

from __future__ import annotations

import numpy as np

from curved_block import ACROSS, RADIUS, STIFF

REACH = 1.25  # extent of the elements over the half width


def half_width(load: float) -> float:
    """Hertz's half width, on the finite block."""
    return float(np.sqrt(4 * load * RADIUS / (np.pi * STIFF) / (1 - 2 * RADIUS * ACROSS * load)))


def pressure_on_springs(load: float, stiffness: float, elements: int) -> tuple[np.ndarray, np.ndarray]:
    """[elements] positions and pressures, constant in each element. There is no contact where it would be tensile."""
    width = 2 * REACH * half_width(load) / elements
    x = width * (np.arange(elements) + 0.5 - elements / 2)
    give, touching = _compliance(x, width, stiffness), np.abs(x) < half_width(load)
    for _ in range(100):
        pressure, approach = _pressed(give, x, width, load, touching)
        overlap = approach - x**2 / (2 * RADIUS) - give @ pressure
        after = np.where(touching, pressure > 0, overlap > 0)
        if (after == touching).all():
            return x, pressure
        touching = after
    raise RuntimeError("the contact area is not found")


def _compliance(x: np.ndarray, width: float, stiffness: float) -> np.ndarray:
    """[elements x elements] displacement of the face in one element per pressure in another."""
    def integral(t: np.ndarray) -> np.ndarray:
        return t * np.log(np.abs(t)) - t  # element ends never coincide with a midpoint

    apart = x[:, None] - x
    half_plane = -2 / (np.pi * STIFF) * (integral(apart + width / 2) - integral(apart - width / 2))
    return half_plane - ACROSS * width * x[:, None] ** 2 + np.eye(len(x)) / stiffness


def _pressed(give: np.ndarray, x: np.ndarray, width: float, load: float,
             touching: np.ndarray) -> tuple[np.ndarray, float]:
    """Pressures and approach for a given contact area and load."""
    there = np.flatnonzero(touching)
    matrix = np.block([[give[np.ix_(there, there)], -np.ones((len(there), 1))],
                       [np.full((1, len(there)), width), np.zeros((1, 1))]])
    solved = np.linalg.solve(matrix, np.append(-x[there] ** 2 / (2 * RADIUS), load))
    pressure = np.zeros(len(x))
    pressure[there] = solved[:-1]
    return pressure, float(solved[-1])
