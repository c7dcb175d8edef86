"""benchmarks/page.py: the page as a browser shows it, from made-up measurements. All EXACT."""

from __future__ import annotations

import json
import re
from html.parser import HTMLParser
from pathlib import Path

import pytest

import history
import page
from browser import BROWSER, dumped
from page import Measured

ROOT = Path(__file__).resolve().parents[2]

needs_charts = pytest.mark.skipif(not page.CHARTS.exists(), reason="libjs-chart.js is not installed")
needs_browser = pytest.mark.skipif(not (BROWSER and page.CHARTS.exists()), reason="chromium is not installed")
MACHINE = {"cpu": "Processor </script>", "cores": 2}


def line(commit: str, day: int, seconds: list[float], instructions: dict[str, int] | None) -> str:
    return json.dumps({"commit": commit * 40, "date": f"2026-01-0{day}T00:00:00+00:00", "machine": MACHINE,
                       "scene": "ab", "instructions": instructions, "seconds": seconds})


def benchmark(name: str, milliseconds: float, threads: int = 1, **counters: float) -> dict:
    full = f"{name}/threads:{threads}/real_time"
    return {"name": full, "run_name": full, "run_type": "iteration", "real_time": milliseconds, "time_unit": "ms",
            **counters}


KERNELS = [benchmark("machine/fma_peak", 1, flops=1e8),  # 100 GFLOP/s
           benchmark("machine/fma_peak", 1, 2, flops=2e8), benchmark("machine/read_bandwidth_memory", 1, 2, bytes=1e7),
           benchmark("machine/read_bandwidth_l1", 1, bytes=2e8),
           benchmark("machine/read_bandwidth_memory", 1, bytes=1e7),
           *(benchmark("forces/mls", milliseconds, bytes=2e6, flops=1e7) for milliseconds in (3, 2.5, 4)),
           benchmark("forces/mls", 2, 2, bytes=1e6, flops=1e7),
           benchmark("baseline/forces/mls", 9, bytes=2e6, flops=1e7), benchmark("outlines", 1, bytes=4e6, flops=1e6),
           benchmark("no_counters", 1)]


SCALING = {"a <scene>": {"predictions": [{"threads": 1, "seconds": 2e-3, "efficiency": 1.0},
                                        {"threads": 2, "seconds": 1.25e-3, "efficiency": 0.8}]}}


@pytest.fixture
def inputs(tmp_path: Path) -> list[str]:
    (tmp_path / "history.jsonl").write_text("\n".join([
        line("b", 2, [1.9, 2.1, 2.0], {"step": 2100, "contact_forces": 30}),
        line("a", 1, [2.2, 2.4, 2.6], {"step": 2000})]))
    (tmp_path / "kernels.json").write_text(json.dumps({"benchmarks": KERNELS}))
    (tmp_path / "scaling.json").write_text(json.dumps(SCALING))
    counts = tmp_path / history.COUNTS
    counts.parent.mkdir()
    counts.write_text(json.dumps({"counts": {"step": {"instructions": 1890}, "contact_forces": {"instructions": 33}}}))
    return ["--history", str(tmp_path / "history.jsonl"), "--kernels", str(tmp_path / "kernels.json"), "--scaling",
            str(tmp_path / "scaling.json"), "--repository", str(tmp_path), "--out", str(tmp_path / "out")]


class Shown(HTMLParser):
    """Rows of each section's table, labels of its charts, and what it says is missing."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.rows: dict[str, list[list[str]]] = {}
        self.labels: dict[str, list[str]] = {}
        self.text, self.section, self.in_cell = "", "", False
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        of = dict(attributes)
        if tag == "section":
            self.section = of["id"] or ""
            self.rows[self.section] = []
        elif tag == "canvas":
            self.labels.setdefault(self.section, []).append(of["aria-label"] or "")
        elif tag == "tr":
            self.rows[self.section].append([])
        elif tag in ("td", "th"):
            self.in_cell = True
            self.rows[self.section][-1].append("")

    def handle_endtag(self, tag: str) -> None:
        self.in_cell = self.in_cell and tag not in ("td", "th")

    def handle_data(self, text: str) -> None:
        self.text += text
        if self.in_cell:
            self.rows[self.section][-1][-1] += text


@needs_browser
def test_the_page_shows_what_was_measured(tmp_path: Path, inputs: list[str]) -> None:
    assert page.main(inputs) == 0
    shown = Shown(dumped((tmp_path / "out/index.html").as_uri()))
    assert shown.rows["counts"] == [["counted", "at now", "since the one before", "since the first"],
                                    ["step", "1\u202f890", "\u221210.00 %", "\u22125.50 %"],
                                    ["contact_forces", "33", "+10.00 %", "+10.00 %"]]
    assert "step: 3 points, last -5.5" in shown.labels["counts"][0]
    machine = "ab, 2 cores, Processor </script>"
    assert shown.rows["seconds"][1:] == [["a" * 8, machine, "2026-01-01", "2.400", "2.200", "3"],
                                         ["b" * 8, machine, "2026-01-02", "2.000", "1.900", "3"]]
    assert shown.labels["seconds"] == [f"{machine}: 2 points, last 2"]
    # 1e7 operations in 2.5 ms; memory's roof at 5 operations a byte is 50 GFLOP/s, at 0.25 it is 2.5.
    head = ["kernel", "operations a byte", "GFLOP/s", "of the peak", "of the roof of memory"]
    assert shown.rows["roofline"] == [head, ["forces/mls", "5.00", "4.00", "4.0 %", "8.0 %"],
                                      ["outlines", "0.25", "1.00", "1.0 %", "40.0 %"],
                                      head, ["forces/mls", "10.00", "5.00", "2.5 %", "5.0 %"]]
    one, two = shown.labels["roofline"]
    assert one == "forces/mls at 5.00, 4.00 GFLOP/s; outlines at 0.250, 1.00 GFLOP/s"
    assert two == "forces/mls at 10.0, 5.00 GFLOP/s"
    assert shown.rows["scaling"] == [["scene", "ms, 1", "ms, 2"], ["a <scene>", "2.000", "1.250"]]
    assert shown.labels["scaling"] == ["a <scene>: 100, 80 %"]


@needs_browser
def test_what_is_missing_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(page, "ROOT", tmp_path)  # where no kernels were timed
    options = ["--repository", str(tmp_path), "--history", str(tmp_path / "none"), "--out", str(tmp_path)]
    assert page.main(options) == 0
    shown = Shown(dumped((tmp_path / "index.html").as_uri()))
    assert all(f"No {what} yet" in shown.text for what in ("counts", "seconds", "roofline", "prediction"))
    assert not shown.labels.keys() & {"counts", "seconds"}


@needs_charts
def test_the_page_needs_no_other_file(tmp_path: Path, inputs: list[str]) -> None:
    assert page.main(inputs) == 0
    text = (tmp_path / "out/index.html").read_text()
    assert not re.search(r"<(script|link|img)[^>]*(src|href)", text)
    assert text.count("</script>") == 3, "data cannot end their element"


def test_aggregates_alone_count_as_their_median(tmp_path: Path) -> None:
    entries = [benchmark("a", time, bytes=1, flops=2) | {"run_type": "aggregate", "aggregate_name": kind}
               for kind, time in [("mean", 3), ("median", 2), ("stddev", 1)]]
    (tmp_path / "k.json").write_text(json.dumps({"benchmarks": entries}))
    assert page.measured(tmp_path / "k.json") == [Measured("a", 1, 2e-3, 1, 2)]
    (tmp_path / "k.json").write_text(json.dumps({"benchmarks": [*entries, benchmark("a", 4, bytes=1, flops=2)]}))
    assert page.measured(tmp_path / "k.json") == [Measured("a", 1, 4e-3, 1, 2)]


@pytest.mark.parametrize("name, content, said", [
    ("scaling.json", '{"a": {}}', "is no output of"), ("kernels.json", "{", "kernels.json: cannot be read"), ("kernels.json", "[]", "is no JSON object"),
    ("kernels.json", '{"benchmarks": [{"name": "x"}]}', "is no output of"), ("kernels.json", "{}", "fma_peak"),
    ("history.jsonl", "{}", "history.jsonl:1"),
    (history.COUNTS, '{"counts": 3}', "instructions.json: holds no counts")])
def test_bad_inputs(tmp_path: Path, inputs: list[str], capsys: pytest.CaptureFixture[str], name: str, content: str,
                    said: str) -> None:
    (tmp_path / name).write_text(content)
    assert page.main(inputs) == 2
    assert said in capsys.readouterr().err and not (tmp_path / "out").exists()


def test_a_file_that_is_asked_for_must_be_there(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        page.main(["--kernels", str(tmp_path / "none.json")])
    assert stop.value.code == 2 and "no such file" in capsys.readouterr().err


@needs_charts
def test_a_page_that_cannot_be_written(tmp_path: Path, inputs: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "out").touch()
    assert page.main(inputs) == 4
