"""Writes oracles/: /usr/bin/python3 verify/plasticity/make_plasticity_oracles.py [CASE...], by default all of them.

Runs that a table has are not repeated: delete the table to make it anew, an hour in all on one core. Curves are the
finest of the runs, with differences between runs as their errors.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import date
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / folder) for folder in ("verify", "scripts", "python", "verify/plasticity")]

import plasticity_cook as cook
import plasticity_disc as disc
import plasticity_law as law
import plasticity_necking as necking
import plasticity_same_law as same_law
from plasticity_calculix import by_calculix

FOLDER = Path(__file__).parent / "oracles"
POINT = "scipy 1.10: logm, expm, brentq, 3x3 matrices. Plane strain; mu=0.8, bulk=1.9, yield=0.11, hardening=0.07," \
        " saturation=0.16, rate=9."
GETFEM = "GetFEM 5.4.2, quadratic quadrilaterals; mixed 0: 2x2 points, 1: 3x3 points, discontinuous linear pressure."
CALCULIX = "CalculiX 2.20, CPE4 (B-bar) or CPE8R, *PLASTIC with NLGEOM, contact by a linear penalty `stiffness`."
TIMES = 2.0, 1.0  # differences by steps and by mesh: of first order in steps, if not less, and of second in meshes
Run = tuple[float, ...]


@dataclass(frozen=True)
class Runs:
    """Table of all runs of a case: the columns that key them, and the function that computes the rows of one."""

    what: str
    solver: str
    keys: list[str]
    columns: list[str]
    runs: Sequence[Run]
    rows: Callable[..., np.ndarray]


@dataclass(frozen=True)
class Curve:
    """The finest run of a table, and two pairs of runs, of two steps and of two meshes, that give its errors."""

    what: str
    runs: str
    finest: Run
    pairs: tuple[tuple[Run, Run], tuple[Run, Run]]


def in_folder(around: int, kind: int, steps: int, stiffness: float) -> np.ndarray:
    with TemporaryDirectory() as folder:
        return by_calculix(around, ("CPE4", "CPE8R")[kind], steps, stiffness, Path(folder))


TABLES: dict[str, Runs] = {
    "necking_runs": Runs(
        "Bar: mm, MN/m (whole bar). across: elements of half the width; steps: for 0.25 mm.", GETFEM,
        ["across", "steps", "mixed"], necking.COLUMNS, necking.RUNS, necking.by_getfem),
    "disc_runs": Runs(
        "Disc: approach of both plates. around: elements of an eighth of the outline; steps: for 0.005.", GETFEM,
        ["around", "steps"], disc.COLUMNS, disc.RUNS, disc.by_getfem),
    "disc_calculix_runs": Runs(
        "Disc: approach of both plates. around: as in disc_runs; element 0: CPE4, 1: CPE8R; steps: for 0.005.",
        CALCULIX, ["around", "element", "steps", "stiffness"], ["approach", "force"], disc.CALCULIX, in_folder),
    "cook_runs": Runs(
        "Membrane: mm, MN/m. along: elements of a side; steps: for 0.1 MN/m.", GETFEM,
        ["along", "steps", "mixed"], cook.COLUMNS, cook.RUNS, cook.by_getfem),
}
CURVES: dict[str, Curve] = {
    "necking": Curve("Bar: mm, MN/m (whole bar).", "necking_runs", *necking.FINEST),
    "disc": Curve("Disc: approach of both plates.", "disc_runs", *disc.FINEST),
    "cook": Curve("Membrane: mm, MN/m.", "cook_runs", *cook.FINEST),
}


def origin(what: str, solver: str, columns: Sequence[str]) -> str:
    return "\n".join([f"# {what}", f"# {solver}", f"# {date.today()}, make_plasticity_oracles.py, one thread.",
                      ",".join(columns)])


def stored(name: str) -> np.ndarray:
    file = FOLDER / f"{name}.csv"
    if not file.is_file():
        return np.empty((0, 0))
    lines = [line for line in file.read_text().splitlines() if not line.startswith("#")]
    return np.loadtxt(lines[1:], delimiter=",", ndmin=2)


def rows_of(name: str, run: Run) -> np.ndarray:
    """Without the columns that key it; none, if it is not stored."""
    rows, keys = stored(name), len(run)
    return rows[np.isclose(rows[:, :keys], run).all(axis=1)][:, keys:] if rows.size else rows


def make_runs(name: str) -> None:
    """Adds the runs that the table does not have, in the order of the list."""
    table = TABLES[name]
    for run in table.runs:
        if rows_of(name, run).size:
            continue
        found, rows = table.rows(*run), stored(name)
        new = np.array([[*run, *row] for row in found])
        np.savetxt(FOLDER / f"{name}.csv", np.vstack([rows, new]) if rows.size else new, "%.9g", ",", comments="",
                   header=origin(table.what, table.solver, [*table.keys, *table.columns]))


def make_curve(name: str) -> None:
    curve = CURVES[name]
    table = TABLES[curve.runs]
    finest, pairs = rows_of(curve.runs, curve.finest), partial(rows_of, curve.runs)
    errors = sum(times * np.abs(pairs(one) - pairs(other)) for times, (one, other) in zip(TIMES, curve.pairs))
    keys = ", ".join(f"{key} {value:g}" for key, value in zip(table.keys, curve.finest))
    columns = [*table.columns, *(f"error_{column}" for column in table.columns[1:])]
    of = [[f"{'/'.join(f'{value:g}' for value in run)}" for run in pair] for pair in curve.pairs]
    what = f"{curve.what} Run {keys}; errors: twice what {' and '.join(of[0])} differ by, and what " \
           f"{' and '.join(of[1])} do."
    np.savetxt(FOLDER / f"{name}.csv", np.hstack([finest, errors[:, 1:]]), "%.9g", ",", comments="",
               header=origin(what, table.solver, columns))


def make_calculix() -> None:
    """Curve of CalculiX and its relative difference from GetFEM's. Penalty: error of order 1 / stiffness."""
    force = {run: rows_of("disc_calculix_runs", run)[:, 1] for run in disc.CALCULIX}
    getfem = stored("disc")
    best = force[disc.CALCULIX_FINEST]
    of_mesh, of_steps, of_penalty = (np.abs(force[one] - force[other]) for one, other in disc.CALCULIX_PAIRS)
    softer = disc.CALCULIX_FINEST[-1] / disc.CALCULIX_PAIRS[2][0][-1] - 1
    error = of_mesh + 2 * of_steps + of_penalty / softer
    what = "Disc: approach of both plates. difference: force over GetFEM's less 1. Errors by mesh, steps and penalty."
    np.savetxt(FOLDER / "disc_calculix.csv",
               np.column_stack([getfem[:, 0], best, error, getfem[:, 1], best / getfem[:, 1] - 1]), "%.9g", ",",
               header=origin(what, CALCULIX, ["approach", "force", "error_force", "force_getfem", "difference"]),
               comments="")


def make_paths() -> None:
    what = "Stress P, Cauchy sigma_zz, inverse plastic metric and a at the end of each increment to F."
    np.savetxt(FOLDER / "paths.csv", law.paths(), "%.17g", ",", header=origin(what, POINT, law.COLUMNS), comments="")


MADE: dict[str, Callable[[], None]] = {
    "paths": make_paths,
    "law": same_law.check,
    **{name: partial(make_runs, name) for name in TABLES},
    **{name: partial(make_curve, name) for name in CURVES},
    "disc_calculix": make_calculix,
}

if __name__ == "__main__":
    for each in sys.argv[1:] or MADE:
        MADE[each]()
