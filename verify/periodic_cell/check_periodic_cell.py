"""Squares that fill a cell with two periods and hold to each other: the stress of the cell, its work, and its motion
 under a given stress, against the law of its material. Discs: damped motion against the reference's statics."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from verification import Case, Label, Run

CASE = Case(__file__, fast=True)

MU, LAMBDA = 1.0, 4.0  # of E = 2.8 and nu = 0.4
STIFFNESS, SPACING = 2000.0, 0.0625
LOADED, END = 8.0, 16.0  # the wave crosses the square in 0.4
PERIOD = 0.02
SIDE = 0.5  # of a square
PLACES = [[0.25, 0.25], [0.75, 0.25], [0.25, 0.75], [0.75, 0.75]]
IMAGES = [[3.25, -1.75], [0.75, 2.25], [-0.75, 0.75], [0.75, -3.25]]  # of the same
# Four squares meet at a corner, where the last spacing of a side may bear half of its traction.
CORNERS = SPACING / (2 * SIDE)
STRAINS = {
    "compressed": ((0.93, 0.0), (0.0, 0.96)),
    "sheared": ((0.97, 0.05), (0.0, 0.97)),
    "turned": ((0.97, 0.04), (-0.04, 0.97)),
}

# Discs, deformed slowly (a wave crosses one in 0.5) and left to come to rest; static steps of a fortieth of that.
NODES, RAMP, REST, STATIC_STEP = 60, 40.0, 80.0, 1.0
SHORTENING = 0.05
DISCS = {
    "pressed": ((1 - SHORTENING, 0.0), (0.0, 1 - SHORTENING)),
    "pressed and sheared": ((1 - SHORTENING, 0.03), (0.0, 1 - SHORTENING)),
}
# Both solvers turn the discs by other parts of a facet. The width of a contact of two discs then lies within twice the
# sagitta R (pi/n)^2/2 of a facet, R = 1/2. Half of that range, over the approach, is the error of forces. The approach
# is the shortening times the diameter.
FACETS = (np.pi / NODES)**2 / 2 / SHORTENING / 2


def neo_hookean(gradient: np.ndarray) -> np.ndarray:
    """Cauchy stress."""
    j = np.linalg.det(gradient)
    return (MU * (gradient @ gradient.T - np.eye(2)) + LAMBDA * np.log(j) * np.eye(2)) / j


def histories(gradient: np.ndarray, loaded: float = LOADED) -> str:
    names = (("xx", "xy"), ("yx", "yy"))
    return "\n".join(f"{names[i][k]} = [[0, {float(i == k)}], [{loaded}, {gradient[i][k]}]]"
                     for i in range(2) for k in range(2))


@cache
def run(name: str, cell: str, elsewhere: bool = False) -> Run:
    return CASE.engine(name, CASE.scene(end=END, cell=cell, viscosity=0.2, spacing=SPACING, stiffness=STIFFNESS,
                                        positions=IMAGES if elsewhere else PLACES, period=PERIOD))


def tensor(of: Run, name: str) -> np.ndarray:
    """[samples x 2 x 2]"""
    xx, xy, yx, yy = (of.probe(f"{name}_{component}") for component in ("xx", "xy", "yx", "yy"))
    return np.moveaxis(np.array([[xx, xy], [yx, yy]]), 2, 0)


@pytest.mark.parametrize("name", STRAINS)
def test_stress_of_the_material(name: str) -> None:
    gradient = np.array(STRAINS[name])
    found, expected = tensor(run(name, histories(gradient)), "cell.stress")[-1], neo_hookean(gradient)
    size = float(np.linalg.norm(expected))
    # Sides give way by stress over stiffness, on the length of a square: that strain times the largest modulus.
    tolerance = CORNERS + (LAMBDA + 2 * MU) / (SIDE * STIFFNESS)
    for i, k in ((0, 0), (0, 1), (1, 0), (1, 1)):
        CASE.check(Label.EXACT, f"{name}: stress {'xy'[i]}{'xy'[k]} over the norm", found[i, k] / size,
                   expected[i, k] / size, tolerance,
                   "neo-Hookean law at the cell's gradient; half of the traction missing near corners, contact stiffness")


@pytest.mark.parametrize("name", STRAINS)
def test_work_of_the_cell(name: str) -> None:
    of = run(name, histories(np.array(STRAINS[name])))
    t, stress, gradient = of.times("cell.stress_xx"), tensor(of, "cell.stress"), tensor(of, "strain.gradient")
    rate = np.gradient(gradient, t, axis=0)
    power = of.probe("strain.cell_area") * np.einsum("tij,tij->t", stress, rate @ np.linalg.inv(gradient))
    there = t <= LOADED
    work = float(np.sum(0.5 * (power[there][1:] + power[there][:-1]) * np.diff(t[there])))
    done = of.probe("works.work_of_loads")
    # The matter moves with the cell at first: kinetic energy m (rate^2)/24 a component, which goes back at the end.
    kinetic = float(np.sum((np.array(STRAINS[name]) - np.eye(2))**2)) / LOADED**2 / 24
    CASE.check(Label.EXACT, f"{name}: work of the cell over that of its stress", done[-1] / work, 1,
               0.01 + 4 * kinetic / work,
               "area stress : velocity gradient; inertia of the grain at both ends of the ramp, trapezoidal rule")


def test_any_image() -> None:
    gradient = np.array(STRAINS["sheared"])
    here = tensor(run("sheared", histories(gradient)), "cell.stress")
    far = tensor(run("far", histories(gradient), True), "cell.stress")
    CASE.check(Label.EXACT, "stress of other images: largest difference", float(np.abs(far - here).max()), 0, 1e-7,
               "the same cell; the bound of the step is from differences over 1e-6 of a spacing, in which positions of 4 "
               "are rounded by 1e-8, and so is the error of steps")


def test_given_stress() -> None:
    of = run("given", f"stress_xx = [[0, 0], [{LOADED / 4}, -0.3]]\nyy = [[0, 1], [{LOADED / 4}, 0.97]]\ninertia = 0.3")
    stress, gradient = tensor(of, "cell.stress"), tensor(of, "strain.gradient")
    late = of.times("cell.stress_xx") > 0.75 * END
    CASE.check(Label.EXACT, "given stress: found over given", float(stress[late, 0, 0].mean()) / -0.3, 1, 0.01,
               "the cell comes to rest where they agree")
    low, high = 0.5, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if neo_hookean(np.diag([middle, 0.97]))[0, 0] < -0.3 else (low, middle)
    # The stretch along y makes a part of the stress; all of it has the error of corners and contacts.
    share = (LAMBDA + 2 * MU) * (1 - low) / 0.3
    CASE.check(Label.EXACT, "given stress: shortening over that of the law",
               (1 - float(gradient[late, 0, 0].mean())) / (1 - low), 1,
               (CORNERS + (LAMBDA + 2 * MU) / (SIDE * STIFFNESS)) / share,
               "neo-Hookean law; half of the traction missing near corners, contact stiffness")
    CASE.check(Label.EXACT, "given stretch beside it", float(gradient[-1, 1, 1]), 0.97, 1e-12, "the history")


@pytest.mark.parametrize("name", DISCS)
def test_discs_at_rest(name: str) -> None:
    gradient = np.array(DISCS[name])
    text = CASE.scene("discs.toml", end=REST, nodes=NODES, cell=histories(gradient, RAMP))
    run_name = name.replace(" ", "_")
    engine = CASE.engine(f"discs_{run_name}", text)
    reference = CASE.reference(f"discs_{run_name}_reference", text, "--static", "--dt", str(STATIC_STEP))
    pressures = [float(one.probe("cell.pressure")[-1]) for one in (engine, reference)]
    source = "damped motion and statics; turns of the discs by parts of a facet, as a share of the approach"
    CASE.check(Label.INDEPENDENT, f"{name} discs: pressure over the reference's", pressures[0] / pressures[1], 1, FACETS,
               source)
    stresses = [tensor(one, "cell.stress")[-1] for one in (engine, reference)]
    CASE.check(Label.INDEPENDENT, f"{name} discs: difference of stresses over the pressure",
               float(np.abs(stresses[0] - stresses[1]).max()) / pressures[1], 0, 2 * FACETS,
               source + "; each contact counts most in one component")
    energies = [float(one.probe("energy.strain")[-1] + one.probe("energy.contact")[-1]) for one in (engine, reference)]
    CASE.check(Label.INDEPENDENT, f"{name} discs: stored energy over the reference's", energies[0] / energies[1], 1,
               2 * FACETS, source + ", of which energies are the square")
    for column in ("gradient_xx", "gradient_xy", "cell_area"):
        ours, theirs = (float(one.probe(f"strain.{column}")[-1]) for one in (engine, reference))
        CASE.check(Label.EXACT, f"{name} discs: {column}", ours, theirs, 1e-12, "the history; sums over steps round")
    solid = [float(one.probe("packing.solid_fraction")[-1]) for one in (engine, reference)]
    CASE.check(Label.INDEPENDENT, f"{name} discs: solid fraction", solid[0], solid[1], FACETS * SHORTENING,
               "areas of the outlines; strains are off by the same share as forces")
