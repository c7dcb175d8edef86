"""Stored results of third-party solvers, and distances from stored outlines."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

KEYS = ("first", "body", "slave", "rings", "rows", "steps", "stiffness", "down", "increment")  # columns that key a run


@dataclass
class Opinion:
    """Result of one solver."""

    force: np.ndarray  # [places]
    error: np.ndarray  # [places] relative


class Table:
    """Rows below the header; lines that begin with # give their origin."""

    def __init__(self, file: Path) -> None:
        lines = [line for line in file.read_text().splitlines() if not line.startswith("#")]
        self.names = lines[0].split(",")
        self.rows = np.loadtxt(lines[1:], delimiter=",", ndmin=2)

    def of(self, **key: float) -> np.ndarray:
        """[rows x columns that are no KEYS] of all runs that match the key."""
        there = np.full(len(self.rows), True)
        for name, value in key.items():
            there &= np.isclose(self.column(name), value)
        return self.rows[there][:, [name not in KEYS for name in self.names]]

    def column(self, name: str) -> np.ndarray:
        return self.rows[:, self.names.index(name)]

    def outlines(self, **key: float) -> np.ndarray:
        """[places x nodes x 2]"""
        found = self.of(**key)
        return found.reshape(len(found), -1, 2).transpose(1, 0, 2)


def largest_from_here(values: np.ndarray) -> np.ndarray:
    """[..., places] the largest of this place and later ones."""
    return np.maximum.accumulate(values[..., ::-1], axis=-1)[..., ::-1]


def largest(values: np.ndarray) -> np.ndarray:
    """[..., places] the largest of all."""
    return np.broadcast_to(values.max(axis=-1, keepdims=True), values.shape)


def distances(places: np.ndarray, line: np.ndarray) -> np.ndarray:
    """[places] distances from a polyline."""
    starts, ways = line[:-1], np.diff(line, axis=0)
    seen = places[:, None] - starts
    along = np.clip((seen * ways).sum(axis=2) / (ways**2).sum(axis=1), 0, 1)
    return np.linalg.norm(seen - along[..., None] * ways, axis=2).min(axis=1)


def distances_from_half(places: np.ndarray, half: np.ndarray) -> np.ndarray:
    """[places] distances from an outline whose half x >= 0 is a polyline."""
    return distances(np.stack([np.abs(places[:, 0]), places[:, 1]], axis=1), half)
