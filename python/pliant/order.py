"""Order of a packing: who neighbours whom, how hexagonal it is, how mixed are its kinds.

    frames, grains = run.frames, run.frames.bodies("grain")
    of = neighbours(frames.centres(10)[grains], 1.3e-6, frames.periods(10))
    np.nanmean(bond_order(of)), clusters(of, frames.kinds[grains] == COMPLIANT)
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree


@dataclass
class Neighbours:
    """Both directions of every pair."""

    first: np.ndarray  # [2 pairs]
    second: np.ndarray  # [2 pairs]
    branch: np.ndarray  # [2 pairs x 2] from the first's centre to the second's nearest image, m
    grains: int

    def counts(self) -> np.ndarray:
        return np.bincount(self.first, minlength=self.grains)


def neighbours(centres: np.ndarray, distance: float, periods: float | np.ndarray | None = None) -> Neighbours:
    """Of centres [grains x 2], m, nearer to each other than a distance, m. `periods`: the length of one along x, m, or
    vectors [0 to 2 x 2] as Frames.periods gives; the distance must be less than half the shortest period."""
    vectors = _vectors(periods)
    shortest = np.linalg.norm(vectors, axis=1).min(initial=np.inf)
    if not distance < shortest / 2:
        raise ValueError(f"a distance of {distance:g} m in a period of {shortest:g} m; allowed: less than half of it")
    places = centres @ np.linalg.pinv(vectors)
    placed = centres - np.floor(places) @ vectors
    images = np.array(list(product((-1, 0, 1), repeat=len(vectors))), dtype=float) @ vectors
    near = cKDTree(placed).query_ball_point((placed[:, None] + images).reshape(-1, 2), distance)
    seen = np.repeat(np.arange(len(near)), [len(found) for found in near])
    first, second = np.concatenate([*near, []]).astype(int), seen // len(images)
    branch = placed[second] + images[seen % len(images)] - placed[first]
    order = np.lexsort([second, first])
    order = order[(first != second)[order]]
    return Neighbours(first[order], second[order], branch[order], len(centres))


def _vectors(periods: float | np.ndarray | None) -> np.ndarray:
    """[0 to 2 x 2] m; two are the shortest of their lattice (Gauss's reduction)."""
    if periods is None:
        return np.empty((0, 2))
    vectors = np.array([[periods, 0.0]]) if np.isscalar(periods) else np.array(periods, dtype=float)
    if len(vectors) < 2:
        return vectors
    a, b = sorted(vectors, key=np.linalg.norm)
    while (turns := np.round(a @ b / (a @ a))) != 0:
        a, b = sorted((a, b - turns * a), key=np.linalg.norm)
    return np.array([a, b])


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


def clusters(of: Neighbours, chosen: np.ndarray) -> np.ndarray:
    """Sizes of the clusters that the chosen grains [grains] form with their neighbours among them, largest first."""
    joined = chosen[of.first] & chosen[of.second]
    links = coo_array((np.ones(joined.sum()), (of.first[joined], of.second[joined])), shape=(of.grains, of.grains))
    _, number = connected_components(links, directed=False)
    sizes = np.bincount(number[chosen])
    return np.sort(sizes[sizes > 0])[::-1]
