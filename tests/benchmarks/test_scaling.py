"""What benchmarks/scaling.py makes of a recording; nothing is timed. EXACT."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path

import pytest

import scaling

ROOT = Path(__file__).resolve().parents[2]


def region(**changes: object) -> dict:
    return {"file": "lib/contact/contact.cpp", "line": 7, "function": "PairTotals pliant::ContactSystem::forces(const Outlines &, int)",
            "calls": 1, "iterations": 10, "seconds": 8e-3, "serial": 1e-3, "worst_chunk": 1e-4, "bytes": 0,
            "shares": [8e-3, 5e-3], "by_cost": [8e-3, 4e-3]} | changes


def recording(*regions: dict) -> dict:
    return {"grains": 5, "steps": 3, "measured": {"1": [12e-3, 10e-3, 11e-3], "2": [6e-3]}, "region_cost": {"1": 1e-6, "2": 2e-6},
            "bytes": 9e6, "threads": [1, 2], "serial_at_end": 1e-3, "regions": list(regions)}


def test_a_step_is_its_slowest_threads_its_barriers_and_what_is_serial() -> None:
    one, two = scaling.Step(recording(region()), math.inf).predictions()
    assert one.seconds == pytest.approx(10e-3 + 1e-6, rel=1e-12)
    assert one.efficiency == pytest.approx(1)
    assert two.seconds == pytest.approx(7e-3 + 2e-6, rel=1e-12)
    assert two.efficiency == pytest.approx(one.seconds / (2 * two.seconds))
    assert two.equal_cost == pytest.approx(one.seconds / (2 * (6e-3 + 2e-6)))
    assert two.serial == pytest.approx(2e-3 / two.seconds)
    assert two.bandwidth == pytest.approx(9e6 / two.seconds)


def test_no_region_is_faster_than_the_memory() -> None:
    step = scaling.Step(recording(region(bytes=6e6)), 1e9)
    assert step.seconds(2) == pytest.approx(2e-3 + 6e-3 + 2e-6, rel=1e-12)
    assert step.seconds(1) == pytest.approx(10e-3 + 1e-6, rel=1e-12)


def test_bytes_come_from_another_run() -> None:
    both = scaling.with_bytes(recording(region(bytes=0, calls=2), region(line=8)), {"step": 5, "regions": [
        {"file": "lib/contact/contact.cpp", "line": 7, "bytes": 3}]})
    assert both["bytes"] == 5 and [r["bytes"] for r in both["regions"]] == [1.5, 0]


def test_barriers_grow_with_the_logarithm() -> None:
    machine = scaling.Machine(2e-6, 1e-6, math.inf)
    assert [machine.region(n) for n in (1, 2, 64)] == pytest.approx([1e-6, 2e-6, 12e-6])


def test_predictions_stand_beside_the_fastest_measured() -> None:
    one, two = scaling.Step(recording(region()), math.inf).check()
    assert "measured 10.000 ms, +0.0%" in one
    assert "measured 6.000 ms, +16.7%" in two


@pytest.mark.parametrize("full, name", [
    ("PairTotals pliant::ContactSystem::forces(const Outlines &, int)", "ContactSystem::forces"),
    ("void pliant::(anonymous namespace)::update(const Model &)", "update"),
    ("void pliant::for_each_dof(const Model &, CompliantUpdate &&) [CompliantUpdate = (lambda at x.cpp:3:4)]", "for_each_dof"),
    ("std::array<double, size> pliant::Bound::of(std::vector<int> &)", "Bound::of")])
def test_names_of_functions(full: str, name: str) -> None:
    assert scaling.function_name(full) == name


def test_a_large_body_lies_below_the_small_ones() -> None:
    scene = tomllib.loads(scaling.large_body_among_small((ROOT / "cases/third_body.toml").read_text()))
    assert [grains["name"] for grains in scene["grains"]] == ["third_body", "large"]
    assert scene["shapes"]["large"]["nodes"] == 50000
    assert "walls" not in scene and "probes" not in scene


@pytest.mark.parametrize("arguments", [["--threads", "3"], ["--bandwidth", "0"], ["--rounds", "0"], ["--scene", "missing.toml"]])
def test_bad_arguments_are_refused(arguments: list[str], capsys: pytest.CaptureFixture) -> None:
    with pytest.raises(SystemExit) as ended:
        scaling.parse_arguments(arguments)
    assert ended.value.code == 2
    assert arguments[0] in capsys.readouterr().err


def test_a_packing_that_is_not_there(capsys: pytest.CaptureFixture) -> None:
    assert scaling.main(["--only", "3"]) == 2
    assert "2,000 grains, 20,000 grains, large body" in capsys.readouterr().err
