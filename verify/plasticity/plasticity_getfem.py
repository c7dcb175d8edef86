"""A body of the plastic law in plane strain, by GetFEM (5.4): the law in its assembly language by Logm and Expm.

The increment of a is an unknown at each integration point (internal variable, condensed by GetFEM), the inverse plastic
metric and a are data there. Elements are quadratic quadrilaterals with 2 x 2 points, or with 3 x 3 points and a
discontinuous linear pressure (`mixed`).
"""

from __future__ import annotations

from collections.abc import Callable

import getfem
import numpy as np

from plasticity_law import Law

getfem.util_warning_level(0)
getfem.util_trace_level(0)

PLANE = "(Id(2)+Grad_u)"
SOLID = "(Id(3)+[[1,0,0],[0,1,0]]*Grad_u*[[1,0,0],[0,1,0]]')"
# Stored metric: xx, yy, zz, xy.
METRIC = "([[[1,0,0],[0,0,0],[0,0,0]],[[0,0,0],[0,1,0],[0,0,0]],[[0,0,0],[0,0,0],[0,0,1]]," \
         "[[0,1,0],[1,0,0],[0,0,0]]].Cpi)"
COMPONENTS = "[[[1,0,0,0.0],[0,0,0,0.5],[0,0,0,0]],[[0,0,0,0.5],[0,1,0,0.0],[0,0,0,0]],[[0,0,0,0],[0,0,0,0],[0,0,1,0]]]"
IN_PLANE = "[[[[1,0],[0,0]],[[0,1],[0,0]],[[0,0],[0,0]]],[[[0,0],[1,0]],[[0,0],[0,1]],[[0,0],[0,0]]]," \
           "[[[0,0],[0,0]],[[0,0],[0,0]],[[0,0],[0,0]]]]"
# Trial deviator of e = ln sqrt(be), its q, yield stress, and the deviator of e at the end of the step.
TRIAL = f"(0.5*Deviator(Logm({SOLID}*{METRIC}*{SOLID}')))"
Q = f"(2*mu*sqrt(1.5)*Norm({TRIAL}))"
LIMIT = "(yields+hardening*(a+da)+(saturation-yields)*(1-exp(-rate*(a+da))))"
KEPT = f"((1-3*mu*da/max({Q},1e-12*mu))*{TRIAL})"
VOLUME = f"log(Det({PLANE}))"
NEW_METRIC = f"(Inv({SOLID})*Expm(2*{KEPT}+(2/3*{VOLUME})*Id(3))*Inv({SOLID})')"

RESIDUAL = 1e-9
ITERATIONS, HALVINGS = 25, 6
AUGMENTED = 20.0  # mu: it changes results by less than meshes do (README.md, disc)

Where = Callable[[np.ndarray], np.ndarray]  # from points [2 x n], whether each is there


class NotConverged(RuntimeError):
    """Newton's method did not converge with the shortest load steps."""


class Body:
    """Variables u, da at points, t_<name> of imposed displacements; `step` sets imposed values."""

    def __init__(self, law: Law, mesh: getfem.Mesh, mixed: bool = False) -> None:
        self.model, self.mesh = getfem.Model("real"), mesh
        self.halved = 0  # steps
        self._at: dict[str, float] = {}
        self._last: tuple[np.ndarray, np.ndarray] | None = None  # steps of u and da
        self._outputs: dict[str, str] = {}
        self._regions = 0
        points = getfem.MeshIm(mesh, getfem.Integ(f"IM_GAUSS_PARALLELEPIPED(2,{5 if mixed else 3})"))
        self.sides = getfem.MeshIm(mesh, getfem.Integ("IM_GAUSS_PARALLELEPIPED(2,9)"))  # of terms on the outline
        self.scalars, self.metrics = getfem.MeshImData(points, -1, 1), getfem.MeshImData(points, -1, 4)
        self.field = quadratic(mesh, 2)
        self.model.add_fem_variable("u", self.field)
        self.model.add_internal_im_variable("da", self.scalars)
        self.model.add_im_data("a", self.scalars)
        self.model.add_im_data("Cpi", self.metrics)
        self.model.set_variable("Cpi", np.tile([1.0, 1.0, 1.0, 0.0], self.scalars.nbpts()))
        for name, value in vars(law).items():
            self.model.add_initialized_data(name, value)
        mean = self._pressure() if mixed else f"bulk*{VOLUME}"
        tau = f"(({mean})*Id(2)+2*mu*{IN_PLANE}:{KEPT})"
        virtual = f"{tau}:(Grad_Test_u*Inv({PLANE}))"
        if mixed:
            virtual += f"+({VOLUME}-({mean})/bulk)*({self._pressure('Test_')})"
        self.model.add_nonlinear_term(points, f"{virtual}+(3*mu*da-pos_part({Q}-{LIMIT}))/mu*Test_da")

    def _pressure(self, of: str = "") -> str:
        """Mean Kirchhoff stress, linear in X about the middle of each element."""
        if not of:
            constant = getfem.MeshFem(self.mesh, 1)
            constant.set_fem(getfem.Fem("FEM_QK(2,0)"))
            for name in ("p0", "p1", "p2"):
                self.model.add_fem_variable(name, constant)
            size = np.sqrt(np.prod(np.ptp(self.mesh.pts(), axis=1)) / self.mesh.nbcvs())
            self.model.add_initialized_data("size", size)
            for name, middles in zip(("Mx", "My"), constant.basic_dof_nodes()):
                self.model.add_initialized_fem_data(name, constant, middles)
        return f"{of}p0+{of}p1*(X(1)-Mx)/size+{of}p2*(X(2)-My)/size"

    def region(self, where: Where) -> int:
        """Number of a new region: the sides of the outline all of whose points are there."""
        self._regions += 1
        chosen = [face for face in self.mesh.outer_faces().T
                  if where(self.mesh.pts(self.mesh.pid_in_faces(face[:, None]))).all()]
        self.mesh.set_region(self._regions, np.array(chosen).T)
        return self._regions

    def impose(self, region: int, axis: int, name: str) -> None:
        """u along this axis (1 or 2) is the imposed value of this name; `force` of the name is what holds it there."""
        self._data(name)
        self.model.add_filtered_fem_variable(f"t_{name}", quadratic(self.mesh, 1), region)
        self.model.add_linear_term(self.sides, f"-t_{name}*Test_u({axis})-u({axis})*Test_t_{name}", region)
        self.model.add_source_term(self.sides, f"-{name}*Test_t_{name}", region)
        self._outputs[name] = f"t_{name}", region

    def load(self, region: int, axis: int, name: str) -> None:
        """Dead traction per reference length."""
        self._data(name)
        self.model.add_source_term(self.sides, f"{name}*Test_u({axis})", region)

    def press(self, region: int, name: str) -> None:
        """Rigid frictionless plate at y = the imposed value of this name, above: augmented Lagrangian."""
        self._data(name)
        self.model.add_filtered_fem_variable(f"t_{name}", quadratic(self.mesh, 1), region)
        pressure = f"pos_part(t_{name}-{AUGMENTED}*mu*({name}-X(2)-u(2)))"
        self.model.add_nonlinear_term(self.sides, f"{pressure}*Test_u(2)+({pressure}-t_{name})/({AUGMENTED}*mu)"
                                      f"*Test_t_{name}", region)
        self._outputs[name] = pressure, region

    def _data(self, name: str) -> None:
        self._at[name] = 0.0
        self.model.add_initialized_data(name, 0.0)

    def start(self, **imposed: float) -> None:
        """Imposed values at rest, if they are not zero."""
        self._at |= imposed

    def step(self, **imposed: float) -> None:
        """One step of backward Euler; in halves where Newton's method fails."""
        self._step(self._at | imposed, HALVINGS, 1.0)

    def _step(self, imposed: dict[str, float], halvings: int, share: float) -> None:
        before, kept = dict(self._at), self.model.from_variables()
        u = self.model.variable("u").copy()
        for guessed in (True, False):
            if guessed and self._last is None:
                continue
            if guessed:
                self.model.set_variable("u", u + share * self._last[0])
                self.model.set_variable("da", share * self._last[1])
            if self._solve(imposed):
                self.accept(u, share)
                self._at = imposed
                return
            self.model.to_variables(kept)
        if halvings == 0:
            raise NotConverged(f"from {before} to {imposed}")
        self.halved += 1
        middle = {name: (before[name] + value) / 2 for name, value in imposed.items()}
        self._step(middle, halvings - 1, share / 2)
        self._step(imposed, halvings - 1, share / 2)

    def _solve(self, imposed: dict[str, float]) -> bool:
        for name, value in imposed.items():
            self.model.set_variable(name, value)
        try:
            _, converged = self.model.solve("max_res", RESIDUAL, "max_iter", ITERATIONS, "lsolver", "mumps",
                                            "lsearch", "simplest")
        except RuntimeError:  # of a determinant below zero
            return False
        return bool(converged) and bool(np.isfinite(self.model.variable("u")).all())

    def accept(self, u: np.ndarray, share: float) -> None:
        metric = self.model.interpolation(f"{COMPONENTS}:{NEW_METRIC}", self.metrics)
        da = self.model.variable("da").copy()
        self._last = (self.model.variable("u") - u) / share, da / share
        self.model.set_variable("Cpi", metric)
        self.model.set_variable("a", self.model.variable("a") + da)
        self.model.set_variable("da", 0 * da)

    def force(self, name: str) -> float:
        """Integral of what holds an imposed value, along its axis; the push of a plate."""
        expression, region = self._outputs[name]
        return float(getfem.asm_generic(self.sides, 0, expression, region, self.model))

    def moved(self, points: np.ndarray) -> np.ndarray:
        """[2 x n] displacements of these points [2 x n]."""
        return getfem.compute_interpolate_on(self.field, self.model.variable("u"), points)

    def largest_a(self) -> float:
        return float(self.model.variable("a").max())

    def loosest(self) -> float:
        """Largest change of det Cp^-1 from 1."""
        xx, yy, zz, xy = self.model.variable("Cpi").reshape(-1, 4).T
        return float(np.abs((xx * yy - xy**2) * zz - 1).max())


def quadratic(mesh: getfem.Mesh, components: int) -> getfem.MeshFem:
    field = getfem.MeshFem(mesh, components)
    field.set_fem(getfem.Fem("FEM_QK(2,2)"))
    return field


def quadrilaterals(blocks: list[np.ndarray]) -> getfem.Mesh:
    """Mesh of quadratic elements from lattices [2 m + 1, 2 n + 1, 2] of their nodes, x the faster of an element."""
    mesh, kind = getfem.Mesh("empty", 2), getfem.GeoTrans("GT_QK(2,2)")
    for lattice in blocks:
        for i in range(0, lattice.shape[0] - 1, 2):
            for j in range(0, lattice.shape[1] - 1, 2):
                mesh.add_convex(kind, lattice[i:i + 3, j:j + 3].reshape(9, 2).T)
    return mesh
