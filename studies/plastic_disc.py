"""Force on a plastic disc between plates, over their approach."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from pliant import Run

GAP = 0.002  # at the start, of a circle
CALCULIX = Path(__file__).resolve().parents[1] / "verify/plasticity/oracles/disc_calculix.csv"


def force(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """Approach over the diameter, and mean force of both plates over yield stress and diameter."""
    both = np.abs(run.values("floor.force_y")) + np.abs(run.values("lid.force_y"))
    return -run.values("approach.displacement_y") - GAP, both / 2


def calculix(approach: np.ndarray, _: np.ndarray) -> np.ndarray:
    """Its force at these approaches, by CalculiX."""
    with CALCULIX.open() as stream:
        rows = list(csv.DictReader(line for line in stream if not line.startswith("#")))
    table = [np.array([float(row[name]) for row in rows]) for name in ("approach", "force")]
    return np.interp(approach, *table, left=np.nan, right=np.nan)


def difference(run: Run) -> float:
    """Of the force from CalculiX's, rms over the second half of the approach, over its mean there."""
    approach, found = force(run)
    expected = calculix(approach, found)
    late = approach >= 0.5 * approach[-1]
    return float(np.sqrt(np.nanmean((found - expected)[late] ** 2)) / np.nanmean(expected[late]))


def last(run: Run) -> float:
    return float(force(run)[1][-1])
