"""Pictures of contact forces and of means over cells. All are EXACT."""

from pathlib import Path

import h5py
import matplotlib
import numpy as np
import pytest

matplotlib.use("Agg")

from matplotlib.collections import LineCollection
from matplotlib.image import AxesImage

from pliant.results import Run, read_run
from plots.chains import chains
from plots.coarse import coarse
from plots.network import network
from synthetic_run import PITCH, ROW_PITCH, write_run

COLUMNS, ROWS = 10, 6
PERIOD = COLUMNS * PITCH
PRESSING, PULLING = 100.0, -10.0  # N/m, up the columns; across the period


def contacts() -> dict[str, np.ndarray]:
    """Each grain and the next one up its column, numbered by rows; the last and the first of the lowest row."""
    lower = np.arange(COLUMNS * (ROWS - 1))
    x = (lower % COLUMNS + 0.5) * PITCH
    y = (lower // COLUMNS + 0.5 * (lower % COLUMNS % 2) + 0.5) * ROW_PITCH
    across = {"bodies": (0, COLUMNS - 1), "images": -1, "point": (0, 0.25 * ROW_PITCH), "force": (-PULLING, 0),
              "length": 1e-7}
    up = {"bodies": np.column_stack([lower, lower + COLUMNS]), "images": 0 * lower, "point": np.column_stack([x, y]),
          "force": np.column_stack([0 * x, 0 * x + PRESSING]), "length": 0 * x + 1e-7}
    return {name: np.concatenate([up[name], [across[name]]]) for name in up}


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    folder = tmp_path_factory.mktemp("run")
    write_run(folder, COLUMNS, ROWS, rings=2, frames=2)
    with h5py.File(folder / "frames.h5", "a") as file:
        for name, values in contacts().items():
            file[f"contacts/000000/{name}"] = values.astype("f4")
    return read_run(folder)


def test_lines_go_through_contacts_from_centre_to_centre(run: Run) -> None:
    """In um; the pair across the period is drawn on both sides, the strongest lines last and widest."""
    figure = chains(run, [0])
    assert figure is not None
    drawn = next(c for c in figure.axes[0].collections if isinstance(c, LineCollection))
    lines, widths = np.array(drawn.get_segments()), np.array(drawn.get_linewidths())
    pairs = COLUMNS * (ROWS - 1)
    assert len(lines) == pairs + 2
    across = np.ptp(lines[:, :, 0], axis=1) > 0.5
    assert across.sum() == 2
    assert sorted(lines[across][:, 1, 0]) == pytest.approx([0, PERIOD * 1e6], abs=1e-6)
    assert np.ptp(lines[across][:, :, 0], axis=1) == pytest.approx(PITCH * 1e6, rel=1e-6)
    assert np.ptp(lines[~across][:, :, 1], axis=1) == pytest.approx(ROW_PITCH * 1e6, rel=1e-6)
    assert widths[~across].min() == pytest.approx(widths.max()) and widths[across].max() == pytest.approx(
        widths.max() * PULLING / -PRESSING)
    colours = drawn.get_colors()
    assert (colours[~across][:, 2] > colours[~across][:, 0]).all(), "blue: pressing"
    assert (colours[across][:, 0] > colours[across][:, 2]).all(), "red: pulling"


def test_means_over_cells_are_drawn_where_they_are(run: Run) -> None:
    figure = coarse(run, [0])
    assert figure is not None
    pictures = [image for axes in figure.axes for image in axes.images if isinstance(image, AxesImage)]
    labels = [axes.get_ylabel() for axes in figure.axes if "[" in axes.get_ylabel() or "fraction" in axes.get_ylabel()]
    assert len([label for label in labels if not label.startswith("y")]) == 5
    solid = pictures[0].get_array()
    assert solid.shape == (round(solid.shape[0]), 9)  # a period of 8.7 um in discs of 0.98 um or less
    assert pictures[0].get_extent()[:2] == pytest.approx([0, PERIOD * 1e6])
    assert 0.7 < solid[1:-1].mean() < 0.95  # 0.9 in the lattice, a bit less of polygons
    assert pictures[3].get_array().max() > 0, "pressure up the columns"


def test_statistics_of_few_contacts_are_left_out(run: Run, tmp_path: Path) -> None:
    assert network(run, [0]) is not None
    assert network(run, [1]) is None and chains(run, [0, 1]) is None, "no contacts in the second frame"
    write_run(tmp_path, 4, 3, rings=2, frames=1)
    assert coarse(read_run(tmp_path), [0]) is None, "twelve grains"
