"""Friction and fragments of a third body with breakable grains, over the distance of shear."""

from __future__ import annotations

import numpy as np

from pliant import Run

SHEARED = 0.5e-6  # s
DIAMETER = 1e-6  # m
BREAKABLE, SOFT = 30, 30  # grains
SMOOTHED = 20  # samples of 5 ns, a shear distance of a diameter
LATE = 5  # diameters of shear distance from which the mean is taken


def smooth(values: np.ndarray) -> np.ndarray:
    return np.convolve(values, np.ones(SMOOTHED) / SMOOTHED, "valid")


def sheared(run: Run) -> np.ndarray:
    return run.probes.time > SHEARED


def distance(run: Run) -> np.ndarray:
    return smooth(run.values("upper.displacement_x")[sheared(run)]) / DIAMETER


def friction(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """Shear over normal force on the lower wall, each a mean over SMOOTHED samples."""
    along, across = (smooth(run.values(f"lower.force_{axis}")[sheared(run)]) for axis in "xy")
    return distance(run), along / np.abs(across)


def per_grain(run: Run) -> np.ndarray:
    return (run.values("fragments.fragments") - SOFT) / BREAKABLE


def fragments(run: Run) -> tuple[np.ndarray, np.ndarray]:
    return distance(run), smooth(per_grain(run)[sheared(run)])


def peak(run: Run) -> float:
    return float(friction(run)[1].max())


def late(run: Run) -> float:
    """Mean friction factor from LATE on."""
    far, factor = friction(run)
    return float(factor[far > LATE].mean())


def pressed(run: Run) -> float:
    """Fragments per rigid grain before shear."""
    return float(per_grain(run)[~sheared(run)][-1])


def broken(run: Run) -> float:
    """Fragments per rigid grain at the end."""
    return float(per_grain(run)[-1])


def thickness(run: Run) -> float:
    """Change of the layer's thickness during shear, over the diameter of grains."""
    height = run.values("upper.displacement_y")
    return float((height[-1] - height[~sheared(run)][-1]) / DIAMETER)


def bonds_share(run: Run) -> float:
    """Share of the work during shear that bonds took."""
    work, taken = (run.values(f"works.{name}") for name in ("work_of_loads", "dissipated_by_bonds"))
    before = ~sheared(run)
    return float((taken[-1] - taken[before][-1]) / (work[-1] - work[before][-1]))
