"""Curvature of a finite block's loaded face: /usr/bin/python3 verify/cattaneo_mindlin/block_curvature.py.

A block of 2 x 1, held at the bottom, is loaded on the middle of its top by q(x) = 2 Q/(pi a) sqrt(1 - x^2/a^2), Q = 1,
across or along the face. The half-plane's face would move by const - 2 Q x^2/(pi E' a^2) under the load,
E' = E/(1 - nu^2), in either direction. Prints the difference of the block's x^2 coefficient from that, over Q, with
its sign reversed, 1/(Pa m2), for E = 2.8 and nu = 0.4. For dolfinx 0.5.2.
"""

from __future__ import annotations

import numpy as np
import ufl
from dolfinx import fem, mesh
from mpi4py import MPI
from petsc4py.PETSc import ScalarType

YOUNG, POISSON = 2.8, 0.4
LAMBDA, MU = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON)), YOUNG / (2 * (1 + POISSON))


def stress(u: ufl.core.expr.Expr) -> ufl.core.expr.Expr:
    strain = ufl.sym(ufl.grad(u))
    return 2 * MU * strain + LAMBDA * ufl.tr(strain) * ufl.Identity(2)


def face_displacement(cells: int, half_width: float, direction: int) -> tuple[np.ndarray, np.ndarray]:
    """[nodes] x and displacement in the load's direction along the face, with 2 x `cells` biquadratic squares along
    it."""
    corners = [np.array([-1.0, -1.0]), np.array([1.0, 0.0])]
    domain = mesh.create_rectangle(MPI.COMM_WORLD, corners, [2 * cells, cells], mesh.CellType.quadrilateral)
    space = fem.VectorFunctionSpace(domain, ("Lagrange", 2))
    u, v, x = ufl.TrialFunction(space), ufl.TestFunction(space), ufl.SpatialCoordinate(domain)
    inside = ufl.conditional(ufl.lt(abs(x[0]), half_width), 1 - (x[0] / half_width) ** 2, 0.0)
    load = 2 / (np.pi * half_width) * ufl.sqrt(inside) * ufl.conditional(ufl.gt(x[1], -1e-9), 1.0, 0.0)
    sides = ufl.Measure("ds", domain=domain, metadata={"quadrature_degree": 20})
    bottom = fem.locate_dofs_geometrical(space, lambda at: np.isclose(at[1], -1))
    held = fem.dirichletbc(np.zeros(2, dtype=ScalarType), bottom, space)
    problem = fem.petsc.LinearProblem(ufl.inner(stress(u), ufl.grad(v)) * ufl.dx, load * v[direction] * sides,
                                      bcs=[held],
                                      petsc_options={"ksp_type": "preonly", "pc_type": "lu"})
    result = problem.solve().x.array.reshape(-1, 2)[:, direction]
    places = space.tabulate_dof_coordinates()
    top = np.flatnonzero(np.isclose(places[:, 1], 0))
    return places[top, 0], result[top]


def excess_curvature(cells: int, half_width: float, direction: int) -> float:
    x, u = face_displacement(cells, half_width, direction)
    near = np.abs(x) < 0.8 * half_width
    fitted = np.polyfit(x[near] ** 2, u[near], 1)[0]
    return -fitted - 2 * (1 - POISSON**2) / (np.pi * YOUNG * half_width**2)


if __name__ == "__main__":
    for half_width in (0.16, 0.24):
        for cells in (50, 100):
            across, along = (excess_curvature(cells, half_width, direction) for direction in (1, 0))
            print(f"a = {half_width}, {2 * cells} x {cells} squares: across {across:.4f}, along {along:.4f}")
