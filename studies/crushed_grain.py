"""Force on a breakable grain between plates, its strength, and the Weibull distribution of strengths.

The strength is the peak force over the diameter (Jaeger 1967). The peak is the largest force before the grain splits.
Its distribution is fitted by maximum likelihood. The interval of the modulus is exact: the ratio of the fitted to the
true modulus has a distribution of its own, which samples of a Weibull distribution give (Thoman, Bain and Antle 1969,
Technometrics 11, 445). Points have median ranks.
"""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from pliant import Run

DIAMETER = 0.01  # m
GAPS = 4e-5  # m, of both plates at the start
SPLIT = 0.75  # share of the mass that the largest fragment then falls below: chips are less
LATER = 1.05  # approach over that at the peak from which a force is one of fragments
SAMPLES = 4000  # for the interval


def loading(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """Approach of the plates since both could touch, over the diameter, and force on the floor over the diameter."""
    return (-run.values("approach.displacement_y") - GAPS) / DIAMETER, -run.values("floor.force_y") / DIAMETER


def peak_of(run: Run) -> int:
    """Its sample."""
    mass = run.values("fragments.largest_mass")
    split = np.flatnonzero(mass < SPLIT * mass[0])
    return int(loading(run)[1][:split[0] + 1 if len(split) else None].argmax())


def force(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """Both over their values at the peak."""
    (near, over), peak = loading(run), peak_of(run)
    shown = (near >= 0) & (near <= 1.5 * near[peak])
    return near[shown] / near[peak], over[shown] / over[peak]


def strength(run: Run) -> float:
    return float(loading(run)[1][peak_of(run)])


def approach(run: Run) -> float:
    """At the peak, over the diameter."""
    return float(loading(run)[0][peak_of(run)])


def rest(run: Run) -> float:
    """Largest force after the peak, over the peak."""
    near, over = force(run)
    return float(over[near > LATER].max())


def largest(run: Run) -> float:
    """Share of the largest fragment at the end."""
    mass = run.values("fragments.largest_mass")
    return float(mass[-1] / mass[0])


def fit(samples: np.ndarray) -> np.ndarray:
    """Moduli of maximum likelihood of the samples in the rows, by bisection."""
    logarithms = np.log(samples) - np.log(samples).mean(axis=-1, keepdims=True)
    low, high = np.full(samples.shape[:-1], 1e-2), np.full(samples.shape[:-1], 1e3)
    for _ in range(60):
        middle = np.sqrt(low * high)
        weights = np.exp(middle[..., None] * (logarithms - logarithms.max(axis=-1, keepdims=True)))
        above = (weights * logarithms).sum(axis=-1) / weights.sum(axis=-1) - 1 / middle > 0
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    return np.sqrt(low * high)


def interval(modulus: float, count: int) -> tuple[float, float]:
    """That holds the true modulus with a probability of 95 %."""
    ratio = fit(np.random.default_rng(1).weibull(1, (SAMPLES, count)))
    return tuple(modulus / np.quantile(ratio, [0.975, 0.025]))


def draw(axes: Axes, means: list[dict]) -> None:
    """A line in the axes of Weibull for each set of runs."""
    for mean, colour, marker in zip(means, ("#0072b2", "#d55e00"), "os"):
        found = np.sort(mean["outputs"]["strength"]["values"])
        count = len(found)
        if count < 3 or found[0] == found[-1]:
            continue
        modulus = float(fit(found))
        scale = float((found**modulus).mean()**(1 / modulus))
        low, high = interval(modulus, count)
        ranks = (np.arange(1, count + 1) - 0.3) / (count + 0.4)
        bonds = mean["inputs"]["modulus of bonds"]
        name = "equal bonds" if bonds > 1000 else f"bonds of modulus {bonds:g}"
        axes.plot(found / 1e6, -np.log(1 - ranks), marker, markersize=4, color=colour)
        axes.plot(found[[0, -1]] / 1e6, (found[[0, -1]] / scale)**modulus, color=colour, linewidth=1.2,
                  label=f"{name}: {modulus:.1f} ({low:.1f} to {high:.1f})")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.xaxis.set_major_formatter("{x:g}")
    axes.xaxis.set_minor_formatter("{x:g}")
    axes.set_xlabel("crushing strength [MPa]")
    axes.set_ylabel("-ln(share of grains that survive)")
    axes.legend(fontsize=8, frameon=False, title="Weibull modulus, 95 % interval", title_fontsize=8)
    axes.grid(True, alpha=0.25)
