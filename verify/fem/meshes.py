"""Triangles of discs, their quarters and rectangles. Edges on a circle are curved: six nodes per triangle."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import ufl
from dolfinx import mesh
from mpi4py import MPI

PLAIN = 1e-9  # a point is on an axis if it is that near to it


def disc(rings: int) -> mesh.Mesh:
    """Unit disc about the origin: rings of equal width, ring k with 8 k edges, symmetric about both axes."""
    return curved(*ringed(rings, 8, 2 * np.pi))


def quarter_disc(rings: int) -> mesh.Mesh:
    """The quarter x >= 0, y >= 0 of `disc`."""
    return curved(*ringed(rings, 2, np.pi / 2))


def quarter_disc_near_pole(rings: int, width: float, edges: float) -> mesh.Mesh:
    """quarter_disc refined so that `edges` edges fit into the half width of a contact at the pole (0, 1).

    Triangles within 1.6 half widths of the pole get that size, twice as far twice that size, and so on.
    """
    points, cells = ringed(rings, 2, np.pi / 2)
    levels = max(0, int(np.ceil(np.log2(edges / (width * rings)))))
    for level in reversed(range(levels)):
        points, cells = refined(points, cells, near_pole(points, cells, 1.6 * width * 2.0**level))
    return curved(points, cells)


def rectangle(width: float, height: float, columns: int, rows: int) -> mesh.Mesh:
    """[0, width] x [0, height], four triangles per cell around its middle."""
    corners = [np.array([0.0, 0.0]), np.array([width, height])]
    return mesh.create_rectangle(MPI.COMM_SELF, corners, [columns, rows], mesh.CellType.triangle,
                                 diagonal=mesh.DiagonalType.crossed)


def ringed(rings: int, sectors: int, angle: float) -> tuple[np.ndarray, np.ndarray]:
    """Points [n x 2] and counter-clockwise triangles [m x 3] of a unit sector. Ring k has sectors x k edges."""
    closed = angle == 2 * np.pi
    points, first = [np.zeros((1, 2))], [0]
    for k in range(1, rings + 1):
        first.append(first[-1] + len(points[-1]))
        turn = np.linspace(0, angle, sectors * k + 1)[: -1 if closed else None]
        points.append(k / rings * np.column_stack([np.cos(turn), np.sin(turn)]))

    def node(k: int, i: int) -> int:
        return first[k] + (i % (sectors * k) if closed and k else i)

    cells = [cell for k in range(1, rings + 1) for sector in range(sectors) for cell in ring_cells(k, sector, node)]
    points = np.concatenate(points)
    points[np.abs(points) < PLAIN] = 0
    return points, np.array(cells)


def ring_cells(k: int, sector: int, node: Callable[[int, int], int]) -> list[list[int]]:
    """Triangles between rings k - 1 and k in one of the sectors; node(k, i) numbers the points."""
    outer, inner = (lambda j: node(k, sector * k + j)), (lambda j: node(k - 1, sector * (k - 1) + j))
    pointing_in = [[outer(j), outer(j + 1), inner(j)] for j in range(k)]
    return pointing_in + [[inner(j), outer(j + 1), inner(j + 1)] for j in range(k - 1)]


def near_pole(points: np.ndarray, cells: np.ndarray, distance: float) -> np.ndarray:
    """[cells] whether the nearest corner is within the distance of (0, 1)."""
    return (np.linalg.norm(points - [0, 1], axis=1)[cells] < distance).any(axis=1)


def refined(points: np.ndarray, cells: np.ndarray, marked: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Divides marked triangles, and neighbours so that the mesh stays conforming. New points of the arc lie on it."""
    linear = create(points, cells, 1)
    linear.topology.create_entities(1)
    linear.topology.create_connectivity(2, 1)
    edges = linear.topology.connectivity(2, 1)
    chosen = np.flatnonzero(marked[linear.topology.original_cell_index])
    finer = mesh.refine(linear, np.unique(np.concatenate([edges.links(cell) for cell in chosen])), False)
    cells = finer.geometry.dofmap.array.reshape(-1, 3).astype(np.int64)
    points = finer.geometry.x[:, :2].copy()
    points[np.abs(points) < PLAIN] = 0
    arc = np.unique(arc_edges(points, cells))
    points[arc] /= np.linalg.norm(points[arc], axis=1)[:, None]
    return points, cells


def arc_edges(points: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """[edges x 2] point numbers of the boundary edges that do not lie on an axis."""
    edges, count = np.unique(np.sort(cells[:, [[1, 2], [0, 2], [0, 1]]].reshape(-1, 2)), axis=0, return_counts=True)
    boundary = edges[count == 1]
    on_axis = (np.abs(points[boundary]) < PLAIN).all(axis=1).any(axis=1)
    return boundary[~on_axis]


def curved(points: np.ndarray, cells: np.ndarray) -> mesh.Mesh:
    """Mesh with a node in the middle of every edge; those of boundary edges off the axes lie on the unit circle."""
    sides = cells[:, [[1, 2], [0, 2], [0, 1]]]  # in the order of dolfinx
    edges, of_cell = np.unique(np.sort(sides.reshape(-1, 2)), axis=0, return_inverse=True)
    middles = points[edges].mean(axis=1)
    on_arc = (edges[:, None] == np.sort(arc_edges(points, cells))[None]).all(axis=2).any(axis=1)
    middles[on_arc] /= np.linalg.norm(middles[on_arc], axis=1)[:, None]
    return create(np.concatenate([points, middles]),
                  np.column_stack([cells, len(points) + of_cell.reshape(-1, 3)]), 2)


def create(points: np.ndarray, cells: np.ndarray, degree: int) -> mesh.Mesh:
    """A dolfinx mesh of straight (degree 1) or curved (2) triangles."""
    domain = ufl.Mesh(ufl.VectorElement("Lagrange", "triangle", degree))
    return mesh.create_mesh(MPI.COMM_SELF, cells.astype(np.int64), points, domain)
