"""Results go on from wherever they are: outlines are kept with them. All EXACT."""

from __future__ import annotations

import shutil

import pytest

WEDGE = "x [mm], y [mm]\n0, 0\n3, 0\n3, 1\n1, 3\n0, 3\n"

SCENE = """
[time]
end = "2 ms"
[materials.rubber]
law = "linear-elastic"
density = "1000 kg/m3"
young = "200 kPa"
poisson = 0.4
[shapes.wedge]
kind = "file"
file = "shapes/wedge.csv" # a corner
spacing = "0.5 mm"
[[grains]]
shape = "wedge"
packing = { kind = "positions", positions = [[0, 0]] }
body = "compliant"
material = "rubber"
velocity = { gradient = [["200 s-1", 0], [0, "-200 s-1"]] }
[[probes]]
name = "energy"
quantity = "energy"
period = "0.5 ms"
[[contacts]]
between = "all"
law = "frictionless"
"""


@pytest.fixture
def half(desk):
    """Half of a run in `out`, and a whole one in `whole`."""
    desk.write(SCENE)
    (desk.folder / "shapes").mkdir()
    (desk.folder / "shapes/wedge.csv").write_text(WEDGE)
    whole = desk.run("--out", "whole")
    assert whole.returncode == 0 and "linear-elastic" in whole.stderr
    assert desk.run("--out", "out", "--until", "1 ms", "--quiet").returncode == 0
    return desk


def assert_finished(desk, out: str) -> None:
    assert desk.summary(out)["state_hash"] == desk.summary("whole")["state_hash"]


def test_scene_in_the_results_names_its_own_outline(half) -> None:
    kept = (half.folder / "out/scene.toml").read_text()
    assert kept == SCENE.replace("shapes/wedge.csv", "outline_wedge.csv")
    assert (half.folder / "out/outline_wedge.csv").read_text() == WEDGE


def test_resume_without_the_original(half) -> None:
    """Elsewhere, and with nothing but the results."""
    (half.folder / "moved").mkdir()
    shutil.move(half.folder / "out", half.folder / "moved/out")
    half.scene.unlink()
    shutil.rmtree(half.folder / "shapes")
    result = half.engine("run", "--resume", "--out", "moved/out", "--until", "2 ms")
    assert result.returncode == 0, result.stderr
    assert_finished(half, "moved/out")
    assert result.stderr == "", "large strains were warned of before the checkpoint"


def test_resume_with_the_original(half) -> None:
    assert half.run("--out", "out", "--resume", "--quiet").returncode == 0
    assert_finished(half, "out")


def test_another_outline_is_refused(half) -> None:
    (half.folder / "shapes/wedge.csv").write_text(WEDGE.replace("1, 3", "1.1, 3"))
    result = half.run("--out", "out", "--resume", "--quiet")
    assert result.returncode == 2 and "shapes/wedge.csv: not the outline" in result.stderr, result.stderr
    assert (half.folder / "out/outline_wedge.csv").read_text() == WEDGE


def test_a_kept_scene_can_be_run_over_itself(half) -> None:
    """Scene and outline are read before the folder is emptied."""
    result = half.engine("run", "out/scene.toml", "--out", "out", "--force", "--quiet")
    assert result.returncode == 0, result.stderr
    assert_finished(half, "out")


def test_byte_order_marks(desk) -> None:
    """Of scene and outline: the copies have none, and the run goes on from them."""
    desk.write("\ufeff" + SCENE)
    (desk.folder / "shapes").mkdir()
    (desk.folder / "shapes/wedge.csv").write_text("\ufeff" + WEDGE)
    assert desk.run("--out", "out", "--until", "1 ms", "--quiet").returncode == 0
    assert (desk.folder / "out/scene.toml").read_text() == SCENE.replace("shapes/wedge.csv", "outline_wedge.csv")
    assert (desk.folder / "out/outline_wedge.csv").read_text() == WEDGE
    assert desk.run("--out", "out", "--resume", "--quiet").returncode == 0


LISTED = SCENE.replace("linear-elastic", "neo-hookean").replace(
    '{ kind = "positions", positions = [[0, 0]] }', '{ kind = "file", file = "shapes/places.csv", unit = "mm" }')
PLACES = "x, y, scale, angle [deg]\n0, 0, 1, 0\n10, 0, 1.5, 30\n"


def test_places_of_grains_are_kept_too(desk) -> None:
    desk.write(LISTED)
    (desk.folder / "shapes").mkdir()
    (desk.folder / "shapes/wedge.csv").write_text(WEDGE)
    places = desk.folder / "shapes/places.csv"
    places.write_text(PLACES)
    for out, until in (("whole", "2 ms"), ("out", "1 ms")):
        assert desk.run("--out", out, "--until", until, "--quiet").returncode == 0
    kept = (desk.folder / "out/scene.toml").read_text()
    assert kept == LISTED.replace("shapes/wedge.csv", "outline_wedge.csv").replace("shapes/places.csv",
                                                                                  "packing_grains.csv")
    assert (desk.folder / "out/packing_grains.csv").read_text() == PLACES
    places.write_text(PLACES.replace("30", "31"))
    result = desk.run("--out", "out", "--resume", "--quiet")
    assert result.returncode == 2 and "places.csv: not the table of grains" in result.stderr, result.stderr
    shutil.rmtree(desk.folder / "shapes")
    desk.scene.unlink()
    assert desk.engine("run", "--resume", "--out", "out", "--until", "2 ms").returncode == 0
    assert_finished(desk, "out")
