"""Reads what a run wrote. Nothing here draws."""

from __future__ import annotations

import io
import json
import re
import sys
import tomllib
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from pliant import units
from pliant.frames import BadFolder, Frames


@dataclass
class Column:
    """One quantity of a table: "lower.force_x [N/m]" has source "lower", name "force_x", unit "N/m"."""

    source: str
    name: str
    unit: str
    values: np.ndarray

    @property
    def full_name(self) -> str:
        return f"{self.source}.{self.name}" if self.source else self.name


@dataclass
class Table:
    """A CSV file: a time for each row, and the other columns. A file that is absent or has no row yet has none."""

    file: Path
    time: np.ndarray
    columns: list[Column]

    def column(self, full_name: str) -> Column:
        """Of a name such as "lower.force_x"; KeyError: there is none."""
        found = [c for c in self.columns if c.full_name == full_name]
        if not found:
            raise KeyError(f"{self.file}: no column {full_name}; {self._content()}")
        return found[0]

    def _content(self) -> str:
        if not self.file.exists():
            return "there is no such file"
        if not self.columns:
            return "the file has no rows"
        return f"there are {', '.join(c.full_name for c in self.columns)}"

    def get(self, name: str, source: str | None = None) -> Column | None:
        found = (c for c in self.columns if c.name == name and source in (None, c.source))
        return next(found, None)

    def sampled(self, column: Column) -> tuple[np.ndarray, np.ndarray]:
        """Times and values where the column has some."""
        there = np.isfinite(column.values)
        return self.time[there], column.values[there]


def read_json(file: Path) -> dict:
    """{} when there is none."""
    try:
        return json.loads(file.read_text())
    except FileNotFoundError:
        return {}
    except (OSError, ValueError) as error:
        raise BadFolder(f"{file}: cannot be read: {error}") from error


def is_finished(folder: Path) -> bool:
    """The run ended well."""
    return read_json(folder / "summary.json").get("status") == "finished"


def checkpoint_header(folder: Path) -> dict:
    """The line of JSON of checkpoint.bin; {} without one, or if that is damaged."""
    try:
        with (folder / "checkpoint.bin").open("rb") as file:
            header = json.loads(file.readline() and file.readline())
    except (OSError, ValueError):
        return {}
    return header if isinstance(header, dict) and {"time", "steps", "written"} <= header.keys() else {}


def read_table(file: Path) -> Table:
    """The CSV file, empty cells as NaN."""
    header, _, rows = file.read_text().partition("\n") if file.exists() else ("", "", "")
    if not rows.strip():
        return Table(file, np.empty(0), [])
    names = [name.strip('"') for name in header.split(",")]
    filled = re.sub(r"(?<=,)(?=[,\n])", "nan", rows)
    try:
        data = np.loadtxt(io.StringIO(filled), delimiter=",", ndmin=2)
    except ValueError as error:
        raise BadFolder(f"{file}: not a table of numbers: {error}") from error
    if data.shape[1] != len(names):
        raise BadFolder(f"{file}: {len(names)} names in the header, {data.shape[1]} columns below")
    columns = [_column(name, values) for name, values in zip(names, data.T)]
    return Table(file, columns[0].values, columns[1:])


def _column(text: str, values: np.ndarray) -> Column:
    match = re.fullmatch(r"(?:(.*)\.)?(.*?)(?: \[(.*)\])?", text)
    assert match is not None  # every part is optional
    return Column(match[1] or "", match[2], match[3] or "-", values)


@dataclass
class Run:
    """All that a result folder holds."""

    folder: Path
    title: str
    period: float | None  # m
    tolerance: float | None  # of the error estimate, where the scene gives it
    probe_of: dict[str, str]  # what a probe looks at: {"force_lower": "lower"}
    probe_quantity: dict[str, str]  # what it measures: {"force_lower": "force"}
    probes: Table
    steps: Table
    stored_frames: Frames | None  # None: there is no frame

    @property
    def has_frames(self) -> bool:
        return self.stored_frames is not None

    @property
    def frames(self) -> Frames:
        """BadFolder: there is no frame."""
        if self.stored_frames is None:
            raise BadFolder(f"{self.folder}: the run has no frames; its scene asks for them with [frames]")
        return self.stored_frames

    def values(self, column: str) -> np.ndarray:
        """[rows] of a column of probes.csv, as in "energy.kinetic", in the unit of its header."""
        return self.probes.column(column).values

    @cached_property
    def summary(self) -> dict:
        """summary.json: how the run ended, what it cost, its energies; {} when there is none."""
        return read_json(self.folder / "summary.json")

    @property
    def warnings(self) -> list[str]:
        """What the engine warned of in this run."""
        return self.summary.get("warnings", [])


def read_run(folder: Path) -> Run:
    """Throws BadFolder for what is no result folder."""
    names = ("probes.csv", "steps.csv", "frames.h5")
    if not folder.is_dir():
        raise BadFolder(f"{folder}: no such folder; give the folder that `pliant run` wrote")
    if not any((folder / name).exists() for name in names):
        raise BadFolder(f"{folder}: holds none of {', '.join(names)}; give the folder that `pliant run` wrote")
    try:
        return _read(folder)
    except (OSError, UnicodeDecodeError) as error:
        raise BadFolder(f"{folder}: cannot be read: {error}") from error


def _read(folder: Path) -> Run:
    scene = _read_scene(folder / "scene.toml")
    period = _period(scene, folder)
    frames = Frames(folder / "frames.h5", period) if (folder / "frames.h5").exists() else None
    time = scene.get("time", {})
    return Run(
        folder,
        scene.get("title", folder.resolve().name),
        period,
        time.get("tolerance", time.get("target")),
        {probe["name"]: probe.get("of", "") for probe in scene.get("probes", []) if "name" in probe},
        {probe["name"]: probe.get("quantity", "") for probe in scene.get("probes", []) if "name" in probe},
        read_table(folder / "probes.csv"),
        read_table(folder / "steps.csv"),
        frames if frames is not None and len(frames.times) > 0 else None,
    )


def _read_scene(file: Path) -> dict:
    if not file.exists():
        return {}
    try:
        return tomllib.loads(file.read_text())
    except tomllib.TOMLDecodeError as error:
        raise BadFolder(f"{file}: {error}") from error


def _period(scene: dict, folder: Path) -> float | None:
    """m; None with a note for a unit that is not known here: bodies are then drawn where they are."""
    value = scene.get("domain", {}).get("period")
    try:
        return None if value is None else units.length(value)
    except ValueError as error:
        print(f"note: {folder / 'scene.toml'}: period: {error}; bodies are not put into one period", file=sys.stderr)
        return None
