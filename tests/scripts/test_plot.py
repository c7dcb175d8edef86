"""Checks of scripts/plot.py. All are EXACT; captions state the numbers that synthetic_run.py makes up."""

import subprocess
from pathlib import Path

import h5py
import numpy as np
import pytest

from pliant import units
from plots import curves, scenery, wrapping
from pliant.frames import WALL, BadFolder, Grid
from pliant.results import read_run, read_table
from synthetic_run import PITCH, write_run

ROOT = Path(__file__).resolve().parents[2]
PICTURES = {"grains.png", "velocity.png", "von_mises.png", "steps.png", "forces.png", "energy.png",
            "probes.png"}


def plot(*arguments: object) -> subprocess.CompletedProcess[str]:
    command = ["/usr/bin/python3", str(ROOT / "scripts/plot.py"), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True)


@pytest.fixture(scope="module")
def run_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("run")
    write_run(folder, columns=6, rows=4, rings=3, frames=5)
    return folder


def test_all_pictures(run_folder: Path) -> None:
    before = {file.name for file in run_folder.iterdir()} - PICTURES
    result = plot(run_folder, "--times", 1e-6, 18.5e-6)
    assert result.returncode == 0, result.stderr
    assert {file.name for file in run_folder.iterdir()} == before | PICTURES
    assert all((run_folder / name).read_bytes().startswith(b"\x89PNG") for name in PICTURES)


def test_each_field_has_a_map(run_folder: Path, tmp_path: Path) -> None:
    (tmp_path / "frames.h5").write_bytes((run_folder / "frames.h5").read_bytes())
    with h5py.File(tmp_path / "frames.h5", "a") as file:
        for index in range(5):
            bodies, outlines = file[f"bodies/{index:06}"], file[f"outlines/{index:06}"]
            bodies["plastic_strain"] = bodies["von_mises"][()] / 1e9
            bodies["displacement"] = bodies["velocity"][()]
            outlines["contact_pressure"] = np.ones(len(outlines["position"]), "f4")
    result = plot(tmp_path)
    assert result.returncode == 0, result.stderr
    assert {"plastic_strain.png", "displacement.png", "contact_pressure.png"} <= {f.name for f in tmp_path.iterdir()}


def test_missing_data_is_named(tmp_path: Path) -> None:
    (tmp_path / "steps.csv").write_text("time [s],dt [s]\n1e-9,1e-12\n2e-9,1e-12\n")
    result = plot(tmp_path)
    assert result.returncode == 0, result.stderr
    assert {file.name for file in tmp_path.iterdir()} == {"steps.csv", "steps.png"}
    assert all(f"{name}: left out" in result.stdout for name in PICTURES - {"steps.png"})


def test_period_in_another_unit_is_no_obstacle(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    write_steps(tmp_path, 0)
    (tmp_path / "scene.toml").write_text('[domain]\nperiod = "1 inch"\n')
    assert read_run(tmp_path).period is None
    assert "'1 inch' is not a length" in capsys.readouterr().err


@pytest.mark.parametrize("files", [None, {}, {"frames.h5": "no HDF5"}, {"probes.csv": "time [s],a\n1,zero\n"},
                                   {"steps.csv": "time [s],a\n1,2,3\n"}, {"steps.csv": "", "scene.toml": "= 1"}])
def test_bad_folder_is_bad_input(tmp_path: Path, files: dict[str, str] | None) -> None:
    folder = tmp_path / "out"
    if files is not None:
        folder.mkdir()
    for name, text in (files or {}).items():
        (folder / name).write_text(text)
    result = plot(folder)
    assert result.returncode == 2
    assert str(folder) in result.stderr and "Traceback" not in result.stderr


def test_broken_frame_is_bad_input(run_folder: Path, tmp_path: Path) -> None:
    (tmp_path / "frames.h5").write_bytes((run_folder / "frames.h5").read_bytes())
    with h5py.File(tmp_path / "frames.h5", "a") as file:
        del file["bodies/000003/position"]
    result = plot(tmp_path)
    assert result.returncode == 2
    assert "frame 3" in result.stderr


def test_unwritable_picture_is_an_output_error(tmp_path: Path) -> None:
    (tmp_path / "steps.csv").write_text("time [s],dt [s]\n1e-9,1e-12\n2e-9,1e-12\n")
    (tmp_path / "steps.png").mkdir()
    result = plot(tmp_path)
    assert result.returncode == 4
    assert str(tmp_path) in result.stderr and "Traceback" not in result.stderr
    assert not list(tmp_path.glob("*.tmp"))


def test_table_with_empty_cells(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("time [s],wall.force_x [N/m],e.kinetic [J/m],count\n0,,1,2\n1,5,,\n")
    table = read_table(tmp_path / "a.csv")
    assert [(c.source, c.name, c.unit) for c in table.columns] == [
        ("wall", "force_x", "N/m"), ("e", "kinetic", "J/m"), ("", "count", "-")]
    force = table.get("force_x", "wall")
    assert force is not None
    assert [list(part) for part in table.sampled(force)] == [[1.0], [5.0]]


def test_caption_states_peak_and_plateau(run_folder: Path) -> None:
    run = read_run(run_folder)
    figure = curves.forces(run)
    assert figure is not None
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    assert "wall 'lower'" in titles[0]
    assert "mean of the last quarter 5.22 kN/m" in titles[0]  # 1 GPa over 6 columns of 0.87 um
    assert titles[1] == "friction factor: peak 0.5 at 1.4 us, mean of the last quarter 0.25"


def test_probes_of_one_quantity_share_a_panel(tmp_path: Path) -> None:
    probes = {"core": ("stress", "soft"), "rim": ("stress", "soft"), "left": ("velocity", "a"), "right": ("velocity", "b")}
    columns = {"core": ["stress_xx [Pa]", "stress_yy [Pa]"], "rim": ["stress_xx [Pa]", "stress_yy [Pa]"],
               **{name: ["velocity_x [m/s]", "angular_velocity [rad/s]"] for name in ("left", "right")}}
    names = [f"{probe}.{column}" for probe, own in columns.items() for column in own]
    values = [f"{t}," + ",".join(str(t * (i + 1)) for i in range(len(names))) for t in range(3)]
    (tmp_path / "probes.csv").write_text("\n".join([",".join(["time [s]", *names]), *values]) + "\n")
    (tmp_path / "scene.toml").write_text("".join(
        f'[[probes]]\nname = "{name}"\nquantity = "{quantity}"\nof = "{of}"\n' for name, (quantity, of) in probes.items()))
    figure = curves.probes(read_run(tmp_path))
    assert figure is not None
    assert [axes.get_ylabel() for axes in figure.axes] == ["stress [Pa]", "velocity [m/s]", "angular velocity [rad/s]"]
    assert [[line.get_label() for line in axes.lines] for axes in figure.axes] == [
        ["core stress xx", "core stress yy", "rim stress xx", "rim stress yy"], ["a x", "b x"], ["a", "b"]]


def write_steps(folder: Path, rejections: int) -> Path:
    rows = "".join(f"{t}e-9,1e-9,1e-4,{rejections},{2 * t},5\n" for t in range(1, 5))
    (folder / "steps.csv").write_text("time [s],dt [s],error [-],rejections,evaluations,contacts\n" + rows)
    return folder


def test_rejections_have_a_panel_when_there_are_some(tmp_path: Path) -> None:
    without = curves.steps(read_run(write_steps(tmp_path, 0)))
    assert without is not None
    assert [axes.get_ylabel() for axes in without.axes] == ["error estimate", "time step [ns]", "contacts"]
    assert without._supxlabel.get_text() == "no rejections in 8 force evaluations"
    some = curves.steps(read_run(write_steps(tmp_path, 2)))
    assert some is not None
    assert [axes.get_ylabel() for axes in some.axes][2] == "rejections so far"
    assert some._supxlabel.get_text() == "2 rejections in 8 force evaluations (25 %)"


def test_the_tolerance_is_drawn(run_folder: Path) -> None:
    figure = curves.steps(read_run(run_folder))
    assert figure is not None
    lines = {line.get_label(): line.get_ydata()[0] for line in figure.axes[0].lines}
    assert lines["tolerance"] == 1e-3
    assert figure.axes[0].get_ylim()[1] > 1e-3


def test_other_probes_have_a_panel(run_folder: Path) -> None:
    figure = curves.probes(read_run(run_folder))
    assert figure is not None and len(figure.axes) == 1  # the friction factor of the wall is among the forces
    assert figure.axes[0].get_ylabel() == "position [um]"
    assert [line.get_label() for line in figure.axes[0].lines] == ["upper x"]
    assert figure.axes[0].get_title(loc="left") == "zero: upper y"


def test_refined_triangles_keep_area_and_field() -> None:
    triangles = np.array([[[0, 0], [10, 0], [0, 1]], [[0, 0], [0.1, 0], [0, 0.1]]], dtype=float)
    small, values = scenery.refined(triangles, 3 * triangles + 1, 0.5)
    edges = np.linalg.norm(small - np.roll(small, 1, axis=1), axis=2)
    assert edges.max() <= 0.5 and len(small) > 100
    side, other = small[:, 1] - small[:, 0], small[:, 2] - small[:, 0]
    areas = 0.5 * (side[:, 0] * other[:, 1] - side[:, 1] * other[:, 0])
    assert areas.min() > 0, "halves keep the sense of rotation"
    assert areas.sum() == pytest.approx(5.005, rel=1e-12)
    assert np.allclose(values, 3 * small + 1, rtol=1e-13)
    nothing, _ = scenery.refined(triangles[:0], triangles[:0], 1.0)
    assert nothing.shape == (0, 3, 2)


@pytest.mark.parametrize("period", [10.0, None])
@pytest.mark.parametrize("box", [(0, 10, -400, 400), (-3, 4, -20, 90), (17, 49, -50, 50)])
def test_bodies_stand_where_any_of_their_images_is_seen(period: float | None, box: wrapping.Box) -> None:
    """INDEPENDENT: all images within 40 periods, tried one by one."""
    random = np.random.default_rng(4)
    low = random.uniform(-300, 300, (200, 2))
    high = low + random.uniform(0.1, 25, (200, 2))
    steps = range(-40, 41) if period else [0]
    expected = [(n, 10.0 * k) for n in range(200) for k in steps
                if high[n, 0] + 10 * k > box[0] and low[n, 0] + 10 * k < box[1]
                and high[n, 1] > box[2] and low[n, 1] < box[3]]
    periods = np.array([[period, 0.0]]) if period else np.empty((0, 2))
    index, shifts = wrapping.images(low, high, periods, box)
    assert expected and list(zip(index, shifts[:, 0])) == expected and (shifts[:, 1] == 0).all()


def test_bodies_at_an_edge_are_copied_whole(run_folder: Path) -> None:
    """Each body has all of its triangles as often as it is seen, moved by whole periods and no otherwise."""
    run = read_run(run_folder)
    scene, grid = scenery.scenery(run, 3), run.frames.grids["bodies"]
    points = run.frames.positions("bodies", 3)
    moved = (scene.triangles - points[grid.cells[scene.cells]]) / np.array([run.period, 1.0])
    assert np.allclose(moved, moved[:, :1, :].round(), atol=1e-9) and (moved[:, :, 1] == 0).all()
    seen = np.bincount(scene.cells, minlength=len(grid.cells)).reshape(24, -1)
    assert (seen == seen[:, :1]).all() and seen.min() == 1 and seen.max() == 2
    x = scene.triangles[:, :, 0].reshape(len(scene.cells) // seen.shape[1], -1)
    assert (x.max(axis=1) > 0).all() and (x.min(axis=1) < run.period).all()


def test_a_wall_is_closed_across_the_period() -> None:
    grid = Grid(np.array([[0, 1], [1, 2], [3, 4], [4, 3]]), np.array([WALL, WALL, 0, 0]), np.array([7, 7, 1, 1]))
    closed = grid.closed_across()
    assert closed.cells.tolist()[4:] == [[0, 2]] and closed.body[4] == 7 and closed.kind[4] == WALL
    segment = np.array([[[0.0, 0.0], [9.0, 0.0]]])
    assert wrapping.shortened(segment, 10.0)[:, :, 0].tolist() == [[0.0, -1.0]]


@pytest.mark.parametrize("value, unit, expected", [(2.5e8, "Pa", (1e-6, "MPa")), (8.7e-5, "m", (1e6, "um")),
                                                   (1e-6, "s", (1e6, "us")), (0.25, "-", (1.0, "-")),
                                                   (0.0, "N/m", (1.0, "N/m")), (999.0, "m/s", (1.0, "m/s"))])
def test_scales(value: float, unit: str, expected: tuple[float, str]) -> None:
    factor, label = units.scale(value, unit)
    assert label == expected[1] and factor == pytest.approx(expected[0], rel=1e-15)


@pytest.mark.parametrize("text, metres", [("87 um", 8.7e-5), ("0.5mm", 5e-4), ("2 m", 2.0), ("1e3 nm", 1e-6),
                                          ("3 µm", 3e-6), (4, 4.0), (0.5, 0.5)])
def test_lengths(text: str | float, metres: float) -> None:
    assert units.length(text) == pytest.approx(metres, rel=1e-15)
    with pytest.raises(ValueError):
        units.length("5 s")


def test_reading_keeps_the_period(run_folder: Path) -> None:
    assert read_run(run_folder).period == pytest.approx(6 * PITCH, rel=1e-9)  # as many digits as the scene is given
    with pytest.raises(BadFolder):
        read_run(run_folder / "scene.toml")
