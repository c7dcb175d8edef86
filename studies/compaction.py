"""Quantities of the compaction studies: pressure and coordination over solid fraction, and published forms of them.

Cardenas-Barrantes et al. (2020, Phys. Rev. E 102, 032904; 2021, arXiv 2012.10399): the coordination grows as the square
root of the solid fraction above jamming, and the bulk modulus diverges where the solid fraction has its largest value.
Here Z = Z_0 + a sqrt(phi - phi_0) and p = -b ln((phi_m - phi)/(phi_m - phi_J)), with fitted constants.
"""

from __future__ import annotations

import numpy as np

from pliant import Run

YOUNG = 200e3  # Pa, of the scene
BEARING = 1e-3  # pressure p over Young's modulus above which d sqrt(rho/p) times the strain rate of a side is below 0.007
DENSEST = 0.98  # solid fraction up to which the forms are fitted


def pressure(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """Solid fraction, and pressure over Young's modulus, from where it stays above BEARING."""
    fraction, over_young = run.values("packing.solid_fraction"), run.values("cell.pressure") / YOUNG
    first = int(np.flatnonzero(over_young < BEARING)[-1]) + 1
    return fraction[first:], over_young[first:]


def coordination(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """Solid fraction, and contacts of a disc that has at least two, from jamming on."""
    fraction, _ = pressure(run)
    return fraction, run.values("coordination.coordination_without_rattlers")[-len(fraction):]


def at(run: Run, fraction: float) -> float:
    """NaN: the run does not reach it."""
    return float(np.interp(fraction, *pressure(run), right=np.nan))


def pressure_at_90(run: Run) -> float:
    return at(run, 0.90)


def pressure_at_95(run: Run) -> float:
    return at(run, 0.95)


def pressure_at_98(run: Run) -> float:
    return at(run, 0.98)


def fit_logarithm(fraction: np.ndarray, over_young: np.ndarray) -> tuple[float, float, float]:
    """phi_J, phi_m and b/E: for each phi_m, in steps of 1e-4, the others follow from linear least squares."""
    inside = fraction <= DENSEST
    phi, p = fraction[inside], over_young[inside]
    best = (np.inf, 0.0, 0.0, 0.0)
    for densest in np.arange(phi.max() + 1e-3, 1.2, 1e-4):
        basis = np.stack([np.ones_like(phi), -np.log(densest - phi)], axis=1)
        (level, factor), *_ = np.linalg.lstsq(basis, p, rcond=None)
        square = float(((basis @ [level, factor] - p) ** 2).sum())
        best = min(best, (square, densest - np.exp(level / factor), densest, factor))
    return float(best[1]), float(best[2]), float(best[3])


def logarithm(fraction: np.ndarray, over_young: np.ndarray) -> np.ndarray:
    jammed, densest, factor = fit_logarithm(fraction, over_young)
    inside = (fraction > jammed) & (fraction <= DENSEST)
    return np.where(inside, -factor * np.log(np.maximum(densest - fraction, 1e-9) / (densest - jammed)), np.nan)


def fit_root(fraction: np.ndarray, contacts: np.ndarray) -> tuple[float, float]:
    """Z_0 and a by linear least squares; phi_0 is the first solid fraction."""
    inside = fraction <= DENSEST
    basis = np.stack([np.ones(inside.sum()), np.sqrt(fraction[inside] - fraction[0])], axis=1)
    (least, factor), *_ = np.linalg.lstsq(basis, contacts[inside], rcond=None)
    return float(least), float(factor)


def root(fraction: np.ndarray, contacts: np.ndarray) -> np.ndarray:
    least, factor = fit_root(fraction, contacts)
    return np.where(fraction <= DENSEST, least + factor * np.sqrt(fraction - fraction[0]), np.nan)


def jammed_at(run: Run) -> float:
    return fit_logarithm(*pressure(run))[0]


def densest(run: Run) -> float:
    return fit_logarithm(*pressure(run))[1]


def factor(run: Run) -> float:
    return fit_logarithm(*pressure(run))[2]


def least_contacts(run: Run) -> float:
    return fit_root(*coordination(run))[0]


def overlap(run: Run) -> float:
    """Estimate at the end: energy of contacts over pressure, as a share of the discs' area. Of a penalty kn and a uniform
    pressure p on contacts of length L the energy is p^2 L/(2 kn) and the area of overlaps p L/kn."""
    area = run.values("packing.solid_fraction") * run.values("gradient.cell_area")
    return float(2 * run.values("energy.contact")[-1] / run.values("cell.pressure")[-1] / area[-1])
