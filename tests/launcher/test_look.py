"""What tells whether pictures of a newcomer's run are there and show something (tests/fresh/look.py). EXACT."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import pytest
from conftest import ROOT


def look(*files: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-B", ROOT / "tests/fresh/look.py", *files], capture_output=True, text=True)


@pytest.fixture
def drawn(tmp_path: Path) -> Path:
    figure, axes = plt.subplots()
    axes.fill_between([0, 1, 2], [1, 3, 2])
    figure.savefig(tmp_path / "drawn.png")
    plt.close(figure)
    return tmp_path / "drawn.png"


def test_a_picture_is_seen(drawn: Path) -> None:
    assert look(drawn).returncode == 0


def test_what_is_missing_empty_or_blank_is_told(drawn: Path, tmp_path: Path) -> None:
    plt.figure()
    plt.savefig(tmp_path / "blank.png")
    plt.close()
    (tmp_path / "empty.html").write_text("<html></html>")
    result = look(drawn, tmp_path / "blank.png", tmp_path / "empty.html", tmp_path / "missing.png")
    assert result.returncode == 1
    assert [line.split("/")[-1].split(" ", 2)[0] for line in result.stdout.splitlines()] == ["blank.png", "empty.html", "missing.png"]
    assert "is blank: 0.00 %" in result.stdout


def test_axes_without_data_are_blank(tmp_path: Path) -> None:
    plt.figure(figsize=(8, 6))
    plt.axes().set_title("Energies")
    plt.savefig(tmp_path / "frame.png")
    plt.close()
    result = look(tmp_path / "frame.png")
    assert result.returncode == 1, result.stdout
