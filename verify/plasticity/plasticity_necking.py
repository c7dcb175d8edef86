"""A bar in plane strain that necks, by GetFEM, after de Souza Neto et al.: a quarter of it.

The bar is along y; the middle of its length is y = 0, where it is 1.8 % narrower. Units: mm, GPa, MN/m.
"""

from __future__ import annotations

import sys
from time import time

import numpy as np

from plasticity_getfem import Body, quadrilaterals
from plasticity_law import Law

LENGTH, WIDTH, NARROWER = 53.334, 12.826, 0.018
ELONGATION, EVERY = 10.0, 0.25  # of the whole bar
LAW = Law.of_young(206.9, 0.29, 0.45, 0.12924, 0.715, 16.93)
DENSER = 0.4  # spacing along the bar at the neck over the mean
COLUMNS = ["elongation", "force", "half_width", "largest_a"]
# Elements across half the width; steps per output; mixed.
RUNS = [*((4, steps, 0) for steps in (1, 2, 4, 8)), *((8, steps, 0) for steps in (1, 2, 4, 8)), (16, 2, 0), (16, 4, 0),
        (16, 8, 0), (4, 2, 1), (8, 2, 1), (16, 2, 1)]
FINEST = (16, 8, 0), (((16, 8, 0), (16, 4, 0)), ((16, 2, 0), (8, 2, 0)))  # and the pairs that give its error


def blocks(across: int) -> list[np.ndarray]:
    """Lattice of half as many rows again as squares would need."""
    x, s = np.linspace(0, 1, 2 * across + 1), np.linspace(0, 1, 6 * across + 1)
    y = LENGTH / 2 * (DENSER * s + (1 - DENSER) * s**2)
    half = WIDTH / 2 * (1 - NARROWER * (1 - y / (LENGTH / 2)))
    return [np.stack([x[None] * half[:, None], np.repeat(y[:, None], len(x), axis=1)], axis=2)]


def by_getfem(across: int, steps: int, mixed: int) -> np.ndarray:
    """[outputs x COLUMNS]"""
    body = Body(LAW, quadrilaterals(blocks(across)), bool(mixed))
    body.impose(body.region(lambda p: np.abs(p[0]) < 1e-9), 1, "axis")
    body.impose(body.region(lambda p: np.abs(p[1]) < 1e-9), 2, "middle")
    body.impose(body.region(lambda p: np.abs(p[1] - LENGTH / 2) < 1e-9), 2, "end")
    neck = np.array([[WIDTH / 2 * (1 - NARROWER)], [0.0]])
    rows, began = [[0.0, 0.0, neck[0, 0], 0.0]], time()
    for output in range(1, round(ELONGATION / EVERY) + 1):
        for share in range(1, steps + 1):
            body.step(end=EVERY / 2 * (output - 1 + share / steps))
        rows.append([output * EVERY, 2 * body.force("end"), (neck + body.moved(neck))[0, 0], body.largest_a()])
    print(f"necking {across} {steps} {mixed}: {time() - began:.0f} s, {body.halved} halved, det Cp^-1 - 1 "
          f"{body.loosest():.1e}; {rows[-1]}", file=sys.stderr, flush=True)
    return np.array(rows)
