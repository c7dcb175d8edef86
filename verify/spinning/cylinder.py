"""A solid cylinder in steady spin and plane strain: linear, and neo-Hookean at finite strain.

Units mu = R = rho = 1, lambda = 4. R is the initial radial coordinate, r(R) the current one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import OdeSolution, solve_ivp
from scipy.optimize import brentq

MU, LAME = 1.0, 4.0
AXIS = 1e-6  # first coordinate, instead of the axis itself
TOLERANCE = 1e-12  # relative, per step


def linear_strains(spin: float, R: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """u' and u/R of u = c (k R - R^3), c = spin^2 / 8 (lambda + 2 mu), k = (2 lambda + 3 mu) / (lambda + mu).

    It solves u'' + u'/R - u/R^2 = - spin^2 R / (lambda + 2 mu) without stress at R = 1.
    """
    c, k = spin**2 / 8 / (LAME + 2 * MU), (2 * LAME + 3 * MU) / (LAME + MU)
    return c * (k - 3 * R**2), c * (k - R**2)


def stresses(s: np.ndarray, h: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """First Piola stresses P_R and P_Theta at the stretches s = r' and h = r/R."""
    log_J = np.log(s * h)
    return MU * (s - 1 / s) + LAME * log_J / s, MU * (h - 1 / h) + LAME * log_J / h


def energy_density(s: np.ndarray, h: np.ndarray) -> np.ndarray:
    log_J = np.log(s * h)
    return MU / 2 * (s**2 + h**2 - 2 - 2 * log_J) + LAME / 2 * log_J**2


@dataclass
class Cylinder:
    """A neo-Hookean cylinder at a spin in rad/s."""

    spin: float
    solution: OdeSolution  # r and r' over R

    def stretches(self, R: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """r' and r/R."""
        r, s = self.solution(R)
        return s, r / R

    @property
    def rim(self) -> float:
        """Radius of the rim over that at rest."""
        return float(self.solution(1.0)[0])

    @property
    def inertia(self) -> float:
        return self._integral(lambda R, s, h: (h * R) ** 2)

    @property
    def strain_energy(self) -> float:
        return self._integral(lambda R, s, h: energy_density(s, h))

    def _integral(self, density: Callable[..., np.ndarray]) -> float:
        """Integral over the initial area by Gauss's rule, for smooth densities."""
        at, weights = np.polynomial.legendre.leggauss(40)
        R = (at + 1) / 2
        return float(weights @ (np.pi * R * density(R, *self.stretches(R))))


def _derivatives(spin: float, R: float, y: np.ndarray) -> list[float]:
    """Derivatives of r and s = r', from dP_R/dR + (P_R - P_Theta)/R + spin^2 r = 0."""
    r, s = y
    h = r / R
    log_J, (across, around) = np.log(s * h), stresses(s, h)
    by_s = MU * (1 + 1 / s**2) + LAME * (1 - log_J) / s**2
    by_h = LAME / (s * h)
    return [s, -(spin**2 * r + (across - around) / R + by_h * (s - h) / R) / by_s]


def _from_axis(spin: float, stretch: float) -> OdeSolution:
    """Solution with that stretch on the axis, which determines the stress at the rim."""
    return solve_ivp(lambda R, y: _derivatives(spin, R, y), (AXIS, 1), [stretch * AXIS, stretch], method="DOP853",
                     rtol=TOLERANCE, atol=1e-15, dense_output=True).sol


def spinning_at(spin: float) -> Cylinder:
    """Cylinder without stress at the rim; the stretch on the axis is sought up to three times the linear strain."""
    def at_rim(stretch: float) -> float:
        r, s = _from_axis(spin, stretch)(1.0)
        return float(stresses(s, r)[0])

    linear = linear_strains(spin, np.zeros(1))[0][0]
    stretch = brentq(at_rim, 1, 1 + 3 * linear, xtol=1e-15, rtol=1e-14)
    return Cylinder(spin, _from_axis(spin, stretch))


def spun_up_to(spin: float) -> Cylinder:
    """Cylinder with the angular momentum of a round one at that spin, pi/2 x spin."""
    def excess(slower: float) -> float:
        return slower * spinning_at(slower).inertia - np.pi / 2 * spin

    return spinning_at(brentq(excess, 0.8 * spin, spin, xtol=1e-13))
