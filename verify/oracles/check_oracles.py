"""The stored numbers of oracles/, computed again by finite elements on two meshes each, or from closed forms."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import jn_zeros, jv

from fem.free_disc import Oscillation
from fem.plates import Plates, Squeezed, hertz_force, hertz_half_width, modulus, without_penalty
from fem.solid import Material
from oracle_tables import read_oracle
from pictures import COLOURS, describe, legend, panels, save, set_ticks
from verification import FULL, Case, Label

CASE = Case(__file__, fast=True)
MATERIAL = Material()
PLATES = read_oracle("disc_between_plates")
APPROACHES = list(PLATES["approach_over_diameter"]) if FULL else [0.01, 0.05, 0.3]
# Rings of triangles in the quarter disc, and edges in the half width of the contact.
COARSE, FINE = (12, 6), (24, 12)
PENALTY = 1e4  # mu / R; and twice that
OSCILLATION = read_oracle("disc_oscillation")
UNTIL = 9.3 if FULL else 2.2


@dataclass
class Both:
    """A squeezed disc on both meshes."""

    coarse: Squeezed
    fine: Squeezed

    def change(self, name: str, offset: float = 0) -> float:
        """Relative change between meshes of a quantity less an offset."""
        return abs(getattr(self.coarse, name) - offset) / abs(getattr(self.fine, name) - offset) - 1


def squeezed(mesh: tuple[int, int], approach: float, force: float) -> Squeezed:
    plates = Plates(MATERIAL, mesh[0], hertz_half_width(force, MATERIAL), mesh[1])
    return without_penalty(plates.squeeze(approach, PENALTY), plates.squeeze(approach, 2 * PENALTY))


@pytest.fixture(scope="module")
def plates() -> dict[float, Both]:
    forces = dict(zip(PLATES["approach_over_diameter"], PLATES["force_over_muR"]))
    return {D: Both(*(squeezed(mesh, D, forces[D]) for mesh in (COARSE, FINE))) for D in APPROACHES}


@pytest.mark.parametrize("approach", APPROACHES, ids=lambda D: f"{100 * D:g}")
def test_disc_between_plates(plates: dict[float, Both], approach: float) -> None:
    row = list(PLATES["approach_over_diameter"]).index(approach)
    both, stored_error = plates[approach], PLATES["relative_error"][row]
    for name, column, offset in (("force", "force_over_muR", 0), ("strain_energy", "work_over_muR2", 0),
                                 ("horizontal_diameter", "horizontal_diameter_over_R", 2)):
        stored, value = PLATES[column][row] - offset, getattr(both.fine, name) - offset
        error = max(abs(other.change(name, offset)) for other in plates.values())
        CASE.check(Label.INDEPENDENT, f"plates at {100 * approach:g} %: {name.replace('_', ' ')}", value / stored, 1,
                   stored_error + error, "stored error plus largest difference of two meshes by a factor 2, as at one "
                   "approach the contact edge may have the same position between nodes of both")
    balance = both.fine.reaction / both.fine.force
    CASE.check(Label.EXACT, f"plates at {100 * approach:g} %: reaction over force", balance, 1, 1e-9,
               "equilibrium; Newton's method to 1e-10 of the displacement")


def test_hertz() -> None:
    stored = PLATES["hertz_force_over_muR"]
    again = np.array([hertz_force(D, MATERIAL) for D in PLATES["approach_over_diameter"]])
    CASE.check(Label.EXACT, "Hertz: stored over computed", np.abs(stored / again - 1).max(), 0, 1e-9,
               "stored values were solved to 4e-10")
    small = PLATES["approach_over_diameter"] <= 0.03
    share = stored / (np.pi * modulus(MATERIAL))  # phi
    beyond = share**1.5 / PLATES["approach_over_diameter"]
    deviation = PLATES["force_over_muR"] / stored - 1
    CASE.check(Label.INDEPENDENT, "finite elements over Hertz up to 3 %, of what large strains may do",
               np.abs(deviation / beyond)[small].max(), 0, 1,
               "linear theory; strain a / 2R in the contact, which contributes phi / D of the approach")


def frequency_condition(order: int, omega: float) -> float:
    """Zero at the eigenfrequencies of a free disc in plane strain: radial and shear traction at R = 1 vanish.

    u = grad(J_n(h r) cos n t) + curl(J_n(k r) sin n t), h = omega/c_p, k = omega/c_s; mu = 1, lambda = 4.
    """
    n, k, h = order, omega, omega / np.sqrt(MATERIAL.lame + 2)
    slope = {x: x * (jv(n - 1, x) - jv(n + 1, x)) / 2 for x in (h, k)}  # x J_n'(x)
    radial = 2 * (n**2 * jv(n, h) - slope[h]) - k**2 * jv(n, h), 2 * n * (slope[k] - jv(n, k))
    shear = 2 * n * (jv(n, h) - slope[h]), 2 * slope[k] + (k**2 - 2 * n**2) * jv(n, k)
    return radial[0] * shear[1] - radial[1] * shear[0]


def test_eigenfrequencies() -> None:
    stored = read_oracle("disc_eigenfrequencies")
    for order, kind, omega in zip(*(stored[name] for name in ("circumferential_order", "kind", "omega_R_over_cs"))):
        if kind == "torsion":
            again = jn_zeros(2, 1)[0]
        else:
            again = brentq(lambda w: frequency_condition(int(order), w), omega - 0.02, omega + 0.02, xtol=1e-14)
        CASE.check(Label.EXACT, f"eigenfrequency {omega:.4f}: stored over computed", omega / again, 1, 1e-12,
                   "Bessel functions; rounding")


@pytest.fixture(scope="module")
def oscillations() -> list[Oscillation]:
    return [Oscillation(rings, UNTIL) for rings in ((10, 20) if FULL else (6, 12))]


def test_oscillation(oscillations: list[Oscillation]) -> None:
    coarse, fine = oscillations
    table = zip(*(OSCILLATION[name] for name in ("quantity", "t_cs_over_R", "value", "error_in_value")))
    for quantity, time, value, error in table:
        if time > UNTIL - 0.1:
            continue
        found = [run.value(quantity, time) for run in (coarse, fine)]
        CASE.check(Label.INDEPENDENT, f"oscillation: {quantity.replace('_', ' ')} at {time:g}", found[1], value,
                   error + abs(found[1] - found[0]), "stored error plus difference of two meshes by a factor 2")
    CASE.check(Label.EXACT, "oscillation: energy at the start over pi / 16", fine.energies[0] / (np.pi / 16), 1, 1e-6,
               "closed form; quadratic edges of the circle")


def test_picture(plates: dict[float, Both], oscillations: list[Oscillation]) -> None:
    figure, axes = panels(2, "Oracles, stored and computed again", across=True)
    percent = 100 * np.array(APPROACHES)
    names = ("force_over_muR", "relative_error")
    stored = [dict(zip(PLATES["approach_over_diameter"], PLATES[name])) for name in names]
    for name, mesh, colour, marker in (("coarse", COARSE, COLOURS[0], "o"), ("fine", FINE, COLOURS[1], "s")):
        forces = [getattr(plates[D], name).force / stored[0][D] - 1 for D in APPROACHES]
        axes[0].plot(percent, 1e4 * np.array(forces), marker, color=colour, label=f"{mesh[0]} rings, {mesh[1]} edges")
    bars = 1e4 * np.array([stored[1][D] for D in APPROACHES])
    axes[0].errorbar(percent, 0 * bars, bars, fmt="none", color="0.3", capsize=3, label="stored error")
    describe(axes[0], "disc between plates: force over the stored, less 1 [1e-4]", "approach over the diameter [%]")
    axes[0].set_xscale("log")
    set_ticks(axes[0], percent, [f"{value:g}" for value in percent])
    axes[1].plot(oscillations[1].times, oscillations[1].s, color=COLOURS[0], linewidth=1.1, label="computed")
    rows = (OSCILLATION["quantity"] != "horizontal_diameter_over_R") & (OSCILLATION["t_cs_over_R"] < UNTIL - 0.1)
    axes[1].plot(OSCILLATION["t_cs_over_R"][rows], OSCILLATION["value"][rows], "s", color=COLOURS[1], fillstyle="none",
                 label="stored")
    describe(axes[1], "free disc: s = sqrt(Ixx / Ixx0)", "time [R / cs]")
    for panel in axes:
        legend(panel)
    save(CASE, figure, "oracles")
