"""Quantities of the third-body studies: friction on the lower wall, and order."""

from __future__ import annotations

import numpy as np

from pliant import Run
from pliant.order import kept_fraction, like_fraction, neighbours

SHEARED = 1e-6  # s
SMOOTHED = 10  # samples of 5 ns, as the paper's curves are smooth
NEIGHBOUR = 1.3e-6  # m between centres, of discs of 1 um


def _friction(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """Times, s, and friction factors during shear, positive in the direction of the upper wall; means of 50 ns."""
    column = {axis: run.probes.column(f"force_lower.force_{axis}") for axis in "xy"}
    times, along = run.probes.sampled(column["x"])
    _, across = run.probes.sampled(column["y"])
    sheared = times > SHEARED
    weights = np.ones(SMOOTHED) / SMOOTHED
    return np.convolve(times[sheared], weights, "valid"), np.convolve((-along / across)[sheared], weights, "valid")


def peak(run: Run) -> float:
    return float(_friction(run)[1].max())


def peak_time(run: Run) -> float:
    """us"""
    times, factors = _friction(run)
    return float(1e6 * times[factors.argmax()])


def kept(run: Run) -> float:
    """Share of the first neighbours that are still neighbours at the end."""
    grains = run.frames.bodies("grain")
    first, last = (neighbours(run.frames.centres(i)[grains], NEIGHBOUR, run.period) for i in (0, -1 + len(run.frames.times)))
    return kept_fraction(first, last)


def like(run: Run) -> float:
    """Share of neighbours of one kind at the end."""
    grains = run.frames.bodies("grain")
    last = neighbours(run.frames.centres(len(run.frames.times) - 1)[grains], NEIGHBOUR, run.period)
    return like_fraction(last, run.frames.kinds[grains])
