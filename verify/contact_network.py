"""The contact network of a packing from its outlines alone: contact pairs, forces, and area fractions in a box.

It is independent of the engine's contact code. A node inside another outline is found by the distance to one of the two
segments at the nearest corner, chosen by the corner's bisector; the force pushes it out of that segment.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

Box = tuple[float, float, float, float]  # x and y limits


@dataclass
class Outlines:
    """Closed counter-clockwise outlines, with consecutive points of each body."""

    points: np.ndarray  # [points x 2]
    body: np.ndarray  # [points]
    following: np.ndarray  # [points] the next point of the same outline
    preceding: np.ndarray  # [points]

    @classmethod
    def of(cls, points: np.ndarray, cells: np.ndarray, cell_body: np.ndarray) -> Outlines:
        """From segments [n x 2] and the body of each."""
        body, following, preceding = (np.zeros(len(points), dtype=int) for _ in range(3))
        body[cells[:, 0]], following[cells[:, 0]], preceding[cells[:, 1]] = cell_body, cells[:, 1], cells[:, 0]
        return cls(points, body, following, preceding)

    def of_body(self, body: int) -> np.ndarray:
        return self.points[self.body == body]

    def tributary_lengths(self) -> np.ndarray:
        """[points] half of the two adjacent segments."""
        lengths = np.linalg.norm(self.points[self.following] - self.points, axis=1)
        return 0.5 * (lengths + lengths[self.preceding])

    def areas(self) -> np.ndarray:
        """[bodies]"""
        x, y = self.points.T
        return np.bincount(self.body, 0.5 * (x * y[self.following] - x[self.following] * y))

    def centres(self) -> np.ndarray:
        """[bodies x 2] mean of the points, which are equally spaced on these outlines."""
        count = np.bincount(self.body)
        return np.stack([np.bincount(self.body, column) / count for column in self.points.T], axis=1)


@dataclass
class Network:
    """Pairs of bodies in contact, each once, i < j."""

    pairs: np.ndarray  # [pairs x 2]
    forces: np.ndarray  # [pairs x 2] on j, opposite on i
    bodies: int

    def magnitudes(self) -> np.ndarray:
        return np.linalg.norm(self.forces, axis=1)

    def resultants(self) -> np.ndarray:
        """[bodies x 2] sums of the forces."""
        sums = np.zeros((self.bodies, 2))
        np.add.at(sums, self.pairs[:, 1], self.forces)
        np.add.at(sums, self.pairs[:, 0], -self.forces)
        return sums

    def counts(self) -> np.ndarray:
        """[bodies] numbers of partners."""
        return np.bincount(self.pairs.ravel(), minlength=self.bodies)

    def without_rattlers(self, walls: np.ndarray) -> Network:
        """Network without rattlers: grains with fewer than three contacts (no walls) are removed until none is left."""
        network = self
        while True:
            loose = (network.counts() < 3) & ~np.isin(np.arange(self.bodies), walls)
            keep = ~loose[network.pairs].any(axis=1)
            if keep.all():
                return network
            network = Network(network.pairs[keep], network.forces[keep], self.bodies)


@dataclass
class Touching:
    """Nodes inside other bodies. A force acts on the node's body at the node, and on the other body at its foot."""

    own: np.ndarray  # [n] the node's body
    partner: np.ndarray  # [n]
    places: np.ndarray  # [n x 2]
    feet: np.ndarray  # [n x 2]
    forces: np.ndarray  # [n x 2] on the node

    def moments(self, bodies: int) -> np.ndarray:
        """[bodies] sums of force times place, about the origin."""
        return (np.bincount(self.own, np.einsum("ij,ij->i", self.forces, self.places), bodies)
                - np.bincount(self.partner, np.einsum("ij,ij->i", self.forces, self.feet), bodies))


def touching(outlines: Outlines, tributary: np.ndarray, stiffness: float) -> Touching:
    """Frictionless penalty contact: stiffness times depth times the node's reference length, half from each side."""
    node, partner, push = _penetrations(outlines)
    places = outlines.points[node]
    return Touching(outlines.body[node], partner, places, places + push,
                    (0.5 * stiffness * tributary[node])[:, None] * push)


def network(touching: Touching, bodies: int) -> Network:
    own, partner, force = touching.own, touching.partner, touching.forces
    swapped = own < partner  # the force acts on the node's body; the network stores that on the later body
    keys = np.where(swapped, own, partner) * 1_000_000 + np.where(swapped, partner, own)
    signed = np.where(swapped[:, None], -force, force)
    unique, index = np.unique(keys, return_inverse=True)
    sums = np.stack([np.bincount(index, column, len(unique)) for column in signed.T], axis=1)
    return Network(np.stack([unique // 1_000_000, unique % 1_000_000], axis=1), sums, bodies)


def _penetrations(outlines: Outlines) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Nodes, bodies that contain them, and depth times outward normal, [n x 2]."""
    node, corner = _nearest_corners(outlines)
    start = np.where(_beyond(outlines, node, corner), corner, outlines.preceding[corner])
    along = outlines.points[outlines.following[start]] - outlines.points[start]
    way = outlines.points[node] - outlines.points[start]
    inside = along[:, 0] * way[:, 1] > along[:, 1] * way[:, 0]
    share = np.clip(np.einsum("ij,ij->i", way, along) / np.einsum("ij,ij->i", along, along), 0, 1)
    push = share[:, None] * along - way
    return node[inside], outlines.body[corner[inside]], push[inside]


def _beyond(outlines: Outlines, node: np.ndarray, corner: np.ndarray) -> np.ndarray:
    """Whether a node lies past the bisector of a corner, so that the following segment counts, not the preceding one.
    """
    here = outlines.points[corner]
    ways = here - outlines.points[outlines.preceding[corner]], outlines.points[outlines.following[corner]] - here
    tangent = sum(way / np.linalg.norm(way, axis=1)[:, None] for way in ways)
    return np.einsum("ij,ij->i", outlines.points[node] - here, tangent) > 0


def _nearest_corners(outlines: Outlines) -> tuple[np.ndarray, np.ndarray]:
    """Nearest point of every other nearby body, for every node."""
    reach = 1.01 * np.linalg.norm(outlines.points[outlines.following] - outlines.points, axis=1).max()
    pairs = cKDTree(outlines.points).query_pairs(reach, output_type="ndarray")
    pairs = np.concatenate([pairs, pairs[:, ::-1]])
    node, corner = pairs[outlines.body[pairs[:, 0]] != outlines.body[pairs[:, 1]]].T
    distance = np.linalg.norm(outlines.points[node] - outlines.points[corner], axis=1)
    order = np.lexsort((distance, outlines.body[corner], node))
    node, corner = node[order], corner[order]
    first = np.ones(len(node), dtype=bool)
    first[1:] = (node[1:] != node[:-1]) | (outlines.body[corner[1:]] != outlines.body[corner[:-1]])
    return node[first], corner[first]


def filled(outlines: Outlines, bodies: np.ndarray, box: Box) -> np.ndarray:
    """[bodies] share of each body's area in the box."""
    areas = outlines.areas()
    shares = np.zeros(len(bodies))
    for i, body in enumerate(bodies):
        polygon = outlines.of_body(body)
        shares[i] = polygon_area(clipped(polygon, box)) / areas[body]
    return shares


def polygon_area(polygon: np.ndarray) -> float:
    if len(polygon) < 3:
        return 0.0
    x, y = polygon.T
    return float(0.5 * (x * np.roll(y, -1) - np.roll(x, -1) * y).sum())


def clipped(polygon: np.ndarray, box: Box) -> np.ndarray:
    """A polygon clipped by the sides of a box (Sutherland and Hodgman 1974)."""
    for axis, sign, limit in ((0, 1, box[0]), (0, -1, box[1]), (1, 1, box[2]), (1, -1, box[3])):
        if len(polygon) == 0:
            return polygon
        height = sign * (polygon[:, axis] - limit)
        if (height >= 0).all():
            continue
        polygon = _cut(polygon, height)
    return polygon


def _cut(polygon: np.ndarray, height: np.ndarray) -> np.ndarray:
    """Part of a polygon with nonnegative `height` [points]."""
    kept = []
    for i in range(len(polygon)):
        j = (i + 1) % len(polygon)
        if height[i] >= 0:
            kept.append(polygon[i])
        if (height[i] >= 0) != (height[j] >= 0):
            kept.append(polygon[i] + height[i] / (height[i] - height[j]) * (polygon[j] - polygon[i]))
    return np.array(kept).reshape(-1, 2)
