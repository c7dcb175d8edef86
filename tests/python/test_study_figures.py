"""Figures of studies: what their axes say. All EXACT."""

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import pytest

from pliant.study import figures


def ticks(values: list[str], log: list[str]) -> list[str]:
    rows = [{"inputs": {"load": value}, "outputs": {"force": {"value": 1.0 + i, "error": None, "unit": "N/m"}}}
            for i, value in enumerate(values)]
    figure, axes = plt.subplots()
    about = {"parameters": ["load"], "replicas": None}
    figures._plot(axes, {"x": "load", "y": "force", "by": None, "log": log}, about, rows)
    figure.canvas.draw()
    assert axes.get_ylabel() == "force [N/m]"
    assert axes.get_xlabel() == ("load" if values[0] == "soft" else "load [GPa]")
    texts = [label.get_text() for label in axes.get_xticklabels()]
    plt.close(figure)
    return texts


@pytest.mark.parametrize("values", [["1 GPa", "0.125 GPa", "2.5 GPa"], ["0.5 GPa"]])
def test_a_logarithmic_axis_names_the_values(values: list[str]) -> None:
    numbers = sorted(float(value.split()[0]) for value in values)
    assert ticks(values, ["x"]) == [f"{number:g}" for number in numbers]


def test_many_values_and_linear_axes_are_left_to_matplotlib() -> None:
    assert ticks([f"{1.37**i:.3g} GPa" for i in range(12)], ["x"]) != ticks(["1 GPa"], ["x"])
    assert len(ticks(["1 GPa", "8 GPa"], [])) > 2


def test_a_quantity_that_no_run_has_leaves_an_empty_figure() -> None:
    figure, axes = plt.subplots()
    figures._plot(axes, {"x": "load", "y": "force", "by": None, "log": ["x"]}, {"parameters": ["load"], "replicas": None}, [])
    assert [text.get_text() for text in axes.texts] == ["no run has it"]
    plt.close(figure)


def test_words_stand_in_their_order() -> None:
    assert ticks(["soft", "hard"], []) == ["soft", "hard"]
