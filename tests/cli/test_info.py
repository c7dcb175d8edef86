"""`./pliant info` and `./pliant compare` on folders of the engine. All EXACT."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
import time

import h5py
import pytest
from conftest import ENGINE, ROOT, Desk
from scenes import TWO_DISCS


def script(desk: Desk, name: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-B", str(ROOT / f"scripts/{name}.py"), *arguments]
    return subprocess.run(command, cwd=desk.folder, capture_output=True, text=True)


def info(desk: Desk, folder: str) -> dict[str, str]:
    result = script(desk, "info", folder)
    assert result.returncode == 0, result.stderr
    return dict(re.split(r" +", line, maxsplit=1) for line in result.stdout.splitlines())


def compared(desk: Desk, code: int, *arguments: str) -> str:
    result = script(desk, "compare", *arguments)
    assert result.returncode == code, result.stdout + result.stderr
    assert "Traceback" not in result.stderr
    return result.stdout + result.stderr


@pytest.fixture
def half(desk) -> Desk:
    desk.write(TWO_DISCS)
    assert desk.run("--out", "out", "--until", "10 ns", "--quiet", "--threads", "1").returncode == 0
    return desk


def test_a_finished_run(half) -> None:
    lines, summary = info(half, "out"), half.summary("out")
    assert lines["run"] == "out: Two discs" and lines["status"] == "finished"
    assert lines["time"] == "10 ns of 10 ns (100.0 %)"
    assert lines["steps"].startswith(f"{summary['steps']}, 0 rejected")
    assert summary["state_hash"] in lines["hash"] and summary["commit"] in lines["build"]
    assert f"step {summary['steps']}," in lines["checkpoint"] and lines["frames"] == "2, the last at 10 ns"
    assert all(name in lines["files"] for name in ["checkpoint.bin", "frames.h5", "probes.csv", "scene.toml"])
    assert "--resume --out out --until" in lines["next"]


def test_running_then_killed(desk) -> None:
    desk.write(TWO_DISCS)
    process = subprocess.Popen([ENGINE, "run", desk.scene, "--out", "out", "--quiet", "--until", "1 s",
                                "--checkpoint-every", "0.1 s"], cwd=desk.folder)
    while not (desk.folder / "out/checkpoint.bin").exists():
        time.sleep(0.01)
    assert info(desk, "out")["status"] == "running"
    process.kill()
    process.wait()
    lines = info(desk, "out")
    assert lines["status"].startswith("killed") and lines["next"] == "./pliant run --resume --out out"
    assert lines["time"].endswith("of 1 s (0.0 %)")
    (desk.folder / "out/checkpoint.bin").unlink()
    assert info(desk, "out")["next"].startswith("./pliant run SCENE --resume --out out, which starts anew")


def test_stopped_and_failed_runs_say_what_to_do(half) -> None:
    file = half.folder / "out/summary.json"
    for status, then in [("stopped: SIGINT", "./pliant run --resume --out out"), ("failed: J <= 0", "see the reason")]:
        file.write_text(json.dumps(half.summary("out") | {"status": status}))
        lines = info(half, "out")
        assert lines["status"] == status and lines["next"].startswith(then)
    (half.folder / "out/checkpoint.bin").unlink()
    lines = info(half, "out")
    assert lines["checkpoint"] == "none" and "--force" in lines["next"]


def test_remains_of_a_run_are_enough(half) -> None:
    for name in ["summary.json", "frames.h5", "checkpoint.bin"]:
        (half.folder / "out" / name).unlink()
    lines = info(half, "out")
    assert lines["status"].startswith("killed") and lines["frames"] == "none"
    assert lines["time"] == f"{1e9 * half.table('out/steps.csv').time[-1]:.3g} ns"


@pytest.mark.parametrize("make", [lambda folder: None, lambda folder: folder.mkdir(),
                                  lambda folder: (folder.mkdir(), (folder / "summary.json").write_text("{"))])
def test_what_is_no_result_folder(desk, make) -> None:
    make(desk.folder / "other")
    for name, folders in [("info", ["other"]), ("compare", ["other", "other"])]:
        result = script(desk, name, *folders)
        assert result.returncode == 2 and "other" in result.stderr and "Traceback" not in result.stderr


def test_equal_runs(half) -> None:
    assert half.run("--out", "two", "--until", "10 ns", "--quiet", "--threads", "2").returncode == 0
    text = compared(half, 0, "out", "two")
    count = int(re.search(r"bit by bit: (\d+) figures.*, \1 of them the same", text)[1])
    assert count > 20


def largest_difference(desk: Desk, a: str, b: str, field: str) -> tuple[float, float]:
    """And the largest magnitude."""
    values = [h5py.File(desk.folder / folder / "frames.h5")[field][()].astype(float) for folder in (a, b)]
    return abs(values[0] - values[1]).max(), max(abs(value).max() for value in values)


def test_a_small_change_is_found_and_located(half) -> None:
    half.write(TWO_DISCS.replace('"20 m/s"', '"20.00001 m/s"'))
    assert half.run("--out", "two", "--until", "10 ns", "--quiet").returncode == 0
    text = compared(half, 1, "out", "two")
    row = next(line for line in text.splitlines() if "frames bodies/velocity" in line)
    absolute, relative = (float(number) for number in re.search(r"(\S+) absolute +(\S+) relative", row).groups())
    largest, scale = largest_difference(half, "out", "two", "bodies/000001/velocity")
    assert absolute == pytest.approx(largest, rel=1e-3) and relative == pytest.approx(largest / scale, rel=1e-3)
    assert re.search(r"\* frames bodies/velocity .* t = \S+ s", text)


@pytest.mark.parametrize("tolerance", ["-1", "nan", "inf", "small"])
def test_bad_tolerance(half, tolerance: str) -> None:
    compared(half, 2, "out", "out", "--tolerance", tolerance)


def test_a_small_change_is_within_a_tolerance(desk) -> None:
    """Smaller than what steps would need to end at other times: their bound sees where bodies are."""
    for folder, speed in (("out", "20 m/s"), ("two", "20.0000001 m/s")):
        desk.write(TWO_DISCS.replace("20 m/s", speed))
        assert desk.run("--out", folder, "--until", "10 ns", "--quiet", "--threads", "1").returncode == 0
    compared(desk, 0, "out", "two", "--tolerance", "1e-3")


def test_other_times_and_columns_are_told(half) -> None:
    assert half.run("--out", "short", "--until", "6 ns", "--quiet").returncode == 0
    text = compared(half, 1, "out", "short", "--tolerance", "1e9")
    assert "probes: 6 and 4 times, 4 in common" in text and "frames: 2 and 1 times, 1 in common" in text
    half.write(TWO_DISCS.replace('name = "energies"', 'name = "balance"').replace('["velocity", ', '['))
    assert half.run("--out", "other", "--until", "10 ns", "--quiet").returncode == 0
    text = compared(half, 1, "out", "other", "--tolerance", "1e9")
    assert "probes energies.kinetic [J/m]: only in the first run" in text
    assert "probes balance.kinetic [J/m]: only in the second run" in text
    assert "frames bodies/velocity: only in the first run" in text


def test_other_grids_cannot_be_compared(half) -> None:
    half.write(TWO_DISCS.replace("nodes = 60", "nodes = 61"))
    assert half.run("--out", "two", "--until", "10 ns", "--quiet").returncode == 0
    assert "other cells" in compared(half, 2, "out", "two")


def test_a_single_bit_and_a_missing_value_differ(half) -> None:
    shutil.copytree(half.folder / "out", half.folder / "two")
    with h5py.File(half.folder / "two/frames.h5", "a") as file:
        file["bodies/000001/velocity"][7, 1] += 1
    assert "* frames bodies/velocity" in compared(half, 1, "out", "two")
    shutil.copy(half.folder / "out/frames.h5", half.folder / "two/frames.h5")
    rows = (half.folder / "two/probes.csv").read_text().splitlines()
    rows[-1] = rows[-1].rpartition(",")[0] + ","
    (half.folder / "two/probes.csv").write_text("\n".join(rows) + "\n")
    assert "inf absolute" in compared(half, 1, "out", "two", "--tolerance", "1e9")
