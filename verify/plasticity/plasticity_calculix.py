"""The quarter of a disc and a rigid frictionless plate by CalculiX (ccx 2.20): CPE8R, *PLASTIC with NLGEOM.

Its elastic law is that of Simo and Hughes, K/2 ((J^2 - 1)/2 - ln J) + mu/2 (tr be-bar - 3), so stresses differ from
those of the Hencky energy by terms of order yield / E. Contact is by a linear penalty of surfaces.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path
from time import time

import numpy as np

from plasticity_disc import APPROACHES, LAW, RADIUS, blocks

PLATE = 0.45  # its half width beyond the axis
SHORTEST = 1e-4  # increment over its step
FLAT = 1e-9
ELEMENTS = {"CPE4": 1, "CPE8R": 2}  # their sides in spacings of the lattice
LOOPS = {1: ([0, 0, 1, 1], [0, 1, 1, 0]), 2: ([0, 0, 0, 1, 2, 2, 2, 1], [0, 1, 2, 2, 2, 1, 0, 0])}


class Failed(RuntimeError):
    """ccx did not reach the end."""


def mesh(around: int, kind: str) -> tuple[np.ndarray, np.ndarray]:
    """[nodes x 2], [elements x 4 or 8] nodes from 1, corners first, counter-clockwise; four CPE4 for each CPE8R."""
    places: dict[tuple[float, float], int] = {}
    cells = []
    every = ELEMENTS[kind]
    row, column = LOOPS[every]
    for lattice in blocks(around):
        for i in range(0, lattice.shape[0] - 1, every):
            for j in range(0, lattice.shape[1] - 1, every):
                loop = lattice[i:i + every + 1, j:j + every + 1][row, column]
                if np.cross(loop[every] - loop[0], loop[2 * every] - loop[0]) < 0:
                    loop = np.roll(loop[::-1], 1, axis=0)
                numbers = [places.setdefault((round(x, 12) + 0.0, round(y, 12) + 0.0), len(places) + 1)
                           for x, y in loop]
                cells.append(numbers if every == 1 else numbers[::2] + numbers[1::2])
    return np.array(list(places)), np.array(cells)


def by_calculix(around: int, kind: str, steps: int, stiffness: float, folder: Path) -> np.ndarray:
    """[approaches x 2] approach and the force of a plate; fewer approaches where ccx stops."""
    points, cells = mesh(around, kind)
    count = len(points)
    arc = (np.abs(np.hypot(*points.T) - RADIUS) < FLAT) & (points[:, 1] > points[:, 0] - FLAT)
    sides = [(element + 1, side + 1) for element, nodes in enumerate(cells) for side in range(4)
             if arc[nodes[[side, (side + 1) % 4]] - 1].all()]
    elastic = f"{LAW.young:.15g},{LAW.nu:.15g}"
    plate = [(-0.05, RADIUS), (PLATE, RADIUS), (PLATE, RADIUS + 0.1), (-0.05, RADIUS + 0.1)]
    lines = ["*NODE,NSET=ALL", *(f"{n + 1},{x:.15g},{y:.15g},0." for n, (x, y) in enumerate([*points, *plate])),
             f"*ELEMENT,TYPE={kind},ELSET=EDISC",
             *(",".join(map(str, [n + 1, *nodes])) for n, nodes in enumerate(cells)),
             "*ELEMENT,TYPE=CPE4,ELSET=EPLATE", ",".join(map(str, [len(cells) + 1, *range(count + 1, count + 5)])),
             "*NSET,NSET=AXIS", *(str(n + 1) for n in np.flatnonzero(np.abs(points[:, 0]) < FLAT)),
             "*NSET,NSET=LEVEL", *(str(n + 1) for n in np.flatnonzero(np.abs(points[:, 1]) < FLAT)),
             "*NSET,NSET=PLATE", *(str(count + n) for n in range(1, 5)),
             "*SURFACE,NAME=ARC,TYPE=ELEMENT", *(f"{element},S{side}" for element, side in sides),
             "*SURFACE,NAME=FACE,TYPE=ELEMENT", f"{len(cells) + 1},S1",
             "*MATERIAL,NAME=MDISC", "*ELASTIC", elastic, "*PLASTIC",
             *(f"{LAW.limit(a):.15g},{a:g}" for a in (0.0, 5.0)),
             "*MATERIAL,NAME=MPLATE", "*ELASTIC", elastic,
             "*SOLID SECTION,ELSET=EDISC,MATERIAL=MDISC", "1.", "*SOLID SECTION,ELSET=EPLATE,MATERIAL=MPLATE", "1.",
             "*SURFACE INTERACTION,NAME=TOUCH", "*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR", f"{stiffness:.15g}",
             "*CONTACT PAIR,INTERACTION=TOUCH,TYPE=SURFACE TO SURFACE", "ARC,FACE",
             "*BOUNDARY", "AXIS,1,1", "LEVEL,2,2", "PLATE,1,1"]
    for approach in APPROACHES:
        lines += ["*STEP,NLGEOM,INC=2000", "*STATIC", f"{1 / steps:g},1.,{SHORTEST:g},{1 / steps:g}", "*BOUNDARY",
                  f"PLATE,2,2,{-approach / 2:.15g}", "*NODE PRINT,NSET=PLATE,TOTALS=ONLY", "RF", "*END STEP"]
    began = time()
    (folder / "disc.inp").write_text("\n".join(lines) + "\n")
    ran = subprocess.run(["ccx", "disc"], cwd=folder, capture_output=True, text=True, stdin=subprocess.DEVNULL,
                         env=os.environ | {"OMP_NUM_THREADS": "1"})
    text = (folder / "disc.dat").read_text()
    found = re.findall(r"for set PLATE and time\s+(\S+)\s+\S+\s+(\S+)", text)
    rows = np.array([[APPROACHES[round(float(at)) - 1], -2 * float(force)] for at, force in found
                     if abs(float(at) - round(float(at))) < 1e-6])
    print(f"calculix {around} {kind} {steps} {stiffness:g}: {time() - began:.0f} s, exit {ran.returncode}, "
          f"{len(rows)} of {len(APPROACHES)}; {rows[-1:]}", file=sys.stderr, flush=True)
    if not len(rows):
        raise Failed(ran.stdout[-2000:])
    return rows
