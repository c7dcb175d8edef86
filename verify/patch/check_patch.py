"""Patch test: loads of a uniform stress must cause a uniform strain."""

from __future__ import annotations

import numpy as np
import pytest
import ufl
from dolfinx import fem

from fem.compiled import compile_form
from fem.meshes import disc
from fem.solid import Material, Solid
from fem.statics import Minimiser
from pictures import COLOURS, describe, legend, panels, save, set_ticks
from pliant.frames import COMPLIANT, Frames
from squeeze import METHODS
from verification import Case, Label, Run

CASE = Case(__file__, fast=True)
MATERIAL = Material()
NODES = [168, 340, 700, 1400]
FINE = NODES[1:]  # at 168 the outline's curvature still matters
SIDE = {"square": 2.0, "disc": np.sqrt(np.pi)}  # of a square of the shape's area
# Scatter of errors between meshes, standard deviation of the logarithm: measured on eleven meshes of 5 % more or fewer
# nodes at each of FINE, root mean square of the three.
SCATTER = {"all": 0.035, "outline": 0.040, "middle": 0.076}
STRETCH = {"square": np.array([[1.2, 0.1], [0.1, 1.1]]), "disc": 0.9 * np.eye(2)}
CONSISTENT = [method for method in METHODS if method != "mls-gauss"]
COMPONENTS = {"xx": (0, 0), "yy": (1, 1), "xy": (0, 1)}


def strain(F: np.ndarray) -> np.ndarray:
    return (F.T @ F - np.eye(2)) / 2


def stress(F: np.ndarray) -> np.ndarray:
    """First Piola-Kirchhoff stress over mu: force per initial area."""
    G = np.linalg.inv(F).T
    return MATERIAL.mu * (F - G) + MATERIAL.lame * np.log(np.linalg.det(F)) * G


def scene(shape: str, method: str, nodes: int = 168) -> str:
    P = stress(STRETCH[shape])
    if shape == "disc":  # force P N per initial area, which F reduces to 0.9 of it
        return CASE.scene("disc.toml", method=method, nodes=nodes, pressure=float(-P[0, 0] / STRETCH[shape][0, 0]))
    across, along = np.hypot(*P[:, 0]), np.hypot(*P[:, 1])
    return CASE.scene("square.toml", method=method, nodes=nodes, across=float(across), along=float(along),
                      xx=float(P[0, 0]), yx=float(P[1, 0]), xy=float(P[0, 1]), yy=float(P[1, 1]))


def largest_error(run: Run, shape: str) -> float:
    """Largest error of the Green-Lagrange strain at all integration points."""
    expected = strain(STRETCH[shape])
    return max(abs(run.probe(f"{which}.strain_{name}")[-1] - expected[index])
               for which in ("least", "largest") for name, index in COMPONENTS.items())


@pytest.mark.parametrize("shape", STRETCH)
@pytest.mark.parametrize("method", CONSISTENT)
def test_uniform_strain(method: str, shape: str) -> None:
    run = CASE.engine(f"{shape}_{method}", scene(shape, method))
    CASE.check(Label.EXACT, f"engine, {method}, {shape}: error of the strain", largest_error(run, shape), 0, 1e-12,
               "conditioning of the consistent gradients 1e-12; motion decays to exp(-1.5 x 28)")
    run = by_reference(shape, method)
    bounds = [run.probe(f"{which}_jacobian.jacobian")[-1] for which in ("least", "largest")]
    error = np.abs(np.array(bounds) / np.linalg.det(STRETCH[shape]) - 1).max()
    CASE.check(Label.EXACT, f"reference, {method}, {shape}: error of J", error, 0, 1e-11,
               "conditioning of its gradients 1e-11; Newton to 1e-13 of the forces")


def by_reference(shape: str, method: str) -> Run:
    return CASE.reference(f"{shape}_{method}_reference", scene(shape, method), "--static", "--dt", "1",
                          "--tolerance", "1e-13", "--pseudo-inertia", "1e-6")


def cell_errors(run: Run, shape: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points, triangles and norms of the error of each triangle's mean strain; single precision."""
    frames = Frames(run.folder / "frames.h5", None)
    grid, last = frames.grids["bodies"], len(frames.times) - 1
    cells = grid.cells[grid.kind == COMPLIANT]
    found = np.array([frames.field("bodies", last, f"strain_{name}") for name in COMPONENTS])
    expected = np.array([strain(STRETCH[shape])[index] for index in COMPONENTS.values()])
    weights = np.array([1, 1, 2])[:, None]  # xy counts as yx too
    return frames.positions("bodies", last), cells, np.sqrt((weights * (found - expected[:, None]) ** 2).sum(axis=0))


@pytest.fixture(scope="module")
def flawed() -> dict[str, dict[int, Run]]:
    """The engine with `mls-gauss`, three points per triangle, by shape and nodes."""
    def run(shape: str, nodes: int) -> Run:
        return CASE.engine(f"{shape}_mls-gauss_{nodes}", scene(shape, "mls-gauss", nodes))

    return {shape: {nodes: run(shape, nodes) for nodes in NODES} for shape in STRETCH}


def part_of(run: Run, part: str) -> np.ndarray:
    """Mask of the triangles: all, those with a node on the outline, or those within half of the radius."""
    frames = Frames(run.folder / "frames.h5", None)
    grid, points = frames.grids["bodies"], frames.positions("bodies", 0)
    cells = grid.cells[grid.kind == COMPLIANT]
    if part == "middle":
        return np.hypot(*points[cells].mean(axis=1)[:, :2].T) < 0.5
    edges, count = np.unique(np.sort(cells[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)), axis=0, return_counts=True)
    return np.isin(cells, edges[count == 1]).any(axis=1) if part == "outline" else np.ones(len(cells), dtype=bool)


def root_mean_square(run: Run, shape: str, part: str = "all") -> float:
    """Root mean square of the triangles' errors, over the strain."""
    errors = cell_errors(run, shape)[2][part_of(run, part)]
    return float(np.sqrt(np.mean(errors**2)) / np.linalg.norm(strain(STRETCH[shape])))


FLAWS = [("square", "all", 1, "the error does not decrease at corners, a share h^2 of the area"),
         ("disc", "outline", 0, "the quadrature error there scales with the mesh"),
         ("disc", "middle", 1.5, "1/h random loads along the outline without resultant, each a stress on an area h^2: "
          "the root of 1/h (h^2)^2")]


@pytest.mark.parametrize("shape, part, order, why", FLAWS, ids=lambda value: value if isinstance(value, str) else "")
def test_known_flaw(flawed: dict, shape: str, part: str, order: float, why: str) -> None:
    """Quadrature with three points does not integrate the gradients of moving least squares exactly."""
    found = [root_mean_square(flawed[shape][nodes], shape, part) for nodes in FINE]
    spacings = np.array([SIDE[shape] * nodes**-0.5 for nodes in FINE])
    CASE.check_rate(f"mls-gauss, {shape}, {part}: rms error of the strain in h", list(spacings), found, order,
                    3 * SCATTER[part] / np.sqrt(len(FINE)) / np.log(spacings).std(),
                    f"{why}; three standard errors of the slope, by the scatter of meshes")


@pytest.mark.parametrize("shape", STRETCH)
def test_flaw_is_the_method_s(flawed: dict, shape: str) -> None:
    run, other = flawed[shape][168], by_reference(shape, "mls-gauss")
    for which in ("least", "largest"):
        ratio = other.probe(f"{which}_jacobian.jacobian")[-1] / run.probe(f"{which}_jacobian.jacobian")[-1]
        CASE.check(Label.INDEPENDENT, f"mls-gauss, {shape}: {which} J, reference over engine", ratio, 1, 1e-9,
                   "the same tables to 1e-11; conditioning of the equilibrium")


def finite_elements(shape: str) -> Solid:
    """A disc of curved triangles under the traction P N, with translation and rotation fixed at exact positions."""
    F = STRETCH[shape]
    solid = Solid(disc(4), MATERIAL)
    traction = ufl.dot(ufl.as_matrix(stress(F).tolist()), ufl.FacetNormal(solid.domain))
    held = []
    for place, axis in (((0, 0), 0), ((0, 0), 1), ((1, 0), 1)):
        value = float(((F - np.eye(2)) @ place)[axis])
        held.append(fem.dirichletbc(value, solid.component_at(place, axis), solid.space.sub(axis)))
    potential = solid.strain_energy() - ufl.inner(traction, solid.u) * solid.ds
    Minimiser(potential, solid.u, held).solve()
    return solid


@pytest.mark.parametrize("shape", STRETCH)
def test_finite_elements(shape: str) -> None:
    solid = finite_elements(shape)
    error = solid.deformation_gradient(solid.u) - ufl.as_matrix(STRETCH[shape].tolist())
    rms = np.sqrt(fem.assemble_scalar(compile_form(ufl.inner(error, error) * solid.dx)) / np.pi)
    CASE.check(Label.EXACT, f"finite elements, strain of the {shape}: rms error of F", rms, 0, 1e-12,
               "curved triangles contain linear displacements; Newton's method")


def test_picture(flawed: dict) -> None:
    figure, axes = panels(3, "mls-gauss, 3 points: error of the strain over the strain (others: 1e-14)", across=True)
    for panel, shape in zip(axes, STRETCH):
        points, cells, error = cell_errors(flawed[shape][340], shape)
        relative = np.maximum(error / np.linalg.norm(strain(STRETCH[shape])), 1e-5)
        colours = panel.tripcolor(*points[:, :2].T, cells, np.log10(relative), cmap="viridis", vmin=-4, vmax=0)
        figure.colorbar(colours, ax=panel, shrink=0.7, label="decimal logarithm")
        panel.set_aspect("equal")
        panel.grid(False)
        panel.set_title(f"{shape}, 340 nodes", fontsize=10, loc="left")
    for (shape, part, order, _), colour, marker in zip(FLAWS, COLOURS, "os^"):
        found = [root_mean_square(flawed[shape][nodes], shape, part) for nodes in NODES]
        axes[2].loglog(NODES, found, marker=marker, color=colour, label=f"{shape}, {part}")
        slope = found[-1] * (np.array(NODES) / NODES[-1]) ** (-order / 2)
        axes[2].loglog(NODES, slope, ":", color=colour, label=f"slope {order} in h")
    set_ticks(axes[2], NODES, [str(nodes) for nodes in NODES])
    describe(axes[2], "rms error", "nodes")
    legend(axes[2])
    save(CASE, figure, "patch")
