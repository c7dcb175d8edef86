"""Disc between two frictionless plates up to 30 %: engine, reference solver, finite elements, Hertz."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.axes import Axes

from fem.plates import Plates, Squeezed, hertz_force, hertz_half_width
from fem.solid import Material
from oracle_tables import read_oracle
from pictures import COLOURS, MARKERS, describe, draw_rate, draw_ratios, legend, panels, save, set_ticks
from squeeze import (OUTLINE, METHODS, Rests, Squeeze, both_ways, by_engine, by_reference, to_rigid_contact,
                     to_zero_spacing, worst_over_reference)
from verification import FULL, Case, Label

CASE = Case(__file__)
# The cheapest method has the largest error and gets one more size.
SIZES = {method: [168, 340, 700] + ([1400] if FULL or method == "t3" else []) for method in METHODS}
APPROACHES = tuple(np.round(0.025 * np.arange(1, 13), 3))
COMPARED = (0.05, 0.1, 0.2, 0.3)  # compared with the reference, after a long pause each
CHECKED = np.array(APPROACHES) >= 0.05
SOFT, STIFF = 3e3, 12e3  # contact stiffness, mu / R
STIFFNESSES = [1e3, 2e3, 4e3, 8e3]
ACCEPTED = 0.003
ELEMENTS_ERROR, LIMIT_ERROR = 1.5e-4, 2e-3  # of finite elements; of the saw tooth remaining after extrapolation
MATERIAL = Material()
ORACLE = read_oracle("disc_between_plates")


@pytest.fixture(scope="module")
def squeezed() -> list[Squeezed]:
    """By approach, finite elements with the engine's own penalty: the same problem except for the mesh."""
    widths = [hertz_half_width(hertz_force(D, MATERIAL), MATERIAL) for D in APPROACHES]
    return [Plates(MATERIAL, 12, width, 6).squeeze(D, SOFT) for D, width in zip(APPROACHES, widths)]


@pytest.fixture(scope="module")
def elements(squeezed: list[Squeezed]) -> np.ndarray:
    """[approaches] forces."""
    return np.array([squeeze.force for squeeze in squeezed])


@pytest.fixture(scope="module")
def runs() -> dict[str, dict[int, list[Rests]]]:
    """By method and nodes, in both orientations."""
    return {method: {nodes: both_ways(CASE, Squeeze(APPROACHES, method, nodes)) for nodes in SIZES[method]}
            for method in METHODS}


@pytest.fixture(scope="module")
def references() -> dict[str, Rests]:
    """By method, 168 nodes, corners at the poles."""
    return {method: by_reference(CASE, Squeeze(APPROACHES, method)) for method in METHODS}


@pytest.fixture(scope="module")
def stiff() -> dict[int, list[Rests]]:
    return {nodes: both_ways(CASE, Squeeze(APPROACHES, "mls", nodes, stiffness=STIFF)) for nodes in SIZES["mls"]}


def mean(both: list[Rests]) -> np.ndarray:
    """[approaches] mean force of both orientations."""
    return np.mean([rests.force for rests in both], axis=0)


def errors(both: list[Rests], elements: np.ndarray) -> np.ndarray:
    """[2 x approaches checked] force errors against finite elements with the same penalty."""
    return np.array([rests.force / elements - 1 for rests in both])[:, CHECKED]


@pytest.mark.parametrize("method", METHODS)
def test_convergence_in_node_distance(runs: dict, elements: np.ndarray, method: str) -> None:
    found = rms_errors(runs[method], elements)
    CASE.check_rate(f"{method}: error of the force in h", spacings(runs[method]), found, 2, 0.4,
                    "second order of triangles, outline and contact edge; 1.5 to 3 node spacings in the half width at "
                    "5 %, where errors are largest, and 22 samples of a saw tooth")
    limit = (at_zero_spacing(runs[method]) / elements)[CHECKED]
    CASE.check(Label.INDEPENDENT, f"{method}: force at h = 0 over finite elements", worst(limit), 1, ACCEPTED,
               "dolfinx, same penalty, 1.5e-4; saw tooth of the contact edges, halved by two orientations")


def rms_errors(sizes: dict[int, list[Rests]], elements: np.ndarray) -> list[float]:
    return [float(np.sqrt(np.mean(errors(both, elements) ** 2))) for both in sizes.values()]


def spacings(sizes: dict[int, list[Rests]]) -> list[float]:
    return [2 * np.pi / OUTLINE[nodes] for nodes in sizes]


def at_zero_spacing(sizes: dict[int, list[Rests]]) -> np.ndarray:
    return to_zero_spacing(list(sizes), [mean(both) for both in sizes.values()])


def worst(ratios: np.ndarray) -> float:
    return float(ratios[np.abs(ratios - 1).argmax()])


def test_convergence_in_contact_stiffness() -> None:
    stiffnesses = [*STIFFNESSES, 2 * STIFFNESSES[-1]]
    forces = [by_engine(CASE, Squeeze(APPROACHES, stiffness=k)).force[CHECKED] for k in stiffnesses]
    changes = [((b - a) / b).mean() for a, b in zip(forces, forces[1:])]
    CASE.check_rate("change of the force from k to 2 k in 1 / k", [1 / k for k in STIFFNESSES], changes, 1, 0.02,
                    "penetration p / k; the next term is smaller by penetration over D, 2e-4 / 0.05")


def limits(runs: dict, stiff: dict) -> np.ndarray:
    """[approaches] force of `mls` in rigid contact at zero node spacing."""
    rigid = [to_rigid_contact(mean(runs["mls"][nodes]), mean(stiff[nodes]), STIFF / SOFT) for nodes in stiff]
    return to_zero_spacing(list(stiff), rigid)


def test_force_against_the_oracle(runs: dict, stiff: dict) -> None:
    found = dict(zip(APPROACHES, limits(runs, stiff)))
    names = ("approach_over_diameter", "force_over_muR", "relative_error")
    for D, force, error in zip(*(ORACLE[name] for name in names)):
        if D >= 0.05:
            CASE.check(Label.INDEPENDENT, f"mls: force at {100 * D:g} %, h = 0, rigid contact, over the oracle",
                       found[D] / force, 1, ACCEPTED, f"oracle {error:.1g}; saw tooth 2e-3, its extrapolation 1e-3")


@pytest.mark.parametrize("method", METHODS)
def test_energy_of_the_disc(runs: dict, squeezed: list[Squeezed], method: str) -> None:
    strain = [np.mean([rests.strain for rests in both], axis=0) for both in runs[method].values()]
    ratios = to_zero_spacing(SIZES[method], strain) / [squeeze.strain_energy for squeeze in squeezed]
    CASE.check(Label.INDEPENDENT, f"{method}: strain energy at h = 0 over finite elements", worst(ratios[CHECKED]), 1,
               ACCEPTED, "dolfinx, same penalty, 1.5e-4; work of the force, with the same accuracy")


@pytest.mark.parametrize("facet", [False, True], ids=["corner", "facet"])
def test_work_is_force_times_way(facet: bool) -> None:
    middles, step = (0.1, 0.2, 0.3), 0.001
    rests = by_engine(CASE, Squeeze(tuple(D + i * step for D in middles for i in (-1, 0, 1)), facet=facet))
    lie = "facet" if facet else "corner"
    for i, D in enumerate(middles):
        part = slice(3 * i, 3 * i + 3)
        force, stored = rests.force[part], rests.stored[part]
        work, chord = (2 * step * np.dot(weights, force) for weights in ([1 / 3, 4 / 3, 1 / 3], [0.5, 1, 0.5]))
        unrest = np.sqrt((rests.kinetic[part] / stored).max())
        CASE.check(Label.EXACT, f"stored energy over work around {100 * D:g} %, {lie} at the pole",
                   (stored[2] - stored[0]) / work, 1, abs(work - chord) / work + unrest,
                   "Simpson's rule on the force, its difference from the trapezoidal one; residual motion")


@pytest.mark.parametrize("method", METHODS)
def test_engine_against_reference(references: dict[str, Rests], method: str) -> None:
    forces = dict(zip(APPROACHES, references[method].force))
    ratio, allowed = worst_over_reference(CASE, Squeeze(COMPARED, method), forces)
    CASE.check(Label.INDEPENDENT, f"{method}: engine over reference, the worst", ratio, 1, allowed,
               "force of residual motion, from its kinetic energy by Cauchy and Schwarz; Newton's method")


def test_at_rest_and_balanced(runs: dict) -> None:
    every = [rests for method in runs.values() for both in method.values() for rests in both]
    kinetic = max((rests.kinetic / rests.strain).max() for rests in every)
    CASE.check(Label.EXACT, "kinetic over strain energy at rest, all runs", kinetic, 0, 1e-6,
               "the slowest motion, rotation on the springs at the poles, decays by exp(-1.5 t) over 5.5 s: 7e-8, and "
               "as much again for the plates' excitation")
    uneven = max(np.abs((rests.upper - rests.lower) / rests.force)[CHECKED].max() for rests in every)
    CASE.check(Label.EXACT, "upper less lower force, all runs", uneven, 0, 1e-3, "balance; root of the kinetic energy")
    places = max(np.abs(rests.gap - 2 * (1 - np.array(APPROACHES))).max() for rests in every)
    CASE.check(Label.EXACT, "gap of the plates, all runs", places, 0, 1e-12, "imposed motion; rounding")
    held = max((rests.boundary / rests.strain)[CHECKED].max() for rests in every)
    CASE.check(Label.EXACT, "energy of the springs at the poles, all runs", held, 0, 1e-3,
               "their share is at most a third of the accepted error")


def test_hertz(runs: dict) -> None:
    """The closed form for small approaches."""
    force = at_zero_spacing(runs["mls"])
    CASE.check(Label.INDEPENDENT, "mls: force at 2.5 % over Hertz", force[0] / hertz_force(APPROACHES[0], MATERIAL), 1,
               0.02, "linear theory to 1.2e-3; at 168 nodes three of them touch: 5 % too much, mostly removed by h^2")


def test_picture(runs: dict, stiff: dict, references: dict[str, Rests], elements: np.ndarray) -> None:
    figure, axes = panels(4, "Disc between plates", across=True)
    draw_forces(axes[0], runs, 100 * np.array(APPROACHES))
    draw_checked_ratios(axes[1], {method: runs[method][168][0].force for method in METHODS},
                        {method: rests.force for method, rests in references.items()}, elements)
    axes[1].set_title("168 nodes, corner at the pole: over FEM, less 1 [%]", fontsize=10, loc="left")
    draw_checked_ratios(axes[2], {method: mean(runs[method][700]) for method in METHODS}, {}, elements)
    draw_limits(axes[2], limits(runs, stiff))
    axes[2].axhspan(-100 * ACCEPTED, 100 * ACCEPTED, color="0.9")
    axes[2].set_title("700 nodes, both orientations: over FEM, less 1 [%]", fontsize=10, loc="left")
    draw_convergence(axes[3], runs, elements)
    for panel in axes:
        legend(panel)
    save(CASE, figure, "plates")


def draw_checked_ratios(axes: Axes, engine: dict, references: dict, elements: np.ndarray) -> None:
    checked = [{method: force[CHECKED] for method, force in forces.items()} for forces in (engine, references)]
    draw_ratios(axes, 100 * np.array(APPROACHES)[CHECKED], *checked, elements[CHECKED], ELEMENTS_ERROR)


def draw_limits(axes: Axes, forces: np.ndarray) -> None:
    oracle = dict(zip(ORACLE["approach_over_diameter"], ORACLE["force_over_muR"]))
    found = {D: 100 * (force / oracle[D] - 1) for D, force in zip(APPROACHES, forces) if D in oracle and D >= 0.05}
    axes.errorbar(100 * np.array(list(found)), list(found.values()), 100 * LIMIT_ERROR, fmt="k*", capsize=3,
                  label="mls, h = 0, rigid contact")


def draw_forces(axes: Axes, runs: dict, percent: np.ndarray) -> None:
    fine = 0.001 * np.arange(1, 301)
    axes.plot(100 * fine, [hertz_force(D, MATERIAL) for D in fine], ":", color=COLOURS[6], label="Hertz")
    axes.plot(100 * ORACLE["approach_over_diameter"], ORACLE["force_over_muR"], "-", color="0.3",
              label="finite elements")
    for method, colour, marker in zip(METHODS, COLOURS, MARKERS):
        axes.plot(percent, mean(runs[method][168]), marker, markersize=4, fillstyle="none", color=colour,
                  label=f"{method}, 168 nodes")
    describe(axes, "force on a plate over mu R", "approach over the diameter [%]")


def draw_convergence(axes: Axes, runs: dict, elements: np.ndarray) -> None:
    for method, colour, marker in zip(METHODS, COLOURS, MARKERS):
        steps, found = spacings(runs[method]), 100 * np.array(rms_errors(runs[method], elements))
        draw_rate(axes, steps, found, method, colour, marker)
    ticks = spacings(runs["t3"])
    axes.loglog(ticks, 0.1 * (np.array(ticks) / ticks[-1]) ** 2, "--", color=COLOURS[6], linewidth=1.0, label="slope 2")
    set_ticks(axes, ticks, [f"{h:.3f}" for h in ticks])
    describe(axes, "5 to 30 %, corners and facets at the poles", "node distance of the outline over R",
             "rms error of the force [%]")
