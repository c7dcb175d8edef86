"""Two cohesive compliant blocks fly apart: bond energy, and both solvers through tension, slip and detachment."""

from __future__ import annotations

import numpy as np
import pytest

from order_study import Quantity, Study, check_differences, run_study
from pictures import draw_both, draw_differences, legend, panels, save
from verification import Case, Label

CASE = Case(__file__, fast=True)
STEPS = [0.005, 0.0025, 0.00125]  # 0.01 does not resolve the tear: the reference's error is 40 times as large
FINEST = 0.000625
TIMES = 0.04 * np.arange(1, 31)
STRENGTH, RANGE, STIFFNESS = 0.03, 0.02, 20.0
LENGTH = 1.0  # of the left block's face, which lies within the right one's
POSITIONS = Quantity("positions", ["left.position_x", "corner.position_x", "corner.position_y"])
FORCE = Quantity("force", ["force.force_x"])
DISSIPATION = Quantity("dissipation", ["energy.dissipated"])
SHEAR = {"apart": 0.0, "apart and along": 0.02}


@pytest.fixture(scope="module", params=list(SHEAR))
def way(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture(scope="module")
def study(way: str) -> Study:
    return run_study(CASE, way.replace(" ", "_"), STEPS, FINEST, TIMES, shear=SHEAR[way])


@pytest.mark.parametrize("quantity", [POSITIONS, FORCE, DISSIPATION], ids=lambda q: q.name)
def test_solvers_converge_to_each_other(way: str, study: Study, quantity: Quantity) -> None:
    if way == "apart" and quantity is DISSIPATION:
        return  # here only ringing causes slip; it dissipates 1e-2 of the other case
    check_differences(CASE, way, study, quantity, 1.5, 0.7,
                      "slip and kinks of the law lie within steps: between first and second order; 0.2 for scatter")


def energy_of_a_bond() -> float:
    """Reversible energy from closed to torn: G = strength x range / 2 on the face. Beside either end of it, the left
    block's flank (in one pass) and the right block's face (in the other) lie at the distance y. They carry the
    remaining energy W(y) = G - kn y^2/2 up to y_c = strength/kn, then strength (range - y)^2/(2 (range - y_c))."""
    opening = STRENGTH / STIFFNESS
    bond = 0.5 * STRENGTH * RANGE
    left = bond * opening - STIFFNESS * opening**3 / 6 + STRENGTH * (RANGE - opening)**2 / 6
    return bond * LENGTH + 2 * left


def test_energy_of_the_bond(way: str, study: Study) -> None:
    for name, run in study.finest_runs().items():
        energy = run.probe("energy.contact")
        CASE.check(Label.EXACT, f"{way}, {name}: energy of the bond", (energy[-1] - energy[0]) / energy_of_a_bond(), 1,
                   1e-12, "strength x range / 2 on the face, plus the regions beside its ends; rounding")


def test_picture(way: str, study: Study) -> None:
    figure, axes = panels(3, f"Cohesive pair: {way}", across=True)
    runs = study.finest_runs()
    draw_both(axes[0], runs, "force.force_x", 1e3)
    draw_both(axes[1], runs, "energy.contact", 1e6, "stored, ")
    draw_both(axes[1], runs, "energy.dissipated", 1e6, "dissipated, ", 2)
    axes[0].set_ylabel("pull on the left block [mN/m]")
    axes[1].set_ylabel("energy of the contact [uJ/m]")
    for panel in axes[:2]:
        panel.set_xlabel("time [s]")
        panel.set_xlim(0, 0.6)
        legend(panel)
    draw_differences(axes[2], study, [POSITIONS, FORCE, DISSIPATION])
    save(CASE, figure, way.replace(" ", "_"))
