"""Ends runs at chosen moments, and compares what is left with the results of a run that nothing disturbed."""

from __future__ import annotations

import os
import signal
import subprocess
from pathlib import Path

import h5py
import numpy as np
from conftest import ENGINE, Desk

# Figures that the processes taking part decide; the momentum error's is looked at with each line of progress.
OF_THE_PROCESS = {"preparation_seconds", "wall_seconds", "phase_seconds", "evaluations_per_second",
                  "peak_memory_bytes", "threads", "resumed", "momentum_error"}
EACH_STEP = ["--checkpoint-every", "1 ns"]  # a time that every step takes


def build_preload(folder: Path) -> Path:
    """kill_at.cpp as a library to be preloaded."""
    library = folder / "kill_at.so"
    source = Path(__file__).with_name("kill_at.cpp")
    subprocess.run(["g++", "-std=c++20", "-O1", "-shared", "-fPIC", source, "-o", library], check=True)
    return library


def start(desk: Desk, out: str, *options: str, **process) -> subprocess.Popen[str]:
    return subprocess.Popen([ENGINE, "run", desk.scene, "--out", out, "--quiet", *options], cwd=desk.folder, text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, **process)


def start_preloaded(preload: Path, desk: Desk, out: str, *options: str, **variables: object) -> subprocess.Popen[str]:
    """A run with kill_at's variables."""
    # A sanitizer asks to come first among the libraries; it may well come second.
    sanitizer = f"verify_asan_link_order=0:{os.environ.get('ASAN_OPTIONS', '')}"
    environment = os.environ | {"LD_PRELOAD": str(preload), "ASAN_OPTIONS": sanitizer}
    return start(desk, out, *options, env=environment | {name: str(value) for name, value in variables.items()})


def registrations(process: subprocess.Popen[str]) -> list[Path]:
    """Files by which LLVM's OpenMP knows that it is in a process. A kill while the runtime starts, which is the first
    change of a file, leaves an empty one, and the next process of this number, tests later, dies of it by SIGBUS."""
    return list(Path("/dev/shm").glob(f"__KMP_REGISTERED_LIB_{process.pid}_*"))


def killed(process: subprocess.Popen[str]) -> bool:
    """Whether a run was ended by SIGKILL. False when it came to its end."""
    _, errors = process.communicate(timeout=120)
    for file in registrations(process):
        file.unlink(missing_ok=True)
    assert process.returncode in {0, -signal.SIGKILL}, errors
    return process.returncode != 0


def changes_of(preload: Path, desk: Desk, out: str, *options: str) -> int:
    """How often a run changes its files."""
    count = desk.folder / f"{out}.count"
    process = start_preloaded(preload, desk, out, *options, COUNT_FILE=count)
    assert not killed(process)
    return int(count.read_text())


def mend(desk: Desk, out: str, threads: int = 1) -> None:
    """What a user does after a kill: --resume, or the same command once more where no folder is there yet."""
    resume = ["--resume"] if (desk.folder / out).exists() else []
    result = desk.run("--out", out, "--quiet", "--threads", str(threads), *resume)
    assert (result.returncode, result.stderr) == (0, "")


def frames_of(folder: Path) -> dict[str, np.ndarray]:
    arrays: dict[str, np.ndarray] = {}
    with h5py.File(folder / "frames.h5") as file:
        file.visititems(lambda name, item: arrays.update({name: item[()]} if isinstance(item, h5py.Dataset) else {}))
    return arrays


def assert_same(desk: Desk, out: str) -> None:
    """A folder holds what `whole` does: the same files, bits and figures."""
    one, other = desk.folder / "whole", desk.folder / out
    assert {file.name for file in one.iterdir()} == {file.name for file in other.iterdir()}
    for name in ["probes.csv", "steps.csv", "frames.xdmf"]:
        assert (one / name).read_bytes() == (other / name).read_bytes(), name
    left, right = frames_of(one), frames_of(other)
    assert left.keys() == right.keys()
    assert all(np.array_equal(left[name], right[name]) for name in left)
    first, second = desk.summary("whole"), desk.summary(out)
    assert first.keys() == second.keys()
    for key in first.keys() - OF_THE_PROCESS:
        assert first[key] == second[key], key
