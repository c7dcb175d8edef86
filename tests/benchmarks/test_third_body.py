"""What benchmarks/third_body.py makes of a run, and that the page on it says what was measured. EXACT."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import matplotlib.pyplot as plt
import numpy as np
from PIL import Image

import third_body

ROOT = Path(__file__).resolve().parents[2]
SAMPLING = 5e-9  # s


def test_series_are_means_of_50_ns(tmp_path: Path) -> None:
    times = SAMPLING * np.arange(41)  # one more than whole rows
    step_times = np.linspace(1e-12, times[-1], 4000)
    run = SimpleNamespace(times=lambda name: times, probe=lambda name: -1e9 * times * (2 if name.endswith("y") else 1),
                          steps=lambda name: step_times if name == "time" else 1e-4 * step_times)
    third_body.write_series(SimpleNamespace(run=run, end=times[-1]), tmp_path / "series.csv")
    rows = (tmp_path / "series.csv").read_text().splitlines()
    assert rows[0] == "t [s],normal_force [N/m],tangential_force [N/m],dt [s],error [1]"
    values = np.array([[float(value) for value in row.split(",")] for row in rows[1:]])
    middles = SAMPLING * (4.5 + 10 * np.arange(4))
    np.testing.assert_allclose(values[:, :3], np.array([middles, 2e9 * middles, 1e9 * middles]).T, rtol=1e-5)
    beginnings = SAMPLING * 10 * np.arange(4)
    step = step_times[1] - step_times[0]  # each row has whole steps: its mean is off by half of one at most
    np.testing.assert_allclose(values[:, 3], 1e-4 * (beginnings + 5 * SAMPLING), rtol=1e-5, atol=1e-4 * step)


def test_each_step_counts_once() -> None:
    """Three steps with a row each, then two rows for ten steps each; a rejected trial is no step."""
    columns = {"evaluations": [2, 3, 5, 15, 25], "rejections": [0, 0, 1, 1, 1], "dt": [1.0, 2.0, 3.0, 4.0, 5.0]}
    run = SimpleNamespace(steps=lambda name: np.array(columns[name], dtype=float))
    np.testing.assert_array_equal(third_body.of_all_steps(run, "dt"), [1, 2, 3, *[4] * 10, *[5] * 10])


def test_pictures_are_small(tmp_path: Path) -> None:
    figure, axes = plt.subplots(figsize=(9, 9))
    x = np.linspace(0, 50, 700)
    axes.imshow(np.sin(x[:, None]) * np.cos(3 * x[None, :]) + 0.2 * np.sin(7 * x[None, :] * x[:, None]))
    third_body.save_small(figure, tmp_path / "picture.png")
    plt.close(figure)
    assert (tmp_path / "picture.png").stat().st_size <= third_body.MOST_BYTES
    assert Image.open(tmp_path / "picture.png").size[0] >= 9 * 60


def test_a_folder_without_results_is_refused(tmp_path: Path) -> None:
    done = subprocess.run([sys.executable, "-B", ROOT / "benchmarks/third_body.py", tmp_path], capture_output=True, text=True)
    assert done.returncode == 2 and "no results" in done.stderr


def test_the_page_says_what_was_measured() -> None:
    found = json.loads((third_body.RESULTS / "observables.json").read_text())
    page = (ROOT / "docs/third_body.md").read_text()
    for words in [f"{found['friction: peak']:.2f}, at {found['friction: time of the peak, us']:.2f} us",
                  f"{found['friction: plateau']:.3f}, to {found['friction: plateau to']:.3f}",
                  f"{found['steps']:,} steps", f"{found['evaluations'] / 1e6:.2f} million"]:
        assert words in page, words
