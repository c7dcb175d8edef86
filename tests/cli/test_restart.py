"""Checkpoints from the command line: a run that was stopped, killed or ended early goes on with the same bits. All
EXACT."""

from __future__ import annotations

import json
import re
import resource
import signal
import subprocess
import time
from pathlib import Path

import h5py
import pytest
from conftest import Desk
from kills import (EACH_STEP, assert_same, build_preload, changes_of, killed, mend, registrations, start,
                   start_preloaded)
from scenes import LAYER, SHORT_LAYER


def whole_run(folder: Path, scene: str, integrator: str) -> Desk:
    """An uninterrupted run in `whole`, with one thread."""
    desk = Desk(folder)
    desk.write(scene.replace("[time]", f'[time]\nintegrator = "{integrator}"'))
    result = desk.run("--out", "whole", "--threads", "1", "--quiet")
    assert result.returncode == 0, result.stderr
    return desk


@pytest.fixture(scope="module", params=["verlet", "step-doubling"])
def whole(request, tmp_path_factory) -> Desk:
    return whole_run(tmp_path_factory.mktemp("whole"), LAYER, request.param)


@pytest.fixture
def out(whole) -> str:
    """A fresh name for a folder."""
    return f"out{len(list(whole.folder.iterdir()))}"


@pytest.fixture(scope="module")
def preload(tmp_path_factory) -> Path:
    return build_preload(tmp_path_factory.mktemp("preload"))


@pytest.mark.parametrize("threads", ["1", "2"])
def test_a_run_that_ended_early_goes_on(whole, out, threads) -> None:
    """The end was an output's time: equal steps lead there in both runs."""
    assert whole.run("--out", out, "--until", "1.5", "--threads", threads, "--quiet").returncode == 0
    assert whole.summary(out)["time"] == 1.5
    result = whole.run("--out", out, "--resume", "--threads", threads, "--quiet")
    assert result.returncode == 0, result.stderr
    assert result.stderr == "", "the same build wrote it"
    assert_same(whole, out)
    assert whole.summary(out)["resumed"] == 1


@pytest.mark.parametrize("stop, code", [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_stops_in_order_and_the_run_goes_on(whole, out, preload, stop, code) -> None:
    process = start_preloaded(preload, whole, out, *EACH_STEP, KILL_AFTER_CHECKPOINT=5, KILL_SIGNAL=int(stop))
    output, errors = process.communicate(timeout=60)
    assert process.returncode == code
    assert f"stopped by {stop.name}" in errors and "--resume" in errors and output == ""
    summary = whole.summary(out)
    assert summary["status"] == f"stopped: {stop.name}" and 0 < summary["time"] < 4
    assert not (whole.folder / out / "run.lock").exists()
    assert whole.run("--out", out, "--resume", "--threads", "2", "--quiet").returncode == 0
    assert_same(whole, out)


def test_killed_again_and_again(whole, out, preload) -> None:
    """Whatever was written after the last checkpoint is cut back, however often the run is killed."""
    options: list[str] = []
    times = [0.0]
    for _ in range(3):
        assert killed(start_preloaded(preload, whole, out, *EACH_STEP, *options, KILL_AFTER_CHECKPOINT=5))
        times.append(whole.summary(out)["checkpoint_time"])
        assert whole.summary(out)["status"] == "running"
        options = ["--resume"]
    assert times == sorted(set(times))
    result = whole.run("--out", out, "--resume", "--threads", "1", "--quiet")
    assert result.returncode == 0, result.stderr
    assert_same(whole, out)
    assert whole.summary(out)["resumed"] == 3


def test_killed_between_the_last_checkpoint_and_the_summary(whole, out, preload) -> None:
    process = start_preloaded(preload, whole, out, "--checkpoint-every", "never", KILL_AFTER_CHECKPOINT=1)
    assert killed(process) and whole.summary(out)["status"] == "running"
    result = whole.run("--out", out, "--resume", "--until", "1.5")
    assert result.returncode == 0 and "nothing to do" in result.stdout
    mend(whole, out)
    assert_same(whole, out)
    assert "nothing to do" in whole.run("--out", out, "--resume").stdout


@pytest.mark.parametrize("integrator, threads, stride", [("verlet", 2, 1), ("step-doubling", 1, 5)])
def test_every_moment_of_a_kill_is_mended(tmp_path, preload, integrator, threads, stride) -> None:
    """Before every change of a file at the start and at the end, and now and then in between. Each third is killed once
    more, while it goes on. Files are changed alike by both integrators: a fifth of the moments for the second."""
    desk = whole_run(tmp_path, SHORT_LAYER, integrator)
    changes = changes_of(preload, desk, "counted", *EACH_STEP)
    assert changes > 100
    moments = [*range(30), *range(30, changes - 15, 13), *range(changes - 15, changes)]
    for n in moments[::stride]:
        out = f"out{n}"
        assert killed(start_preloaded(preload, desk, out, *EACH_STEP, KILL_BEFORE=n))
        if n % 3 == 0 and (desk.folder / out).exists():
            killed(start_preloaded(preload, desk, out, *EACH_STEP, "--resume", KILL_BEFORE=n // 3))
        mend(desk, out, threads)
        assert_same(desk, out)


def test_killed_while_it_overwrites(desk, preload) -> None:
    """The earlier run is whole, or the new one starts anew."""
    desk.write(SHORT_LAYER)
    assert desk.run("--out", "whole", "--quiet", "--threads", "1").returncode == 0
    for n in range(40):
        assert desk.run("--out", "out", "--quiet", "--force", "--threads", "1").returncode == 0
        assert killed(start_preloaded(preload, desk, "out", "--force", KILL_BEFORE=n))
        mend(desk, "out")
        assert_same(desk, "out")


def test_kills_leave_nothing_to_other_processes(desk, preload) -> None:
    """While the OpenMP runtime starts, and after."""
    desk.write(SHORT_LAYER)
    for n in 0, 20:
        process = start_preloaded(preload, desk, f"out{n}", KILL_BEFORE=n)
        assert killed(process)
        assert registrations(process) == []


def test_killed_before_a_checkpoint_the_folder_knows_its_scene(whole, out, preload) -> None:
    """From the first summary on."""
    changes = changes_of(preload, whole, out, "--checkpoint-every", "never")
    started_with_a_scene = 0
    for n in [*range(40), changes // 2]:
        folder = f"{out}_{n}"
        assert killed(start_preloaded(preload, whole, folder, "--checkpoint-every", "never", KILL_BEFORE=n))
        result = whole.engine("run", "--resume", "--out", folder, "--quiet")
        if (whole.folder / folder / "probes.csv").exists() and result.returncode == 0:
            started_with_a_scene += 1
            assert_same(whole, folder)
        else:
            assert result.returncode == (4 if (whole.folder / folder).exists() else 2)
            assert any(text in result.stderr for text in ("name its scene file", "cannot be read", "no such folder"))
    assert started_with_a_scene > 0


def test_whatever_follows_the_checkpoint_is_cut_off(whole, out) -> None:
    """An old checkpoint beside the files of a finished run: the worst that a kill can leave."""
    assert whole.run("--out", out, "--until", "1.5", "--quiet").returncode == 0
    checkpoint = whole.folder / out / "checkpoint.bin"
    old = checkpoint.read_bytes()
    for _ in range(2):
        assert whole.run("--out", out, "--resume", "--quiet").returncode == 0
        checkpoint.write_bytes(old)
    with h5py.File(whole.folder / out / "frames.h5", "a") as frames:  # killed before the frame's time was listed
        frames["times"].resize((8,))
    assert whole.run("--out", out, "--resume", "--quiet").returncode == 0
    assert_same(whole, out)


def test_a_later_end_goes_on(whole, out) -> None:
    """To the bits of a run that had an output where the first one ended."""
    assert whole.run("--out", out, "--until", "0.5", "--quiet").returncode == 0
    result = whole.run("--out", out, "--resume", "--until", "0.25", "--quiet")
    assert result.returncode == 0 and whole.summary(out)["time"] == 0.5, "nothing to do before the checkpoint"
    assert whole.run("--out", out, "--resume", "--until", "1", "--quiet").returncode == 0
    assert whole.run("--out", out + "b", "--until", "1", "--quiet").returncode == 0
    assert whole.summary(out)["state_hash"] == whole.summary(out + "b")["state_hash"]


def test_resume_finds_the_scene_in_the_folder(whole, out) -> None:
    assert whole.run("--out", out, "--until", "0.5", "--quiet").returncode == 0
    result = whole.engine("run", "--resume", "--out", out, "--quiet")
    assert result.returncode == 0, result.stderr
    assert_same(whole, out)
    assert whole.summary(out)["scene"] == "scene"
    result = whole.engine("run", "--resume", "--quiet")
    assert result.returncode == 2 and "no scene file" in result.stderr


@pytest.fixture
def half(desk) -> Desk:
    """Half of a run in `out`."""
    desk.write(LAYER)
    assert desk.run("--out", "out", "--until", "0.5", "--quiet").returncode == 0
    return desk


def resumed(desk: Desk, *options: str) -> subprocess.CompletedProcess[str]:
    return desk.run("--out", "out", "--resume", "--quiet", *options)


@pytest.mark.parametrize("old, new, said", [
    ("friction = 0.4", "friction = 0.5", "'contacts 1.friction' was 0.4, now 0.5"),
    ("[time]", "[time]\ntolerance = 1e-3", "'time.tolerance' was not there, now 0.001"),
    ("period = 0.01\n", "period = 0.02\n", "'probes 1.period' was 0.01, now 0.02"),
    ("origin = [1, 0]", "origin = [1.0, 0.5]", "'grains 1.packing.origin 2' was 0, now 0.5"),
    ('strength = 0.1', 'strength = "0.1 Pa"', "'contacts 2.strength' was 0.1, now '0.1 Pa'"),
])
def test_another_scene_is_refused(half, old, new, said) -> None:
    before = {file: file.read_bytes() for file in (half.folder / "out").iterdir()}
    half.write(LAYER.replace(old, new))
    result = resumed(half)
    assert result.returncode == 2 and said in result.stderr, result.stderr
    assert {file: file.read_bytes() for file in (half.folder / "out").iterdir()} == before


def test_end_title_comments_and_checkpoints_may_change(half) -> None:
    longer = LAYER.replace("end = 4", "end = 0.75")
    half.write(f'# longer\ntitle = "x"\n{longer}[checkpoint]\nperiod = "never"\n')
    assert resumed(half).returncode == 0
    assert half.summary("out")["time"] == 0.75 and half.summary("out")["title"] == "x"


@pytest.mark.parametrize("damage", ["cut", "flipped", "grown", "empty", "missing", "other version", "no checkpoint"])
def test_a_damaged_checkpoint_is_refused(half, damage) -> None:
    file = half.folder / "out/checkpoint.bin"
    content = file.read_bytes()
    middle = len(content) // 2
    flipped = content[:middle] + bytes([content[middle] ^ 1]) + content[middle + 1:]
    spoilt = {"cut": content[:middle], "flipped": flipped, "grown": content + b"x", "empty": b"",
              "other version": content.replace(b"checkpoint 4", b"checkpoint 3"), "no checkpoint": b"time [s],dt\n"}
    if damage == "missing":
        file.unlink()
    else:
        file.write_bytes(spoilt[damage])
    result = resumed(half)
    assert result.returncode == 4 and "checkpoint.bin" in result.stderr, result.stderr
    assert {"missing": "No such file", "other version": "another version", "empty": "not a checkpoint",
            "no checkpoint": "not a checkpoint"}.get(damage, "is damaged") in result.stderr


@pytest.mark.parametrize("name", ["probes.csv", "steps.csv", "frames.h5"])
def test_files_that_lack_what_the_checkpoint_knows_are_refused(half, name) -> None:
    file = half.folder / "out" / name
    if name == "frames.h5":
        with h5py.File(file, "a") as frames:
            frames["times"].resize((1,))
    else:
        file.write_bytes(file.read_bytes()[:-20])
    result = resumed(half)
    assert result.returncode == 4 and name in result.stderr and "--force" in result.stderr


def test_another_build_is_warned_about(half) -> None:
    file = half.folder / "out/checkpoint.bin"
    content = re.sub(rb'"build":"[^,]*', b'"build":"0123456', file.read_bytes())[:-16]
    file.write_bytes(content + b"%016x" % fnv1a(content))
    result = half.run("--out", "out", "--resume")
    assert result.returncode == 0 and "written by another build (0123456" in result.stderr, result.stderr


def fnv1a(content: bytes) -> int:
    value = 14695981039346656037
    for byte in content:
        value = (value ^ byte) * 1099511628211 % 2**64
    return value


def test_resume_needs_a_checkpoint_and_excludes_force(desk) -> None:
    desk.write(LAYER)
    (desk.folder / "none").mkdir()
    (desk.folder / "none/notes.txt").write_text("of someone else")
    assert desk.run("--out", "none", "--resume", "--quiet").returncode == 4
    assert [file.name for file in (desk.folder / "none").iterdir()] == ["notes.txt"]
    assert desk.run("--out", "none", "--resume", "--force", "--quiet").returncode == 2


def test_a_folder_in_use_is_refused(half) -> None:
    process = start(half, "busy", "--until", "400")
    while not (half.folder / "busy/summary.json").exists():
        time.sleep(0.01)
    process.send_signal(signal.SIGSTOP)  # however long the others take, it is not at its end
    for option in ["--force", "--resume"]:
        result = half.run("--out", "busy", option, "--quiet")
        assert result.returncode == 4, result.stderr
    assert "another run is writing" in half.run("--out", "busy", "--force", "--quiet").stderr
    process.kill()
    assert killed(process)
    assert (half.folder / "busy/run.lock").exists(), "killed: the file stays, its lock does not"
    assert half.run("--out", "busy", "--until", "0.1", "--force", "--quiet").returncode == 0


def limited(bytes_allowed: int) -> None:
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (bytes_allowed, bytes_allowed))


def test_a_full_disk_keeps_the_last_good_checkpoint(desk) -> None:
    """A limit of file sizes stands for the full disk."""
    desk.write(LAYER.partition("[frames]")[0])
    assert desk.run("--out", "out", "--until", "0.5", "--quiet").returncode == 0
    file = desk.folder / "out/checkpoint.bin"
    good = file.read_bytes()
    process = start(desk, "out", "--resume", "--checkpoint-every", "0.001 s",
                    preexec_fn=lambda: limited(len(good) - 1000))
    errors = process.communicate(timeout=60)[1]
    assert process.returncode == 4
    assert "checkpoint.bin: cannot be written: File too large" in errors and "last good checkpoint: t = 0.5 s" in errors
    assert file.read_bytes() == good
    assert not list((desk.folder / "out").glob("*.tmp"))
    assert desk.summary("out")["status"].startswith("failed: ")
    assert resumed(desk).returncode == 0


def test_a_failed_run_leaves_what_tells_why(desk) -> None:
    """The message's figures once more, the place and outlines there, and a frame of the last good state."""
    soft = LAYER.replace('law = "mohr-coulomb"', 'law = "mohr-coulomb"\nstiffness = 0.1')
    desk.write(soft.replace("end = 4", "end = 40"))
    result = desk.run("--out", "out", "--quiet", "--threads", "1")
    assert result.returncode == 3, result.stderr
    report = json.loads((desk.folder / "out/failure.json").read_text())
    good = report["last_good_state"]
    assert report["message"] in result.stderr and report["cause"] in {"contact lost", "inverted"}
    assert all(f"'{name}'" in report["message"] for name in report["bodies"])
    assert set(good["outlines"]) == set(report["bodies"])
    assert good["time"] == desk.summary("out")["time"] < report["time"]
    assert good["least_jacobian"]["value"] > 0 and good["deepest_contact"]["depth_over_segment"] < 1
    near = min(abs(complex(*point) - complex(*report["place"])) for points in good["outlines"].values() for point in points)
    assert near < 0.5, "of a disc of diameter 2"
    with h5py.File(desk.folder / "out/frames.h5") as file:
        assert max(file["times"][()]) == pytest.approx(good["time"], rel=1e-12)
    # A run that goes on has forgotten it.
    assert desk.run("--out", "out", "--force", "--until", "0.5", "--quiet").returncode == 0
    assert not (desk.folder / "out/failure.json").exists()


def test_a_physics_failure_names_the_last_good_checkpoint(desk) -> None:
    soft = LAYER.replace('law = "mohr-coulomb"', 'law = "mohr-coulomb"\nstiffness = 0.1')
    desk.write(soft.replace("end = 4", "end = 40"))
    result = desk.run("--out", "out", "--checkpoint-every", "never", "--quiet")
    assert result.returncode == 3 and "no checkpoint yet" in result.stderr
    half = desk.summary("out")["time"] / 2
    assert half > 0 and desk.run("--out", "out", "--force", "--until", str(half), "--quiet").returncode == 0
    result = desk.run("--out", "out", "--resume", "--checkpoint-every", "never", "--quiet")
    assert result.returncode == 3
    assert f"last good checkpoint: t = {half:.6g} s" in result.stderr
    assert json.dumps(desk.summary("out")["status"]).startswith('"failed: contact')


@pytest.mark.parametrize("text", ["0 s", "-1 s", "10 um", "soon"])
def test_checkpoint_period_is_a_positive_time(desk, text) -> None:
    desk.write(LAYER)
    result = desk.run("--out", "out", "--checkpoint-every", text, "--quiet")
    assert result.returncode == 2 and "--checkpoint-every" in result.stderr and "or never" in result.stderr
    assert not (desk.folder / "out").exists()
