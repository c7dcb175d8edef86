"""Six-node triangles in plain numbers, for third-party solvers; curved sides lie on the true outline."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

PLAIN = 1e-9  # a point within this distance is on a line
Curve = Callable[[np.ndarray], np.ndarray]  # [n] from 0 to 1 -> [n x 2]
Where = Callable[[np.ndarray], np.ndarray]  # [sides x 2] middles of sides -> [sides] whether they are there


@dataclass
class Mesh:
    """Mesh of a body. Cells are counter-clockwise: three corners, then the middles of the sides 1-2, 2-3 and 3-1."""

    points: np.ndarray  # [points x 2]
    cells: np.ndarray  # [cells x 6]
    outline: np.ndarray  # [sides x 2] cell and number of its side, of those on the curve
    order: np.ndarray  # points along the curve

    @property
    def half(self) -> bool:
        """x = 0 is an axis of symmetry."""
        return bool(self.points[:, 0].min() > -PLAIN)

    def side_nodes(self, cell: int, side: int) -> np.ndarray:
        """[3] both ends and the middle."""
        return self.cells[cell, [side, (side + 1) % 3, 3 + side]]

    def side_middles(self) -> np.ndarray:
        """[sides x 2] of the outline."""
        return self.points[self.cells[self.outline[:, 0], 3 + self.outline[:, 1]]]


def above(height: float) -> Where:
    return lambda middles: middles[:, 1] > height


def below(height: float) -> Where:
    return lambda middles: middles[:, 1] < height


def half_disc(rings: int, centre: float) -> Mesh:
    """The half x >= 0 of a disc of radius 1 about (0, centre); ring k has 4 k sides."""
    return fan(half_circle, (0.0, centre), rings, 4)


def half_circle(t: np.ndarray) -> np.ndarray:
    """From the lowest point to the highest; the ends are just on the axis."""
    angle = np.pi * (t - 0.5)
    return np.stack([np.where(np.abs(t - 0.5) < 0.5, np.cos(angle), 0.0), np.sin(angle)], axis=1)


def fan(curve: Curve, centre: tuple[float, float], rings: int, sectors: int) -> Mesh:
    """Mesh between the origin and a curve about it, moved to a centre. Ring k has sectors x k sides."""
    rows = [np.zeros((1, 2))] + [k / rings * curve(np.linspace(0, 1, sectors * k + 1)) for k in range(1, rings + 1)]
    first = np.concatenate([[0], np.cumsum([len(row) for row in rows])])
    corners = np.array([[first[k] + i for k, i in cell] for k in range(1, rings + 1) for s in range(sectors)
                        for cell in ring_cells(k, s)])
    points = np.concatenate(rows)
    sides = np.sort(corners[:, [[0, 1], [1, 2], [2, 0]]], axis=2)
    sides, of_cell = np.unique(sides.reshape(-1, 2), axis=0, return_inverse=True)
    of_cell = of_cell.reshape(-1, 3)
    middles = points[sides].mean(axis=1)
    outer = (sides >= first[rings]).all(axis=1)
    middles[outer] = curve((sides[outer] - first[rings]).sum(axis=1) / (2 * sectors * rings))
    cells = np.column_stack([corners, len(points) + of_cell])
    order = np.empty(2 * sectors * rings + 1, dtype=int)
    order[::2] = np.arange(first[rings], first[rings + 1])
    order[1::2] = len(points) + np.flatnonzero(outer)[np.argsort(sides[outer].sum(axis=1))]
    return Mesh(np.concatenate([points, middles]) + centre, cells, np.argwhere(outer[of_cell]), order)


def ring_cells(k: int, sector: int) -> list[list[tuple[int, int]]]:
    """Triangles between rings k - 1 and k in one of the sectors: ring and number of each corner."""
    outer, inner = [(k, sector * k + j) for j in range(k + 1)], [(k - 1, sector * (k - 1) + j) for j in range(k)]
    pointing_in = [[outer[j], outer[j + 1], inner[j]] for j in range(k)]
    return pointing_in + [[inner[j], outer[j + 1], inner[j + 1]] for j in range(k - 1)]


def full_circle(t: np.ndarray) -> np.ndarray:
    """From the highest point, counter-clockwise."""
    angle = 2 * np.pi * (t + 0.25)
    return np.stack([np.cos(angle), np.sin(angle)], axis=1)


def full_disc(rings: int, centre: tuple[float, float]) -> Mesh:
    """A disc of radius 1; ring k has 6 k sides. Its outline begins and ends at the highest point."""
    return welded(fan(full_circle, centre, rings, 6))


def welded(mesh: Mesh) -> Mesh:
    """Merges coinciding points."""
    _, first, number = np.unique(np.round(mesh.points, 9), axis=0, return_index=True, return_inverse=True)
    number = number.ravel()
    return Mesh(mesh.points[first], number[mesh.cells], mesh.outline, number[mesh.order])


def block(columns: int, rows: int, left: float, right: float, height: float) -> Mesh:
    """A rectangle whose top is y = 0, of squares in two triangles each; its outline is the top, from the right to the
    left, and the bottom, from the left to the right."""
    x, y = np.linspace(left, right, 2 * columns + 1), np.linspace(-height, 0, 2 * rows + 1)
    points = np.stack(np.meshgrid(x, y), axis=2).reshape(-1, 2)

    def at(i: int, j: int) -> int:
        return j * (2 * columns + 1) + i

    corners = []
    for j in range(0, 2 * rows, 2):
        for i in range(0, 2 * columns, 2):
            a, b, c, d = (i, j), (i + 2, j), (i + 2, j + 2), (i, j + 2)
            corners += [[a, b, c], [c, d, a]] if (i + j) % 4 == 0 else [[d, a, b], [b, c, d]]
    cells = np.array([[at(*p) for p in cell] + [at(*(np.add(cell[k], cell[(k + 1) % 3]) // 2)) for k in range(3)]
                      for cell in corners])
    height_of = points[cells[:, 3:], 1]  # of the middles of sides
    outline = np.argwhere((np.abs(height_of) < PLAIN) | (np.abs(height_of + height) < PLAIN))
    top = [at(i, 2 * rows) for i in range(2 * columns, -1, -1)]
    return Mesh(points, cells, outline, np.array(top + [at(i, 0) for i in range(2 * columns + 1)]))
