"""Grains of one mesh topology in the lanes of one batch, against the reference solver and grains with separate meshes.
"""

from __future__ import annotations

import subprocess
from dataclasses import dataclass

import numpy as np
import pytest

from order_study import Quantity
from verification import ENGINE, Case, Label, Run, largest_difference

CASE = Case(__file__)
COARSE, FINE = 0.005, 0.0025
TIMES = 0.06 * np.arange(1, 5)
GRAINS = ("left", "middle", "right")
POSITIONS = [Quantity(f"positions of {g}", [f"{g}_{node}.position_{axis}" for node in (0, 16, 32, 48) for axis in "xy"])
             for g in GRAINS]
STRAIN = Quantity("strain energy", ["energy.strain"])
CONTACT = Quantity("energy stored in contacts", ["energy.contact"])
RELATED = {"left": 340, "middle": 340, "right": 340}
APART = {"left": 340, "middle": 341, "right": 342}  # unequal numbers of nodes have no common mesh
FINER = {"left": 680, "middle": 681, "right": 682}


def engine_of(nodes: dict[str, int], dt: float, of_one_topology: int) -> Run:
    """A run; the engine must report that `of_one_topology` of its bodies share one topology."""
    run = CASE.engine(f"engine_{nodes['middle']}_{dt:g}", CASE.scene(dt=dt, **nodes))
    said = subprocess.run([str(ENGINE), "check", f"{run.folder}.toml"], capture_output=True, text=True, check=True)
    assert f"of one topology: {of_one_topology};" in said.stdout
    return run


@dataclass
class Pair:
    """Runs at the coarse and at the fine step."""

    coarse: Run
    fine: Run

    def error(self, quantity: Quantity) -> float:
        """Error of the fine run, by the second order of both solvers."""
        return largest_difference(self.coarse, self.fine, quantity.columns, TIMES) / 3


@pytest.fixture(scope="module")
def engine() -> Pair:
    return Pair(*(engine_of(RELATED, dt, 3) for dt in (COARSE, FINE)))


@pytest.fixture(scope="module")
def reference() -> Pair:
    return Pair(*(CASE.reference(f"reference_{dt:g}", CASE.scene(dt=dt, **RELATED), "--dt", repr(dt)) for dt in (COARSE, FINE)))


@pytest.mark.parametrize("quantity", [*POSITIONS, STRAIN, CONTACT], ids=lambda q: q.name)
def test_both_solvers(engine: Pair, reference: Pair, quantity: Quantity) -> None:
    CASE.check(Label.INDEPENDENT, f"{quantity.name}: engine - reference",
               largest_difference(engine.fine, reference.fine, quantity.columns, TIMES), 0,
               2 * (engine.error(quantity) + reference.error(quantity)),
               "second-order errors of both solvers, and as much again for kinks of the pressure's derivative")


@pytest.mark.parametrize("quantity", [*POSITIONS, STRAIN], ids=lambda q: q.name)
def test_meshes_of_their_own(engine: Pair, quantity: Quantity) -> None:
    finer, apart = engine_of(FINER, FINE, 0), engine_of(APART, FINE, 0)
    CASE.check(Label.INDEPENDENT, f"{quantity.name}: one topology from finer meshes of their own",
               largest_difference(engine.fine, finer, quantity.columns, TIMES), 0,
               2 * largest_difference(apart, finer, quantity.columns, TIMES),
               "separate meshes with as many nodes differ by half of this: the bent mesh may have twice their error")
