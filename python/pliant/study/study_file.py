"""Study files: read and checked whole before anything runs."""

from __future__ import annotations

import csv
import json
import math
import re
import tomllib
from pathlib import Path
from typing import Any

from pliant import units
from pliant.study.reading import BadStudy, Reader, quantity, unique
from pliant.study.spec import (
    AVERAGES, TAKES, Convergence, Curve, Figure, Parameter, Plot, Quantity, Regression, Study, between, number_of,
    units_of,
)


def read_study(file: Path) -> Study:
    """BadStudy; OSError."""
    try:
        text = tomllib.loads(file.read_text("utf-8-sig"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise BadStudy(f"{file}: {error}") from error
    top = Reader(text, str(file))
    scene = file.parent / top.take("scene", str)
    if not scene.is_file():
        top.fail(f"scene: {scene} is no file")
    kind = top.choice("kind", ["sweep", "convergence", "regression"], "sweep")
    combine = top.choice("combine", ["cross", "zip", "latin hypercube"], "cross")
    hypercube = combine == "latin hypercube"
    title, threads = top.take("title", str, file.stem), top.whole("threads", 1, 1)
    samples = top.whole("samples", 1) if hypercube else 0
    seed = top.whole("seed", 0, 1) if hypercube else 0
    fixed = _paths_of(top.take("set", dict, {}))
    parameters = [_parameter(reader, combine) for reader in top.tables("parameters")]
    replicas = _replicas(top.table("replicas"))
    quantities = [_quantity(reader, file.parent) for reader in top.tables("quantities")]
    plots = [_plot(reader) for reader in top.tables("plots")]
    curves = [_curve(reader, file.parent) for reader in top.tables("curves")]
    figures = [_figure(reader, file.parent) for reader in top.tables("figures")]
    convergence = _convergence(top.table("convergence"))
    regression = _regression(top.table("regression"), file.parent)
    top.done()
    study = Study(file, title, scene, kind, combine, samples, seed, threads, fixed, parameters, replicas, quantities,
                  plots, curves, figures, convergence, regression)
    _check_names(study, top)
    return study


def _paths_of(table: dict[str, Any], before: str = "") -> dict[str, Any]:
    """Values by dotted path: "a.b" = 1 and a.b = 1 are the same."""
    flat: dict[str, Any] = {}
    for key, value in table.items():
        flat |= _paths_of(value, f"{before}{key}.") if isinstance(value, dict) else {f"{before}{key}": value}
    return flat


def _check_names(study: Study, top: Reader) -> None:
    inputs = [p.name for p in study.parameters] + ([study.replicas.name] if study.replicas else [])
    outputs = [q.name for q in study.quantities]
    unique(inputs + outputs, "parameters or quantities", top)
    for name in inputs + outputs:
        if name in ("", "run", "status") or "[" in name or name.endswith(" standard error"):
            top.fail(f"nothing can be called '{name}': table.csv needs the name, or its brackets")
    if study.combine == "latin hypercube" and not study.parameters:
        top.fail("a Latin hypercube needs [[parameters]]")
    unique([curve.name for curve in study.curves], "curves", top)
    unique([figure.name for figure in study.figures], "figures", top)
    if not outputs and not study.curves:
        top.fail("no [[quantities]] and no [[curves]]: nothing would come of it")

    def known(name: str, names: list[str], place: str) -> None:
        if name not in names:
            top.fail(f"{place}: nothing is called '{name}'; there are: {', '.join(names)}")

    for plot in study.plots:
        known(plot.x, inputs + outputs, "[[plots]]: x")
        known(plot.y, outputs, "[[plots]]: y")
        if plot.by is not None:
            known(plot.by, inputs, "[[plots]]: by")
        for p in study.parameters:
            if p.name == plot.x and None not in map(number_of, p.values) and len(units_of(p.values)) > 1:
                top.fail(f"[[plots]]: x: values of '{p.name}' are in different units; write all in one")
    for curve in study.curves:
        if curve.by is not None:
            known(curve.by, inputs, "[[curves]]: by")
    if study.combine == "zip" and len({len(p.values) for p in study.parameters}) > 1:
        top.fail("combine = \"zip\": parameters have " +
                 ", ".join(f"{len(p.values)} ({p.name})" for p in study.parameters) + " values; all need as many")
    if (study.kind == "convergence") != (study.convergence is not None):
        top.fail("kind = \"convergence\" and [convergence] belong together")
    if (study.kind == "regression") != (study.regression is not None):
        top.fail("kind = \"regression\" and [regression] belong together")
    if study.convergence:
        known(study.convergence.by, [p.name for p in study.parameters], "[convergence]: by")
        for name in study.convergence.of:
            known(name, outputs, "[convergence]: of")
        by = next(p for p in study.parameters if p.name == study.convergence.by)
        numbers = [number_of(value) for value in by.values]
        if any(number is None or number <= 0 for number in numbers) or len(units_of(by.values)) > 1:
            top.fail(f"[convergence]: values of '{by.name}' must be numbers above 0, all in the same unit")
        if len(by.values) < 3:
            top.fail(f"[convergence]: '{study.convergence.by}' needs three values at least, for an order")
    if study.regression:
        for name in study.regression.tolerances:
            known(name, outputs, "[regression]: tolerances")


def _paths(reader: Reader) -> list[str]:
    if reader.has("path") == reader.has("paths"):
        reader.fail("one of 'path' and 'paths' is needed")
    return [reader.take("path", str)] if reader.has("path") else reader.names("paths")


def _parameter(reader: Reader, combine: str) -> Parameter:
    hypercube = combine == "latin hypercube"
    parameter = Parameter(reader.take("name", str), _paths(reader))
    if reader.has("values") == reader.has("range"):
        reader.fail("one of 'values' and 'range' is needed")
    if reader.has("values"):
        if hypercube:
            reader.fail("a Latin hypercube takes a 'range', from and to")
        parameter.values = reader.take("values", list)
        if not parameter.values:
            reader.fail("'values' is empty")
        if combine == "cross":
            _refuse_repeated(parameter.values, "values", reader)
    else:
        _range(reader, parameter, hypercube)
    reader.done()
    return parameter


def _refuse_repeated(values: list[Any], key: str, reader: Reader) -> None:
    texts = [json.dumps(value, sort_keys=True, default=str) for value in values]
    for value in texts:
        if texts.count(value) > 1:
            reader.fail(f"'{key}' has {value} twice")


def _range(reader: Reader, parameter: Parameter, hypercube: bool) -> None:
    limits = reader.table("range")
    assert limits is not None
    first, unit = quantity(limits.take("from", (int, float, str)), limits, "from")
    last, other = quantity(limits.take("to", (int, float, str)), limits, "to")
    if unit != other:
        limits.fail(f"'from' is in '{unit}' and 'to' in '{other}'")
    parameter.logarithmic = limits.choice("spacing", ["linear", "log"], "linear") == "log"
    if parameter.logarithmic and min(first, last) <= 0:
        limits.fail("spacing = \"log\" needs numbers above 0")
    if hypercube:
        parameter.limits = (first, last, unit)
    else:
        count = limits.whole("count", 2)
        parameter.values = [between(first, last, i / (count - 1), unit, parameter.logarithmic) for i in range(count)]
    limits.done()


def _replicas(reader: Reader | None) -> Parameter | None:
    if reader is None:
        return None
    name, paths = reader.take("name", str, "seed"), _paths(reader)
    if reader.has("seeds") == reader.has("count"):
        reader.fail("one of 'seeds' and 'count' is needed")
    seeds = reader.take("seeds", list) if reader.has("seeds") else list(range(1, reader.whole("count", 1) + 1))
    if not seeds or not all(type(seed) is int and seed >= 0 for seed in seeds):
        reader.fail("'seeds' must be whole numbers")
    _refuse_repeated(seeds, "seeds", reader)
    reader.done()
    return Parameter(name, paths, seeds)


def _quantity(reader: Reader, folder: Path) -> Quantity:
    result = Quantity(reader.take("name", str))
    if sum(map(reader.has, ("summary", "probe", "function"))) != 1:
        reader.fail("one of 'summary', 'probe' and 'function' is needed")
    result.summary = reader.take("summary", str, None)
    result.probe = reader.take("probe", str, None)
    if result.probe is not None:
        result.take = reader.choice("take", TAKES, "last")
        window = reader.take("window", list, None)
        if window is not None:
            if len(window) != 2:
                reader.fail("'window' is two times, from and to")
            result.window = (window[0], window[1])
            try:
                first, last = (units.time(limit) for limit in window)
            except (ValueError, AttributeError) as error:
                reader.fail(f"'window': {error}")
            if not first < last:
                reader.fail(f"'window' is {window!r}; it must begin before it ends")
    result.function = _function(reader, "function", folder)
    reader.done()
    return result


def _function(reader: Reader, key: str, folder: Path) -> str | None:
    """With the whole path of its file."""
    value = reader.take(key, str, None)
    if value is None:
        return None
    file, _, name = value.partition(":")
    if not name or not (folder / file).is_file():
        reader.fail(f"'{key}' is '{value}'; it must be FILE.py:NAME, a file beside the study's")
    return f"{(folder / file).resolve()}:{name}"


def _plot(reader: Reader) -> Plot:
    plot = Plot(reader.take("x", str), reader.take("y", str), reader.take("by", str, None), _log(reader))
    reader.done()
    return plot


def _log(reader: Reader) -> list[str]:
    axes = reader.names("log", [])
    for axis in axes:
        if axis not in ("x", "y"):
            reader.fail(f"'log' is {axes!r}; it may hold \"x\" and \"y\"")
    return axes


def _curve(reader: Reader, folder: Path) -> Curve:
    name = _file_name(reader)
    function = _function(reader, "function", folder)
    x, y = reader.take("x", str), reader.take("y", str)
    curve = Curve(name, x, y, function, reader.take("by", str, None), _log(reader),
                  reader.choice("average", AVERAGES, "x"), _function(reader, "beside", folder))
    reader.done()
    return curve


def _figure(reader: Reader, folder: Path) -> Figure:
    name, function = _file_name(reader), _function(reader, "function", folder)
    if function is None:
        reader.fail("'function' is missing")
    reader.done()
    return Figure(name, function)


def _file_name(reader: Reader) -> str:
    name = reader.take("name", str)
    if not re.fullmatch(r"[A-Za-z0-9_-]+", name):
        reader.fail(f"'name' is '{name}'; a file is called by it: letters, digits, _ and -")
    return name


def _convergence(reader: Reader | None) -> Convergence | None:
    if reader is None:
        return None
    result = Convergence(reader.take("by", str), float(reader.take("power", (int, float), 1)), reader.names("of"))
    if result.power == 0 or not math.isfinite(result.power):
        reader.fail(f"'power' is {result.power}; it must be a number other than 0")
    reader.done()
    return result


def _regression(reader: Reader | None, folder: Path) -> Regression | None:
    if reader is None:
        return None
    baseline = folder / reader.take("baseline", str)
    tolerances = reader.take("tolerances", dict)
    if not tolerances:
        reader.fail("'tolerances' is empty: nothing would be compared")
    for name, value in tolerances.items():
        if type(value) not in (int, float) or not 0 <= value < math.inf:
            reader.fail(f"tolerances: '{name}' is {value!r}; it must be a number, relative, 0 or more")
    if not baseline.is_file():
        reader.fail(f"baseline: {baseline} is no file; the table.csv of the same study as a sweep, once trusted, is one")
    try:
        with baseline.open(newline="", encoding="utf-8-sig") as stream:
            rows = list(csv.DictReader(stream))
    except (UnicodeDecodeError, csv.Error) as error:
        reader.fail(f"baseline: {baseline}: {error}")
    if not rows or "run" not in rows[0]:
        reader.fail(f"baseline: {baseline} is no table of a study: it has no column 'run', or no row")
    reader.done()
    return Regression(baseline, {name: float(value) for name, value in tolerances.items()})
