"""The page: template, style, scripts, what the run is, and its chunks, written one after the other."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import jinja2
import matplotlib
import numpy as np
from markupsafe import Markup
from matplotlib.colors import to_hex

from plots.drawing import CELL, EDGE, KIND_COLOURS
from plots.fields import NEUTRAL
from pliant import units
from pliant.results import Column, Run, Table
from viewing.packing import Field, Packing, as_text
from viewing.shapes import ERROR, FINE

HERE = Path(__file__).resolve().parent
SCRIPTS = ["unpack.js", "raster.js", "picture.js", "overlay.js", "picking.js", "curve.js",
           "legend.js", "controls.js", "viewer.js"]
TWO_SIDED = {"cells": "RdBu_r", "outlines": "coolwarm"}
BODIES = "#dddddd"  # where colours are along outlines: the middle of coolwarm, so that next to nothing is not seen
# Below and above a scale: colours that it has not.
BEYOND = {"inferno": ("#57d400", "#00d5ff"), "cividis": ("#57d400", "#ff2d95"), "viridis": ("#ff8c00", "#ff2d95"),
          "YlOrRd": ("#57d400", "#0a84ff"), "turbo": ("#ffffff", "#ffffff"), "RdBu_r": ("#57d400", "#ffb000"),
          "coolwarm": ("#57d400", "#ffb000"), "prism": ("#c9c9c9", "#c9c9c9")}
# A column of more rows keeps, of each of so many stretches, the least and the largest, and those nearest to the frames.
ROWS, STRETCHES = 4000, 1500


def measure(largest: float, unit: str) -> dict[str, Any]:
    """Factor to a unit that can be read, and its name as people write it."""
    factor, scaled = units.scale(largest, unit)
    if len(scaled) > len(unit) and scaled.startswith("u"):
        scaled = "µ" + scaled[1:]
    return {"factor": factor, "unit": "" if scaled == "-" else scaled.replace("s2", "s²").replace("m3", "m³")}


def readable(value: float, unit: str, digits: int = 4) -> str:
    of = measure(value, unit)
    return f"{value * of['factor']:.{digits}g} {of['unit']}".rstrip()


def facts(run: Run, packing: Packing) -> list[tuple[str, str]]:
    """What the run is, from summary.json: names and values."""
    summary = run.summary
    found = [("scene", str(summary["scene"]))] if "scene" in summary else []
    status, time = summary.get("status"), summary.get("time")
    if status is not None:
        found.append(("status", str(status)))
    if isinstance(time, (int, float)) and status != "running":
        found.append(("end time", readable(time, "s", 6)))
    if status == "finished" and "state_hash" in summary:
        found.append(("final hash", str(summary["state_hash"])))
    found += [(name, str(summary[name])) for name in ("commit", "compiler") if name in summary]
    found.append(("bodies", str(packing.points.bodies)))
    return found + ([("nodes", str(summary["nodes"]))] if "nodes" in summary else [])


def _box(run: Run, packing: Packing) -> list[float]:
    """Left, right, low, high of all frames; of a periodic scene one period, or all its cells."""
    (left, low), (right, high) = packing.box
    if run.frames.in_cell:
        corners = np.concatenate([[[0, 0], a, b, a + b] for a, b in map(run.frames.periods, packing.chosen)])
        (left, low), (right, high) = corners.min(axis=0), corners.max(axis=0)
    if run.period is not None:
        left, right = 0.0, run.period
    return [float(left), float(right), float(low), float(high)]


def _cell(run: Run, index: int) -> list[float]:
    """ax, ay, bx, by of its sides, m."""
    return [float(x) for x in run.frames.periods(index).ravel()]


def _field(field: Field) -> dict[str, Any]:
    scale = field.scale
    assert scale is not None
    of = measure(max(abs(scale.low), abs(scale.high)), field.look.unit)
    palette = TWO_SIDED[field.look.at] if scale.two_sided else field.look.colours + ("_r" if scale.negative else "")
    return {"name": field.name, "label": field.look.label, "at": field.look.at, "once": field.once, "low": scale.low,
            "high": scale.high, "centre": scale.centre, "step": scale.step, "least": scale.least,
            "largest": scale.largest, "palette": palette, "error_text": _error(field), "fixed": field.look.fixed,
            "digits": _digits(field, of["factor"]), **of}


def _digits(field: Field, factor: float) -> int:
    """Behind the point: as many as steps need, and not many more."""
    assert field.scale is not None
    return 0 if field.look.step is not None else int(np.clip(np.ceil(-np.log10(field.scale.step * factor / 4)), 0, 12))


def _error(field: Field) -> str:
    assert field.scale is not None
    return "none" if field.look.step is not None else readable(field.scale.step / 2, field.look.unit, 3)


def _palette(name: str) -> dict[str, Any]:
    """Colours of a map; one that is reversed has its ends reversed too."""
    colours = matplotlib.colormaps[name](np.arange(256))
    below, above = BEYOND[name] if name in BEYOND else BEYOND[name.removesuffix("_r")][::-1]
    return {"colours": [to_hex(colour) for colour in colours], "below": below, "above": above}


def _probe(column: Column) -> dict[str, Any]:
    largest = float(np.abs(column.values[np.isfinite(column.values)]).max())
    return {"name": column.full_name, **measure(largest, column.unit)}


def _shown(table: Table) -> list[Column]:
    return [column for column in table.columns if np.isfinite(column.values).any()]


def thinned(time: np.ndarray, values: np.ndarray, kept: np.ndarray) -> np.ndarray:
    """Rows of a curve that looks the same and has its value at the times `kept`."""
    if len(time) <= ROWS:
        return np.arange(len(time))
    rows = {0, len(time) - 1, *(int(np.abs(time - t).argmin()) for t in kept)}
    for stretch in np.array_split(np.arange(len(time)), STRETCHES):
        rows |= {int(stretch[values[stretch].argmin()]), int(stretch[values[stretch].argmax()])}
    return np.array(sorted(rows))


def _curves(run: Run, times: np.ndarray) -> Iterator[tuple[str, str]]:
    """A chunk for each column of the probes: times, then values, in single precision."""
    for number, column in enumerate(_shown(run.probes)):
        time, values = run.probes.sampled(column)
        rows = thinned(time, values, times)
        yield f"probe-{number}", as_text(np.concatenate([time[rows], values[rows]]).astype("<f4").tobytes())


def about(run: Run, packing: Packing) -> dict[str, Any]:
    """All that the scripts need beside the chunks."""
    times, box = run.frames.times[packing.chosen], _box(run, packing)
    fields = [_field(field) for field in packing.fields]
    step = packing.shapes.step
    latest = max(float(np.abs(times).max()), float(run.probes.time.max(initial=0.0)))
    return {
        "title": run.title, "times": [float(t) for t in times], "frames": packing.chosen, "period": run.period,
        "cells": [_cell(run, index) for index in packing.chosen] if run.frames.in_cell else None,
        "box": box, "step": step, "fine": step / FINE, "error_text": readable(ERROR * step, "m", 3),
        "fields": fields,
        "palettes": {name: _palette(name) for name in {field["palette"] for field in fields}},
        "colours": {"kinds": KIND_COLOURS, "edge": EDGE, "neutral": NEUTRAL, "bodies": BODIES, "cell": CELL},
        "probes": [_probe(column) for column in _shown(run.probes)], "time": measure(latest, "s"),
        "length": measure(max(box[1] - box[0], box[3] - box[2]), "m"),
        "outlines": packing.points.outlines is not None,
    }


def parts(run: Run, packing: Packing) -> Iterator[str]:
    """The page in pieces."""
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE), autoescape=True, trim_blocks=True,
                                     lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    chunks = ((name, Markup(text)) for part in (packing.chunks(), _curves(run, run.frames.times[packing.chosen]))
              for name, text in part)
    return environment.get_template("viewer.html.j2").generate(
        title=run.title, facts=facts(run, packing), about=about(run, packing), chunks=chunks,
        style=Markup((HERE / "viewer.css").read_text()),
        script=Markup("\n".join((HERE / name).read_text() for name in SCRIPTS)))
