"""One quantity over time, of however many rows."""

import numpy as np
from matplotlib.axes import Axes

# More rows than this are drawn as a band from least to largest with the mean in it.
DENSE = 1500
_BINS = 500


def _binned(time: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, ...]:
    """Centres of equal bins of time, and least, mean, largest value of those that have any."""
    edges = np.linspace(time[0], time[-1], _BINS + 1)
    index = np.clip(np.searchsorted(edges, time, side="right") - 1, 0, _BINS - 1)
    count = np.bincount(index, minlength=_BINS)
    least, largest = np.full(_BINS, np.inf), np.full(_BINS, -np.inf)
    np.minimum.at(least, index, values)
    np.maximum.at(largest, index, values)
    filled = count > 0
    mean = np.bincount(index, values, minlength=_BINS)[filled] / count[filled]
    return (0.5 * (edges[1:] + edges[:-1])[filled], least[filled], mean, largest[filled])


def draw_history(
    axes: Axes, time: np.ndarray, values: np.ndarray, colour: str, name: str | None = None, style: str = "-"
) -> None:
    """Values that are NaN leave a gap."""
    if len(time) <= DENSE:
        axes.plot(time, values, style, color=colour, linewidth=1.1, label=name)
        return
    there = np.isfinite(values)
    centre, least, mean, largest = _binned(time[there], values[there])
    axes.fill_between(centre, least, largest, color=colour, alpha=0.25, linewidth=0)
    axes.plot(centre, mean, style, color=colour, linewidth=1.1, label=name)
