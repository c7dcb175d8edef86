"""Order of a packing of equal discs in a period: who neighbours whom, how hexagonal it is, how mixed are its kinds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

NEIGHBOUR = 1.3  # diameters between centres: between the hexagonal packing's first neighbours, 1, and second, 1.73


@dataclass
class Neighbours:
    """Both directions of every pair."""

    first: np.ndarray  # [2 pairs]
    second: np.ndarray  # [2 pairs]
    branch: np.ndarray  # [2 pairs x 2] from the first's centre to the second's nearest image, m
    grains: int

    def counts(self) -> np.ndarray:
        return np.bincount(self.first, minlength=self.grains)


def neighbours(centres: np.ndarray, period: float, diameter: float) -> Neighbours:
    """Of centres [grains x 2], m, periodic in x."""
    branch = centres[None, :] - centres[:, None]
    branch[:, :, 0] -= period * np.round(branch[:, :, 0] / period)
    near = np.linalg.norm(branch, axis=2) < NEIGHBOUR * diameter
    np.fill_diagonal(near, False)
    first, second = np.nonzero(near)
    return Neighbours(first, second, branch[first, second], len(centres))


def bond_order(of: Neighbours) -> np.ndarray:
    """[grains] |psi6| = |mean over neighbours of exp(6 i angle)|, Nelson and Halperin 1979; NaN with fewer than three,
    whose few bonds say nothing of the order."""
    turned = np.exp(6j * np.arctan2(of.branch[:, 1], of.branch[:, 0]))
    sums = np.bincount(of.first, turned.real, of.grains) + 1j * np.bincount(of.first, turned.imag, of.grains)
    counts = of.counts()
    return np.where(counts >= 3, np.abs(sums) / np.maximum(counts, 1), np.nan)


def like_fraction(of: Neighbours, kind: np.ndarray) -> float:
    """Share of the pairs whose grains are of one kind [grains]."""
    return float((kind[of.first] == kind[of.second]).mean())


def like_fraction_at_random(of: Neighbours, kind: np.ndarray, draws: int = 1000, seed: int = 1) -> tuple[float, float]:
    """Mean, in closed form, and standard deviation, drawn, of the share if kinds were dealt out anew."""
    grains, same = len(kind), np.bincount(kind)
    mean = float((same * (same - 1)).sum() / (grains * (grains - 1)))
    generator = np.random.default_rng(seed)
    shares = [like_fraction(of, generator.permutation(kind)) for _ in range(draws)]
    return mean, float(np.sqrt(np.mean((np.array(shares) - mean) ** 2)))


def kept_fraction(before: Neighbours, after: Neighbours) -> float:
    """Share of the pairs of neighbours that are neighbours still."""
    codes = [of.first * of.grains + of.second for of in (before, after)]
    return float(np.isin(codes[0], codes[1]).mean())
