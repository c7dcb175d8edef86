"""A run that starts from where another one ended, with other loads and laws."""

from __future__ import annotations

import shutil

import numpy as np
import pytest
from conftest import Desk
from scenes import LAYER, line_of

# Contacts repay no energy: what they owe at the end is not carried, and friction feels what they just repay.
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
    """EXACT: positions, forces and energies to the digits that are written; books take none of it for work."""
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
    "debts": ("energy_consistent = false", "energy_consistent = true"),
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
    "recipe": ("[materials.soft]", '[discretisation]\nrecipe = "t3"\n[materials.soft]', "discretisation"),
    "law of a material": ('"neo-hookean"', '"melody"', "materials.soft.law"),
    "seed": ("seed = 3", "seed = 4", "grains 1.seed"),
    "rows": ("rows = 3", "rows = 2", "grains 1.packing.rows"),
    "level": ("level = 5.04", "level = 5.05", "walls 2.level"),
    "self-contact": ("energy_consistent = false", "self_contact = true", "contact"),
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
        assert f"'{key}'" in result.stderr and str(desk.scene) in result.stderr
    assert desk.content() == before


def test_without_a_state_it_says_so(desk) -> None:
    """EXACT: the place of the key, or the file that is not there; exit code 2, nothing written."""
    desk.write(AFTER.replace('"first"', '"frist"'))
    before = desk.content()
    result = desk.run("--out", "next")
    assert result.returncode == 2
    assert f"{desk.scene}:{line_of(AFTER, 'from =')}:" in result.stderr and "frist" in result.stderr
    desk.write(AFTER)
    (desk.folder / "first/final.bin").rename(desk.folder / "first/other.bin")
    result = desk.run("--out", "next")
    assert result.returncode == 2 and "final.bin" in result.stderr and "--resume" in result.stderr
    assert not (desk.folder / "next").exists()
    assert len(desk.content()) == len(before)
    desk.write(AFTER.replace('"first"', '"first/checkpoint.bin"'))
    result = desk.run("--out", "next")
    assert result.returncode == 2 and "no state to start from" in result.stderr
    result = desk.reference("--out", "next")
    assert result.returncode == 2 and "[start]" in result.stderr


def test_a_damaged_state_is_refused(desk) -> None:
    """EXACT"""
    file = desk.folder / "first/final.bin"
    content = bytearray(file.read_bytes())
    content[len(content) // 2] ^= 1
    file.write_bytes(content)
    result = desk.run("--out", "next")
    assert result.returncode == 4 and "damaged" in result.stderr
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


def test_check_says_where_it_starts(desk) -> None:
    """EXACT"""
    result = desk.engine("check", desk.scene)
    assert result.returncode == 0, result.stderr
    assert "from 'scene' at its t = 2 s" in result.stdout
