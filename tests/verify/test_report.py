"""The report of ./pliant verify: what is red comes first, and nothing red is lost."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import asdict
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "verify"))

from report import report
from verification import Row


def row(case: str, name: str, value: float, label: str = "EXACT") -> Row:
    return Row(label, case, name, value, 1.0, 0.1, "theory", abs(value - 1) <= 0.1, f"{case}/check.py::test_{name}", 2.0)


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
    assert page.index(">wrong<") < page.index(">sound<")
    assert page.index('id="second"') < page.index('id="first"')


def test_a_run_that_failed_is_red(out: Path) -> None:
    failure = report.Failure("first", "test_x", "engine <ended> with exit code 3")
    (out / "first/failures.json").write_text(json.dumps([asdict(failure)]))
    report.write(out)
    assert json.loads((out / "checks.json").read_text())["red"] == 2
    assert "engine &lt;ended&gt; with exit code 3" in (out / "report.html").read_text()


def test_how_much_of_a_tolerance_is_used() -> None:
    assert row("a", "b", 1.05).used == pytest.approx(0.5)
    assert Row("EXACT", "a", "b", 1, 1, 0, "counted", True).used is None


CASE = '''
from verification import Case
CASE = Case(__file__)
def test_red(): CASE.check("EXACT", "two", 2, 1, 0.5, "counted")
def test_green(): CASE.check("EXACT", "one", 1, 1, 0.5, "counted")
def test_broken(): raise RuntimeError("no run")
def test_without_a_source(): CASE.check("EXACT", "three", 3, 3, 0.5, "")
'''


@pytest.mark.parametrize("options", [[], ["-n", "2", "--dist", "loadfile"]], ids=["alone", "side by side"])
def test_a_session_writes_red_and_broken_checks_down(tmp_path: Path, options: list[str]) -> None:
    case = tmp_path / "verify/odd"
    case.mkdir(parents=True)
    for name in ("conftest.py", "pytest.ini", "verification.py", "report"):
        (tmp_path / "verify" / name).symlink_to(ROOT / "verify" / name)
    (case / "check_odd.py").write_text(CASE)
    environment = {**os.environ, "PLIANT_VERIFY_OUT": str(tmp_path / "out")}
    result = subprocess.run([sys.executable, "-B", "-m", "pytest", "-c", str(tmp_path / "verify/pytest.ini"), *options, str(case)],
                            env=environment, capture_output=True, text=True)
    assert result.returncode == 1
    checks = json.loads((tmp_path / "out/checks.json").read_text())
    assert [(r["name"], r["green"]) for r in checks["checks"]] == [("two", False), ("one", True)]
    assert sorted(failure["test"] for failure in checks["failures"]) == ["test_broken", "test_without_a_source"]
    assert checks["red"] == 3 and "2 checks: 2 EXACT" in result.stdout
