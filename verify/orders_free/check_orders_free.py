"""Time integration of a free compliant disc at large strains: both solvers converge to each other."""

from __future__ import annotations

import numpy as np
import pytest

from order_study import Quantity, Study, check_same_motion, run_study
from pictures import draw_orders, panels, save
from verification import FULL, Case

CASE = Case(__file__, fast=True)
STEPS = [0.02, 0.01, 0.005, 0.0025] + ([0.00125] if FULL else [])
FINEST = STEPS[-1] / 4
TIMES = 0.2 * np.arange(1, 9)
NODES = ("outline_0", "outline_5", "inside")
POSITIONS = Quantity("positions", [f"{node}.position_{axis}" for node in NODES for axis in "xy"])
STRAIN = Quantity("strain energy", ["energy.strain"])
KINETIC = Quantity("kinetic energy", ["energy.kinetic"])
QUANTITIES = [POSITIONS, STRAIN, KINETIC]
SECOND = ("Verlet and Newmark (beta 1/4, gamma 1/2) are of second order; the finest run's error adds at most an eighth "
          "to the last error, 0.05 to the slope; the engine's short first steps reduce it by as much")


@pytest.fixture(scope="module", params=["lumped", "corrected"])
def mass(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture(scope="module")
def study(mass: str) -> Study:
    return run_study(CASE, mass, STEPS, FINEST, TIMES, mass=mass)


@pytest.mark.parametrize("quantity", QUANTITIES, ids=lambda q: q.name)
def test_second_order(mass: str, study: Study, quantity: Quantity) -> None:
    for name, steps, errors in study.curves(quantity):
        CASE.check_rate(f"{mass}: {quantity.name}, {name}", steps, errors, 2, 0.15, SECOND)


def test_same_motion(mass: str, study: Study) -> None:
    check_same_motion(CASE, mass, study, POSITIONS)


def test_picture(mass: str, study: Study) -> None:
    figure, axes = panels(len(QUANTITIES), f"Free disc, {mass} mass", across=True)
    for panel, quantity in zip(axes, QUANTITIES):
        draw_orders(panel, quantity.name, study.curves(quantity), [2])
    save(CASE, figure, f"orders_{mass}")
