#!/usr/bin/python3
"""The converged solution of impact.toml by finite elements (dolfinx), as oracles/README.md tells.

    /usr/bin/python3 benchmarks/error_study/make_impact_oracle.py
"""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "verify"), str(ROOT / "scripts"), str(ROOT / "python")]

import numpy as np

from fem.impact import velocities

SPEED, START = 0.2, 1.002  # of shear waves; height of the centre over the wall
PERIOD, SAMPLES = 0.1, 45
SOFT, STIFF = 4e3, 16e3  # penalties, mu / R
COARSE, FINE = 9, 12  # rings of elements


def main() -> None:
    coarse, soft, stiff = (velocities(rings, penalty, SPEED, START, PERIOD, SAMPLES)
                           for rings, penalty in ((COARSE, STIFF), (FINE, SOFT), (FINE, STIFF)))
    rigid = stiff + (stiff - soft) * SOFT / (STIFF - SOFT)  # errors go with 1 / penalty
    for what, other in (("coarser mesh", coarse), ("stiffer penalty", stiff), ("softer penalty", soft)):
        print(f"{what}: {np.sqrt(np.mean((other - rigid) ** 2)) / SPEED:.2e} of the speed, rms")
    rows = np.column_stack([PERIOD * np.arange(SAMPLES + 1), rigid])
    np.savetxt(Path(__file__).with_name("oracles") / "impact.csv", rows, delimiter=",", header="time,velocity",
               comments="", fmt="%.9g")


if __name__ == "__main__":
    main()
