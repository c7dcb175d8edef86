"""Writes oracles/: /usr/bin/python3 verify/pushed_disc/make_pushed_disc_oracles.py. Or those of neo-hookean,
melody, calculix, as named. Half an hour each on a busy machine, neo-hookean an hour and a half.

A stiff disc pushed along a soft block with Coulomb friction, by GetFEM and CalculiX: forces on meshes and in load steps
of several sizes, and surfaces.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from datetime import date
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from foreign.calculix_deck import Deck
from foreign.meshes import Mesh, block, full_disc

FOLDER = Path(__file__).parent / "oracles"
DEPTH, FRICTION = 0.5, 0.3
START = -0.5  # x of the disc
LAWS = ("neo-hookean", "melody")
MODULI = {"disc": 10.0, "block": 1.0}  # mu; lambda = 4 mu
HOLD = 100.0  # mu / R: of the springs
STUCK = [0.0, 0.1, 0.2, 0.3]  # pushes at which all of the contact, or a part of it, sticks
SLIDING = np.linspace(0.4, 1.2, 33)  # all of it slips
# Rings of the disc, rows of squares in the block, load steps for 0.1 R on the way along.
MESHES = [(8, 10), (12, 15), (16, 20)]
FINER = {"neo-hookean": [(24, 30)], "melody": []}
STEPS = [2, 4, 8]
DRAWN = (0.3, 1.2)  # pushes of the stored surfaces, of the finest mesh
COLUMNS = "rings,rows,steps,push,along,across"
# CalculiX: R, of its increments on the way down and then along, of which forces lag by first order; penalties, mu / R.
DOWN, LONGEST, LONG, SHORT = 0.025, 0.025, 0.0125, 0.00625
SOFT, STIFF = 300.0, 1000.0
CALCULIX_MESHES = [(4, 5), (8, 10)]
FINEST = (12, 15)  # with SOFT and LONG alone
# Slave, rings, rows, penalty, increments down and along, whether it goes on to slip.
CALCULIX = [*(("disc", *mesh, stiffness, DOWN, along, True) for mesh in CALCULIX_MESHES for stiffness in (SOFT, STIFF)
              for along in (LONG, SHORT)),
            *(("disc", *mesh, SOFT, DOWN, LONGEST, True) for mesh in CALCULIX_MESHES),
            ("disc", *FINEST, SOFT, DOWN, LONG, True),
            *(("block", *CALCULIX_MESHES[0], STIFF, DOWN, along, True) for along in (LONG, SHORT)),
            ("disc", *CALCULIX_MESHES[0], SOFT, DOWN / 2, LONG, False)]
CALCULIX_COLUMNS = "slave,rings,rows,stiffness,down,increment,push,along,across"
MELODY = "_melody"  # in names of files
GETFEM = "GetFEM 5.4.2, quadratic triangles, augmented Lagrangian, large sliding by ray tracing."
CALCULIX_SAYS = "CalculiX 2.20, CPE6, contact of surfaces by a linear penalty of `stiffness` mu / R, along as across."


@dataclass
class Pushed:
    """By GetFEM on one mesh."""

    forces: np.ndarray  # [pushes x 3] push, force along and across on the block
    surfaces: dict[float, np.ndarray]  # [nodes x 2] the block's top from the right to the left, by push


def meshes(rings: int, rows: int) -> dict[str, Mesh]:
    return {"disc": full_disc(rings, (START, 1.0)), "block": block(3 * rows, rows, -3.0, 3.0, 2.0)}


def upper_half(middles: np.ndarray) -> np.ndarray:
    """[sides] of the disc."""
    return middles[:, 1] > 1


def bottom(middles: np.ndarray) -> np.ndarray:
    """[sides] of the block."""
    return middles[:, 1] < -1


def by_getfem(rings: int, rows: int, steps: int, pushes: list[float], law: str = LAWS[0]) -> Pushed:
    from foreign.getfem_bodies import Bodies  # GetFEM is there with --full alone

    bodies = Bodies(law, {"along": 0.0, "down": 0.0})
    for name, mesh in meshes(rings, rows).items():
        bodies.add(name, mesh, MODULI[name], 4 * MODULI[name])
    bodies.hold("disc", upper_half, HOLD, "along", "down")
    bodies.hold("block", bottom, HOLD, "0", "0")
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


def by_calculix(rings: int, rows: int, stiffness: float, folder: Path, increment: float, slave: str = "disc",
                down: float = DOWN, slides: bool = True) -> np.ndarray:
    """[pushes it gets to x 3] push, force along and across on the block, by the law `melody` and a penalty of so many
    mu / R. Opposite points of both surfaces are those at the start of an increment: forces lag by it."""
    deck = Deck(stiffness, FRICTION)
    for name, mesh in meshes(rings, rows).items():
        deck.add(name.upper(), mesh, MODULI[name], 4 * MODULI[name], half=False)
    deck.hold("DISC", upper_half, HOLD, "RAM")
    deck.hold("BLOCK", bottom, HOLD, "GROUND")
    deck.touch(*(("DISCDOWN", "BLOCKUP") if slave == "disc" else ("BLOCKUP", "DISCDOWN")))
    pushes = [*STUCK, *(SLIDING if slides else [])]
    deck.step({"GROUND": 0.0, "RAM": -DEPTH}, down / DEPTH, {"RAM": pushes[0]})
    for before, push in zip(pushes, pushes[1:]):
        deck.step({"GROUND": 0.0, "RAM": -DEPTH}, increment / (push - before), {"RAM": push})
    found = deck.forces(folder / f"{rings}_{stiffness:g}_{slave}", all_steps=False)["RAM"]
    return np.column_stack([pushes[:len(found)], found[:, 0], -found[:, 1]])


def write(name: str, columns: str, rows: np.ndarray, what: str, solver: str = GETFEM) -> None:
    header = [f"# {what}", f"# {solver}",
              f"# {date.today()}, make_pushed_disc_oracles.py, one thread. Units mu = R = 1 of the block.", columns]
    np.savetxt(FOLDER / f"{name}.csv", rows, "%.8g", ",", header="\n".join(header), comments="")


def main(made: list[str]) -> None:
    FOLDER.mkdir(exist_ok=True)
    for name in made:
        MAKERS[name]()


def write_getfem(law: str) -> None:
    rows, found = [], None
    pushes = [*STUCK, *(float(push) for push in SLIDING)]
    for rings, squares in [*MESHES, *FINER[law]]:
        for steps in STEPS if (rings, squares) == MESHES[0] else STEPS[-1:]:
            with_slip = steps == STEPS[-1]  # what slips does not depend on the way
            found = by_getfem(rings, squares, steps, pushes if with_slip else STUCK, law)
            rows += [[rings, squares, steps, *row] for row in found.forces]
            print(rings, squares, steps, found.forces[:4].round(5).tolist(), flush=True)
            write("pushed_disc_getfem" + MELODY * (law == "melody"), COLUMNS, np.array(rows),
                  f"Forces on the block by push, law {law}: rings of the disc, rows of squares in the block, load steps"
                  " for 0.1.")
    if law == LAWS[0]:
        write("pushed_disc_surfaces", ",".join(f"{axis}_{push:g}" for push in DRAWN for axis in "xy"),
              np.column_stack([found.surfaces[push] for push in DRAWN]),
              "The block's top by push, {} rings and {} rows.".format(*[*MESHES, *FINER[law]][-1]))


def write_calculix() -> None:
    rows = []
    for slave, rings, squares, stiffness, down, increment, slides in CALCULIX:
        with TemporaryDirectory() as folder:
            found = by_calculix(rings, squares, stiffness, Path(folder), increment, slave, down, slides)
        rows += [[list(MODULI).index(slave), rings, squares, stiffness, down, increment, *row] for row in found]
        print(slave, rings, squares, stiffness, down, increment, found[:4].round(5).tolist(), flush=True)
        write_calculix_rows(rows)


def write_calculix_rows(rows: list[list[float]]) -> None:
    write("pushed_disc_calculix_melody", CALCULIX_COLUMNS, np.array(rows),
          "Forces on the block by push, law melody. slave 0: the disc, 1: the block; increments down and along.",
          CALCULIX_SAYS)


MAKERS = {"neo-hookean": lambda: write_getfem("neo-hookean"), "melody": lambda: write_getfem("melody"),
          "calculix": write_calculix}

if __name__ == "__main__":
    main(sys.argv[1:] or list(MAKERS))
