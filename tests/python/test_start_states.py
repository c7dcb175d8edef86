"""Scenes that start from the end of another run, from Python and in studies."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import pliant
from pliant.results import read_json
from pliant.scene import Scene

ROOT = Path(os.environ.get("PLIANT_SOURCE_DIR", Path(__file__).parents[2]))
SCENE = """
[time]
end = 0.2
[materials.hard]
law = "rigid"
density = 1
[shapes.disc]
kind = "disc"
diameter = 1
nodes = 40
[[grains]]
name = "disc"
shape = "disc"
body = "rigid"
material = "hard"
packing = { kind = "positions", positions = [[0, 0]] }
velocity = { uniform = [1, 0] }
[[contacts]]
between = "all"
law = "mohr-coulomb"
stiffness = 1
friction = 0
[[probes]]
name = "energy"
quantity = "energy"
period = 0.1
"""
STUDY = """
scene = "scenes/next.toml"
[[parameters]]
name = "friction"
path = "contacts.0.friction"
values = [0.1, 0.2]
[[quantities]]
name = "steps"
summary = "steps"
"""


@pytest.fixture(params=["folder", "file"])
def folder(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    """A run in `pressed`, and a scene in a folder beside it that starts from there: as a folder, or as a file."""
    (tmp_path / "scenes").mkdir()
    (tmp_path / "scenes/first.toml").write_text(SCENE)
    pliant.run(tmp_path / "scenes/first.toml", tmp_path / "pressed")
    name = "../pressed" + ("/final.bin" if request.param == "file" else "")
    (tmp_path / "scenes/next.toml").write_text(f'{SCENE}[start]\nfrom = "{name}"\n')
    (tmp_path / "study.toml").write_text(STUDY)
    return tmp_path


def test_a_scene_is_checked_and_run_from_where_it_starts(folder: Path) -> None:
    """EXACT: from the state that the engine starts from when it reads the file itself."""
    scene = Scene.read(folder / "scenes/next.toml")
    assert scene.files() == []
    assert "from 'first' at its t = 0.2 s" in scene.check().text
    scene["contacts.0.friction"] = 0.3
    first = read_json(folder / "pressed/summary.json")
    assert pliant.run(scene, folder / "next").summary["started_from"]["state_hash"] == first["state_hash"]


def study(folder: Path) -> list[dict]:
    result = subprocess.run([sys.executable, "-B", "-m", "pliant.study", folder / "study.toml", "--out", folder / "out",
                             "--cores", "2"], capture_output=True, text=True, timeout=300, check=False,
                            env={**os.environ, "PYTHONPATH": str(ROOT / "python")})
    assert result.returncode == 0, result.stdout + result.stderr
    summaries = [read_json(file) for file in sorted(folder.glob("out/runs/*/results/summary.json"))]
    assert len(summaries) == 2
    return summaries


def test_a_study_starts_from_it_and_anew_when_it_changed(folder: Path) -> None:
    """EXACT: all runs from that state; from the new one when it changed; from a copy, when it went."""
    hashes = []
    for end in ["0.2", "0.3"]:
        (folder / "scenes/first.toml").write_text(SCENE.replace("end = 0.2", f"end = {end}"))
        pliant.run(folder / "scenes/first.toml", folder / "pressed")
        hashes.append(read_json(folder / "pressed/summary.json")["state_hash"])
        assert [one["started_from"]["state_hash"] for one in study(folder)] == 2 * hashes[-1:]
    assert hashes[0] != hashes[1]
    times = [file.stat().st_mtime_ns for file in sorted(folder.glob("out/runs/*/outcome.json"))]
    study(folder)
    assert times == [file.stat().st_mtime_ns for file in sorted(folder.glob("out/runs/*/outcome.json"))], "as it was"


def test_a_state_that_is_not_there_is_missed_where_the_scene_names_it(folder: Path) -> None:
    shutil.rmtree(folder / "pressed")
    with pytest.raises(pliant.BadScene, match=f"there is no {folder}.*pressed"):
        Scene.read(folder / "scenes/next.toml").check()


def test_a_table_without_a_dot_in_its_name_goes_along(tmp_path: Path) -> None:
    (tmp_path / "table").write_text("x,y\n0,0\n")
    text = SCENE.replace('{ kind = "positions", positions = [[0, 0]] }', '{ kind = "file", file = "table" }')
    (tmp_path / "scene.toml").write_text(text)
    scene = Scene.read(tmp_path / "scene.toml")
    assert scene.files() == ["table"]
    assert scene.check().evaluations
