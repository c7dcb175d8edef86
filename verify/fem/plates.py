"""A disc between two rigid frictionless plates: a quarter of it, with symmetry on both axes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from dolfinx import fem
from dolfinx.mesh import locate_entities_boundary

from fem.compiled import compile_form
from fem.meshes import PLAIN, quarter_disc_near_pole
from fem.solid import Material, Solid
from fem.statics import Conditions, Minimiser, NotConverged

STEP = 0.03  # largest change of the approach per step, over the diameter
SOFT, STIFFER = 100.0, 5.0  # first stiffness, mu / R, and its growth factor


@dataclass
class Squeezed:
    """The whole disc of radius 1 at an approach of the plates, over its diameter."""

    approach: float
    force: float  # on one plate
    reaction: float  # of the plane of symmetry, which must be equal
    strain_energy: float
    horizontal_diameter: float


class Plates:
    """Squeezes a quarter disc. Its mesh has `edges` edges in the half width of a contact, `width` over the radius."""

    def __init__(self, material: Material, rings: int, width: float, edges: float, degree: int = 2) -> None:
        self.solid = Solid(quarter_disc_near_pole(rings, width, edges), material, degree)
        self._at = (0.0, SOFT)  # approach and stiffness
        self._height, self._stiffness = (fem.Constant(self.solid.domain, 1.0) for _ in range(2))
        plate = self.solid.plate_energy(self._height, self._stiffness, 1)
        self._strain = compile_form(self.solid.strain_energy())
        self._force = compile_form(self.solid.plate_force(self._height, self._stiffness, 1))
        conditions, self._bottom = symmetry(self.solid)
        self._equator = int(self.solid.component_at((1, 0), 0)[0])
        self._minimiser = Minimiser(self.solid.strain_energy() + plate, self.solid.u, conditions)

    def squeeze(self, approach: float, stiffness: float) -> Squeezed:
        """From the last approach to this one, over the diameter, with a penalty of stiffness x mu / R.

        The plate is soft while it moves and is then stiffened: the kinks of a stiff one stop Newton's method.
        """
        steps = int(np.ceil(abs(approach - self._at[0]) / STEP))
        for level in np.linspace(self._at[0], approach, 1 + steps)[1:]:
            self._move(level, SOFT)
        for harder in SOFT * STIFFER ** np.arange(1, np.log(stiffness / SOFT) / np.log(STIFFER)):
            self._move(approach, max(harder, self._at[1]))
        self._move(approach, stiffness)
        return self._measured()

    def _move(self, approach: float, stiffness: float, halvings: int = 4) -> None:
        """In one step, or in halves if that does not converge."""
        before = self.solid.u.x.array.copy()
        self._height.value, self._stiffness.value = 1 - approach, stiffness
        try:
            self._minimiser.solve()
        except NotConverged:
            if halvings == 0:
                raise
            self.solid.u.x.array[:] = before
            self._move((self._at[0] + approach) / 2, np.sqrt(self._at[1] * stiffness), halvings - 1)
            self._move(approach, stiffness, halvings - 1)
        self._at = (approach, stiffness)

    def _measured(self) -> Squeezed:
        strain, force = (fem.assemble_scalar(form) for form in (self._strain, self._force))
        reaction = self._minimiser.reaction()[self._bottom].sum()
        wide = 2 * (1 + self.solid.u.x.array[self._equator])
        return Squeezed(self._at[0], 2 * force, 2 * reaction, 4 * strain, wide)


def symmetry(solid: Solid) -> tuple[Conditions, np.ndarray]:
    """Conditions u_x = 0 on x = 0 and u_y = 0 on y = 0; the degrees of freedom of the latter."""
    space, domain = solid.space, solid.domain
    held = []
    for axis in (0, 1):
        edges = locate_entities_boundary(domain, 1, lambda x: np.abs(x[axis]) < PLAIN)
        held.append(fem.locate_dofs_topological(space.sub(axis), 1, edges))
    conditions = [fem.dirichletbc(0.0, dofs, space.sub(axis)) for axis, dofs in enumerate(held)]
    return conditions, held[1]


def without_penalty(coarse: Squeezed, fine: Squeezed) -> Squeezed:
    """Extrapolates results of stiffnesses k and 2 k, whose errors are of order 1/k, to a rigid plate."""
    names = ("force", "reaction", "strain_energy", "horizontal_diameter")
    return Squeezed(fine.approach, **{name: 2 * getattr(fine, name) - getattr(coarse, name) for name in names})


def hertz_force(approach: float, material: Material) -> float:
    """Force on a disc of radius 1 in linear theory: D = phi (ln(4 / phi) - 1), phi = f / (pi E* R)."""
    phi = approach / 5
    for _ in range(100):
        phi = approach / (np.log(4 / phi) - 1)
    return float(phi * np.pi * modulus(material))


def hertz_half_width(force: float, material: Material) -> float:
    """a / R = 2 sqrt(phi)."""
    return float(2 * np.sqrt(force / (np.pi * modulus(material))))


def modulus(material: Material) -> float:
    """E* = E / (1 - nu^2) = 4 mu (lambda + mu) / (lambda + 2 mu) in plane strain."""
    return 4 * material.mu * (material.lame + material.mu) / (material.lame + 2 * material.mu)
