"""What benchmarks/many_machines.py makes of counts; nothing is timed. EXACT."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest

import many_machines
from many_machines import NODES, Network, Surface

ROOT = Path(__file__).resolve().parents[2]
SURFACE = Surface(ghosts=2.0, bytes=100.0, pairs=3.0, pairs_a_grain=3.0, area=1.0, height=10.0, imbalance=1.5)
COUNTS = {"parts": 4, "bodies": [4] * 4, "ghosts": [5] * 4, "bytes": [400] * 4, "border": 10.0, "pairs": 48, "pairs_twice": 20,
          "area": 32.0, "imbalance": 1.25}


def test_a_square_part() -> None:
    """64 x 10,000 grains of area 1: a part has 400 m of border, hence 800 ghosts and 1200 pairs across."""
    step = many_machines.predict(64e4, 64, 16, "square", SURFACE, Network(2e-6, 1e9, 2))
    grain = 1.45e-6 / 0.53 / (16 * 0.85)
    assert step.compute == pytest.approx(1.5 * 1e4 * grain, rel=1e-12)
    assert (step.ghosts, step.bytes, step.messages) == (800, 80000, 8)
    assert step.exchange == pytest.approx(8 * 2e-6 + 80e-6, rel=1e-12)
    assert step.twice == pytest.approx(600 * 0.5 * grain / 3, rel=1e-12)
    assert step.reductions == pytest.approx(2 * 6 * 2e-6, rel=1e-12)
    assert step.total == pytest.approx(step.compute + step.twice + step.exchange + step.reductions, rel=1e-12)
    assert step.hidden == step.exchange  # contacts take half of the computation


def test_a_strip_has_two_neighbours_whatever_its_length() -> None:
    steps = [many_machines.predict(grains, 64, 64, "strip", SURFACE, Network()) for grains in (64e3, 64e4)]
    assert [(step.messages, step.ghosts) for step in steps] == [(2, 40), (2, 40)]


def test_no_more_is_hidden_than_contacts_take() -> None:
    slow = Network(latency=1.0)
    step = many_machines.predict(64e3, 64, 16, "strip", SURFACE, slow)
    grain = NODES[0].one_thread / (16 * 0.72)
    assert step.hidden == pytest.approx((3000 - 30) * 0.5 * grain / 3, rel=1e-12)


def test_figures_a_border_length() -> None:
    surface = many_machines.surface_of(COUNTS, 7.0)
    assert surface == Surface(ghosts=2.0, bytes=80.0, pairs=4.0, pairs_a_grain=3.0, area=2.0, height=7.0, imbalance=1.25)


@pytest.mark.parametrize("grains, node", [(100, 2000), (6000, 2000), (7000, 20000), (1e6, 20000)])
def test_the_nearest_packing_counts(grains: float, node: int) -> None:
    assert many_machines.node_for(grains).grains == node


def test_times_are_those_of_the_page() -> None:
    """docs/speed.md states them."""
    rows = [[cell.strip() for cell in line.split("|")] for line in (ROOT / "docs/speed.md").read_text().splitlines()]
    cell = {row[1]: row for row in rows if len(row) > 5}
    for node in NODES:
        thousands = f"{node.grains:,}" if node.grains >= 10000 else str(node.grains)
        shares = cell[f"{thousands} grains"]
        for cores, efficiency in node.efficiency.items():
            assert shares[1 + int(math.log2(cores))] == f"{efficiency:.0%}".replace("%", " %")
        values = [float(v) for v in cell["us"][cell["grains"].index(thousands)].split(" to ")]
        assert node.two_threads == pytest.approx(1e-6 * sum(values) / len(values), rel=1e-12)


def test_the_program_prints_all_cases(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    (tmp_path / "counts.json").write_text(json.dumps([COUNTS | {"ghosts": [1] * 4}, COUNTS]))
    assert many_machines.main([str(tmp_path / "counts.json")]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 2 + 8 and "2.00 ghosts" not in lines[0] and lines[2].split()[:3] == ["1e+05", "square", "16"]


@pytest.mark.parametrize("content, message", [("[]", "no entry of 4 parts"), ("[{}]", "no 'parts'"), ("x", "Expecting value"),
                                              (json.dumps([COUNTS | {"ghosts": [0] * 4}]), "no ghosts")])
def test_bad_files_are_refused(tmp_path: Path, content: str, message: str, capsys: pytest.CaptureFixture) -> None:
    (tmp_path / "counts.json").write_text(content)
    assert many_machines.main([str(tmp_path / "counts.json")]) == 2
    assert message in capsys.readouterr().err


@pytest.mark.parametrize("arguments", [["--nodes", "0"], ["--grains", "-1"], ["--latency", "-2"]])
def test_bad_arguments_are_refused(arguments: list[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        many_machines.parse_arguments(["counts.json", *arguments])
    assert ended.value.code == 2
