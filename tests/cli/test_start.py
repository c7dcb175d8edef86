"""A run that starts from where another one ended, with other loads and laws."""

from __future__ import annotations

import shutil

import numpy as np
import pytest
from conftest import Desk
from scenes import LAYER, line_of

# Without energy correction: a start does not carry it, and friction depends on it.
STEADY = LAYER.replace("[[contacts]]", "[contact]\nenergy_consistent = false\n[[contacts]]", 1).replace("velocity = [[0, 0.3], [1, 0.6]]", "velocity = 0.3").replace(
    "pressure = [[0, 0], [2, 0.1]]", "pressure = 0.05").replace('of = "grains"\nperiod = 0.015', 'of = "grains 4"\nperiod = 0.01')
AFTER = STEADY.replace("[time]\nend = 4", '[start]\nfrom = "first"\n[time]\nend = 1')


@pytest.fixture(scope="module")
def finished(tmp_path_factory) -> Desk:
    """A run until 2 in `first`, and one until 3 in `whole`."""
    desk = Desk(tmp_path_factory.mktemp("start"))
    desk.write(STEADY)
    for out, until in [("first", "2"), ("whole", "3")]:
        result = desk.run("--out", out, "--until", until, "--quiet")
        assert result.returncode == 0, result.stderr
    return desk


@pytest.fixture
def desk(finished, tmp_path) -> Desk:
    """The end of the first run, alone with what the test makes of it."""
    shutil.copytree(finished.folder / "first", tmp_path / "first")
    made = Desk(tmp_path)
    made.write(AFTER)
    return made


def at(desk: Desk, out: str, time: float) -> dict[str, float]:
    """What probes show nearest to a time, by the columns' names."""
    table = desk.table(f"{out}/probes.csv")
    shown = {}
    for column in table.columns:
        times, values = table.sampled(column)
        if len(times):
            shown[column.full_name] = float(values[np.argmin(abs(times - time))])
    return shown


def test_it_begins_where_the_other_one_ended(desk, finished) -> None:
    """EXACT: positions, forces and energies to the digits that are written; energy balance take none of it for work."""
    result = desk.run("--out", "next")
    assert result.returncode == 0, result.stderr
    assert "starting from 'scene' at its t = 2 s" in result.stdout
    first, summary = finished.summary("first"), desk.summary("next")
    assert summary["started_from"] == {"scene": "scene", "time": 2.0, "state_hash": first["state_hash"]}
    assert summary["initial_overlap"]["pairs"] == 0
    ended, begun = at(finished, "first", 2), at(desk, "next", 0)
    for name in ended:
        if "work" in name or "dissipated" in name or "error" in name:
            assert begun[name] == pytest.approx(0, abs=1e-12), name
        else:
            assert begun[name] == pytest.approx(ended[name], rel=1e-9, abs=1e-12), name
    assert summary["energy"]["balance_error"] < 0.01, "the promise of 1 %"


def test_it_goes_on_as_the_other_one_did(desk, finished) -> None:
    """INDEPENDENT: steps are others, by less than half, so that they differ by less than what halved steps change."""
    fine = Desk(desk.folder)
    fine.write(STEADY.replace("[time]", "[time]\nsafety = 0.4"))
    assert fine.run("--out", "fine", "--until", "3", "--quiet").returncode == 0
    desk.write(AFTER)
    assert desk.run("--out", "next", "--quiet").returncode == 0
    went_on, halved, begun = at(finished, "whole", 3), at(desk, "fine", 3), at(desk, "next", 1)
    names = [name for name in went_on if name.startswith("where")]
    assert names
    error = max(abs(went_on[name] - halved[name]) for name in names)
    assert max(abs(went_on[name] - begun[name]) for name in names) < error


CHANGES = {
    "pressure": ("pressure = 0.05", "pressure = [[0, 0.05], [0.5, 0.02]]"),
    "drive": ("velocity = 0.3 }", "force = 0 }"),
    "friction": ("friction = 0.4", "friction = 0"),
    "law": ('law = "cohesive"\nstrength = 0.1', 'law = "frictionless"'),
    "stiffness of a material": ("young = 2.8", "young = 3"),
    "gravity": ("period = 6", "period = 6\ngravity = [0, -0.01]"),
    "integrator": ("end = 1", 'end = 0.1\nintegrator = "step-doubling"'),
    "contact": ("energy_consistent = false", 'skin = 1\nlength = "current"'),
    "correction": ("energy_consistent = false", "energy_consistent = true"),
    "outputs": ("period = 0.5", "period = 0.1"),
}


@pytest.mark.parametrize("change", CHANGES)
def test_what_may_change(desk, change) -> None:
    """EXACT: it runs, and to another state than without the change."""
    old, new = CHANGES[change]
    assert old in AFTER
    desk.write(AFTER.replace("end = 1", "end = 0.2"))
    assert desk.run("--out", "same", "--quiet").returncode == 0
    desk.write(AFTER.replace("end = 1", "end = 0.2").replace(old.replace("end = 1", "end = 0.2"), new, 1))
    result = desk.run("--out", "next", "--quiet")
    assert result.returncode == 0, result.stderr
    assert (desk.summary("next")["state_hash"] == desk.summary("same")["state_hash"]) == (change == "outputs")


REFUSED = {
    "period": ("period = 6", "period = 6.5", "domain.period"),
    "nodes": ("nodes = 40", "nodes = 60", "shapes.disc.nodes"),
    "method": ("[materials.soft]", '[discretisation]\nmethod = "t3"\n[materials.soft]', "discretisation.method"),
    "law of a material": ('"neo-hookean"', '"melody"', "materials.soft.law"),
    "seed": ("seed = 3", "seed = 4", "grains 1.seed"),
    "rows": ("rows = 3", "rows = 2", "grains 1.packing.rows"),
    "level": ("level = 5.04", "level = 5.05", "walls 2.level"),
    "self-contact": ("energy_consistent = false", "self_contact = true", "contact.self_contact"),
    "quadrature": ("energy_consistent = false", 'quadrature = "segments"', "contact.quadrature"),
}


@pytest.mark.parametrize("change", REFUSED)
def test_other_bodies_are_refused(desk, change) -> None:
    """EXACT: the key, exit code 2, and nothing written."""
    old, new, key = REFUSED[change]
    assert old in AFTER
    desk.write(AFTER.replace(old, new, 1))
    before = desk.content()
    for command in ["run", "check"]:
        result = desk.engine(command, desk.scene)
        assert result.returncode == 2, result.stderr
        assert f"'{key}'" in result.stderr
        place = result.stderr.split(f"{desk.scene}:")[1].split(":")[0]
        line = desk.scene.read_text().splitlines()[int(place) - 1]
        assert any(part in line for part in new.split("\n")), line
    assert desk.content() == before


WRONG = {
    "nothing": ("frist", "there is no"),
    "a folder without a state": (".", "there is no"),
    "an empty name": ("", "found"),
    "a scene": ("scene.toml", "is not a checkpoint"),
    "a table": ("first/probes.csv", "is not a checkpoint"),
    "an empty file": ("empty", "is not a checkpoint"),
    "a part of a state": ("cut", "is damaged"),
    "a changed state": ("flipped", "is damaged"),
    "a checkpoint": ("first/checkpoint.bin", "no state to start from"),
}


@pytest.mark.parametrize("what", WRONG)
def test_what_is_no_state_is_refused(desk, what) -> None:
    """EXACT: the place of the key, what it names and what it may; exit code 2, nothing written."""
    name, why = WRONG[what]
    state = (desk.folder / "first/final.bin").read_bytes()
    (desk.folder / "empty").touch()
    (desk.folder / "cut").write_bytes(state[:-100])
    (desk.folder / "flipped").write_bytes(state[:-100] + bytes([state[-100] ^ 1]) + state[-99:])
    text = AFTER.replace('"first"', f'"{name}"')
    desk.write(text)
    before = desk.content()
    for command in ["run", "check"]:
        result = desk.engine(command, desk.scene)
        assert result.returncode == 2, result.stderr
        assert f"{desk.scene}:{line_of(text, 'from =')}:8: 'from' in [start]: " in result.stderr
        assert name in result.stderr and why in result.stderr
        assert "allowed: the output folder of a run that has come to its end" in result.stderr
        assert "--force" not in result.stderr
    assert desk.content() == before


def test_a_run_that_has_not_ended_is_to_go_on(desk) -> None:
    """EXACT"""
    (desk.folder / "first/final.bin").unlink()
    result = desk.run("--out", "next")
    assert result.returncode == 2 and "final.bin" in result.stderr and "--resume" in result.stderr
    result = desk.reference("--out", "next")
    assert result.returncode == 2 and "[start]" in result.stderr
    assert not (desk.folder / "next").exists()


def test_results_hold_the_state_that_they_started_from(desk) -> None:
    """EXACT: they are run again, and go on, without the other run's folder."""
    assert desk.run("--out", "next", "--quiet").returncode == 0
    assert desk.run("--out", "half", "--until", "0.5", "--quiet").returncode == 0
    shutil.rmtree(desk.folder / "first")
    desk.scene.unlink()
    kept = (desk.folder / "next/scene.toml").read_text()
    assert kept == AFTER.replace('"first"', '"start.bin"')
    assert desk.engine("run", "next/scene.toml", "--out", "again", "--quiet").returncode == 0
    assert desk.engine("run", "--resume", "--out", "half", "--until", "1", "--quiet").returncode == 0
    hashes = {desk.summary(out)["state_hash"] for out in ["next", "again", "half"]}
    assert len(hashes) == 1
    assert len({str(desk.summary(out)["started_from"]) for out in ["next", "again", "half"]}) == 1
    files = {(desk.folder / out / "final.bin").read_bytes() for out in ["next", "half"]}
    assert len(files) == 1, "a run that went on leaves what one without a stop leaves"


def test_other_spellings_of_the_same_bodies_start(desk) -> None:
    """EXACT"""
    desk.write(AFTER.replace("period = 6", 'period = "600 cm"').replace("diameter = 2", 'diameter = "2 m"'))
    result = desk.engine("check", desk.scene)
    assert result.returncode == 0, result.stderr


DISC = "".join(f"{x:.6f},{y:.6f}\n" for x, y in zip(np.cos(np.arange(40) * np.pi / 20), np.sin(np.arange(40) * np.pi / 20)))
TABLE = "x,y\n1,0\n3,0\n"
FROM_FILES = """\
[time]
end = 0.1
[materials.hard]
law = "rigid"
density = 1
[shapes.disc]
kind = "file"
file = "disc.csv"
nodes = 40
[[grains]]
name = "discs"
shape = "disc"
body = "rigid"
material = "hard"
packing = { kind = "file", file = "table.csv" }
velocity = { uniform = [1, 0] }
[[contacts]]
between = "all"
law = "frictionless"
stiffness = 1
"""


@pytest.fixture
def from_files(tmp_path) -> Desk:
    """A run of an outline and a table of grains, in `first`; its state alone, in state.bin."""
    desk = Desk(tmp_path)
    (tmp_path / "disc.csv").write_text(DISC)
    (tmp_path / "table.csv").write_text(TABLE)
    desk.write(FROM_FILES)
    result = desk.run("--out", "first", "--quiet")
    assert result.returncode == 0, result.stderr
    shutil.copyfile(tmp_path / "first/final.bin", tmp_path / "state.bin")
    return desk


@pytest.mark.parametrize("file, old, new", [("disc.csv", "1.000000,0.000000", "1.010000,0.000000"),
                                            ("table.csv", "3,0", "3,0.01")])
def test_a_state_knows_its_outlines_and_tables(from_files, file, old, new) -> None:
    """EXACT: other bodies by a file, with as many nodes, are refused; where a run goes on, before anything is written."""
    desk = from_files
    desk.write(FROM_FILES + '[start]\nfrom = "state.bin"\n')
    assert desk.engine("check", desk.scene).returncode == 0
    original = (desk.folder / file).read_text()
    assert old in original
    (desk.folder / file).write_text(original.replace(old, new))
    result = desk.run("--out", "next")
    assert result.returncode == 2 and "other bodies" in result.stderr, result.stderr
    assert f"{desk.scene}:{line_of(desk.scene.read_text(), 'from =')}:" in result.stderr
    assert not (desk.folder / "next").exists()
    copy = next((desk.folder / "first").glob("outline_*" if file == "disc.csv" else "packing_*"))
    copy.write_text(copy.read_text().replace(old, new))
    before = {path: path.read_bytes() for path in desk.content() if path.is_file()}
    result = desk.engine("run", "--resume", "--out", "first", "--until", "0.2")
    assert result.returncode == 2 and "other bodies" in result.stderr, result.stderr
    assert {path: path.read_bytes() for path in desk.content() if path.is_file()} == before


def test_a_run_goes_on_from_the_state_that_it_started_from(desk) -> None:
    """EXACT: another one is refused; one that is gone is not missed, as the folder keeps it."""
    assert desk.run("--out", "next", "--until", "0.1", "--quiet").returncode == 0
    assert desk.engine("run", "--resume", "--out", "first", "--until", "2.1", "--quiet").returncode == 0
    before = {path: path.read_bytes() for path in desk.content() if path.is_file()}
    result = desk.run("--out", "next", "--until", "0.2", "--resume")
    assert result.returncode == 2 and "start.bin" in result.stderr, result.stderr
    assert f"{desk.scene}:{line_of(AFTER, 'from =')}:" in result.stderr
    assert {path: path.read_bytes() for path in desk.content() if path.is_file()} == before
    shutil.rmtree(desk.folder / "first")
    result = desk.run("--out", "next", "--until", "0.2", "--resume", "--quiet")
    assert result.returncode == 0, result.stderr
    assert desk.summary("next")["time"] == pytest.approx(0.2)
    (desk.folder / "killed").mkdir()  # before its first checkpoint
    (desk.folder / "killed/run.lock").touch()
    shutil.copyfile(desk.folder / "next/start.bin", desk.folder / "killed/start.bin")
    result = desk.run("--out", "killed", "--until", "0.2", "--resume", "--quiet")
    assert result.returncode == 0, result.stderr
    assert desk.summary("killed")["state_hash"] == desk.summary("next")["state_hash"]


def test_check_says_where_it_starts(desk) -> None:
    """EXACT"""
    result = desk.engine("check", desk.scene)
    assert result.returncode == 0, result.stderr
    assert "from 'scene' at its t = 2 s" in result.stdout
