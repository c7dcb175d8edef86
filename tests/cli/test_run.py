"""A short run from the command line: files, keys, same bits for any number of threads."""

from __future__ import annotations

import csv
import os
import re
import subprocess

import h5py
import numpy as np
import pytest
from conftest import ENGINE, REFERENCE, ROOT
from scenes import TWO_DISCS

SUMMARY_KEYS = {"state_hash", "evaluations", "steps", "rejections", "preparation_seconds", "wall_seconds", "phase_seconds",
                "evaluations_per_second", "energy", "momentum_error", "peak_memory_bytes", "bodies", "nodes", "dofs",
                "commit", "compiler", "threads"}
ENERGY_KEYS = {"kinetic", "strain", "contact", "dissipated", "external_work", "balance_error"}


@pytest.fixture
def finished(desk):
    """A desk with results in `out`."""
    desk.write(TWO_DISCS)
    result = desk.run("--out", "out", "--threads", "1", "--quiet")
    assert result.returncode == 0, result.stderr
    return desk


def test_summary_has_the_documented_keys(finished) -> None:  # EXACT
    summary = finished.summary("out")
    assert SUMMARY_KEYS <= summary.keys()
    assert ENERGY_KEYS <= summary["energy"].keys()


def test_summary_counts(finished) -> None:  # EXACT
    summary = finished.summary("out")
    assert summary["bodies"] == 2
    assert summary["nodes"] == 120
    assert summary["dofs"] == 240
    assert summary["threads"] == 1
    assert summary["evaluations"] >= summary["steps"] > 0
    assert re.fullmatch(r"[0-9a-f]{7,40}(-dirty)?|unknown", summary["commit"])


def test_a_program_says_what_it_was_built_from(finished) -> None:  # EXACT
    assert finished.engine("--version").stdout.strip() == finished.summary("out")["commit"]


def test_the_discs_met_and_energy_balances(finished) -> None:  # EXACT: 1 % of the initial energy is the promise
    energy = finished.summary("out")["energy"]
    assert energy["strain"] > 0
    assert abs(energy["balance_error"]) < 0.01


def test_momentum_balances(finished) -> None:  # EXACT: rounding over a run of some thousand evaluations
    assert finished.summary("out")["momentum_error"] < 1e-10


def test_tables_are_complete(finished) -> None:  # EXACT
    for name in ["probes.csv", "steps.csv"]:
        rows = list(csv.reader((finished.folder / "out" / name).open()))
        assert len(rows) > 2, name
        assert {len(row) for row in rows} == {len(rows[0])}, name


def test_frames_read_back(finished) -> None:  # EXACT
    with h5py.File(finished.folder / "out/frames.h5") as file:
        frames = [group for name, group in sorted(file["bodies"].items()) if name.isdigit()]
        times = [float(frame.attrs["time"]) for frame in frames]
        positions = [frame["position"][:] for frame in frames]
    assert times == pytest.approx([0, 10e-9, 20e-9])
    assert all(np.isfinite(position).all() for position in positions)
    assert (finished.folder / "out/frames.xdmf").is_file()


@pytest.mark.parametrize("stops", ["false", "true"])
def test_until_ends_the_run(desk, stops) -> None:  # EXACT
    desk.write(TWO_DISCS.replace("[time]", f"[time]\nstop_at_outputs = {stops}"))
    assert desk.run("--out", "out", "--until", "3 ns", "--quiet").returncode == 0
    end, last = desk.summary("out")["time"], desk.table("out/steps.csv").time[-1]
    assert end == pytest.approx(3e-9, rel=1e-15)
    assert last == end if stops == "true" else 2.9e-9 < last < end


@pytest.mark.parametrize("program, options, folder", [
    ("engine", [], "results/scene"), ("engine", ["--out", "my results"], "my results"),
    ("reference", [], "results/scene_reference"), ("reference", ["--out=o"], "o")])
def test_where_results_go_is_told(desk, monkeypatch, program: str, options: list[str], folder: str) -> None:  # EXACT
    monkeypatch.setenv("PLIANT_TELL_FOLDER", str(desk.folder / "told"))
    desk.write(TWO_DISCS)
    start = desk.run if program == "engine" else desk.reference
    for again in ([], ["--resume"] if program == "engine" else ["--force"]):  # "nothing to do" has a folder too
        assert start("--until", "1 ns", "--quiet", *options, *again).returncode == 0
        assert (desk.folder / "told").read_text() == f"{folder}\n"
        assert (desk.folder / folder / "summary.json").is_file()
        (desk.folder / "told").unlink()


@pytest.mark.parametrize("command, program", [
    ("run", [ENGINE, "run"]), ("check", [ENGINE, "check"]), ("modes", [ENGINE, "modes"]), ("reference", [REFERENCE])])
def test_help_of_the_launcher_has_the_options_of_the_program(command: str, program: list[str]) -> None:  # EXACT
    said = subprocess.run([*program, "--help"], capture_output=True, text=True).stdout
    told = (ROOT / f"launcher/help/{command}.txt").read_text()
    assert options_in(said) - {"--help"} == options_in(told.rpartition("Example:")[0]) - {"--no-plot"}


def options_in(text: str) -> set[str]:
    return set(re.findall(r"(?<![\w-])--[a-z-]+", text))


def test_default_folder_is_named_after_the_scene(desk) -> None:  # EXACT
    desk.write(TWO_DISCS)
    assert desk.run("--until", "1 ns", "--quiet").returncode == 0
    assert (desk.folder / "results/scene/summary.json").is_file()


def test_quiet_is_quiet(desk) -> None:  # EXACT
    desk.write(TWO_DISCS)
    result = desk.run("--until", "1 ns", "--quiet")
    assert result.stdout == "" and result.stderr == ""


MISSED = TWO_DISCS.replace("[time]", "[contact]\nrefresh = \"1 s\"\n\n[time]")


def test_warnings_stay_in_the_summary_when_quiet_and_after_a_stop(desk) -> None:  # EXACT
    """The discs meet before the only search of contacts is repeated."""
    desk.write(MISSED)
    for options in (["--until", "10 ns"], ["--resume"]):
        result = desk.run("--out", "out", "--quiet", *options)
        assert result.returncode == 0 and not result.stderr, result.stderr
        found = [text for text in desk.summary("out")["warnings"] if "contacts can be missed" in text]
        assert len(found) == 1, desk.summary("out")["warnings"]
    late = '[[boundary]]\nof = "grains"\npressure = "1 kPa"\nfrom = "15 ns"\n'
    desk.write(TWO_DISCS + late)
    assert desk.run("--out", "other", "--quiet", "--until", "10 ns").returncode == 0
    assert any("it never is" in text for text in desk.summary("other")["warnings"])
    assert desk.run("--out", "other", "--quiet", "--resume").returncode == 0
    assert desk.summary("other")["warnings"] == [], "of an end that is none any more"


# A pressure bends the thin arm of a clip into the thick one.
CLIP = """\
[time]
end = 10

[materials.soft]
law = "neo-hookean"
density = 1
young = 2.8
poisson = 0.4
mass_damping = 1

[shapes.clip]
kind = "polygon"
points = [[-1, -0.4], [1, -0.4], [1, 1.5], [0, 1.5], [0, 0], [-0.5, 0], [-0.5, 1.5], [-1, 1.5]]
spacing = 0.2

[[grains]]
name = "clip"
shape = "clip"
body = "compliant"
material = "soft"
packing = { kind = "positions", positions = [[0, 0]] }

[[boundary]]
of = "clip"
part = { side = "bottom" }
x = "fixed"
y = "fixed"

[[boundary]]
of = "clip"
part = { side = "left" }
pressure = [[0, 0], [10, 0.15]]

[[contacts]]
between = "all"
law = "frictionless"
"""


def folds(desk, out: str) -> list[str]:
    return [text for text in desk.summary(out)["warnings"] if "folded through itself" in text]


def test_a_fold_is_told_of_once_at_the_first_frame_that_shows_it(desk) -> None:  # EXACT
    """However often the run was interrupted; without frames at its end."""
    desk.write(CLIP)
    assert desk.run("--out", "unseen", "--quiet").returncode == 0
    assert len(folds(desk, "unseen")) == 1 and "m by t = 10 s: " in folds(desk, "unseen")[0]
    desk.write(CLIP + '[frames]\nperiod = 1\nfields = []\n')
    assert desk.run("--out", "whole", "--quiet").returncode == 0
    told = folds(desk, "whole")
    assert len(told) == 1, told
    time = int(re.findall("m by t = ([0-9]+) s: ", told[0])[0])
    assert 1 < time < 9
    for end, expected in [(time - 1, []), (time + 1.5, told), (10, told)]:
        assert desk.run("--out", "parts", "--quiet", "--until", str(end), "--resume").returncode == 0
        assert folds(desk, "parts") == expected


def test_resume_without_a_folder_starts_anew(desk) -> None:  # EXACT
    desk.write(TWO_DISCS)
    assert desk.run("--out", "out", "--until", "2 ns", "--resume", "--quiet").returncode == 0
    result = desk.engine("run", "--resume", "--out", "nowhere")
    assert result.returncode == 2 and "no such folder" in result.stderr


def test_no_temporary_files_remain(finished) -> None:  # EXACT
    assert not [file for file in finished.content() if file.suffix in {".tmp", ".part"}]


@pytest.mark.skipif((os.cpu_count() or 1) < 2, reason="needs two cores")
def test_same_bits_with_one_and_two_threads(finished) -> None:  # EXACT
    result = finished.run("--out", "two", "--threads", "2", "--quiet")
    assert result.returncode == 0, result.stderr
    assert finished.summary("two")["threads"] == 2
    assert finished.summary("two")["state_hash"] == finished.summary("out")["state_hash"]


def test_same_bits_twice(finished) -> None:  # EXACT
    assert finished.run("--out", "again", "--threads", "1", "--quiet").returncode == 0
    assert finished.summary("again")["state_hash"] == finished.summary("out")["state_hash"]


def test_hash_sees_a_small_change(finished) -> None:  # EXACT: a hash that never changes would pass the tests above
    finished.write(TWO_DISCS.replace('"3.02 um"', '"3.020000000001 um"'))
    assert finished.run("--out", "moved", "--threads", "1", "--quiet").returncode == 0
    assert finished.summary("moved")["state_hash"] != finished.summary("out")["state_hash"]


def test_check_writes_nothing_and_counts(desk) -> None:  # EXACT
    desk.write(TWO_DISCS)
    before = desk.content()
    result = desk.engine("check", desk.scene)
    assert result.returncode == 0, result.stderr
    for word in ["bodies", "nodes", "time step", "memory"]:
        assert word in result.stdout.lower()
    assert desk.content() == before
