"""A neo-Hookean solid in plane strain on a mesh: its energy, mass and stiffness as forms."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import ufl
from dolfinx import fem
from dolfinx.mesh import Mesh

from fem.compiled import vector_space


@dataclass
class Material:
    """Lame's constants, Pa, density, kg/m3, and micro-inertia, m2. The defaults are the units of verify/: mu = 1,
    nu = 0.4.

    Kinetic energy is density/2 (|v|^2 + micro_inertia |grad v|^2).
    """

    mu: float = 1.0
    lame: float = 4.0
    density: float = 1.0
    micro_inertia: float = 0.0

    @classmethod
    def of_poisson(cls, poisson: float) -> Material:
        """Material with mu = density = 1."""
        return cls(lame=2 * poisson / (1 - 2 * poisson))


class Solid:
    """Displacements `u` (a fem.Function of `space`) of a body on a mesh, with elements of the given degree.

    Constants of the material enter as fem.Constant, so that forms are compiled once for all values.
    """

    def __init__(self, domain: Mesh, material: Material, degree: int = 2) -> None:
        self.domain = domain
        self.space = vector_space(domain, degree)
        self.u = fem.Function(self.space)
        self.test, self.trial = ufl.TestFunction(self.space), ufl.TrialFunction(self.space)
        self.mu, self.lame, self.density = (fem.Constant(domain, value) for value in (
            material.mu, material.lame, material.density))
        self._micro_inertia = fem.Constant(domain, material.micro_inertia) if material.micro_inertia else None
        rule = {"quadrature_degree": 2 * degree + 2}
        self.dx, self.ds = ufl.Measure("dx", domain, metadata=rule), ufl.Measure("ds", domain, metadata=rule)
        self.X = ufl.SpatialCoordinate(domain)

    def component_at(self, place: tuple[float, float], axis: int) -> np.ndarray:
        """[1] the degree of freedom of that displacement at the node there; empty if there is no node."""
        part = self.space.sub(axis)
        near = fem.locate_dofs_geometrical((part, part.collapse()[0]), lambda x: np.hypot(*(x[:2].T - place).T) < 1e-9)
        return near[0]

    def deformation_gradient(self, u: fem.Function) -> ufl.core.expr.Expr:
        return ufl.Identity(2) + ufl.grad(u)

    def energy_density(self, u: fem.Function) -> ufl.core.expr.Expr:
        """psi = mu/2 (I1 - 3 - 2 ln J) + lambda/2 (ln J)^2; I1 of diag(F, 1). NaN where J < 0."""
        F = self.deformation_gradient(u)
        log_J = ufl.ln(ufl.det(F))
        return self.mu / 2 * (ufl.inner(F, F) - 2 - 2 * log_J) + self.lame / 2 * log_J**2

    def strain_energy(self) -> ufl.Form:
        return self.energy_density(self.u) * self.dx

    def kinetic_energy(self, v: fem.Function) -> ufl.Form:
        return self.inertia(v, v) / 2 * self.dx

    def mass(self) -> ufl.Form:
        """Bilinear form of the consistent mass."""
        return self.inertia(self.trial, self.test) * self.dx

    def inertia(self, v: ufl.core.expr.Expr, w: ufl.core.expr.Expr) -> ufl.core.expr.Expr:
        """Density of the bilinear form of the mass."""
        product = ufl.inner(v, w)
        if self._micro_inertia is not None:
            product += self._micro_inertia * ufl.inner(ufl.grad(v), ufl.grad(w))
        return self.density * product

    def stiffness(self) -> ufl.Form:
        """Bilinear form of the tangent at the current `u`; at u = 0 that of linear elasticity."""
        force = ufl.derivative(self.strain_energy(), self.u, self.test)
        return ufl.derivative(force, self.u, self.trial)

    def plate_energy(self, height: fem.Constant, stiffness: fem.Constant, side: int) -> ufl.Form:
        """Penalty, Pa/m, of a rigid frictionless plate at y = height, above (side 1) or below (-1) the body."""
        return stiffness / 2 * self._depth(height, side)**2 * self.ds

    def plate_force(self, height: fem.Constant, stiffness: fem.Constant, side: int) -> ufl.Form:
        """Magnitude of the plate's force, N/m."""
        return stiffness * self._depth(height, side) * self.ds

    def _depth(self, height: fem.Constant, side: int) -> ufl.core.expr.Expr:
        depth = side * (self.X[1] + self.u[1] - height)
        return ufl.conditional(depth > 0, depth, 0.0)
