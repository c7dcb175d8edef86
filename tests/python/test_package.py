"""The package: scenes read, changed and written; runs begun and opened."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import pliant
from pliant.scene import Scene

ROOT = Path(os.environ.get("PLIANT_SOURCE_DIR", Path(__file__).parents[2]))
TWO_DISCS = ROOT / "cases/two_discs.toml"


@pytest.fixture
def scene() -> Scene:
    scene = Scene.read(TWO_DISCS)
    scene["time.end"] = "1 ns"
    scene["shapes.disc.nodes"] = 40
    return scene


def test_a_changed_scene_keeps_all_else(scene: Scene) -> None:
    old, new = TWO_DISCS.read_text().splitlines(), scene.text().splitlines()
    assert [(a, b) for a, b in zip(old, new, strict=True) if a != b] == [('end = "10 ns"', 'end = "1 ns"'),
                                                                         ("nodes = 168", "nodes = 40")]


def test_reading_results_needs_h5py_and_numpy_alone() -> None:
    """EXACT: every other package is kept from being imported; a scene then says which one it lacks."""
    code = """
import importlib.abc, sys
class Refuses(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in {"tomlkit", "scipy", "matplotlib", "jinja2", "markdown", "snakemake"}:
            raise ModuleNotFoundError(f"refused: {name}", name=name)
sys.meta_path.insert(0, Refuses())
import pliant, pliant.network, pliant.coarse
try:
    pliant.open(".")
except pliant.BadFolder:
    print("read")
try:
    pliant.Scene
except ModuleNotFoundError as error:
    print(error.name)
"""
    result = subprocess.run([sys.executable, "-B", "-c", code], capture_output=True, text=True,
                            env={**os.environ, "PYTHONPATH": str(ROOT / "python")})
    assert (result.returncode, result.stdout) == (0, "read\ntomlkit\n"), result.stderr


def test_members_by_number_and_by_name(scene: Scene) -> None:
    scene["grains.right.velocity.uniform.0"] = "-7 m/s"
    assert scene["grains.1.velocity.uniform"] == ["-7 m/s", "0 m/s"]
    scene["discretisation.mass"] = "corrected"
    assert "[discretisation]" in scene.text() and "grains.middle.name" not in scene


@pytest.mark.parametrize("path, message", [
    ("grains.rigth.seed", "did you mean 'right'"), ("shapes.disk.nodes", "did you mean 'disc'"),
    ("grains.7.seed", "no member '7'"), ("time.end.unit", "a value, not a table")])
def test_wrong_paths(scene: Scene, path: str, message: str) -> None:
    before = scene.text()
    with pytest.raises(KeyError, match=message):
        scene[path] = 1
    assert scene.text() == before


def test_the_engine_says_what_is_wrong(scene: Scene, tmp_path: Path) -> None:
    scene["materials.soft.poisson"] = 0.7
    with pytest.raises(pliant.BadScene, match="poisson"):
        scene.check()
    with pytest.raises(pliant.BadScene, match="poisson"):
        pliant.run(scene, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_warnings_of_the_engine_come_through(scene: Scene, tmp_path: Path) -> None:
    scene["contact"] = {"refresh": "1 s"}
    scene["time.end"] = "5 ns"
    with pytest.warns(pliant.EngineWarning, match="contacts can be missed") as found:
        run = pliant.run(scene, tmp_path / "out")
        scene.run(tmp_path / "again")
        (tmp_path / "scene.toml").write_text(scene.text())
        pliant.run(tmp_path / "scene.toml", tmp_path / "of_a_file")
    assert any("contacts can be missed" in text for text in run.warnings)
    assert {warning.filename for warning in found} == {__file__}  # they name the user's line, whatever the call


def test_a_run_is_as_estimated_and_opens(scene: Scene, tmp_path: Path) -> None:
    """A run within a second is counted by `check`, to the three digits that it prints."""
    estimate = scene.check()
    run = pliant.run(scene, tmp_path / "out")
    assert estimate.evaluations == pytest.approx(run.summary["evaluations"], rel=5e-3)
    assert estimate.seconds is not None and estimate.memory is not None
    assert estimate.output == pytest.approx(sum(f.stat().st_size for f in (tmp_path / "out").iterdir()), rel=0.5)
    again = pliant.open(tmp_path / "out")
    assert again.summary["state_hash"] == run.summary["state_hash"]
    column = again.probes.column("velocity_left.velocity_x")
    assert column.unit == "m/s" and column.values[0] == pytest.approx(50)
    last = len(again.frames.times) - 1
    moved = again.frames.positions("bodies", last)[:, 0] - again.frames.positions("bodies", 0)[:, 0]
    assert np.abs(moved).max() > 1e-8
    with pytest.raises(pliant.BadFolder):
        pliant.open(tmp_path)


def test_what_a_run_did_not_write_is_named(tmp_path: Path) -> None:  # EXACT
    (tmp_path / "steps.csv").write_text("time [s],dt [s]\n")
    run = pliant.open(tmp_path)
    assert not run.has_frames
    with pytest.raises(pliant.BadFolder, match=r"the run has no frames; its scene asks for them with \[frames\]"):
        run.frames.nearest(0)
    with pytest.raises(KeyError, match=r"probes\.csv: no column energy\.kinetic; there is no such file"):
        run.probes.column("energy.kinetic")
    with pytest.raises(KeyError, match=r"steps\.csv: no column dt; the file has no rows"):
        run.steps.column("dt")
    (tmp_path / "probes.csv").write_text("time [s],energy.strain [J/m]\n0,1\n")
    with pytest.raises(KeyError, match="no column energy.kinetic; there are energy.strain"):
        pliant.open(tmp_path).values("energy.kinetic")


def test_files_that_a_scene_names_go_along(tmp_path: Path) -> None:
    text = (ROOT / "docs/keys/grains.toml").read_text()
    for name in ["outline.csv", "grains.csv", "two_parts.msh"]:
        (tmp_path / name).write_text((ROOT / "docs/keys" / name).read_text())
    (tmp_path / "grains.toml").write_text(text)
    scene = Scene.read(tmp_path / "grains.toml")
    assert scene.files() == ["grains.csv", "outline.csv", "two_parts.msh"]
    assert scene.check().memory is not None
    (tmp_path / "below").mkdir()
    (tmp_path / "below/grains.toml").write_text(text.replace("outline.csv", "../outline.csv"))
    with pytest.raises(pliant.BadScene, match="at or below"):
        Scene.read(tmp_path / "below/grains.toml").check()


def test_a_byte_order_mark_is_no_text(tmp_path: Path) -> None:
    (tmp_path / "marked.toml").write_text("\ufeff" + TWO_DISCS.read_text())
    assert Scene.read(tmp_path / "marked.toml").text() == TWO_DISCS.read_text()
