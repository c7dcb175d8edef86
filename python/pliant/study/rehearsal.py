"""What a study gathers is there: told by the first run's very beginning, not by the end of the last."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from pliant import units
from pliant.engine import call
from pliant.results import Run, read_run
from pliant.names import nearest
from pliant.scene import Scene
from pliant.study.reading import BadStudy
from pliant.study.spec import Quantity, Study

BEGINNING = "1e-25 s"  # of a run: one step, whatever the scene


def rehearse(study: Study, scene_file: Path, scratch: Path) -> None:
    """BadStudy: a run has no such probe, or no such key in its summary. A scene that fails at once tells nothing."""
    named = [quantity for quantity in study.quantities if quantity.function is None]
    columns = [(curve.name, column) for curve in study.curves if curve.function is None
               for column in (curve.x, curve.y)]
    folder = scratch / "beginning"
    if not named + columns or call("run", scene_file, "--out", folder, "--until", BEGINNING, "--quiet").returncode != 0:
        return
    run = read_run(folder)
    for quantity in named:
        _check(study, quantity, run)
    for name, column in columns:
        _check_probe(f"{study.file}: [[curves]]: '{name}'", column, run)


def _check(study: Study, quantity: Quantity, run: Run) -> None:
    place = f"{study.file}: [[quantities]]: '{quantity.name}'"
    if quantity.summary is not None:
        names = _numbers(run.summary)
        if quantity.summary not in names:
            raise BadStudy(f"{place}: summary.json has no number '{quantity.summary}'{nearest(quantity.summary, names)}")
        return
    _check_probe(place, quantity.probe or "", run)


def _check_probe(place: str, column: str, run: Run) -> None:
    names = [known.full_name for known in run.probes.columns]
    if column not in names:
        raise BadStudy(f"{place}: the scene has no probe '{column}'{nearest(column, names)}")


def _numbers(summary: dict[str, Any], before: str = "") -> list[str]:
    """Paths of the numbers in nested tables."""
    names = []
    for key, value in summary.items():
        if isinstance(value, dict):
            names += _numbers(value, f"{before}{key}.")
        elif isinstance(value, (int, float)):
            names.append(before + key)
    return names


def check_windows(study: Study, scene: Scene, of: str) -> None:
    """BadStudy: a window reaches beyond the end of the run that is called `of`."""
    end = units.time(scene["time.end"])
    for quantity in study.quantities:
        if quantity.window is not None and units.time(quantity.window[1]) > end * (1 + 1e-9):
            raise BadStudy(f"{study.file}: [[quantities]]: '{quantity.name}': the window ends at {quantity.window[1]}, the "
                           f"run {of} at {scene['time.end']}")
