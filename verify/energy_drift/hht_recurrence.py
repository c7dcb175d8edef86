"""Small motions under HHT: its recurrence, mode by mode, on matrices of `pliant modes`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.io import mmread
from scipy.linalg import eigh


def modes_of(folder: Path, velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """w^2 and the modal components of a velocity [2 nodes]; modes have the mass 1."""
    stiffness = mmread(folder / "disc_stiffness.mtx").toarray()
    mass = np.kron(np.diag(1 / mmread(folder / "disc_inverse_mass.mtx").diagonal()), np.eye(2))
    squares, modes = eigh(stiffness, mass)
    return squares, modes.T @ mass @ velocity


def energies(squares: np.ndarray, speeds: np.ndarray, alpha: float, dt: float, steps: int) -> np.ndarray:
    """[steps + 1] energies of all modes together, from zero displacement: a + (1 + alpha) w^2 u - alpha w^2 u_before
    = 0 with Newmark's beta = (1 - alpha)^2 / 4 and gamma = 1/2 - alpha (Hilber, Hughes and Taylor 1977)."""
    beta, gamma = (1 - alpha)**2 / 4, 0.5 - alpha
    u, v, a = np.zeros_like(speeds), speeds.copy(), np.zeros_like(speeds)
    found = [0.5 * (v**2).sum()]
    for _ in range(steps):
        known = u + dt * v + dt**2 * (0.5 - beta) * a
        new = (alpha * u - (1 + alpha) * known) * squares / (1 + (1 + alpha) * beta * dt**2 * squares)
        u, v, a = known + beta * dt**2 * new, v + dt * ((1 - gamma) * a + gamma * new), new
        found.append(0.5 * (v**2 + squares * u**2).sum())
    return np.array(found)
