"""Scatter of a chain about its orders: /usr/bin/python3 verify/two_bars/chain.py.

This is half of the problem of two bars in one dimension. A chain of masses rho h, half of that at its ends, and springs
E/h meets its mirror image at the speed v, with a penalty of 8 E/h, by velocity Verlet. The script prints, over spacings
from 1/8 to 1/64, the orders of the velocity that is not exchanged and of the largest error of the mean stress. It also
prints the standard deviation of their logarithms about a straight line. It shares nothing with either solver.
"""

from __future__ import annotations

import numpy as np

LENGTH, YOUNG, SPEED, END = 4.0, 2.0, 1e-3, 8.0
WAVE = np.sqrt(YOUNG)
STRESS = WAVE * SPEED / 2
SPACINGS = [1 / n for n in (8, 10, 12, 14, 16, 20, 24, 28, 32, 40, 48, 64)]


def inverse_mass(h: float, nodes: int, corrected: bool) -> np.ndarray:
    """[nodes x nodes] lumped, or corrected 2 D^-1 - D^-1 M D^-1."""
    lumped = np.full(nodes, h)
    lumped[[0, -1]] /= 2
    consistent = np.diag(4 * lumped) + h * (np.eye(nodes, k=1) + np.eye(nodes, k=-1))
    return 2 * np.diag(1 / lumped) - consistent / 6 / np.outer(lumped, lumped) if corrected else np.diag(1 / lumped)


def forces(x: np.ndarray, h: float) -> np.ndarray:
    stretch = YOUNG / h * np.diff(x)
    force = np.append(stretch, 0) - np.insert(stretch, 0, 0)
    force[0] += 8 * YOUNG / h * max(-2 * x[0], 0)  # the gap to the mirror image is twice the displacement
    return force


def chain(h: float, corrected: bool) -> tuple[float, float]:
    """Share of the velocity not exchanged, and largest error of the mean stress over rho c v/2 during contact."""
    x = np.zeros(round(LENGTH / h) + 1)
    inverse = inverse_mass(h, len(x), corrected)
    momentum = np.linalg.solve(inverse, np.full(len(x), -SPEED / 2))
    count = int(np.ceil(END / (0.05 * h / WAVE)))
    dt, error, force = END / count, 0.0, forces(x, h)
    for i in range(count):
        momentum += 0.5 * dt * force
        x += dt * (inverse @ momentum)
        force = forces(x, h)
        momentum += 0.5 * dt * force
        way = (i + 1) * dt * WAVE / LENGTH
        if way < 2:
            error = max(error, abs(YOUNG * (x[-1] - x[0]) / LENGTH / STRESS + min(way, 2 - way)))
    return 1 - momentum.sum() / LENGTH / (SPEED / 2), error


if __name__ == "__main__":
    for corrected in (False, True):
        values = np.log([chain(h, corrected) for h in SPACINGS])
        for name, column in zip(("velocity not exchanged", "mean stress"), values.T):
            order, start = np.polyfit(np.log(SPACINGS), column, 1)
            scatter = np.std(column - order * np.log(SPACINGS) - start, ddof=2)
            print(f"{'corrected' if corrected else 'lumped'}, {name}: order {order:.2f}, scatter {scatter:.3f}")
