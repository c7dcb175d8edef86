"""Cook's membrane in plane strain with the plastic law, by GetFEM. The shear on its right edge is dead: it keeps its
direction, and its size per reference length. Units: mm, GPa, MN/m.
"""

from __future__ import annotations

import sys
from time import time

import numpy as np

from plasticity_getfem import Body, quadrilaterals
from plasticity_law import Law

CORNERS = np.array([[[0.0, 0.0], [48.0, 44.0]], [[0.0, 44.0], [48.0, 60.0]]])  # lower, upper; left, right
EDGE = 16.0  # length of the right edge
LAW = Law.of_young(70.0, 0.2, 0.243, 0.135, 0.343, 10.0)
FORCE, OUTPUTS = 3.0, 30
COLUMNS = ["force", "tip_x", "tip_y", "largest_a"]
# Elements along a side; steps per output; mixed.
RUNS = [(8, 1, 0), (8, 2, 0), (8, 4, 0), (16, 1, 0), (16, 2, 0), (16, 4, 0), (32, 2, 0),
        (8, 2, 1), (16, 2, 1), (32, 2, 1)]
FINEST = (32, 2, 1), (((16, 2, 0), (16, 4, 0)), ((32, 2, 1), (16, 2, 1)))  # and the pairs that give its error


def blocks(along: int) -> list[np.ndarray]:
    s = np.linspace(0, 1, 2 * along + 1)
    up, right = s[:, None, None], s[None, :, None]
    left, at_right = ((1 - up) * CORNERS[0, side] + up * CORNERS[1, side] for side in (0, 1))
    return [(1 - right) * left + right * at_right]


def by_getfem(along: int, steps: int, mixed: int) -> np.ndarray:
    """[outputs x COLUMNS]"""
    body = Body(LAW, quadrilaterals(blocks(along)), bool(mixed))
    clamped = body.region(lambda p: np.abs(p[0]) < 1e-9)
    body.impose(clamped, 1, "left_x")
    body.impose(clamped, 2, "left_y")
    body.load(body.region(lambda p: np.abs(p[0] - CORNERS[0, 1, 0]) < 1e-9), 2, "shear")
    tip = CORNERS[1, 1][:, None]
    rows, began = [[0.0] * len(COLUMNS)], time()
    for output in range(1, OUTPUTS + 1):
        for share in range(1, steps + 1):
            body.step(shear=FORCE / EDGE * (output - 1 + share / steps) / OUTPUTS)
        rows.append([FORCE * output / OUTPUTS, *body.moved(tip)[:, 0], body.largest_a()])
    held = body.force("left_y") + FORCE
    print(f"cook {along} {steps} {mixed}: {time() - began:.0f} s, {body.halved} halved, det Cp^-1 - 1 "
          f"{body.loosest():.1e}, forces {held:.1e}; {rows[-1]}", file=sys.stderr, flush=True)
    return np.array(rows)
