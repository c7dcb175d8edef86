"""Engine against reference state by state: discretisations, internal forces, contact forces."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

from pictures import COLOURS, panels, save
from verification import ENGINE, LONGEST_RUN, Case, Label

CASE = Case(__file__)
PROGRAM = Path(os.environ.get("PLIANT_AGREEMENT", ENGINE.parent / "pliant_agreement"))
TOLERANCE = 1e-11
SOURCE = "rounding: sums of up to 1e3 terms of both signs, conditioning of moment matrices of up to 1e3"
# Of discretisations, of distances, of internal forces, of stresses, of contact, of integrated contact, of bonds.
FIGURES = 35 + 1 + 7 + 1 + 12 + 16 + 1 + 4


@pytest.fixture(scope="module")
def agreement() -> dict:
    """Report of gtest: each test gives its largest differences by name, relative to the largest value of their kind."""
    file = CASE.out / "agreement.json"
    result = subprocess.run([str(PROGRAM), f"--gtest_output=json:{file}"], capture_output=True, text=True, timeout=LONGEST_RUN)
    if result.returncode not in (0, 1):
        raise RuntimeError(f"{PROGRAM.name}: exit code {result.returncode}\n{result.stdout[-2000:]}{result.stderr[-2000:]}")
    return json.loads(file.read_text())


@pytest.fixture(scope="module")
def figures(agreement: dict) -> dict[str, float]:
    tests = [test for suite in agreement["testsuites"] for test in suite["testsuite"]]
    return {name: float(value) for test in tests for name, value in test.items() if ": " in name}


def test_engine_and_reference_agree(agreement: dict, figures: dict[str, float]) -> None:
    red = []
    for name, value in figures.items():
        try:
            CASE.check(Label.INDEPENDENT, name, value, 0, TOLERANCE, SOURCE)
        except AssertionError as error:  # all failures are recorded
            red.append(str(error))
    assert not red, red[0]
    CASE.check(Label.EXACT, "number of figures", len(figures), FIGURES, 0,
               "7 methods x (5 tables + forces), distances, stresses, 9 sets of laws, 2 more shapes, own images; "
               "integrated: 5 laws of outlines, crowds and own images, a notch, short edges; bonds: cells, unmatched "
               "outlines, walls, images of a cell")
    CASE.check(Label.INDEPENDENT, "tests that failed", agreement["failures"], 0, 0,
               "quantities without a figure: energies, numbers of contacts")


def test_picture(figures: dict[str, float]) -> None:
    figure, (axes,) = panels(1, "Engine and reference, state by state: largest relative differences")
    figure.set_size_inches(9, 0.19 * len(figures) + 1.2)
    names = list(figures)[::-1]
    kinds = list(dict.fromkeys(name.split(":")[0] for name in figures))
    colours = [COLOURS[kinds.index(name.split(":")[0]) % len(COLOURS)] for name in names]
    places = np.arange(len(names))
    axes.barh(places, [max(figures[name], 1e-17) for name in names], color=colours)
    axes.set_yticks(places, names, fontsize=7)
    axes.set_ylim(-0.7, len(names) - 0.3)
    axes.set_xscale("log")
    axes.set_xlim(1e-17, 1e-10)
    axes.axvline(TOLERANCE, color=COLOURS[6], linestyle="--", linewidth=1.2)
    save(CASE, figure, "frozen_states")
