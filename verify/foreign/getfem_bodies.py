"""Bodies at large strain in contact, by GetFEM (5.4): quadratic triangles, augmented Lagrangian, no residual penalty.

Contact uses GetFEM's large-sliding brick by ray tracing. The slave has first-order multipliers on its outline; slip is
counted from the last load step. Rigid frictionless plates have second-order pressures.
"""

from __future__ import annotations

from collections.abc import Callable

import getfem
import numpy as np

from foreign.meshes import PLAIN, Mesh, Where

getfem.util_warning_level(0)
getfem.util_trace_level(0)

# First Piola stress of F in plane strain (docs/method.md, section 3).
LAWS = {
    "neo-hookean": "(mu_{n}*({F}-Inv({F})')+lame_{n}*log(Det({F}))*Inv({F})')",
    "melody": "(mu_{n}*pow(Det({F}),-2/3)*{F}+((lame_{n}+2/3*mu_{n})*(Det({F})-1)*Det({F})"
              "-mu_{n}/3*pow(Det({F}),-2/3)*(Norm_sqr({F})+1))*Inv({F})')",
}
OUTLINE, AXIS, HELD = 1, 2, 3  # regions
AUGMENTED = 20.0  # mu / R: results are independent of it
REACH = 0.5  # R, of rays
RESIDUAL = 1e-9
ITERATIONS, HALVINGS = 40, 6


class NotConverged(RuntimeError):
    """Newton's method did not converge with the shortest load steps."""


class Bodies:
    """Variables u_<name>, pressures p_<name>, multipliers t_<slave>; `load` sets imposed values. lambda = 4 mu."""

    def __init__(self, law: str, meshes: dict[str, Mesh], moduli: dict[str, float], imposed: dict[str, float]) -> None:
        self.model, self.law, self.meshes = getfem.Model("real"), law, meshes
        self._own: dict[str, getfem.Mesh] = {}
        self._rules: dict[str, getfem.MeshIm] = {}
        self._at = dict(imposed)
        self._springs: dict[str, str] = {}
        self._slip_since: list[str] = []  # bodies
        for name, value in imposed.items():
            self.model.add_initialized_data(name, value)
        for name, mesh in meshes.items():
            self._add(name, mesh, moduli[name])

    def _add(self, name: str, mesh: Mesh, mu: float) -> None:
        """Adds a body; a half body has u_x = 0 on x = 0."""
        own = as_getfem(mesh)
        field = fields(own, 2, 2)
        self._own[name] = own
        self._rules[name] = getfem.MeshIm(own, getfem.Integ("IM_TRIANGLE(6)"))
        self.model.add_fem_variable(f"u_{name}", field)
        self.model.add_initialized_data(f"mu_{name}", mu)
        self.model.add_initialized_data(f"lame_{name}", 4 * mu)
        stress = LAWS[self.law].format(n=name, F=f"(Id(2)+Grad_u_{name})")
        self.model.add_nonlinear_term(self._rules[name], f"{stress}:Grad_Test_u_{name}")
        if mesh.half:
            self.model.add_normal_Dirichlet_condition_with_multipliers(self._rules[name], f"u_{name}", 2, AXIS)

    def hold(self, name: str, where: Where, stiffness: float, x: str, y: str) -> None:
        """Springs of this stiffness per length on the selected outline, whose other ends move by imposed values."""
        own = self._own[name]
        sides = own.region(OUTLINE)
        middles = np.array([own.pts(own.pid_in_faces(side[:, None])).mean(axis=1) for side in sides.T])
        held = where(middles)
        own.set_region(HELD, sides[:, held])
        own.delete_region(OUTLINE)
        own.set_region(OUTLINE, sides[:, ~held])
        self._springs[name] = f"({stiffness!r}*([{x},{y}]-u_{name}))"
        self.model.add_nonlinear_term(self._rules[name], f"-{self._springs[name]}.Test_u_{name}", HELD)

    def holding_force(self, name: str) -> np.ndarray:
        """[2] force of the springs on the body."""
        return np.array([getfem.asm_generic(self._rules[name], 0, f"{self._springs[name]}({i})", HELD, self.model)
                         for i in (1, 2)])

    def press(self, name: str, plate: str, side: int) -> None:
        """Contact with a plate at y = the imposed value of its name, above (side 1) or below (-1)."""
        self.model.add_filtered_fem_variable(f"p_{name}", fields(self._own[name], 1, 2), OUTLINE)
        pressure = self._pressure(name, plate, side)
        self.model.add_nonlinear_term(self._rules[name], f"{side}*{pressure}*Test_u_{name}(2)"
                                      f"+({pressure}-p_{name})/{AUGMENTED}*Test_p_{name}", OUTLINE)

    def touch(self, slave: str, master: str, friction: float = 0.0) -> None:
        self.model.add_filtered_fem_variable(f"t_{slave}", fields(self._own[slave], 2, 1), OUTLINE)
        self.model.add_initialized_data("augmented", AUGMENTED)
        before = {name: [] for name in (slave, master)}
        options = []
        if friction > 0:
            self.model.add_initialized_data("friction", friction)
            self.model.add_initialized_data("rate", 1.0)
            options = ["friction", "rate"]
            for name in before:
                self.model.add_fem_data(f"w_{name}", self.model.mesh_fem_of_variable(f"u_{name}"))
                before[name] = [f"w_{name}"]
                self._slip_since.append(name)
        brick = self.model.add_integral_large_sliding_contact_brick_raytracing("augmented", REACH, *options)
        self.model.add_slave_contact_boundary_to_large_sliding_contact_brick(
            brick, self._rules[slave], OUTLINE, f"u_{slave}", f"t_{slave}", *before[slave])
        self.model.add_master_contact_boundary_to_large_sliding_contact_brick(
            brick, self._rules[master], OUTLINE, f"u_{master}", *before[master])

    def go(self, loads: list[dict[str, float]], steps: list[int],
           force: Callable[[], object]) -> tuple[np.ndarray, dict[str, np.ndarray]]:
        """Applies all loads; returns [loads x ...] forces, and by body [loads x nodes x 2] outlines."""
        forces, outlines = [], {name: [] for name in self.meshes}
        for imposed, count in zip(loads, steps):
            self.load(imposed, count)
            forces.append(force())
            for name, places in outlines.items():
                places.append(self.outline(name))
        return np.array(forces), {name: np.array(places) for name, places in outlines.items()}

    def load(self, imposed: dict[str, float], steps: int) -> None:
        """Advances from the last load in this number of steps, in halves where Newton's method fails."""
        before = dict(self._at)
        for share in np.linspace(0, 1, steps + 1)[1:]:
            self._move({name: (1 - share) * before[name] + share * value for name, value in imposed.items()}, HALVINGS)

    def _move(self, imposed: dict[str, float], halvings: int) -> None:
        before, kept = dict(self._at), self.model.from_variables()
        if self._solve(imposed):
            return
        if halvings == 0:
            raise NotConverged(f"from {before} to {imposed}")
        self.model.to_variables(kept)
        self._move({name: (before[name] + value) / 2 for name, value in imposed.items()}, halvings - 1)
        self._move(imposed, halvings - 1)

    def _solve(self, imposed: dict[str, float]) -> bool:
        for name, value in imposed.items():
            self.model.set_variable(name, value)
        _, converged = self.model.solve("max_res", RESIDUAL, "max_iter", ITERATIONS, "lsolver", "mumps",
                                        "lsearch", "simplest")
        if converged:
            self._at = dict(imposed)
            for name in self._slip_since:
                self.model.set_variable(f"w_{name}", self.model.variable(f"u_{name}"))
        return bool(converged)

    def plate_force(self, name: str, plate: str, side: int) -> float:
        """Force of the plate on the body's mesh, N/m."""
        return float(getfem.asm_generic(self._rules[name], 0, self._pressure(name, plate, side), OUTLINE, self.model))

    def _pressure(self, name: str, plate: str, side: int) -> str:
        gap = f"{side}*({plate}-X(2)-u_{name}(2))"
        return f"pos_part(p_{name}-{AUGMENTED}*({gap}))"

    def outline(self, name: str) -> np.ndarray:
        """[nodes x 2] current positions of the outline's nodes, along it."""
        mesh = self.meshes[name]
        places = mesh.points[mesh.order]
        moved = getfem.compute_interpolate_on(self.model.mesh_fem_of_variable(f"u_{name}"),
                                              self.model.variable(f"u_{name}"), places.T)
        return places + moved.T


def fields(own: getfem.Mesh, components: int, degree: int) -> getfem.MeshFem:
    field = getfem.MeshFem(own, components)
    field.set_fem(getfem.Fem(f"FEM_PK(2,{degree})"))
    return field


def as_getfem(mesh: Mesh) -> getfem.Mesh:
    """Mesh with the regions of the curve and of the axis x = 0."""
    own, kind = getfem.Mesh("empty", 2), getfem.GeoTrans("GT_PK(2,2)")
    for cell in mesh.cells[:, [0, 3, 1, 5, 4, 2]]:
        own.add_convex(kind, mesh.points[cell].T)
    faces, middles = own.outer_faces(), {tuple(np.round(p, 9)) for p in mesh.side_middles()}
    corners = own.pts()
    on_curve, on_axis = [], []
    for face in faces.T:
        places = corners[:, own.pid_in_faces(face[:, None])].T
        if any(tuple(np.round(p, 9)) in middles for p in places):
            on_curve.append(face)
        elif (np.abs(places[:, 0]) < PLAIN).all():
            on_axis.append(face)
    for region, chosen in ((OUTLINE, on_curve), (AXIS, on_axis)):
        if chosen:
            own.set_region(region, np.array(chosen).T)
    return own
