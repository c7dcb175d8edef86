"""Runs of a scene by one of the solvers, with what they cost and how far off they are."""

from __future__ import annotations

import json
import os
import subprocess
from dataclasses import dataclass
from pathlib import Path

from error_study.choices import Choice
from error_study.scenes import Scene


@dataclass(frozen=True)
class Measured:
    scene: str
    choice: Choice
    error: float  # NaN: the run failed
    evaluations: int  # of forces; of the reference, residuals
    seconds: float  # of the steps, the least of the repetitions; without output
    memory: float  # peak, bytes
    message: str = ""  # of a run that failed


@dataclass(frozen=True)
class Programs:
    engine: Path
    reference: Path


class Runner:
    """One thread each: costs are those of the method."""

    def __init__(self, programs: Programs, scratch: Path, repetitions: int) -> None:
        self.programs, self.scratch, self.repetitions = programs, scratch, repetitions
        self.out = scratch / "out"

    def measure(self, scene: Scene, choice: Choice) -> Measured:
        seconds = []
        for _ in range(1 if choice.step else self.repetitions):
            message = self.run(scene, choice)
            if message:
                return Measured(scene.name, choice, float("nan"), 0, float("nan"), 0, message)
            summary = json.loads((self.out / "summary.json").read_text())
            seconds.append(seconds_of(summary))
        return Measured(scene.name, choice, scene.error(self.out), summary["evaluations"], min(seconds),
                        summary["peak_memory_bytes"])

    def run(self, scene: Scene, choice: Choice) -> str:
        """Returns the message of a failed run."""
        file = self.scratch / f"{scene.name}.toml"
        file.write_text(scene.text(choice))
        if choice.step is None:
            command = [self.programs.engine, "run", file, "--threads", "1"]
        else:
            command = [self.programs.reference, file, "--dt", repr(choice.step * scene.unit)]
        result = subprocess.run([*map(str, command), "--out", str(self.out), "--force", "--quiet"], capture_output=True,
                                text=True, stdin=subprocess.DEVNULL, env=os.environ)
        return (result.stderr.strip() or f"exit code {result.returncode}") if result.returncode else ""


def seconds_of(summary: dict) -> float:
    """Of all steps, without output where the solver tells it apart."""
    phases = summary.get("phase_seconds")
    if phases is None:
        return summary["wall_seconds"]
    return sum(phases.values()) - phases["output"]
