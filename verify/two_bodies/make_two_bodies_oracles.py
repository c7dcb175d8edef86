"""Writes oracles/: /usr/bin/python3 verify/two_bodies/make_two_bodies_oracles.py [TABLE...], by default all of them.

Each takes half an hour on a busy machine, push_getfem_neo-hookean an hour and a half.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from datetime import date
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / folder) for folder in ("verify", "scripts", "python")]

import two_bodies_discs as discs
import two_bodies_polygon as polygon
import two_bodies_push as push
from two_bodies_study import FOLDER

GETFEM = "GetFEM 5.4.2, quadratic triangles, augmented Lagrangian, large sliding by ray tracing."
CALCULIX = "CalculiX 2.20, CPE6, contact of surfaces by a linear penalty of `stiffness` mu / R, along as across."
PERCENT = [100 * approach for approach in discs.APPROACHES]
PLATE = "Force of a plate by approach in percent, by rings of the soft disc."
FORCE = "Force by depth. first 0: a corner, 1: a face. slave 0: the disc, 1: the hexagon."
PUSH = ["push", "along", "across"]
ON_BLOCK = "Forces on the block by push. rings: of the disc; rows: of squares in the block;"
HALF = "Half outlines from the lowest point up, law neo-hookean, by body."
# Columns of the key, other columns, description; then, by key, the function that computes its rows, in a folder for
# files of CalculiX.
Made = dict[tuple[float, ...], Callable[[Path], np.ndarray]]
Table = tuple[str, list[str], str, Made]


def names(levels: Sequence[float], of: str = "force") -> list[str]:
    return [f"{name}_{level:g}" for level in levels for name in of.split()]


def forces(by_getfem: Callable[..., tuple[np.ndarray, object]], *run: object) -> Callable[[Path], np.ndarray]:
    return lambda _: by_getfem(*run)[0]


def outlines(every: int, by_getfem: Callable[..., tuple[object, dict[str, np.ndarray]]],
             *run: object) -> Callable[[Path], np.ndarray]:
    """Rows of body and positions, of every n-th node."""
    return lambda _: np.array([[i, *places.ravel()] for i, each in enumerate(by_getfem(*run)[1].values())
                               for places in each[:, ::every].transpose(1, 0, 2)])


def surfaces(_: Path) -> np.ndarray:
    tops = push.by_getfem("neo-hookean", push.RINGS["neo-hookean"][-1], push.STEPS[-1])[1]
    return np.column_stack([tops[np.abs(np.array(push.PUSHES) - at).argmin()] for at in push.DRAWN])


def by_getfem(law: str) -> dict[str, Table]:
    """Slip is path-independent, so runs with coarser load steps of the push end at its onset."""
    bodies, coarsest, shortest = list(polygon.MODULI), push.RINGS[law][0], push.STEPS[-1]
    swapped = {first: polygon.SWAPPED[first, law] for first in polygon.FIRST}
    pressed = [(i, slave, rings) for i, first in enumerate(polygon.FIRST) for slave in (0, 1)
               for rings in (swapped[first] if slave else sorted({*polygon.RINGS, *swapped[first]}))]
    pushed = [*((coarsest, steps) for steps in push.STEPS[:-1]), *((rings, shortest) for rings in push.RINGS[law])]
    return {f"discs_getfem_{law}": ("rings", names(PERCENT), PLATE, {
                (rings,): forces(discs.by_getfem, law, rings) for rings in discs.RINGS[law]}),
            f"polygon_getfem_{law}": ("first,slave,rings", names(polygon.DEPTHS), FORCE, {
                (i, slave, rings): forces(polygon.by_getfem, polygon.FIRST[i], law, rings, bodies[slave])
                for i, slave, rings in pressed}),
            f"push_getfem_{law}": ("rings,rows,steps", PUSH, f"{ON_BLOCK} steps: of load for 0.1 R.", {
                (rings, push.ROWS[rings], steps): forces(push.by_getfem, law, rings, steps, steps == shortest)
                for rings, steps in pushed})}


TABLES: dict[str, Table] = {
    **by_getfem("neo-hookean"), **by_getfem("melody"),
    "discs_outlines": ("", ["body", *names(PERCENT, "x y")], HALF, {
        (): outlines(2, discs.by_getfem, "neo-hookean", discs.OUTLINE_RINGS)}),
    **{f"{first}_outlines": ("", ["body", *names(polygon.DEPTHS, "x y")], HALF, {
        (): outlines(1, polygon.by_getfem, first, "neo-hookean", polygon.RINGS[1])}) for first in polygon.FIRST},
    "push_surfaces": ("", names(push.DRAWN, "x y"), "The block's top by push, law neo-hookean.", {(): surfaces}),
    "discs_calculix_melody": ("rings,stiffness", names(PERCENT[:discs.CALCULIX_REACHES]), PLATE, {
        run: partial(discs.by_calculix, *run) for run in discs.CALCULIX}),
    "polygon_calculix_melody": ("first,slave,rings,stiffness", names(polygon.DEPTHS), FORCE, {
        (i, list(polygon.MODULI).index(slave), *mesh): partial(polygon.by_calculix, first, slave, *mesh)
        for i, first in enumerate(polygon.FIRST) for slave, *mesh in polygon.CALCULIX}),
    "push_calculix_melody": ("slave,rings,rows,stiffness,down,increment", PUSH, f"{ON_BLOCK} increments down, along.", {
        (list(push.MODULI).index(slave), rings, push.ROWS[rings], *more[:3]):
        partial(push.by_calculix, slave, rings, *more) for slave, rings, *more in push.CALCULIX})}


def make(name: str) -> None:
    """Make a table, written after each run."""
    keys, columns, what, runs = TABLES[name]
    header = [f"# {what}", f"# {CALCULIX if 'calculix' in name else GETFEM}",
              f"# {date.today()}, make_two_bodies_oracles.py, one thread. Units mu = R = 1 of the softer body.",
              ",".join([*keys.split(","), *columns] if keys else columns)]
    rows: list[list[float]] = []
    for key, run in runs.items():
        with TemporaryDirectory() as folder:
            found = np.atleast_2d(run(Path(folder)))
        rows += [[*key, *row] for row in found]
        print(name, *key, *found[0, :4].round(5), flush=True)
        np.savetxt(FOLDER / f"{name}.csv", np.array(rows), "%.9g", ",", header="\n".join(header), comments="")


if __name__ == "__main__":
    for table in sys.argv[1:] or TABLES:
        make(table)
