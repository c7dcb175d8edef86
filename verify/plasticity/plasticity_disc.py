"""A disc in plane strain between two rigid frictionless plates, by GetFEM and CalculiX: a quarter of it.

The diameter is 1 and the middle is the origin; the plates approach along y. Dimensionless.
"""

from __future__ import annotations

import sys
from time import time

import numpy as np

from plasticity_getfem import Body, quadrilaterals
from plasticity_law import Law

RADIUS = 0.5
LAW = Law.of_young(1000.0, 0.3, 1.0, 10.0, 1.0, 0.0)
APPROACHES = np.arange(1, 21) * 0.005  # of both plates in all
COLUMNS = ["approach", "force", "half_width", "largest_a"]
# Elements along an eighth of the outline; steps per approach of 0.005.
RUNS = [(8, 1), (8, 2), (8, 4), (16, 1), (16, 2), (16, 4), (8, 8), (16, 8), (24, 8)]
FINEST = (24, 8), (((16, 8), (16, 4)), ((24, 8), (16, 8)))  # and the pairs that give its error
# Also element (0: CPE4, 1: CPE8R) and contact stiffness, by CalculiX.
CALCULIX = [(8, 0, 2, 1e6), (16, 0, 2, 1e5), (16, 0, 2, 1e6), (8, 0, 4, 1e6), (8, 1, 8, 1e4)]
CALCULIX_FINEST = 16, 0, 2, 1e6
CALCULIX_PAIRS = (((16, 0, 2, 1e6), (8, 0, 2, 1e6)), ((8, 0, 4, 1e6), (8, 0, 2, 1e6)),
                  ((16, 0, 2, 1e5), (16, 0, 2, 1e6)))  # of meshes, steps, stiffnesses
CORE = 0.5  # of the radius: the square of the mesh
DENSER = 0.5  # spacing at the poles over the mean, along the outline and across it


def graded(s: np.ndarray) -> np.ndarray:
    return DENSER * s + (1 - DENSER) * s**2


def blocks(around: int) -> list[np.ndarray]:
    """Lattices of a square at the middle, and of what is right of it and above, with `around` elements along a side."""
    s = graded(np.linspace(0, 1, 2 * around + 1))
    square = CORE * RADIUS * np.stack(np.meshgrid(s, s), axis=2)
    angle = np.pi / 2 - np.pi / 4 * s
    arc = RADIUS * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    out = 1 - s[::-1, None, None]
    above = (1 - out) * square[-1][None] + out * arc[None]
    beside = above[:, ::-1, ::-1].transpose(1, 0, 2)
    return [square, above, beside]


def by_getfem(around: int, steps: int) -> np.ndarray:
    """[approaches x COLUMNS]"""
    body = Body(LAW, quadrilaterals(blocks(around)))
    body.impose(body.region(lambda p: np.abs(p[0]) < 1e-9), 1, "upright")
    body.impose(body.region(lambda p: np.abs(p[1]) < 1e-9), 2, "level")
    above = body.region(lambda p: (np.abs(np.hypot(*p) - RADIUS) < 1e-9) & (p[1] > np.abs(p[0]) - 1e-9))
    body.press(above, "plate")
    body.start(plate=RADIUS)
    side = np.array([[RADIUS], [0.0]])
    rows, began, before = [], time(), 0.0
    for approach in APPROACHES:
        for share in range(1, steps + 1):
            body.step(plate=RADIUS - (before + (approach - before) * share / steps) / 2)
        before = approach
        rows.append([approach, 2 * body.force("plate"), (side + body.moved(side))[0, 0], body.largest_a()])
    print(f"disc {around} {steps}: {time() - began:.0f} s, {body.halved} halved, det Cp^-1 - 1 {body.loosest():.1e}; "
          f"{rows[-1]}", file=sys.stderr, flush=True)
    return np.array(rows)
