"""Runs the engine on files of scenes and asks it about them."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import warnings
from dataclasses import dataclass
from pathlib import Path

from pliant.results import Run, read_json, read_run

BUILT = Path(__file__).resolve().parents[2] / "build/release/pliant_engine"  # in a checkout
INSTALLED = Path(__file__).resolve().parents[4] / "bin/pliant_engine"  # as cmake/install.cmake lays it out
BAD_INPUT = 2  # exit code of what is wrong before a run begins
ENGINE_SETTINGS = {"OMP_WAIT_POLICY": "passive", "OMP_PROC_BIND": "false"}  # runs side by side must not wait actively


class BadScene(Exception):
    """The engine refuses a scene; the message is its own."""


class EngineWarning(UserWarning):
    """What the engine warned of in a run: lost energy, deep contacts."""


class RunFailed(Exception):
    """A run that began did not end well; its folder has what is left of it."""


def engine() -> Path:
    """What PLIANT_ENGINE names; else the program that ./pliant builds in the checkout; else the one that is installed
    beside this package, or on the PATH."""
    if named := os.environ.get("PLIANT_ENGINE"):
        found = [Path(named)]
    else:
        found = [BUILT, INSTALLED, *map(Path, filter(None, [shutil.which(BUILT.name)]))]
    path = next((file for file in found if file.exists()), None)
    if path is None:
        raise FileNotFoundError(f"{found[0]}: there is no engine; ./pliant build makes it, or PLIANT_ENGINE names one")
    return path


def start(*arguments: str | Path) -> subprocess.Popen[str]:
    return subprocess.Popen([engine(), *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                            stdin=subprocess.DEVNULL, env={**ENGINE_SETTINGS, **os.environ})


def call(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    with start(*arguments) as process:
        output, errors = process.communicate()
    return subprocess.CompletedProcess(process.args, process.returncode, output, errors)


@dataclass
class Estimate:
    """What `check` says of a scene. None: it does not say."""

    text: str
    evaluations: float | None
    seconds: float | None
    memory: float | None  # bytes
    output: float | None  # bytes


_COUNTS = {"thousand": 1e3, "million": 1e6, "until": 1.0}
_BYTES = {"B": 1.0, "kB": 1e3, "MB": 1e6, "GB": 1e9, "TB": 1e12}
_SECONDS = {"s": 1.0, "min": 60.0, "h": 3600.0, "days": 86400.0, "d": 86400.0}


def _quantity(text: str, row: str, units: dict[str, float]) -> float | None:
    number = r"([\d.]+(?:e[-+]?\d+)?)"
    found = re.search(rf"^{row} +(?:at least |about )*{number} ({'|'.join(units)})\b", text, re.MULTILINE)
    return float(found[1]) * units[found[2]] if found else None


def check(file: Path, threads: int = 1) -> Estimate:
    """Of a scene in a file. BadScene with the engine's words. Of one that fails within the steps that `check` tries there
    is no estimate."""
    result = call("check", file, "--threads", str(threads))
    if result.returncode == BAD_INPUT:
        raise BadScene(result.stderr.strip())
    text = result.stdout
    return Estimate(text, _quantity(text, "evaluations", _COUNTS), _quantity(text, "time", _SECONDS),
                    _quantity(text, "memory", _BYTES), _quantity(text, "output", _BYTES))


def _depth_in_package() -> int:
    """Calls from the user's line to the one that asks: a warning with it as `stacklevel` names the user's line."""
    depth, frame = 1, sys._getframe(1)
    while frame.f_back and frame.f_globals.get("__name__", "").partition(".")[0] == "pliant":
        depth, frame = depth + 1, frame.f_back
    return depth


def run(file: Path, folder: Path, threads: int = 1) -> Run:
    """Runs a scene in a file into a folder, over what is there, and opens it. BadScene, RunFailed; EngineWarning."""
    result = call("run", file, "--out", folder, "--force", "--threads", str(threads), "--quiet")
    if result.returncode == BAD_INPUT:
        raise BadScene(result.stderr.strip())
    for text in read_json(folder / "summary.json").get("warnings", []):
        warnings.warn(text, EngineWarning, stacklevel=_depth_in_package())
    if result.returncode != 0:
        raise RunFailed(result.stderr.strip() or f"{folder}: the engine ended with {result.returncode}")
    return read_run(folder)
