"""Stresses and contact tractions of a run's frames, with errors of stresses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pliant.frames import Frames
from verification import Run

STRESSES = ("xx", "yy", "xy")


@dataclass
class Stresses:
    """Stresses of all cells of the compliant bodies."""

    centres: np.ndarray  # [cells x 2] at the start, m
    areas: np.ndarray  # [cells] at the start, m2
    body: np.ndarray  # [cells] in the scene's order
    values: np.ndarray  # [cells x 3] xx, yy, xy, Pa
    across: np.ndarray  # [cells] zz, Pa
    triangles: np.ndarray  # [cells x 3 x 2] corners at the start, m

    def rms(self, difference: np.ndarray, where: np.ndarray) -> float:
        """Root of the mean of |s|^2 = xx^2 + yy^2 + 2 xy^2, weighted by area and a mask or weight of the cells."""
        square = difference[:, 0] ** 2 + difference[:, 1] ** 2 + 2 * difference[:, 2] ** 2
        return float(np.sqrt(np.average(square, weights=self.areas * where)))


def frames_of(run: Run) -> Frames:
    return Frames(run.folder / "frames.h5", None)


def stresses_of(run: Run, frame: int = -1) -> Stresses:
    """Needs stress_xx, stress_yy, stress_xy and stress_zz among the fields of the scene's frames."""
    frames = frames_of(run)
    number, grid = range(len(frames.times))[frame], frames.grids["bodies"]
    corners = frames.positions("bodies", 0)[:, :2][grid.cells]
    sides = corners[:, 1:] - corners[:, :1]
    areas = 0.5 * (sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0])
    field = {name: frames.field("bodies", number, f"stress_{name}").astype(float) for name in (*STRESSES, "zz")}
    values = np.stack([field[name] for name in STRESSES], axis=1)
    return Stresses(corners.mean(axis=1), areas, grid.body, values, field["zz"], corners)


def along_outline(run: Run, body: int, name: str, frame: int = -1) -> tuple[np.ndarray, np.ndarray]:
    """[nodes x 2] initial positions, m, and [nodes] a field of frames, along the outline of a body."""
    frames = frames_of(run)
    number, there = range(len(frames.times))[frame], frames.grids["outlines"].point_body == body
    values = frames.field("outlines", number, name).astype(float)
    return frames.positions("outlines", 0)[there, :2], values[there]
