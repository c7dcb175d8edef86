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
from dolfinx.fem import Constant, assemble_scalar

from fem.compiled import compile_form
from fem.dynamics import Explicit
from fem.meshes import disc
from fem.solid import Material, Solid

SPEED, START = 0.2, 1.002  # of shear waves; height of the centre over the wall
PERIOD, SAMPLES = 0.1, 45
SOFT, STIFF = 4e3, 16e3  # penalties, mu / R
COARSE, FINE = 9, 12  # rings of elements


def velocities(rings: int, penalty: float) -> np.ndarray:
    """Of the centre of mass at all samples; quadratic triangles, half of the stable step with all nodes in touch."""
    solid = Solid(disc(rings), Material())
    height, stiffness = Constant(solid.domain, 10.0), Constant(solid.domain, penalty)
    motion = Explicit(solid, solid.strain_energy() + solid.plate_energy(height, stiffness, -1))
    steps = int(np.ceil(PERIOD * motion.largest_frequency()))
    height.value = -START
    motion.v.interpolate(lambda x: np.stack([0 * x[0], 0 * x[0] - SPEED]))
    motion.start()
    momentum = compile_form(motion.v[1] * solid.dx)
    values = [assemble_scalar(momentum)]
    for _ in range(SAMPLES):
        for _ in range(steps):
            motion.step(PERIOD / steps)
        values.append(assemble_scalar(momentum))
    return -SPEED * np.array(values) / values[0]


def main() -> None:
    coarse, soft, stiff = velocities(COARSE, STIFF), velocities(FINE, SOFT), velocities(FINE, STIFF)
    rigid = stiff + (stiff - soft) * SOFT / (STIFF - SOFT)  # errors go with 1 / penalty
    for what, other in (("coarser mesh", coarse), ("stiffer penalty", stiff), ("softer penalty", soft)):
        print(f"{what}: {np.sqrt(np.mean((other - rigid) ** 2)) / SPEED:.2e} of the speed, rms")
    rows = np.column_stack([PERIOD * np.arange(SAMPLES + 1), rigid])
    np.savetxt(Path(__file__).with_name("oracles") / "impact.csv", rows, delimiter=",", header="time,velocity",
               comments="", fmt="%.9g")


if __name__ == "__main__":
    main()
