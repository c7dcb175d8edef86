"""Writes oracles/: /usr/bin/python3 verify/pushed_disc/make_pushed_disc_oracles.py. Half an hour.

A stiff disc pushed along a soft block with Coulomb friction, by GetFEM: forces on meshes and in load steps of several
sizes, and surfaces.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from datetime import date
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from foreign.meshes import block, full_disc

FOLDER = Path(__file__).parent / "oracles"
DEPTH, FRICTION = 0.5, 0.3
START = -0.5  # x of the disc
MODULI = {"disc": 10.0, "block": 1.0}  # mu; lambda = 4 mu
HOLD = 100.0  # mu / R: of the springs
STUCK = [0.0, 0.1, 0.2, 0.3]  # pushes at which all of the contact, or a part of it, sticks
SLIDING = np.linspace(0.4, 1.2, 33)  # all of it slips
# Rings of the disc, rows of squares in the block, load steps for 0.1 R on the way along.
MESHES = [(8, 10), (12, 15), (16, 20)]
STEPS = [2, 4, 8]
DRAWN = (0.3, 1.2)  # pushes of the stored surfaces, of the finest mesh
COLUMNS = "rings,rows,steps,push,along,across"


@dataclass
class Pushed:
    """By GetFEM on one mesh."""

    forces: np.ndarray  # [pushes x 3] push, force along and across on the block
    surfaces: dict[float, np.ndarray]  # [nodes x 2] the block's top from the right to the left, by push


def by_getfem(rings: int, rows: int, steps: int, pushes: list[float]) -> Pushed:
    from foreign.getfem_bodies import Bodies  # GetFEM is there with --full alone

    bodies = Bodies("neo-hookean", {"along": 0.0, "down": 0.0})
    bodies.add("disc", full_disc(rings, (START, 1.0)), MODULI["disc"], 4 * MODULI["disc"])
    bodies.add("block", block(3 * rows, rows, -3.0, 3.0, 2.0), MODULI["block"], 4 * MODULI["block"])
    bodies.hold("disc", lambda middles: middles[:, 1] > 1, HOLD, "along", "down")
    bodies.hold("block", lambda middles: middles[:, 1] < -1, HOLD, "0", "0")
    bodies.touch("disc", "block", FRICTION)
    bodies.load({"along": 0.0, "down": -DEPTH}, round(10 * DEPTH * steps))
    forces, surfaces, before = [], {}, 0.0
    for push in pushes:
        if push > before:
            sticks = push <= STUCK[-1]
            bodies.load({"along": push, "down": -DEPTH}, round((push - before) * 10 * steps) if sticks else 1)
        force = bodies.holding_force("disc")
        forces.append([push, force[0], -force[1]])
        if push in DRAWN:
            top = 6 * rows + 1
            surfaces[push] = bodies.outline("block")[:top]
        before = push
    return Pushed(np.array(forces), surfaces)


def write(name: str, columns: str, rows: np.ndarray, what: str) -> None:
    header = [f"# {what}", "# GetFEM 5.4.2, quadratic triangles, augmented Lagrangian, large sliding by ray tracing.",
              f"# {date.today()}, make_pushed_disc_oracles.py, one thread. Units mu = R = 1 of the block.", columns]
    np.savetxt(FOLDER / f"{name}.csv", rows, "%.8g", ",", header="\n".join(header), comments="")


def main() -> None:
    FOLDER.mkdir(exist_ok=True)
    rows, found = [], None
    pushes = [*STUCK, *(float(push) for push in SLIDING)]
    for rings, squares in MESHES:
        for steps in STEPS if (rings, squares) == MESHES[0] else STEPS[-1:]:
            with_slip = steps == STEPS[-1]  # what slips does not depend on the way
            found = by_getfem(rings, squares, steps, pushes if with_slip else STUCK)
            rows += [[rings, squares, steps, *row] for row in found.forces]
            print(rings, squares, steps, found.forces[:4].round(5).tolist(), flush=True)
            write("pushed_disc_getfem", COLUMNS, np.array(rows),
                  "Forces on the block by push: rings of the disc, rows of squares in the block, load steps for 0.1.")
    write("pushed_disc_surfaces", ",".join(f"{axis}_{push:g}" for push in DRAWN for axis in "xy"),
          np.column_stack([found.surfaces[push] for push in DRAWN]),
          f"The block's top by push, {MESHES[-1][0]} rings and {MESHES[-1][1]} rows.")


if __name__ == "__main__":
    main()
