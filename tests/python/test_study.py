"""Studies: what their files may say, what runs, what comes of it, and what a kill, a failure or a change leads to."""

from __future__ import annotations

import csv
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from pliant.engine import engine
from pliant.results import read_json
from pliant.study.__main__ import check_all
from pliant.study.points import points_of
from pliant.study.reading import BadStudy
from pliant.study.study_file import read_study

ROOT = Path(os.environ.get("PLIANT_SOURCE_DIR", Path(__file__).parents[2]))
SCENE = """
[time]
end = "{end}"
[materials.soft]
law = "neo-hookean"
density = 1
young = 2.8
poisson = 0.4
[shapes.disc]
kind = "disc"
diameter = 1
nodes = 40
[[grains]]
name = "disc"
shape = "disc"
body = "compliant"
material = "soft"
packing = {{ kind = "positions", positions = [[0, 0]] }}
velocity = {{ gradient = [[0.1, 0], [0, -0.1]] }}
[[contacts]]
between = "all"
law = "frictionless"
[[probes]]
name = "energy"
quantity = "energy"
period = 0.1
"""
STUDY = """
scene = "scene.toml"
[[parameters]]
name = "nodes"
path = "shapes.disc.nodes"
values = [40, 60]
[[parameters]]
name = "young"
path = "materials.soft.young"
values = [2.8, 5.6]
[[quantities]]
name = "strain"
probe = "energy.strain"
take = "max"
[[quantities]]
name = "steps"
summary = "steps"
"""


class Desk:
    def __init__(self, folder: Path) -> None:
        self.folder, self.out = folder, folder / "out"
        self.scene("1 s")
        self.study(STUDY)

    def scene(self, end: str) -> None:
        (self.folder / "scene.toml").write_text(SCENE.format(end=end))

    def study(self, text: str) -> Path:
        file = self.folder / "study.toml"
        file.write_text(text)
        return file

    def command(self, *options: str) -> list[str | Path]:
        return [sys.executable, "-B", "-m", "pliant.study", self.folder / "study.toml", "--out", self.out, "--cores", "2",
                *options]

    def call(self, *options: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(self.command(*options), capture_output=True, text=True, timeout=300, check=False,
                              env={**os.environ, "PYTHONPATH": str(ROOT / "python")})

    def rows(self) -> list[dict[str, str]]:
        with (self.out / "table.csv").open(newline="") as stream:
            return list(csv.DictReader(stream))

    def hashes(self) -> dict[str, str]:
        return {file.parent.parent.name: read_json(file)["state_hash"]
                for file in sorted(self.out.glob("runs/*/results/summary.json"))}

    def times(self) -> dict[str, int]:
        return {file.parent.name: file.stat().st_mtime_ns for file in self.out.glob("runs/*/outcome.json")}


@pytest.fixture
def desk(tmp_path: Path) -> Desk:
    return Desk(tmp_path)


def test_all_runs_come_into_table_and_report(desk: Desk) -> None:
    """In a folder with a blank and quotes, too."""
    desk.out = desk.folder / "it's \"mine\" & $HOME"
    result = desk.call()
    assert result.returncode == 0, result.stderr
    rows = desk.rows()
    assert [(row["nodes"], row["young"]) for row in rows] == [("40", "2.8"), ("40", "5.6"), ("60", "2.8"), ("60", "5.6")]
    for row in rows:
        summary = read_json(desk.out / "runs" / row["run"] / "results/summary.json")
        assert int(float(row["steps [-]"])) == summary["steps"]
        assert float(row["strain [J/m]"]) > 0
    report = (desk.out / "report.html").read_text()
    assert "4 runs of scene.toml, 4 finished" in report and "src=\"http" not in report


def test_warnings_of_the_engine_are_told(desk: Desk) -> None:
    scene = desk.folder / "scene.toml"
    scene.write_text(scene.read_text() + '[[boundary]]\nof = "disc"\npressure = 1\nfrom = 99\n')
    result = desk.call()
    assert result.returncode == 0, result.stderr
    assert result.stderr.count("warning: ") == 4 and "is acted on from 99 s" in result.stderr, result.stderr
    report = (desk.out / "report.html").read_text()
    assert report.count("is acted on from 99 s") == 4 and "Warnings of the engine" in report


def test_only_what_changed_runs_again(desk: Desk) -> None:
    assert desk.call().returncode == 0
    before = desk.times()
    assert desk.call().returncode == 0
    assert desk.times() == before, "nothing changed"
    desk.study(STUDY.replace("[2.8, 5.6]", "[2.8, 5.6, 8.4]"))
    assert desk.call().returncode == 0
    after = desk.times()
    assert {name: after[name] for name in before} == before and len(after) == 6
    desk.study(STUDY.replace("[2.8, 5.6]", "[2.8, 5.6, 8.4]").replace('take = "max"', 'take = "mean"'))
    assert desk.call().returncode == 0
    assert desk.times() == after, "another quantity of the same runs"
    hashes = desk.hashes()
    shutil.rmtree(desk.out / "runs/nodes=40,young=2.8/results")
    assert desk.call().returncode == 0
    assert desk.hashes() == hashes, "what was taken away is run again"


def test_a_failed_run_is_reported_and_does_not_stop_the_others(desk: Desk) -> None:
    """Three thousand times as fast, the disc turns inside out."""
    desk.study(STUDY.replace('name = "young"\npath = "materials.soft.young"\nvalues = [2.8, 5.6]',
                             'name = "pull"\npath = "grains.disc.velocity.gradient.0.0"\nvalues = [0.1, -300]'))
    result = desk.call()
    assert result.returncode == 1
    assert result.stderr.count(": failed: ") == 2 and "nodes=40,pull=-300" in result.stderr
    assert [row["status"] for row in desk.rows()] == ["finished", "failed", "finished", "failed"]
    report = (desk.out / "report.html").read_text()
    assert report.index("What failed") < report.index("All runs")
    before = desk.times()
    assert desk.call().returncode == 1
    assert desk.times() == before, "it would fail again"
    assert desk.call("--retry").returncode == 1
    after = desk.times()
    assert {name for name in before if after[name] != before[name]} == {"nodes=40,pull=-300", "nodes=60,pull=-300"}


def test_an_outline_that_changed_is_another_scene(desk: Desk) -> None:
    """The engine keeps it in its results as outline_disc.csv: as its own file may be called."""
    def square(side: float) -> None:
        corners = [(-side, -side), (side, -side), (side, side), (-side, side)]
        (desk.folder / "outline_disc.csv").write_text("\n".join(f"{x},{y}" for x, y in corners) + "\n")

    square(0.5)
    text = SCENE.format(end="1 s").replace('kind = "disc"\ndiameter = 1\n', 'kind = "file"\nfile = "outline_disc.csv"\n')
    (desk.folder / "scene.toml").write_text(text)
    assert desk.call().returncode == 0, desk.call().stderr
    before = desk.hashes()
    square(0.6)
    assert desk.call().returncode == 0
    assert all(desk.hashes()[name] != value for name, value in before.items())


def test_a_killed_study_goes_on_with_the_same_bits(desk: Desk) -> None:
    """EXACT: killed at once, with all its processes, it ends in the states of an undisturbed one."""
    desk.scene("200 s")
    assert desk.call().returncode == 0
    undisturbed = desk.hashes()
    desk.out = desk.folder / "other"
    killed = subprocess.Popen(desk.command(), start_new_session=True, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL, env={**os.environ, "PYTHONPATH": str(ROOT / "python")})
    deadline = time.monotonic() + 60
    while not list(desk.out.glob("runs/*/results/probes.csv")) and time.monotonic() < deadline:
        time.sleep(0.01)
    time.sleep(0.5)
    os.killpg(killed.pid, signal.SIGKILL)
    killed.wait()
    assert len(desk.times()) < 4, "or it was not disturbed"
    result = desk.call()
    assert result.returncode == 0, result.stderr
    assert desk.hashes() == undisturbed


def other_engine(desk: Desk, monkeypatch: pytest.MonkeyPatch, on_run: str) -> None:
    """Does something before it runs: not when it is asked for the very beginning of the first run, by --until."""
    program = desk.folder / "other_engine"
    program.write_text(f'#!/bin/sh\ncase "$*" in *--until*) ;; run*) {on_run} ;; esac\nexec {engine()} "$@"\n')
    program.chmod(0o755)
    monkeypatch.setenv("PLIANT_ENGINE", str(program))


def test_a_stopped_study_waits_for_checkpoints(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    """However long they take: here a second."""
    other_engine(desk, monkeypatch, f"trap 'kill $!; sleep 1; touch {desk.folder}/written; exit 130' INT; "
                 f"touch {desk.folder}/runs; sleep 60 >/dev/null 2>&1 & wait")
    stopped = subprocess.Popen(["env", "--default-signal=INT", *desk.command()], start_new_session=True,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                               env={**os.environ, "PYTHONPATH": str(ROOT / "python")})
    deadline = time.monotonic() + 60
    while not (desk.folder / "runs").exists() and time.monotonic() < deadline:
        time.sleep(0.05)
    os.killpg(stopped.pid, signal.SIGINT)
    assert stopped.wait(60) == 1 and (desk.folder / "written").exists()


def test_what_another_scene_became_is_no_outcome(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    """As when a study is called with another one while the old still runs on a cluster."""
    with monkeypatch.context() as patch:
        other_engine(desk, patch, 'echo "# other" >> "$2"')
        assert desk.call().returncode == 1
    assert not desk.times()
    assert desk.call().returncode == 0


@pytest.mark.parametrize("old, new, message", [
    ('path = "shapes.disc.nodes"', 'path = "shapes.dics.nodes"', "did you mean 'disc'?"),
    ('path = "shapes.disc.nodes"', 'path = "shapes.disc.nodse"', "nodse"),
    ("values = [40, 60]", "values = [40, 2]", "the run nodes=2,young=2.8: "),
    ('take = "max"', 'take = "maxx"', "did you mean 'max'?"),
    ('summary = "steps"', 'sumary = "steps"', "one of 'summary', 'probe' and 'function'"),
    ('scene = "scene.toml"', 'scene = "scenes.toml"', "no file"),
    ('scene = "scene.toml"', 'scene = "scene.toml"\ncombin = "zip"', "did you mean 'combine'?"),
    ("values = [40, 60]", "values = []", "empty"),
    ('path = "shapes.disc.nodes"', 'path = "grains.disk.seed"', "no member 'disk'; did you mean 'disc'?"),
    ('path = "shapes.disc.nodes"', 'path = "time.end.unit"', "a value, not a table"),
    ('name = "young"', 'name = "nodes"', "two parameters or quantities are called 'nodes'"),
    ('scene = "scene.toml"', 'scene = "scene.toml"\nkind = "convergence"', "[convergence]"),
    ("values = [40, 60]", "values = [40, 40]", "'values' has 40 twice"),
    ('path = "materials.soft.young"', 'path = "shapes.disc.nodes"', "which 'nodes' sets too"),
    ('name = "young"\npath = "materials.soft.young"', 'name = "young"\npaths = ["grains.0.seed", "grains.disc.seed"]',
     "sets too"),
    ('path = "materials.soft.young"', 'path = "materials.soft"', "it is a table"),
    ('name = "strain"', 'name = "run"', "nothing can be called 'run'"),
    ('take = "max"', 'take = "max"\nwindow = ["1 s", "0.5 s"]', "begin before it ends"),
    ('take = "max"', 'take = "max"\nwindow = ["1 MPa", "2 MPa"]', "not a time"),
    ('summary = "steps"', 'function = "none.py:f"', "FILE.py:NAME"),
    ('scene = "scene.toml"', 'scene = "scene.toml"\nset.shapes.disc.nodes = 40', "which '[set]' sets too"),
    ('probe = "energy.strain"', 'probe = "energy.strian"', "no probe 'energy.strian'; did you mean 'energy.strain'?"),
    ('summary = "steps"', 'summary = "setps"', "no number 'setps'; did you mean 'steps'?"),
    ('take = "max"', 'take = "max"\nwindow = ["0.5 s", "1.5 s"]', "'strain': the window ends at 1.5 s, the run nodes=40"),
    ('scene = "scene.toml"', 'scene = "scene.toml"\nset.shapes.disk.nodes = 40', "did you mean 'disc'?"),
])
def test_bad_input_runs_nothing(desk: Desk, old: str, new: str, message: str) -> None:
    text = STUDY.replace(old, new)
    assert text != STUDY
    desk.study(text)
    result = desk.call()
    assert result.returncode == 2 and message in result.stderr, result.stderr
    assert not desk.out.exists()


@pytest.mark.parametrize("written", ['"materials.soft.poisson" = 0.3', "materials.soft.poisson = 0.3"])
def test_what_all_runs_share_is_in_no_name(desk: Desk, written: str) -> None:
    points = points_of(read_study(desk.study(f"{STUDY}\n[set]\n{written}\n")))
    assert [point.name for point in points] == [point.name for point in points_of(read_study(desk.study(STUDY)))]
    assert all(point.sets["materials.soft.poisson"] == 0.3 and len(point.sets) == 3 for point in points)


@pytest.mark.parametrize("file", sorted((ROOT / "studies").glob("*.toml")), ids=lambda file: file.stem)
def test_studies_that_come_along_are_sound(file: Path) -> None:
    study = read_study(file)
    points = points_of(study)
    check_all(study, [points[0], points[-1]])
    assert len({point.name for point in points}) == len(points)


def test_byte_order_marks_are_no_text(desk: Desk) -> None:
    """Of study and scene, as some editors write them."""
    text = (desk.folder / "scene.toml").read_text()
    (desk.folder / "scene.toml").write_text(f"\ufeff{text}")
    desk.study(f"\ufeff{STUDY}")
    assert desk.call().returncode == 0
    assert (desk.out / "base.toml").read_text() == text


def test_dry_run_lists_and_writes_nothing(desk: Desk) -> None:
    result = desk.call("--dry-run")
    assert result.returncode == 0 and "nodes=60,young=5.6" in result.stdout and "4 runs" in result.stdout
    assert not desk.out.exists()


def test_regression_tells_what_changed(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of numbers, and of the engine: another one runs anew."""
    regression = STUDY.replace("[[parameters]]", 'kind = "regression"\n[regression]\nbaseline = "baseline.csv"\n'
                               "tolerances = { strain = 1e-9 }\n[[parameters]]", 1)
    desk.call()
    (desk.folder / "baseline.csv").write_text("\ufeff" + (desk.out / "table.csv").read_text())  # as spreadsheets do
    desk.study(regression)
    assert desk.call().returncode == 0
    rows = (desk.out / "table.csv").read_text().splitlines()
    value = desk.rows()[0]["strain [J/m]"]
    (desk.folder / "baseline.csv").write_text("\n".join(rows).replace(value, repr(float(value) * (1 + 1e-6)), 1) + "\n")
    result = desk.call()
    assert result.returncode == 1 and "nodes=40,young=2.8: strain was" in result.stderr
    (desk.folder / "baseline.csv").write_text("\n".join(rows) + "\n")
    other_engine(desk, monkeypatch, 'echo "error: planted" >&2; exit 1')
    result = desk.call()
    assert result.returncode == 1 and result.stderr.count(": failed: ") == 4, result.stderr


def test_latin_hypercube_has_one_value_in_each_stratum(desk: Desk) -> None:
    """EXACT: by definition."""
    study = read_study(desk.study("""
scene = "scene.toml"
combine = "latin hypercube"
samples = 10
[[parameters]]
name = "young"
path = "materials.soft.young"
range = { from = "1 Pa", to = "1e4 Pa", spacing = "log" }
[[parameters]]
name = "density"
path = "materials.soft.density"
range = { from = 0, to = 10 }
[[quantities]]
name = "steps"
summary = "steps"
"""))
    points = points_of(study)
    assert sorted(int(point.values["density"]) for point in points) == list(range(10))
    from math import log10
    assert sorted(int(10 * log10(float(point.values["young"].split()[0])) / 4) for point in points) == list(range(10))
    assert [p.values for p in points] == [p.values for p in points_of(study)], "the same for the same seed"


def test_zip_needs_equal_lengths(desk: Desk) -> None:
    text = STUDY.replace('scene = "scene.toml"', 'scene = "scene.toml"\ncombine = "zip"')
    assert len(points_of(read_study(desk.study(text)))) == 2
    twice = read_study(desk.study(text.replace("[40, 60]", "[40, 40]")))
    assert len(points_of(twice)) == 2, "with other partners"
    with pytest.raises(BadStudy, match="same values"):
        check_all(twice, [*points_of(twice), *points_of(twice)])
    with pytest.raises(BadStudy, match="all need as many"):
        read_study(desk.study(text.replace("[2.8, 5.6]", "[2.8]")))


def test_units_must_agree_where_numbers_count(desk: Desk) -> None:
    """0.5 ns and 600 ps are no 0.5 and 600."""
    text = STUDY.replace("values = [2.8, 5.6]", 'values = ["2 Pa", "3 kPa"]')
    assert len(points_of(read_study(desk.study(text)))) == 4
    with pytest.raises(BadStudy, match="different units"):
        read_study(desk.study(text + '[[plots]]\nx = "young"\ny = "strain"\n'))
