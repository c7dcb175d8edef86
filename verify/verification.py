"""Common to all cases of verify/: runs of both solvers on scenes, their probes, and recorded checks.

A case is a folder with a README.md, scenes and one check_*.py that says `CASE = Case(__file__)`. Results, pictures
and the rows of the checks go to results/verify/<case>/, or below PLIANT_VERIFY_OUT.
"""

from __future__ import annotations

import json
import os
import subprocess
from dataclasses import asdict, dataclass
from enum import Enum
from functools import cache
from pathlib import Path

import numpy as np

from pliant.results import read_json, read_table

ROOT = Path(__file__).resolve().parents[1]
ENGINE = Path(os.environ.get("PLIANT_ENGINE", ROOT / "build/release/pliant_engine"))
REFERENCE = Path(os.environ.get("PLIANT_REFERENCE", ROOT / "build/release/pliant_reference_solver"))
OUT = Path(os.environ.get("PLIANT_VERIFY_OUT", ROOT / "results/verify"))
FULL = os.environ.get("PLIANT_VERIFY_FULL", "") not in ("", "0")
LONGEST_RUN = float(os.environ.get("PLIANT_VERIFY_LONGEST", 14400 if FULL else 900))  # s


class Label(str, Enum):
    """Source of an expected value."""

    EXACT = "EXACT"
    RATE = "RATE"
    INDEPENDENT = "INDEPENDENT"
    FROZEN = "FROZEN"

    @property
    def meaning(self) -> str:
        return {"EXACT": "a closed form, or rounding", "RATE": "the order that theory gives, from three resolutions",
                "INDEPENDENT": "another solver or the literature, with its error",
                "FROZEN": "an earlier value of our own"}[self.value]


@dataclass
class Row:
    """A check in the form of results/verify/checks.json. Green: |value - expected| <= tolerance."""

    label: str
    case: str
    name: str
    value: float
    expected: float
    tolerance: float
    source: str  # of the expected value and of the tolerance
    green: bool
    test: str = ""  # pytest test of the check
    seconds: float = 0.0  # of that test, including its runs
    commit: str = ""  # from which the engine was built

    @property
    def used(self) -> float | None:
        """Distance from the expected value as a share of the tolerance."""
        return abs(self.value - self.expected) / self.tolerance if self.tolerance > 0 else None


class Run:
    """The folder of a finished run."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.summary = read_json(folder / "summary.json")
        self._probes = read_table(folder / "probes.csv")

    def probe(self, name: str) -> np.ndarray:
        """Measured values of a column such as "energy.strain"."""
        return self._sampled(name)[1]

    def times(self, name: str) -> np.ndarray:
        """Times of the column's values, s."""
        return self._sampled(name)[0]

    def _sampled(self, name: str) -> tuple[np.ndarray, np.ndarray]:
        return self._probes.sampled(self._probes.column(name))

    def at(self, name: str, times: np.ndarray) -> np.ndarray:
        """A column at times of its values; others raise an error."""
        measured = self.times(name)
        index = np.abs(measured[:, None] - np.atleast_1d(times)).argmin(axis=0)
        if not np.allclose(measured[index], times, rtol=1e-9, atol=1e-9 * measured[-1]):
            raise KeyError(f"{self.folder}: {name} was not measured at all of these times")
        return self.probe(name)[index]

    def steps(self, name: str) -> np.ndarray:
        """A column of steps.csv such as "dt", or "time"."""
        table = read_table(self.folder / "steps.csv")
        if len(table.time) == 0:
            raise KeyError(f"{table.file}: no steps")
        return table.time if name == "time" else table.column(name).values

    @property
    def balance_error(self) -> float:
        return self.summary["energy"]["balance_error"]


class Case:
    """A folder of verify/: its scenes, its results, its checks.

    Fast cases run in ./pliant test too. Long ones run where they are named and with --full. Cases with the largest cost,
    in minutes of one core, start first.
    """

    def __init__(self, file: str, fast: bool = False, long: bool = False, cost: float = 1) -> None:
        self.fast, self.long, self.cost = fast, long, cost
        self.folder = Path(file).resolve().parent
        self.name = self.folder.name
        self.out = OUT / self.name
        self.out.mkdir(parents=True, exist_ok=True)

    def scene(self, template: str = "scene.toml", **values: object) -> str:
        """A scene file's text with @name@ replaced by values. All values must be used, and no @name@ may remain."""
        text = (self.folder / template).read_text()
        for name, value in values.items():
            if f"@{name}@" not in text:
                raise KeyError(f"{template}: no @{name}@")
            text = text.replace(f"@{name}@", repr(value) if isinstance(value, float) else str(value))
        return text

    def engine(self, run: str, scene: str, *options: str) -> Run:
        """Runs the engine on a scene's text, on one thread, as several cases may run at once."""
        return self._run(run, scene, [str(ENGINE), "run"], ["--threads", "1", *options])

    def reference(self, run: str, scene: str, *options: str) -> Run:
        """Solves a scene's text with the reference solver."""
        return self._run(run, scene, [str(REFERENCE)], [*options])

    def _run(self, run: str, scene: str, program: list[str], options: list[str]) -> Run:
        file, folder = self.out / f"{run}.toml", self.out / run
        file.write_text(scene)
        command = [*program, str(file), "--out", str(folder), "--force", "--quiet", *options]
        result = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=LONGEST_RUN)
        if result.returncode != 0:
            raise RuntimeError(f"{' '.join(command)}\nexit code {result.returncode}\n{result.stdout}{result.stderr}")
        return Run(folder)

    def check(self, label: Label | str, name: str, value: float, expected: float, tolerance: float,
              source: str) -> None:
        """Checks |value - expected| <= tolerance, derived in `source`. A red check is recorded before it fails."""
        value, expected, tolerance = float(value), float(expected), float(tolerance)
        if not (tolerance >= 0 and np.isfinite(expected)) or not source:
            raise ValueError(f"{name}: expected {expected}, tolerance {tolerance}, source '{source}'")
        green = bool(abs(value - expected) <= tolerance)
        test = os.environ.get("PYTEST_CURRENT_TEST", "").rpartition(" ")[0]  # without "(call)"
        self._write_down(Row(Label(label).value, self.name, name, value, expected, tolerance, source, green, test,
                             commit=commit_of_engine()))
        assert green, f"{Label(label).value} {name}: {value:.6g}, expected {expected:.6g} +- {tolerance:.2g} ({source})"

    def check_rate(self, name: str, steps: list[float], errors: list[float], order: float, tolerance: float,
                   source: str) -> float:
        """Checks the slope of errors over steps in logarithms, for at least three steps."""
        if len(steps) < 3:
            raise ValueError(f"{name}: a rate needs three resolutions, not {len(steps)}")
        slope = observed_order(steps, errors)
        self.check(Label.RATE, name, slope, order, tolerance, source)
        return slope

    def _write_down(self, row: Row) -> None:
        file = self.out / "checks.json"
        others = [r for r in read_rows(file) if (r["name"], r["test"]) != (row.name, row.test)]
        replace_file(file, json.dumps([*others, asdict(row)], indent=1) + "\n")


@cache
def commit_of_engine() -> str:
    """Commit from which the engine was built, as in summaries; "unknown" without an engine or without its answer."""
    try:
        answer = subprocess.run([str(ENGINE), "--version"], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    except OSError:
        return "unknown"
    return answer.stdout.strip() if answer.returncode == 0 else "unknown"


def replace_file(file: Path, text: str) -> None:
    """Atomic replacement, as concurrent runs may read the file for their reports."""
    temporary = file.with_suffix(file.suffix + ".tmp")
    temporary.write_text(text)
    temporary.replace(file)


def read_rows(file: Path) -> list[dict]:
    return json.loads(file.read_text()) if file.exists() else []


def weights_of_limit(spacings: np.ndarray, order: int) -> np.ndarray:
    """[sizes] weights of the values at h = 0 of a straight line in this power of the spacing."""
    powers = spacings**order
    return np.polyfit(powers, np.eye(len(powers)), 1, w=1 / powers)[1]


def observed_order(steps: list[float], errors: list[float]) -> float:
    """Slope of a straight line through the logarithms, by least squares."""
    return float(np.polyfit(np.log(steps), np.log(errors), 1)[0])


def largest_difference(a: Run, b: Run, names: list[str], times: np.ndarray) -> float:
    """Largest difference of columns of one unit, over their largest magnitude in b."""
    first, second = (np.array([run.at(name, times) for name in names]) for run in (a, b))
    return float(np.abs(first - second).max() / np.abs(second).max())
