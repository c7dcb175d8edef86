"""Curves and figures of studies: means over replicas, what lies beside them, and what is refused. All EXACT."""

from __future__ import annotations

import csv
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
import pytest
from test_study import STUDY, Desk, desk  # noqa: F401: a fixture

from pliant.study.curves import MeanCurve, advancing, draw_curve, mean_at_x, mean_of_points
from pliant.study.reading import BadStudy
from pliant.study.spec import Curve
from pliant.study.study_file import read_study

CURVES = """
[[curves]]
name = "strain"
x = "energy.kinetic"
y = "energy.strain"
by = "nodes"

[[curves]]
name = "both"
function = "own.py:line"
x = "a title"
y = "another"
beside = "own.py:twice"

[[figures]]
name = "drawn"
function = "own.py:draw"
"""
OWN = """
import numpy as np
def line(run):
    return np.array([0.0, 1.0]), np.array([0.0, run.summary["steps"]])
def twice(x, y):
    return 2 * y
def draw(axes, means):
    axes.set_title(str(len(means)))
"""


def test_a_mean_is_taken_at_the_same_x() -> None:
    """Of straight lines with different points and ends: the mean line, where both have values."""
    first = {"x": [0.0, 1.0, 3.0], "y": [0.0, 2.0, 6.0]}
    second = {"x": [1.0, 4.0], "y": [6.0, 12.0]}
    x, y, error = mean_at_x([first, second], False)
    assert (x[0], x[-1]) == (1.0, 3.0)
    np.testing.assert_allclose(y, 2 * x + 2, rtol=1e-14)
    np.testing.assert_allclose(error, np.full_like(x, 2.0), rtol=1e-13)  # half the difference of two is their error
    assert mean_at_x([first, {"x": [5.0, 6.0], "y": [0.0, 0.0]}], False) is None
    assert mean_at_x([first, first], True) is None, "a logarithmic axis has no 0"


def test_points_that_fall_back_are_left_out() -> None:
    x, y = advancing(np.array([0.0, 2.0, 1.0, 2.0, 3.0]), np.arange(5.0))
    assert (x.tolist(), y.tolist()) == ([0.0, 2.0, 3.0], [0.0, 1.0, 4.0])
    x, y = advancing(np.array([3.0, 1.0, 2.0, 0.0]), np.arange(4.0))
    assert (x.tolist(), y.tolist()) == ([0.0, 1.0, 3.0], [3.0, 1.0, 0.0])


def test_a_loop_is_averaged_point_by_point() -> None:
    x, y, error = mean_of_points([{"x": [0, 1, 0], "y": [0, 1, 2]}, {"x": [0, 3, 0, 9], "y": [0, 1, 4, 9]}])
    assert (x.tolist(), y.tolist(), error.tolist()) == ([0, 2, 0], [0, 1, 3], [0, 0, 1])


def test_styles_tell_inputs_apart() -> None:
    """A colour for each value of `by`; lines of the others differ unless that value tells them."""
    curve = Curve("c", "x", "y", None, "a", [], "x", None)

    def legend(inputs: list[dict]) -> list[str]:
        figure, axes = plt.subplots()
        draw_curve(axes, curve, [MeanCurve(i, np.arange(2.0), np.arange(2.0), None, 1, ["-", "Pa"]) for i in inputs], ["r", "b"])
        texts = [text.get_text() for text in axes.get_legend().get_texts()]
        assert axes.get_ylabel() == "y [Pa]"
        plt.close(figure)
        return texts

    assert legend([{"a": 1, "b": 3}, {"a": 2, "b": 4}]) == ["a = 1", "a = 2"]
    assert legend([{"a": 1, "b": 3}, {"a": 1, "b": 4}]) == ["a = 1", "b = 3", "b = 4"]


def test_curves_of_a_study(desk: Desk) -> None:  # noqa: F811
    """Over replicas in one table; the study is drawn anew, not run, when a function changes."""
    (desk.folder / "own.py").write_text(OWN)
    text = STUDY.replace('[[parameters]]\nname = "young"\npath = "materials.soft.young"\nvalues = [2.8, 5.6]',
                         '[replicas]\nname = "young"\npath = "materials.soft.young"\nseeds = [3, 5]')
    desk.study(text + CURVES)
    result = desk.call()
    assert result.returncode == 0, result.stderr
    rows = {name: list(csv.DictReader((desk.out / f"curves/{name}.csv").open())) for name in ("strain", "both")}
    assert {row["nodes"] for row in rows["strain"]} == {"40", "60"} and {row["runs"] for row in rows["strain"]} == {"2"}
    assert list(rows["strain"][0]) == ["nodes", "energy.kinetic [J/m]", "energy.strain [J/m]", "standard error", "runs"]
    steps = [float(row["steps [-]"]) for row in desk.rows() if row["nodes"] == "40"]
    end = [row for row in rows["both"] if row["nodes"] == "40"][-1]
    assert float(end["another"]) == sum(steps) / 2 and float(end["beside"]) == sum(steps)
    assert {"curve_strain.png", "curve_both.png", "drawn.png"} == {file.name for file in (desk.out / "figures").iterdir()}
    before = desk.times()
    (desk.folder / "own.py").write_text(OWN.replace("2 * y", "y[:1]"))
    result = desk.call()
    assert result.returncode == 0 and "curve both: " in result.stderr and "two arrays" in result.stderr
    assert desk.times() == before
    rows = list(csv.DictReader((desk.out / "curves/both.csv").open()))
    assert "beside" in rows[0] and not rows[0]["beside"], "a function that fails leaves its curve out"


@pytest.mark.parametrize("change, message", [
    (("energy.kinetic", "energy.kinetics"), "no probe 'energy.kinetics'.*energy.kinetic"),
    (("own.py:line", "own.py:lines"), "no function 'lines'"),
    (("own.py:draw", "other.py:draw"), "must be FILE.py:NAME"),
    (('by = "nodes"', 'by = "node"'), "nothing is called 'node'"),
    (('name = "both"', 'name = "strain"'), "two curves are called 'strain'"),
    (('name = "both"', 'name = "a/b"'), "a file is called by it"),
    (('by = "nodes"', 'average = "y"'), "'average' is 'y'"),
])
def test_bad_curves_are_refused(desk: Desk, change: tuple[str, str], message: str) -> None:  # noqa: F811
    (desk.folder / "own.py").write_text(OWN)
    desk.study(STUDY + CURVES.replace(*change))
    result = desk.call()
    assert result.returncode == 2 and not desk.out.exists()
    import re
    assert re.search(message, result.stderr), result.stderr


def test_a_study_of_curves_alone(desk: Desk) -> None:  # noqa: F811
    text = STUDY[:STUDY.index("[[quantities]]")]
    with pytest.raises(BadStudy, match="nothing would come of it"):
        read_study(desk.study(text))
    assert read_study(desk.study(text + CURVES[:CURVES.index("[[curves]]", 20)])).curves[0].name == "strain"
    assert Path(desk.folder / "scene.toml").exists()
