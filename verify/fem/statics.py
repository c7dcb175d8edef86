"""Equilibrium: the minimum of a potential by Newton's method."""

from __future__ import annotations

import numpy as np
import ufl
from dolfinx import fem
from dolfinx.fem import petsc
from petsc4py import PETSc

from fem.compiled import compile_form

Conditions = list[fem.DirichletBCMetaClass]


class NotConverged(RuntimeError):
    """Newton's method found no equilibrium."""


def direct_solver(matrix: PETSc.Mat) -> PETSc.KSP:
    """A sparse factorisation by MUMPS; call setUp or solve after each change of the matrix."""
    solver = PETSc.KSP().create(PETSc.COMM_SELF)
    solver.setType("preonly")
    solver.getPC().setType("lu")
    solver.getPC().setFactorSolverType("mumps")
    solver.setOperators(matrix)
    return solver


class Minimiser:
    """Minimiser of a potential over `u`, which it changes in place.

    Values of conditions, constants and loads may change between calls. The first iteration, from the last solution,
    moves a displaced boundary and the interior together, so no element is folded at the boundary.
    """

    def __init__(self, potential: ufl.Form, u: fem.Function, conditions: Conditions = ()) -> None:
        space = u.function_space
        gradient = ufl.derivative(potential, u, ufl.TestFunction(space))
        tangent = ufl.derivative(gradient, u, ufl.TrialFunction(space))
        self.u, self.conditions = u, list(conditions)
        self._potential, self._gradient, self._tangent = (compile_form(f) for f in (potential, gradient, tangent))
        self._matrix, self._vector = petsc.create_matrix(self._tangent), petsc.create_vector(self._gradient)
        self._step = self._vector.duplicate()
        self._solver = direct_solver(self._matrix)

    def solve(self, tolerance: float = 1e-10, iterations: int = 40) -> int:
        """Iterates until no displacement changes by more than the tolerance, m. Returns the iterations; raises
        NotConverged."""
        for i in range(iterations):
            self._newton_step()
            size = self._step.norm(PETSc.NormType.NORM_INFINITY)
            share = self._advance(free=i == 0)
            if share == 1 and size <= tolerance:
                return i + 1
        raise NotConverged(f"{iterations} iterations, the last step was {size:.2g}, more than {tolerance:.2g}")

    def potential(self) -> float:
        """At the current u; NaN if an element is inverted."""
        return fem.assemble_scalar(self._potential)

    def reaction(self) -> np.ndarray:
        """[degrees of freedom] gradient of the potential, N/m: zero except at conditions."""
        with self._vector.localForm() as local:
            local.set(0)
        petsc.assemble_vector(self._vector, self._gradient)
        return self._vector.array.copy()

    def _newton_step(self) -> None:
        self.reaction()
        petsc.apply_lifting(self._vector, [self._tangent], bcs=[self.conditions], x0=[self.u.vector], scale=-1.0)
        petsc.set_bc(self._vector, self.conditions, self.u.vector, -1.0)
        self._matrix.zeroEntries()
        petsc.assemble_matrix(self._matrix, self._tangent, bcs=self.conditions)
        self._matrix.assemble()
        self._solver.solve(self._vector, self._step)

    def _advance(self, free: bool) -> float:
        """Takes the largest share 1, 1/2, ... of the step that lowers the potential, or, if free, keeps it finite."""
        before, u = self.potential(), self.u.x.array.copy()
        limit = np.inf if free or not np.isfinite(before) else before + 1e-11 * abs(before) + 1e-15
        for halvings in range(16):
            share = 0.5**halvings
            self.u.x.array[:] = u - share * self._step.array
            value = self.potential()
            if np.isfinite(value) and value <= limit:
                return share
        raise NotConverged(f"no part of the step down to {share:.1g} lowers the potential {before:.6g}")
