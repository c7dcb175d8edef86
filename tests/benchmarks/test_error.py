"""What benchmarks/error_study makes of choices and measurements. EXACT but where said."""

from __future__ import annotations

import json
import math
import os
import tomllib
from dataclasses import replace
from pathlib import Path

import pytest

import error
from error_study import choices, judge, keep, report
from error_study.choices import DEFAULT, PAPER, Choice
from error_study.measure import Measured, Programs, Runner, seconds_of
from error_study.pareto import cost_at, front
from error_study.scenes import SCENES, filled, stiffness

ROOT = Path(__file__).resolve().parents[2]
SMALL = Choice(nodes=40)


def row(choice: Choice, seconds: float, error: float, message: str = "") -> Measured:
    return Measured("impact", choice, error, 100, seconds, 1e6, message)


def test_front_holds_what_nothing_else_beats() -> None:
    points = [(1.0, 5.0), (2.0, 6.0), (2.0, 4.0), (3.0, 4.0), (4.0, 1.0), (0.5, 9.0)]
    assert front(points, lambda p: p[0], lambda p: p[1]) == [(0.5, 9.0), (1.0, 5.0), (2.0, 4.0), (4.0, 1.0)]


def test_cost_at_an_error_goes_by_powers() -> None:
    """error = cost^-2 on three points: exact between them, too much below them, unknown beyond."""
    curve = [(cost, cost**-2.0) for cost in (1.0, 10.0, 100.0)]
    for cost in (1.0, 3.0, 10.0, 50.0, 100.0):
        assert cost_at(cost**-2.0, curve) == pytest.approx(cost, rel=1e-12)
    assert cost_at(4.0, curve) == 1.0
    assert cost_at(1e-6, curve) is None
    assert cost_at(1.0, []) is None


def test_the_default_is_the_engines() -> None:
    """What docs/scene.md says of each key, which is tested against the engine."""
    text = (ROOT / "docs/scene.md").read_text()
    for key, value in [("method", f'"{DEFAULT.method}"'), ("mass", f'"{DEFAULT.mass}"'), ("safety", f"{DEFAULT.safety:g}"),
                       ("integrator", f'"{DEFAULT.integrator}"'), ("tolerance", f"{DEFAULT.bound:g}"), ("target", f"{PAPER.bound:g}")]:
        row = next(line for line in text.splitlines() if line.startswith(f"| `{key}` |"))
        assert row.split("|")[4].strip() == value, key


@pytest.mark.parametrize("scene", SCENES, ids=lambda scene: scene.name)
def test_choices_reach_the_scene(scene: error.Scene) -> None:
    made = tomllib.loads(scene.text(Choice("es-t3", "corrected", 84, safety=0.4, bound=1e-3)))
    assert made["discretisation"] == {"method": "es-t3", "mass": "corrected"}
    assert {key: made["time"][key] for key in ("integrator", "tolerance", "safety")} == \
        {"integrator": "verlet", "tolerance": 1e-3, "safety": 0.4}
    assert made["shapes"]["disc"]["nodes"] == 84
    assert tomllib.loads(scene.text(judge.SCALED))["discretisation"]["mass_scaling"] == 3
    paper = tomllib.loads(scene.text(PAPER))
    assert paper["time"]["integrator"] == "step-doubling" and paper["time"]["target"] == 1e-4
    soft, stiff = (tomllib.loads(scene.text(Choice(stiffness=factor))) for factor in (1.0, 4.0))
    changed = soft["contacts"][0]["stiffness"] != stiff["contacts"][0]["stiffness"]
    assert changed or not scene.free_stiffness


def test_stiffness_is_the_automatic_one() -> None:
    """8 E over the side of a regular polygon of 48 corners, which 168 nodes get."""
    assert stiffness(Choice()) == pytest.approx(8 * 2.8 / (2 * math.sin(math.pi / 48)), rel=1e-14)
    assert stiffness(Choice(stiffness=4.0)) == 4 * stiffness(Choice())


def test_a_template_uses_all_that_it_gets() -> None:
    with pytest.raises(KeyError, match="@colour@"):
        filled("oscillation", Choice(), colour=1)


@pytest.mark.parametrize("scene", SCENES, ids=lambda scene: scene.name)
def test_each_choice_is_measured_once(scene: error.Scene) -> None:
    found = list(error.choices_of(scene, scene.sizes))
    assert len(found) == len(set(found))
    assert {PAPER, *judge.NAMED.values()} <= {replace(choice, nodes=168) for choice in found}


def test_families_tell_all_but_the_nodes() -> None:
    every = {choice for scene in SCENES for choice in error.choices_of(scene, scene.sizes)}
    assert len({(choice.family, choice.nodes) for choice in every}) == len(every)


def test_time_is_that_of_the_steps() -> None:
    assert seconds_of({"phase_seconds": {"contact": 2.0, "internal": 1.0, "output": 5.0}, "wall_seconds": 9.0}) == 3.0
    assert seconds_of({"wall_seconds": 9.0}) == 9.0


def test_the_papers_way_over_others_at_equal_error() -> None:
    rows = [row(replace(DEFAULT, nodes=nodes), cost, 1 / cost) for nodes, cost in ((40, 1.0), (84, 2.0), (168, 4.0))]
    rows += [row(replace(PAPER, nodes=84), 30.0, 1 / 3), row(replace(PAPER, nodes=340), 90.0, 1e-3)]
    near, far = judge.paper_against_others(rows, "impact")
    assert near.ratios["default"] == pytest.approx(10.0, rel=1e-12)
    assert far.ratios["default"] is None and near.ratios["es-t3, corrected mass"] is None


def test_report_tells_failures_and_fronts(tmp_path: Path) -> None:
    scene = next(scene for scene in SCENES if scene.name == "impact")
    rows = [row(SMALL, 1.0, 0.1), row(replace(SMALL, nodes=84), 2.0, 0.05), row(PAPER, 9.0, 0.07),
            row(replace(DEFAULT, nodes=99), float("nan"), float("nan"), "turned inside out")]
    data, page, picture = report.write(tmp_path, [scene], rows, {"commit": "abc"})
    stored = json.loads(data.read_text())
    assert [point["nodes"] for point in stored["fronts"]["impact"]] == [40, 84]
    assert stored["measured"][3]["error"] is None and stored["measured"][3]["message"] == "turned inside out"
    assert "turned inside out" in page.read_text() and "<svg" in page.read_text() and "commit: abc" in page.read_text()
    assert picture.stat().st_size > 1000


def test_stored_rows_come_back(tmp_path: Path) -> None:
    rows = [row(judge.SCALED, 1.5, 0.1), row(PAPER, float("nan"), float("nan"), "turned inside out")]
    assert report.read(tmp_path, {"commit": "abc"}) == []
    report.write_data(tmp_path, rows, {"commit": "abc"})
    first, second = report.read(tmp_path, {"commit": "abc"})
    assert first == rows[0]
    assert second.choice == PAPER and math.isnan(second.error) and second.message == "turned inside out"
    with pytest.raises(ValueError, match="commit was abc, now def"):
        report.read(tmp_path, {"commit": "def"})


def test_resume_measures_only_what_is_missing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = next(scene for scene in SCENES if scene.name == "impact")
    asked: list[Choice] = []

    def of(runner: Runner, scene: error.Scene, choice: Choice) -> Measured:
        asked.append(choice)
        return row(choice, 1.0, 0.1)

    monkeypatch.setattr(Runner, "measure", of)
    engine = tmp_path / "engine"
    engine.write_text("#!/bin/sh\necho abc\n")
    engine.chmod(0o755)
    options = ["--only", "impact", "--engine", str(engine), "--out", str(tmp_path)]
    assert error.main([*options, "--sizes", "40"]) == 0
    before = list(asked)
    asked.clear()
    assert error.main([*options, "--sizes", "40", "84", "--resume"]) == 0
    assert set(asked) == set(error.choices_of(scene, [40, 84])) - set(before)
    stored = json.loads((tmp_path / "error.json").read_text())["measured"]
    assert len(stored) == len(before) + len(asked)
    asked.clear()
    assert error.main([*options, "--repetitions", "1", "--resume"]) == 2 and not asked


def test_bad_options() -> None:
    for options in (["--only", "impcat"], ["--sizes", "3"], ["--repetitions", "0"]):
        with pytest.raises(SystemExit) as left:
            error.main(options)
        assert left.value.code == 2


def table_rows(factor: float = 1.0) -> list[Measured]:
    """Of all methods and masses in two sizes; each error names its row."""
    return [Measured(scene, Choice(method, mass, nodes), factor * (0.1 + 0.01 * place) / nodes, 100, 1.0, 1e6)
            for place, scene in enumerate(keep.KEPT) for method in choices.METHODS for mass in choices.MASSES
            for nodes in (40, 84)]


def test_kept_errors_come_back_in_two_digits(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    header = tmp_path / "measured_errors.hpp"
    keep.keep(table_rows(), header)
    assert keep.read_header(header.read_text())["es-t3", "corrected"] == [[0.0025, 0.0012], [0.0027, 0.0013], [0.003, 0.0014]]
    capsys.readouterr()
    keep.keep(table_rows(), header)
    assert capsys.readouterr().out == "", "nothing changed"
    keep.keep(table_rows(2), header)
    assert "oscillation, mls, lumped: [0.0025, 0.0012] -> [0.005, 0.0024]" in capsys.readouterr().out


def test_nothing_is_kept_of_half_a_study(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="same sizes"):
        keep.keep(table_rows()[:-1], tmp_path / "measured_errors.hpp")
    assert not list(tmp_path.iterdir())


def test_kept_errors_are_the_engines(tmp_path: Path) -> None:
    """FROZEN: what lib/cli/measured_errors.hpp says of the smallest discs, measured again; two digits, and the last one's
    half that rounding may take to either side."""
    programs = Programs(Path(os.environ["PLIANT_ENGINE"]), Path(os.environ["PLIANT_REFERENCE"]))
    runner = Runner(programs, tmp_path, repetitions=1)
    kept = keep.read_header(keep.HEADER.read_text())
    for scene in (scene for scene in SCENES if scene.name in keep.KEPT):
        for (method, mass), errors in kept.items():
            before = errors[keep.KEPT.index(scene.name)][0]
            measured = runner.measure(scene, Choice(method, mass, 40)).error
            assert float(f"{measured:.1e}") == pytest.approx(before, abs=1.01 * 10 ** (math.floor(math.log10(before)) - 1))
