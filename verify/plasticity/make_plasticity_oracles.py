"""Writes oracles/: /usr/bin/python3 verify/plasticity/make_plasticity_oracles.py [TABLE...], by default all of them."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from datetime import date
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / folder) for folder in ("verify", "scripts", "python", "verify/plasticity")]

import plasticity_law as law

FOLDER = Path(__file__).parent / "oracles"
POINT = "scipy 1.10: logm, expm, brentq, 3x3 matrices. Plane strain; mu=0.8, bulk=1.9, yield=0.11, hardening=0.07," \
        " saturation=0.16, rate=9."


@dataclass(frozen=True)
class Table:
    """A file: its description, its solver, its columns, and the function that computes its rows."""

    what: str
    solver: str
    columns: list[str]
    rows: Callable[[], np.ndarray]
    digits: int = 9


TABLES: dict[str, Table] = {
    "paths": Table("Stress P, Cauchy sigma_zz, inverse plastic metric and a at the end of each increment to F.", POINT,
                   law.COLUMNS, law.paths, 17),
}


def make(name: str) -> None:
    table = TABLES[name]
    header = [f"# {table.what}", f"# {table.solver}", f"# {date.today()}, make_plasticity_oracles.py, one thread.",
              ",".join(table.columns)]
    np.savetxt(FOLDER / f"{name}.csv", table.rows(), f"%.{table.digits}g", ",", header="\n".join(header), comments="")


if __name__ == "__main__":
    for each in sys.argv[1:] or TABLES:
        make(each)
