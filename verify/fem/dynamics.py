"""Motion of a solid: explicit steps with the consistent mass."""

from __future__ import annotations

import numpy as np
import ufl
from dolfinx import fem
from dolfinx.fem import petsc

from fem.compiled import compile_form
from fem.solid import Solid
from fem.statics import Conditions, direct_solver


class Motion:
    """Velocity `v` and acceleration `a` of a solid under a potential (strain energy, plates, loads); the time, s."""

    def __init__(self, solid: Solid, potential: ufl.Form, conditions: Conditions = ()) -> None:
        self.solid, self.conditions = solid, list(conditions)
        self.u, self.v, self.a = solid.u, fem.Function(solid.space), fem.Function(solid.space)
        self.time = 0.0
        self._force = ufl.derivative(potential, self.u, solid.test)
        self._gradient = compile_form(self._force)
        self._potential, self._kinetic = compile_form(potential), compile_form(solid.kinetic_energy(self.v))
        self._mass_form = compile_form(solid.mass())
        self._mass = petsc.assemble_matrix(self._mass_form, bcs=self.conditions)
        self._mass.assemble()
        self._solver = direct_solver(self._mass)
        self._vector = petsc.create_vector(self._gradient)

    def potential(self) -> float:
        """J/m; NaN if an element is inverted."""
        return fem.assemble_scalar(self._potential)

    def kinetic_energy(self) -> float:
        return fem.assemble_scalar(self._kinetic)

    def update_acceleration(self) -> None:
        """From the forces at `u`. Conditions prescribe the acceleration: zero keeps the velocity of a boundary."""
        with self._vector.localForm() as local:
            local.set(0)
        petsc.assemble_vector(self._vector, self._gradient)
        self._vector.scale(-1)
        petsc.apply_lifting(self._vector, [self._mass_form], bcs=[self.conditions])
        petsc.set_bc(self._vector, self.conditions)
        self._solver.solve(self._vector, self.a.vector)

    def largest_frequency(self, iterations: int = 60) -> float:
        """Of small vibrations about `u` with the current contacts, rad/s; power iteration, from below."""
        tangent = compile_form(ufl.derivative(self._force, self.u, self.solid.trial))
        stiffness = petsc.assemble_matrix(tangent, bcs=self.conditions)
        stiffness.assemble()
        x, y = self._vector.duplicate(), self._vector.duplicate()
        x.array[:] = np.random.default_rng(1).standard_normal(x.getSize())
        petsc.set_bc(x, self.conditions, scale=0)
        for _ in range(iterations):
            x.scale(1 / x.norm())
            stiffness.mult(x, y)
            petsc.set_bc(y, self.conditions, scale=0)
            self._solver.solve(y, x)
        return float(np.sqrt(x.norm()))


class Explicit(Motion):
    """Velocity Verlet. Stable below 2 / largest_frequency, which grows with strain and contact.

    Half of its initial value was sufficient for strains of a half. The caller sets u and v, and moves plates between
    steps.
    """

    def start(self) -> None:
        """Call after setting u and v."""
        self.update_acceleration()

    def step(self, dt: float) -> None:
        """Advances `u`, `v` and `a` from t to t + dt; raises if an element is inverted."""
        self.v.x.array[:] += dt / 2 * self.a.x.array
        self.u.x.array[:] += dt * self.v.x.array
        self.update_acceleration()
        self.v.x.array[:] += dt / 2 * self.a.x.array
        self.time += dt
        if not np.isfinite(self.a.x.array).all():
            raise FloatingPointError(f"an element is turned inside out at {self.time:g} s")
