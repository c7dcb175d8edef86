"""`modes`: natural frequencies, the files that it writes, and what it refuses. EXACT but where said."""

from __future__ import annotations

import json

import numpy as np
import pytest
from scenes import TWO_DISCS
from scipy.io import mmread
from scipy.linalg import eigh

ROUNDING = 1e-8  # of frequencies: differences of forces err by 1e-11 of the stiffness, w^2 spans 1e3


def modes(desk, text: str, *options: str) -> list[dict]:
    desk.write(text)
    result = desk.engine("modes", desk.scene, "--json", "modes.json", *options)
    assert result.returncode == 0, result.stderr
    return json.loads((desk.folder / "modes.json").read_text())["bodies"]


def frequencies(desk, text: str, *options: str) -> np.ndarray:
    return np.array(modes(desk, text, *options)[0]["frequencies"])


def test_two_alike_are_told_once(desk) -> None:
    bodies = modes(desk, TWO_DISCS)
    assert [(body["like_it"], body["nodes"], body["motions_at_rest"]) for body in bodies] == [(1, 60, 3)]
    assert len(bodies[0]["frequencies"]) == 10 and np.all(np.diff(bodies[0]["frequencies"]) > 0)


def test_table_and_json_agree(desk) -> None:
    desk.write(TWO_DISCS)
    result = desk.engine("modes", desk.scene, "--count", "4", "--json", "modes.json")
    rows = [line.split() for line in result.stdout.splitlines()[2:]]
    values = json.loads((desk.folder / "modes.json").read_text())["bodies"][0]["frequencies"]
    assert [int(row[0]) for row in rows] == [1, 2, 3, 4]
    assert [float(row[1]) for row in rows] == pytest.approx(values, rel=1e-9)
    assert [float(row[1]) * float(row[3]) for row in rows] == pytest.approx([2 * np.pi] * 4, rel=1e-6)


@pytest.mark.parametrize("old, new, factor", [
    ('young = "2 GPa"', 'young = "8 GPa"', 2),
    ('density = "1200 kg/m3"', 'density = "4800 kg/m3"', 0.5),
    ('diameter = "1 um"', 'diameter = "0.1 um"', 10),
    ('body = "compliant"', 'body = "compliant"\nangle = "0.7 rad"', 1),
    ('body = "compliant"', 'body = "compliant"\nsize = { distribution = "list", factors = [0.5], shares = [1] }', 2),
], ids=["young", "density", "diameter", "angle", "size"])
def test_frequencies_go_as_the_speed_of_waves_over_the_size(desk, old: str, new: str, factor: float) -> None:
    options = ("--body", "grains")
    before = frequencies(desk, TWO_DISCS, *options)
    assert frequencies(desk, TWO_DISCS.replace(old, new), *options) == pytest.approx(factor * before, rel=ROUNDING)


@pytest.mark.parametrize("mass", ["lumped", "corrected"])
def test_matrices_have_the_frequencies(desk, mass: str) -> None:
    text = TWO_DISCS + f'\n[discretisation]\nmass = "{mass}"\n'
    printed = frequencies(desk, text, "--count", "117", "--matrices", "matrices")
    stiffness, inverse = (mmread(file).toarray() for file in sorted((desk.folder / "matrices").iterdir(), reverse=True))
    assert stiffness.shape == (120, 120) and inverse.shape == (60, 60)
    assert (np.count_nonzero(inverse) == 60) == (mass == "lumped")
    squares = eigh(stiffness, np.linalg.inv(np.kron(inverse, np.eye(2))), eigvals_only=True)
    assert np.sqrt(squares[3:]) == pytest.approx(printed, rel=1e-6)
    assert np.count_nonzero(stiffness) < 0.6 * stiffness.size, "nodes without a common point have no stiffness"


@pytest.mark.parametrize("text, options, says", [
    (TWO_DISCS, ["--count", "0"], "--count"),
    (TWO_DISCS, ["--body", "grain"], "nearest: grains;"),
    (TWO_DISCS.replace('body = "compliant"', 'body = "rigid"', 1), ["--body", "grains"], "not compliant"),
    (TWO_DISCS.replace("nodes = 60", "nodes = 1501"), [], "at most 1500"),
], ids=["count", "unknown body", "rigid body", "too many nodes"])
def test_refused(desk, text: str, options: list[str], says: str) -> None:
    desk.write(text)
    before = desk.content()
    result = desk.engine("modes", desk.scene, *options)
    assert result.returncode == 2 and says in result.stderr and not result.stdout
    assert desk.content() == before


def test_no_scene_is_overwritten(desk) -> None:
    desk.write(TWO_DISCS)
    before = desk.content()
    result = desk.engine("modes", desk.scene, "--json", desk.scene)
    assert result.returncode == 2 and "must end with .json" in result.stderr
    assert desk.content() == before


def test_a_folder_that_cannot_be_written(desk) -> None:
    desk.write(TWO_DISCS)
    assert desk.engine("modes", desk.scene, "--matrices", desk.scene / "matrices").returncode == 4
    assert desk.engine("modes", desk.scene, "--json", "no_such_folder/modes.json").returncode == 4
