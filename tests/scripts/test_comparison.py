"""Several runs in one picture. All are EXACT."""

import subprocess
from pathlib import Path

import matplotlib
import numpy as np
import pytest

matplotlib.use("Agg")

from pliant.results import Run, read_run
from plots.comparison import comparison, labels

ROOT = Path(__file__).resolve().parents[2]


def run(folder: Path, **columns: list[float]) -> Run:
    folder.mkdir(parents=True)
    names = [f"{name.replace('__', '.')} [N/m]" for name in columns]
    rows = zip(np.arange(len(next(iter(columns.values())))), *columns.values())
    lines = [",".join("" if np.isnan(value) else repr(float(value)) for value in row) for row in rows]
    (folder / "probes.csv").write_text("\n".join([",".join(["time [s]", *names]), *lines]) + "\n")
    return read_run(folder)


def test_columns_that_differ_most_come_first(tmp_path: Path) -> None:
    a = run(tmp_path / "a", same__x=[1, 2], far__x=[1, 2], near__x=[1, 2], zero__x=[0, 0], alone__x=[1, 1])
    b = run(tmp_path / "b", same__x=[1, 2], far__x=[1, 4], near__x=[1, 2.1], zero__x=[0, 0])
    figure = comparison([a, b])
    assert figure is not None
    assert [axes.get_ylabel().split("\n")[0] for axes in figure.axes] == ["far", "near", "same"]
    first = [line.get_ydata().tolist() for line in figure.axes[0].lines]
    assert first == [[1, 2], [1, 4]]
    assert [text.get_text() for text in figure.axes[0].get_legend().get_texts()] == ["a", "b"]


def test_runs_of_other_lengths_are_compared_where_both_are(tmp_path: Path) -> None:
    a = run(tmp_path / "a", f__x=[1, 2, 3], g__x=[1, 1, 1])
    b = run(tmp_path / "b", f__x=[1, 2], g__x=[1, 1.5])
    figure = comparison([a, b])
    assert figure is not None and figure.axes[0].get_ylabel().startswith("g")
    assert figure.axes[0].get_xlim() == (0, 2)


def test_nothing_in_common(tmp_path: Path) -> None:
    assert comparison([run(tmp_path / "a", f__x=[1, 2]), run(tmp_path / "b", g__x=[1, 2])]) is None


def test_labels_are_as_long_as_they_must_be(tmp_path: Path) -> None:
    runs = [run(tmp_path / name, f__x=[1]) for name in ("p/out", "q/out", "r")]
    assert labels([runs[0], runs[2]]) == ["out", "r"]
    assert labels(runs[:2]) == ["p/out", "q/out"]
    assert labels([runs[2], runs[2]]) == ["r (1)", "r (2)"]


@pytest.mark.parametrize("arguments, message", [
    (["a", "b"], "comparison.png"), (["a", "b", "--times", "1"], "--times"), (["a", "c"], "c: no such folder"),
    (["a"] * 9, "allowed: 1 to 8"), (["a", "alone"], "no two of these runs")])
def test_command(tmp_path: Path, arguments: list[str], message: str) -> None:
    for name in ("a", "b"):
        run(tmp_path / name, f__x=[1, 2])
    run(tmp_path / "alone", g__x=[1, 2])
    result = subprocess.run(["/usr/bin/python3", ROOT / "scripts/plot.py", *arguments], cwd=tmp_path, capture_output=True,
                            text=True, check=False)
    good = message == "comparison.png"
    assert result.returncode == (0 if good else 2) and message in (result.stdout if good else result.stderr)
    assert (tmp_path / "a/comparison.png").exists() == good
