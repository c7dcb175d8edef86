"""Locking: a nearly incompressible disc (nu = 0.49) between two plates, by all methods, compared with nu = 0.4."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from dolfinx.fem import Function, dirichletbc
from matplotlib.axes import Axes
from scipy.spatial import cKDTree

from fem.meshes import create
from fem.plates import Plates, hertz_force, hertz_half_width
from fem.solid import Material, Solid
from fem.statics import Minimiser
from motion import SINGLE, Motion, read_motion
from pictures import COLOURS, MARKERS, describe, draw_rate, draw_ratios, legend, panels, save, set_ticks
from squeeze import LONG_PAUSE, OUTLINE, METHODS, Rests, Squeeze, both_ways, by_reference, worst_over_reference
from verification import FULL, Case, Label

CASE = Case(__file__, long=True, cost=2)
NODES = [168, 340, 700, 1400] if FULL else [168, 340, 700]
APPROACHES = (0.05, 0.0625, 0.075, 0.0875, 0.1)
RATIOS = [0.4, 0.49]
STIFFNESS = 3e3  # of the contact, mu / R
LINEAR, SQUARE, CUBIC = 1, 2, 3  # degrees of finite elements
ELEMENTS_ERROR = 3e-4  # of quadratic ones
# Tolerance of forces on the same nodes in frames: as SAME_NODES of modes, for a disc that extends to x = 3.
ROUNDED_NODES = 3 * SINGLE / np.sqrt(np.pi / 168) * np.sqrt(49 / 2)
NEAR_A_PLATE = 0.8  # of the radius: the half width of a contact at 10 % is 0.4, up to 0.92 of it
FRAMES = f'\n[frames]\nperiod = {LONG_PAUSE}\nfields = ["displacement"]\n'


def by_elements(approach: float, poisson: float, degree: int, rings: int = 12, edges: int = 6) -> float:
    """Force with the engine's penalty."""
    material = Material.of_poisson(poisson)
    width = hertz_half_width(hertz_force(approach, material), material)
    return Plates(material, rings, width, edges, degree).squeeze(approach, STIFFNESS).force


@pytest.fixture(scope="module")
def elements() -> dict[float, np.ndarray]:
    """[approaches] by Poisson's ratio."""
    return {poisson: np.array([by_elements(D, poisson, SQUARE) for D in APPROACHES]) for poisson in RATIOS}


@pytest.fixture(scope="module")
def runs() -> dict[float, dict[str, dict[int, list[Rests]]]]:
    """By Poisson's ratio, method and nodes, with corners and with facets at the poles."""
    return {poisson: {method: {nodes: both_ways(CASE, squeeze(poisson, method, nodes)) for nodes in NODES}
                      for method in METHODS} for poisson in RATIOS}


@pytest.fixture(scope="module")
def references() -> dict[str, Rests]:
    """By method, nu = 0.49, 168 nodes, corners at the poles."""
    return {method: by_reference(CASE, squeeze(0.49, method, 168)) for method in METHODS}


def squeeze(poisson: float, method: str, nodes: int) -> Squeeze:
    return Squeeze(APPROACHES, method, nodes, stiffness=STIFFNESS, poisson=poisson)


def rms_errors(sizes: dict[int, list[Rests]], elements: np.ndarray) -> np.ndarray:
    """[sizes] rms errors of the force, over approaches and both orientations."""
    found = [[rests.force / elements - 1 for rests in both] for both in sizes.values()]
    return np.sqrt(np.mean(np.square(found), axis=(1, 2)))


def spacings(nodes: list[int]) -> list[float]:
    return [2 * np.pi / OUTLINE[count] for count in nodes]


def test_finite_elements_agree() -> None:
    """Quadratic triangles do not lock: cubic ones and a finer mesh give the same force."""
    forces = [by_elements(0.1, 0.49, *choice) for choice in ((SQUARE, 12, 6), (SQUARE, 24, 12), (CUBIC, 12, 6))]
    for name, force in zip(("a finer mesh", "cubic triangles"), forces[1:]):
        CASE.check(Label.INDEPENDENT, f"finite elements: quadratic triangles over {name} at 10 %", forces[0] / force, 1,
                   ELEMENTS_ERROR, "the contact's edge lies within an element: second order of six edges in the half "
                   "width")


@pytest.mark.parametrize("method", [method for method in METHODS if method != "t3"])
def test_does_not_lock(runs: dict, elements: dict, method: str) -> None:
    CASE.check_rate(f"{method}: error of the force in h at nu = 0.49", spacings(NODES),
                    list(rms_errors(runs[0.49][method], elements[0.49])), 3, 1.2,
                    "from 2, as at nu = 0.4, to 4: an unavoidable dilation of order h^2 costs lambda h^4; 0.2 for ten "
                    "samples of a saw tooth")


def test_linear_triangles_lock(runs: dict, elements: dict) -> None:
    found = rms_errors(runs[0.49]["t3"], elements[0.49])[:3]
    CASE.check_rate("t3: error of the force in h at nu = 0.49", spacings(NODES[:3]), list(found), 1, 1,
                    "between no convergence (two triangles per node preserve their areas: no freedom left) and order 2 "
                    "for h^2 lambda / mu << 1: here 0.8 to 0.2")


@pytest.mark.parametrize("facet", [False, True], ids=["corner", "facet"])
def test_linear_triangles_of_dolfinx_lock_alike(facet: bool) -> None:
    """On the engine's own nodes: those near the plates are fixed at the engine's positions, the others are in
    equilibrium, and the reactions give the force on a plate."""
    chosen = replace(squeeze(0.49, "t3", 168), facet=facet).at_full_rest()
    run = CASE.engine(f"{chosen.name()}_frames", chosen.scene(CASE) + FRAMES)
    rests = Rests(chosen, run)
    off = rests.force / forces_of_linear_triangles(read_motion(run), 0.49) - 1
    allowed = rests.unrest() + ROUNDED_NODES
    worst = (np.abs(off) / allowed).argmax()
    CASE.check(Label.INDEPENDENT, f"t3, {'facet' if facet else 'corner'} at the poles: force over that of dolfinx's "
               "linear triangles on these nodes - 1", off[worst], 0, allowed[worst],
               "the same triangles; force of residual motion, from its kinetic energy; nodes in single precision "
               "change gradients by 1e-6, energies by that x root of lambda/(2 mu)")


def forces_of_linear_triangles(motion: Motion, poisson: float) -> np.ndarray:
    """[frames but the first] force on a plate."""
    start = motion.positions[0]
    solid = Solid(create(start, motion.triangles, LINEAR), Material.of_poisson(poisson), LINEAR)
    node = cKDTree(start).query(solid.space.tabulate_dof_coordinates()[:, :2])[1]
    from_centre = (start - start.mean(axis=0))[node]
    rim = np.hypot(*from_centre.T) > 1 - 1 / np.sqrt(len(start))
    held = np.flatnonzero(rim & (np.abs(from_centre[:, 1]) > NEAR_A_PLATE)).astype(np.int32)
    places = Function(solid.space)
    minimiser = Minimiser(solid.strain_energy(), solid.u, [dirichletbc(places, held)])

    def force(displacements: np.ndarray) -> float:
        places.x.array[:] = solid.u.x.array[:] = displacements[node].ravel()
        minimiser.solve()
        reactions = minimiser.reaction().reshape(-1, 2)[held, 1]
        return float(np.abs(reactions[from_centre[held, 1] > 0].sum()))

    return np.array([force(displacements) for displacements in motion.displacements[1:]])


@pytest.mark.parametrize("method", METHODS)
def test_engine_against_reference(references: dict[str, Rests], method: str) -> None:
    forces = dict(zip(APPROACHES, references[method].force))
    ratio, allowed = worst_over_reference(CASE, squeeze(0.49, method, 168), forces)
    CASE.check(Label.INDEPENDENT, f"{method}, nu = 0.49: engine over reference, the worst", ratio, 1, allowed,
               "as in plates: force of residual motion, from its kinetic energy; Newton's method")


def test_picture(runs: dict, references: dict[str, Rests], elements: dict) -> None:
    figure, axes = panels(3, "Disc between plates, 5 to 10 %: force", across=True)
    for panel, poisson in zip(axes, RATIOS):
        draw_convergence(panel, runs[poisson], elements[poisson], poisson)
    draw_ratios(axes[2], 100 * np.array(APPROACHES), {method: runs[0.49][method][168][0].force for method in METHODS},
                {method: rests.force for method, rests in references.items()}, elements[0.49], ELEMENTS_ERROR)
    axes[2].set_title("nu = 0.49, 168 nodes: over finite elements, less 1 [%]", fontsize=10, loc="left")
    for panel in axes:
        legend(panel)
    save(CASE, figure, "locking")


def draw_convergence(axes: Axes, runs: dict[str, dict[int, list[Rests]]], elements: np.ndarray, poisson: float) -> None:
    for method, colour, marker in zip(METHODS, COLOURS, MARKERS):
        found = 100 * rms_errors(runs[method], elements)
        locks = ", locks" if (method, poisson) == ("t3", 0.49) else ""
        draw_rate(axes, spacings(NODES), found, method + locks, colour, marker)
    ends = np.array([min(spacings(NODES)), max(spacings(NODES))])
    axes.loglog(ends, 0.15 * (ends / ends[0]) ** 2, "--", color=COLOURS[6], linewidth=1.0, label="slope 2")
    set_ticks(axes, spacings(NODES), [f"{h:.3f}" for h in spacings(NODES)])
    axes.set_ylim(0.1, 30)
    describe(axes, f"nu = {poisson}: rms error over finite elements [%]", "node distance of the outline over R")
