"""Pictures of a cell with two periods: which images of bodies stand in a picture, and the cell's own corners. EXACT."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts"), str(ROOT / "python")]

from plots.scenery import cell_corners  # noqa: E402
from plots.wrapping import images  # noqa: E402

BOX = (-0.5, 3.0, -0.25, 2.0)


def brute_force(low: np.ndarray, high: np.ndarray, periods: np.ndarray, reach: int) -> set[tuple[int, float, float]]:
    found = set()
    for thing in range(len(low)):
        for i in range(-reach, reach + 1):
            for j in range(-reach, reach + 1):
                x, y = np.array([i, j]) @ periods
                inside = low[thing, 0] + x < BOX[1] and high[thing, 0] + x > BOX[0]
                if inside and low[thing, 1] + y < BOX[3] and high[thing, 1] + y > BOX[2]:
                    found.add((thing, round(float(x), 9), round(float(y), 9)))
    return found


@pytest.mark.parametrize("lean", [0.0, 0.45, -0.5])
def test_all_images_in_a_box(lean: float) -> None:
    random = np.random.default_rng(3)
    periods = np.array([[1.1, 0.05], [lean, 0.9]])
    low = random.uniform(-4, 4, (20, 2))
    high = low + random.uniform(0.05, 0.8, (20, 2))
    index, shifts = images(low, high, periods, BOX)
    found = {(int(i), round(float(x), 9), round(float(y), 9)) for i, (x, y) in zip(index, shifts)}
    assert len(found) == len(index)
    assert found == brute_force(low, high, periods, 15)


def test_one_period_and_none_are_as_they_were() -> None:
    low, high = np.array([[0.1, 0.0], [5.0, 1.0]]), np.array([[0.4, 0.5], [5.2, 1.5]])
    index, shifts = images(low, high, np.empty((0, 2)), BOX)
    assert index.tolist() == [0] and shifts.tolist() == [[0.0, 0.0]]
    index, shifts = images(low, high, np.array([[2.0, 0.0]]), BOX)
    assert index.tolist() == [0, 0, 1] and shifts[:, 0].tolist() == [0.0, 2.0, -4.0]


def test_corners() -> None:
    assert cell_corners(np.array([[2.0, 0.0], [0.5, 1.0]])).tolist() == [[0, 0], [2, 0], [2.5, 1], [0.5, 1]]
