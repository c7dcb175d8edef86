"""The report of ./pliant verify: what is red comes first, and nothing red is lost."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import asdict
from pathlib import Path

import pytest

from report import report
from verification import Row

ROOT = Path(__file__).resolve().parents[2]


def row(case: str, name: str, value: float, label: str = "EXACT", commit: str = "") -> Row:
    return Row(label, case, name, value, 1.0, 0.1, "theory", abs(value - 1) <= 0.1, f"{case}/check.py::test_{name}", 2.0,
               commit=commit)


@pytest.fixture
def out(tmp_path: Path) -> Path:
    for case, rows in {"first": [row("first", "sound", 1.05)], "second": [row("second", "fine", 1.0, "RATE"), row("second", "wrong", 1.3)]}.items():
        (tmp_path / case).mkdir()
        (tmp_path / case / "checks.json").write_text(json.dumps([asdict(r) for r in rows]))
    (tmp_path / "second/picture.png").write_bytes(b"")
    return tmp_path


def test_totals_and_rows_go_to_json(out: Path) -> None:
    report.write(out)
    result = json.loads((out / "checks.json").read_text())
    assert result["totals"] == {"EXACT": 2, "RATE": 1, "INDEPENDENT": 0, "FROZEN": 0}
    assert result["red"] == 1 and len(result["checks"]) == 3


def test_red_comes_first(out: Path) -> None:
    report.write(out)
    page = (out / "report.html").read_text()
    assert "3 checks, 1 red" in page and "second/picture.png" in page
    assert page.index(">wrong") < page.index(">sound")
    assert page.index('id="second"') < page.index('id="first"')


def test_a_run_that_failed_is_red(out: Path) -> None:
    failure = report.Failure("first", "test_x", "engine <ended> with exit code 3")
    (out / "first/failures.json").write_text(json.dumps([asdict(failure)]))
    report.write(out)
    assert json.loads((out / "checks.json").read_text())["red"] == 2
    assert "engine &lt;ended&gt; with exit code 3" in (out / "report.html").read_text()


NOW, BEFORE_NOW, CHANGED = "0123456789ab", "ba9876543210", "0123456789ab-dirty"


@pytest.mark.parametrize("sources, built, ran, stale", [
    (NOW, NOW, [], 0), (NOW, BEFORE_NOW, [], 1), (NOW, "", [], 1), (NOW, CHANGED, [], 1), (CHANGED, NOW, [], 1),
    (CHANGED, CHANGED, [], 1), (CHANGED, CHANGED, ["other"], 1), (CHANGED, CHANGED, ["case"], 0),
    ("unknown", "unknown", [], 1), (NOW, BEFORE_NOW, ["case"], 1)],
    ids=["of now", "of another commit", "without a commit", "with changes", "before changes", "of some changes",
         "of another case's session", "of this session", "without git", "by an old engine"])
def test_rows_of_other_sources_are_marked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, sources: str, built: str,
                                          ran: list[str], stale: int) -> None:
    """EXACT. Changes that are not committed have no name, so only rows of the session at hand are known to have them."""
    monkeypatch.setattr(report, "commit", lambda: sources)
    (tmp_path / "case").mkdir()
    (tmp_path / "case/checks.json").write_text(json.dumps([asdict(row("case", "sound", 1.0, commit=built))]))
    report.write(tmp_path, set(ran))
    result = json.loads((tmp_path / "checks.json").read_text())
    assert (result["stale"], result["checks"][0]["commit"]) == (stale, built)
    page = (tmp_path / "report.html").read_text()
    assert (f"(not of the present sources: {built or 'unknown'})" in page) == bool(stale)
    assert ("1 not of the present sources" in page) == bool(stale)


def test_each_mutation_keeps_the_commit_it_was_judged_at(out: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(report, "commit", lambda: NOW)
    verdict = {"what": "half", "file": "a.cpp", "killed": True, "killer": "b", "message": "c", "seconds": 1.0}
    rows = [{**verdict, "name": "old", "what": "old one", "commit": BEFORE_NOW},
            {**verdict, "name": "new", "what": "new one", "commit": NOW}]
    (out / "mutations.json").write_text(json.dumps({"written": "today", "rows": rows}))
    report.write(out)
    page = (out / "report.html").read_text()
    assert f"old one <span class=\"stale\">(not of the present sources: {BEFORE_NOW})</span>" in page
    assert "new one</td>" in page


def test_rows_of_an_earlier_version_are_read(tmp_path: Path) -> None:
    (tmp_path / "old").mkdir()
    (tmp_path / "old/checks.json").write_text(json.dumps([{**asdict(row("old", "sound", 1.0)), "known": "the paper differs"}]))
    assert [case.rows[0].name for case in report.write(tmp_path)] == ["sound"]


def test_how_much_of_a_tolerance_is_used() -> None:
    assert row("a", "b", 1.05).used == pytest.approx(0.5)
    assert Row("EXACT", "a", "b", 1, 1, 0, "counted", True).used is None


CASE = '''
import pytest
from verification import Case
CASE = Case(__file__)
def test_red(): CASE.check("EXACT", "two", 2, 1, 0.5, "counted")
def test_green(): CASE.check("EXACT", "one", 1, 1, 0.5, "counted")
def test_broken(): raise RuntimeError("no run")
def test_without_a_source(): CASE.check("EXACT", "three", 3, 3, 0.5, "")
@pytest.mark.parametrize("value", [1, 4], ids=["a b", "a c"])
def test_named(value): CASE.check("EXACT", "named", value, 1, 0.5, "counted")
@pytest.mark.xfail(strict=True, reason="the paper differs")
def test_expected_to_fail(): CASE.check("EXACT", "paper", 2, 1, 0.5, "counted")
'''
BEFORE = [asdict(row("unreadable", "of an earlier run", 1.0))]


@pytest.mark.parametrize("options", [[], ["-n", "2", "--dist", "loadfile"]], ids=["alone", "side by side"])
def test_a_session_writes_red_and_broken_checks_down(tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
                                                     options: list[str]) -> None:
    case = tmp_path / "verify/odd"
    case.mkdir(parents=True)
    for name in ("conftest.py", "pytest.ini", "verification.py", "report"):
        (tmp_path / "verify" / name).symlink_to(ROOT / "verify" / name)
    for name in ("scripts", "python"):
        (tmp_path / name).symlink_to(ROOT / name)
    (case / "check_odd.py").write_text(CASE)
    (tmp_path / "verify/unreadable").mkdir()
    (tmp_path / "verify/unreadable/check_unreadable.py").write_text("import no_such_module")
    (tmp_path / "out/unreadable").mkdir(parents=True)
    (tmp_path / "out/unreadable/checks.json").write_text(json.dumps(BEFORE))
    engine = tmp_path / "engine"
    engine.write_text("#!/bin/sh\necho 0123456789ab\n")
    engine.chmod(0o755)
    monkeypatch.setenv("PLIANT_ENGINE", str(engine))
    result = session(tmp_path / "verify/pytest.ini", *options, tmp_path / "verify", out=tmp_path / "out")
    assert result.returncode == 1
    checks = json.loads((tmp_path / "out/checks.json").read_text())
    assert sorted((r["name"], r["green"]) for r in checks["checks"]) == [
        ("named", False), ("named", True), ("one", True), ("paper", False), ("two", False)]
    assert all(r["seconds"] > 0 for r in checks["checks"])
    assert {r["commit"] for r in checks["checks"] + checks["failures"]} == {"0123456789ab"}
    assert sorted(failure["test"] for failure in checks["failures"]) == [
        "test_broken", "test_without_a_source", "unreadable/check_unreadable.py"]
    assert checks["red"] == 6
    assert "5 checks: 5 EXACT" in result.stdout and "6 red" in result.stdout
    assert "test_expected_to_fail" in result.stdout.partition("short test summary")[2]  # it hides nothing


def test_a_folder_that_cannot_be_written_is_told(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    result = session(ROOT / "verify/pytest.ini", ROOT / "verify/sliding", out=tmp_path / "file/out")
    assert result.returncode != 0 and "results cannot be written there" in result.stderr


def session(settings: Path, *arguments: str | Path, out: Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-B", "-m", "pytest", "-c", *map(str, [settings, *arguments])]
    return subprocess.run(command, env={**os.environ, "PLIANT_VERIFY_OUT": str(out)}, capture_output=True, text=True)
