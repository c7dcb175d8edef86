"""Motion of one compliant body, from the frames of a run of either solver."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fields import frames_of
from pliant.frames import Frames
from verification import Run

SINGLE = 6e-8  # relative rounding of frames, which are in single precision


@dataclass
class Motion:
    """Positions of all field nodes, m, at the times of the frames, s."""

    times: np.ndarray  # [frames]
    positions: np.ndarray  # [frames x nodes x 2]
    displacements: np.ndarray  # [frames x nodes x 2]
    velocities: np.ndarray | None  # [frames x nodes x 2], m/s; None if the frames have none
    triangles: np.ndarray  # [triangles x 3]

    def areas(self) -> np.ndarray:
        """[triangles] at the start, m2."""
        corners = self.positions[0][self.triangles]
        return 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])

    def node_areas(self) -> np.ndarray:
        """[nodes] a third of the triangles around each: row sums of their mass over the density, m2."""
        return np.bincount(self.triangles.ravel(), np.repeat(self.areas() / 3, 3), self.positions.shape[1])

    def momenta(self, velocities: np.ndarray, mass: str) -> np.ndarray:
        """[nodes x 2] momenta of linear triangles over their density, m3/s, for [nodes x 2] velocities: D v for lumped
        mass, inv(W) v with W = 2 inv(D) - inv(D) M inv(D) for corrected mass; M is the consistent mass, D its row sums.
        """
        lumped = self.node_areas()
        if mass == "lumped":
            return lumped[:, None] * velocities
        consistent = np.zeros((len(lumped), len(lumped)))
        for i in range(3):
            for j in range(3):
                share = self.areas() * (2 if i == j else 1) / 12
                np.add.at(consistent, (self.triangles[:, i], self.triangles[:, j]), share)
        inverse = 2 * np.diag(1 / lumped) - consistent / np.outer(lumped, lumped)
        return np.linalg.solve(inverse, velocities)

    def modal(self, axis: int, shape: np.ndarray) -> np.ndarray:
        """[frames] displacements weighted by shape [nodes] and the areas of nodes, m3."""
        return self.displacements[:, :, axis] @ (shape * self.node_areas())

    def second_moments(self, axis: int) -> np.ndarray:
        """[frames] integral of x^2 over the initial area, m4; x is linear in each triangle."""
        x = self.positions[:, :, axis][:, self.triangles]
        return ((x**2).sum(axis=2) + x.sum(axis=2)**2) @ (self.areas() / 12)


def read_motion(run: Run) -> Motion:
    """Motion from a run with one body and frames with the field displacement, and optionally velocity."""
    frames = frames_of(run)
    count = range(len(frames.times))
    velocities = None
    if frames.field("bodies", 0, "velocity") is not None:
        velocities = np.array([plane(frames, i, "velocity") for i in count])
    return Motion(frames.times, np.array([frames.positions("bodies", i) for i in count]),
                  np.array([plane(frames, i, "displacement") for i in count]), velocities,
                  frames.grids["bodies"].cells)


def plane(frames: Frames, index: int, name: str) -> np.ndarray:
    """[nodes x 2] plane part of a vector, which a frame stores with z = 0."""
    return np.array(frames.field("bodies", index, name), dtype=float)[:, :2]
