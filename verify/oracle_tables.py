"""The numbers of verify/oracles, by column."""

from __future__ import annotations

import csv

import numpy as np

from verification import ROOT

FOLDER = ROOT / "verify/oracles"


def read_oracle(name: str) -> dict[str, np.ndarray]:
    """Columns of oracles/<name>.csv, as text if they are not numeric. Units mu = R = rho = 1, lambda = 4."""
    with (FOLDER / f"{name}.csv").open() as stream:
        header, *rows = csv.reader(stream)
    return {title: as_numbers([row[i] for row in rows]) for i, title in enumerate(header)}


def as_numbers(cells: list[str]) -> np.ndarray:
    try:
        return np.array([float(cell) for cell in cells])
    except ValueError:
        return np.array(cells)
