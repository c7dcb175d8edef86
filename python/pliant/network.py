"""The network of contacts of one frame: which way forces go, how they are spread, who bears them.

    contacts = run.frames.contacts(10)           # None unless the scene says [frames] contacts = true
    network = of_frame(run.frames, 10)
    network.compression, network.shear           # [pairs] N/m, along and across the line of centres
    network.coordination(grains), network.strong_share(), network.fabric()
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pliant.frames import WALL, BadFolder, Contacts, Frames


@dataclass
class Network:
    """Contacts with the arms of both bodies to the point where they touch; a wall has none."""

    contacts: Contacts
    arms: np.ndarray  # [pairs x 2 bodies x 2] m, from a body's centre to the point; NaN of walls
    walls: np.ndarray  # [pairs x 2 bodies] whether it is one

    @property
    def normals(self) -> np.ndarray:
        """[pairs x 2] unit vectors from the first's centre to the second's; to the point where either is a wall."""
        first, second = np.nan_to_num(self.arms[:, 0]), np.nan_to_num(self.arms[:, 1])
        branch = first - second
        return branch / np.linalg.norm(branch, axis=1)[:, None]

    @property
    def compression(self) -> np.ndarray:
        """[pairs] N/m, the part of the force along the normals, positive where bodies press."""
        return (self.contacts.force * self.normals).sum(axis=1)

    @property
    def shear(self) -> np.ndarray:
        """[pairs] N/m, across the normals, positive to their left."""
        force, normal = self.contacts.force, self.normals
        return normal[:, 0] * force[:, 1] - normal[:, 1] * force[:, 0]

    @property
    def magnitude(self) -> np.ndarray:
        """[pairs] N/m."""
        return np.linalg.norm(self.contacts.force, axis=1)

    def coordination(self, bodies: np.ndarray) -> np.ndarray:
        """[bodies] pairs that each of these is in; a body and its own image are two of its pairs."""
        return np.bincount(self.contacts.bodies.ravel(), minlength=bodies.max(initial=-1) + 1)[bodies]

    def strong_share(self) -> float:
        """Share of the pairs whose force exceeds the mean; of forces that decay exponentially it is 1/e."""
        force = self.magnitude
        return float((force > force.mean()).mean()) if len(force) else float("nan")

    def fabric(self, weights: np.ndarray | None = None) -> np.ndarray:
        """[2 x 2] mean of n (x) n over pairs, weighted if asked to, by forces for instance."""
        w = np.ones(len(self.normals)) if weights is None else weights
        return np.einsum("p,pi,pj->ij", w / w.sum(), self.normals, self.normals)


def of_frame(frames: Frames, index: int) -> Network:
    """BadFolder: the run did not store contacts."""
    contacts = frames.contacts(index)
    if contacts is None:
        raise BadFolder(f"{frames.path}: no contacts in frame {index}; scenes store them by [frames] contacts = true")
    centres = frames.centres(index)[contacts.bodies]
    centres[:, 1] += frames.shifts(contacts.images, index)
    walls = frames.kinds[contacts.bodies] == WALL
    arms = contacts.point[:, None] - centres
    arms[walls] = np.nan
    return Network(contacts, arms, walls)
