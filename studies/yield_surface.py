"""Yield surfaces of a compact of plastic discs: stresses at which the plastic work since relief reaches given levels."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from pliant import Run

RELIEVED = 0.9  # s, when the strain path begins
YIELD = 1e3  # Pa, of the discs
LEVELS = [2e-4, 1e-3, 5e-3]  # plastic work over the yield stress and the area of the discs: their mean plastic strain


def stresses(run: Run) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Pressure and shear stress over the yield stress of the discs, and the level of plastic work; on the strain path."""
    path = run.probes.time >= RELIEVED - 1e-9
    along, across = (run.values(f"cell.stress_{axis}")[path] / YIELD for axis in ("xx", "yy"))
    work = run.values("works.dissipated_by_plasticity")[path]
    area = run.values("packing.solid_fraction")[0] * run.values("gradient.cell_area")[0]
    return -(along + across) / 2, (across - along) / 2, (work - work[0]) / (YIELD * area)


def stress_path(run: Run) -> tuple[np.ndarray, np.ndarray]:
    pressure, shear, _ = stresses(run)
    return pressure, shear


def _at(run: Run, stress: int, level: int) -> float:
    """NaN: the path does not reach the level."""
    found = stresses(run)
    return float(np.interp(LEVELS[level], found[2], found[stress], right=np.nan))


def pressure_1(run: Run) -> float:
    return _at(run, 0, 0)


def pressure_2(run: Run) -> float:
    return _at(run, 0, 1)


def pressure_3(run: Run) -> float:
    return _at(run, 0, 2)


def shear_1(run: Run) -> float:
    return _at(run, 1, 0)


def shear_2(run: Run) -> float:
    return _at(run, 1, 1)


def shear_3(run: Run) -> float:
    return _at(run, 1, 2)


def relieved(run: Run) -> float:
    """Solid fraction when the strain path begins."""
    return float(np.interp(RELIEVED, run.probes.time, run.values("packing.solid_fraction")))


def draw(axes: Axes, means: list[dict]) -> None:
    """A curve through the strain paths for each level of plastic work."""
    for number, level in enumerate(LEVELS, 1):
        found = [mean["outputs"] for mean in means if {f"pressure_{number}", f"shear_{number}"} <= set(mean["outputs"])]
        points = {name: np.array([(of[f"{name}_{number}"]["value"], of[f"{name}_{number}"]["error"] or 0) for of in found]).T
                  for name in ("pressure", "shear")}
        axes.errorbar(points["pressure"][0], points["shear"][0], xerr=points["pressure"][1], yerr=points["shear"][1],
                      fmt="o-", markersize=4, linewidth=1.2, capsize=2, label=f"mean plastic strain {level:g}")
    axes.set_xlabel("pressure over the yield stress of the discs")
    axes.set_ylabel("shear stress over the yield stress of the discs")
    axes.set_xlim(left=0)
    axes.axhline(0, color="#7f7f7f", linewidth=0.8)
    axes.legend(fontsize=8, frameon=False)
    axes.grid(True, alpha=0.25)
