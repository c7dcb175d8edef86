"""Natural frequencies by SLEPc: consistent mass, shift and invert."""

from __future__ import annotations

import numpy as np
from dolfinx import fem
from petsc4py import PETSc
from slepc4py import SLEPc

from fem.compiled import compile_form
from fem.solid import Solid

SHIFT = 1.0  # of w^2, near the lowest for a body of size and wave speed 1, where the matrix is regular


def matrix(form) -> PETSc.Mat:
    result = fem.petsc.assemble_matrix(compile_form(form))
    result.assemble()
    return result


def natural_frequencies(solid: Solid, count: int) -> np.ndarray:
    """[count] lowest angular frequencies of a free body at its current `u`, in ascending order, without the three rigid
    motions."""
    solver = SLEPc.EPS().create(PETSc.COMM_SELF)
    solver.setOperators(matrix(solid.stiffness()), matrix(solid.mass()))
    solver.setProblemType(SLEPc.EPS.ProblemType.GHEP)
    solver.setWhichEigenpairs(SLEPc.EPS.Which.TARGET_MAGNITUDE)
    solver.setTarget(SHIFT)
    transform = solver.getST()
    transform.setType(SLEPc.ST.Type.SINVERT)
    transform.getKSP().setType(PETSc.KSP.Type.PREONLY)
    transform.getKSP().getPC().setType(PETSc.PC.Type.LU)
    solver.setTolerances(1e-13, 1000)
    solver.setDimensions(count + 6)
    solver.solve()
    if solver.getConverged() < count + 3:
        raise RuntimeError(f"SLEPc: {solver.getConverged()} eigenvalues converged, {count + 3} are needed")
    squares = np.sort([solver.getEigenvalue(i).real for i in range(solver.getConverged())])
    return np.sqrt(squares[3:3 + count])
