"""Stored numbers of solvers from elsewhere, and distances from stored outlines."""

from __future__ import annotations

from pathlib import Path

import numpy as np


def read_table(file: Path) -> np.ndarray:
    """Rows below the header; lines that begin with # say where they come from."""
    lines = [line for line in file.read_text().splitlines() if not line.startswith("#")]
    return np.loadtxt(lines[1:], delimiter=",", ndmin=2)


def distances(places: np.ndarray, line: np.ndarray) -> np.ndarray:
    """[places] from a polyline."""
    starts, ways = line[:-1], np.diff(line, axis=0)
    seen = places[:, None] - starts
    along = np.clip((seen * ways).sum(axis=2) / (ways**2).sum(axis=1), 0, 1)
    return np.linalg.norm(seen - along[..., None] * ways, axis=2).min(axis=1)


def distances_from_half(places: np.ndarray, half: np.ndarray) -> np.ndarray:
    """[places] from an outline whose half x >= 0 is a polyline."""
    return distances(np.stack([np.abs(places[:, 0]), places[:, 1]], axis=1), half)
