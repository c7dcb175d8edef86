"""What benchmarks/scenes.py makes of scenes and summaries; nothing is timed. EXACT."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

import scenes
from scenes import Figures, Size

ROOT = Path(__file__).resolve().parents[2]
SUMMARY = {"threads": 2, "steps": 500, "evaluations": 520, "preparation_seconds": 1.5, "peak_memory_bytes": 4_000_000,
           "phase_seconds": {"contact": 3.0, "internal": 0.9, "output": 0.1}}


def case(name: str) -> str:
    return (ROOT / f"cases/{name}.toml").read_text()


def test_a_packing_of_ten_columns_is_the_small_third_body() -> None:
    made, small = tomllib.loads(scenes.packing(case("third_body"), Size(10, 20, 1))), tomllib.loads(case("third_body_mini"))
    for key in ["domain", "grains", "shapes", "materials"]:
        assert made[key] == small[key], key
    assert [wall["asperities"]["count"] for wall in made["walls"]] == [10, 10]
    assert made["walls"][1]["level"] == small["walls"][1]["level"]
    assert made["contact"]["refresh"] == scenes.REFRESH


def test_walls_enclose_the_rows() -> None:
    made = tomllib.loads(scenes.packing(case("third_body"), Size(200, 100, 1)))
    assert made["walls"][0]["level"] == "-1.002 um"
    assert made["walls"][1]["level"] == "100.701 um"
    assert made["domain"]["period"] == "174 um"
    assert made["grains"][0]["packing"]["rows"] == 100


def test_the_end() -> None:
    assert tomllib.loads(scenes.with_end(case("third_body"), 2.5e-9))["time"]["end"] == "2.5e-09 s"
    with pytest.raises(ValueError, match="end"):
        scenes.with_end("[time]", 1)


def test_figures() -> None:
    figures = scenes.figures_of("packing", 200, SUMMARY)
    assert (figures.steps, figures.evaluations, figures.preparation, figures.threads) == (500, 520, 1.5, 2)
    assert figures.time_a_grain == pytest.approx(4.0 / (200 * 500))
    assert figures.memory_a_grain == 20_000
    assert figures.output == pytest.approx(0.025)
    resumed = scenes.figures_of("packing", 200, SUMMARY, {"steps": 400, "evaluations": 410})
    assert (resumed.steps, resumed.evaluations) == (100, 110)


def test_verdicts_and_table() -> None:
    def row(name: str, grains: int, seconds: float, output: float) -> Figures:
        return Figures(name, grains, 1, 100, 100, seconds, 1, 1e6, output)

    rows = [row("packing", 200, 0.02, 0.5), row("packing", 2000, 0.3, 0), row("third_body_mini", 200, 1, 0.04)]
    lines = scenes.verdict(rows)
    assert lines == ["1 threads: time a grain and step from 1000 to 1500 ns, 1.50 times",
                     "third_body_mini, 1 threads: 4.0% of the time is output, more than 3%"]
    assert len(scenes.table(rows).splitlines()) == 4


def test_the_last_step_and_memory(tmp_path: Path) -> None:
    (tmp_path / "steps.csv").write_text("time [s],dt [s],error\n1e-9,1e-12,0\n2e-9,3e-12,0\n")
    assert scenes.last_step(tmp_path) == 3e-12
    assert scenes.available_memory("MemTotal: 9 kB\nMemAvailable:    2000 kB\n") == 2000 * 1024
    assert not scenes.is_compressed(tmp_path)


def test_too_little_memory_is_said(capsys: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(scenes, "LARGEST_MEMORY", 1e18)
    assert scenes.main(["--largest"]) == scenes.MISSING
    assert "GB are free" in capsys.readouterr().err
