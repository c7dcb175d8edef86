"""Quantities of one run."""

from __future__ import annotations

import importlib.util
import math
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from pliant import units
from pliant.results import Run
from pliant.study.spec import Curve, Quantity

BLOCKS = 8  # of a plateau, for its error


class CannotGather(Exception):
    """A quantity that this run does not have; the message names it."""


@dataclass
class Value:
    value: float
    error: float | None = None  # standard error, where one is known
    unit: str = "-"


def gather(quantity: Quantity, run: Run) -> Value:
    found = _gather(quantity, run)
    if not math.isfinite(found.value):
        raise CannotGather(f"it is {found.value}")
    return found


def _gather(quantity: Quantity, run: Run) -> Value:
    if quantity.summary is not None:
        return Value(_of_summary(quantity.summary, run.summary))
    if quantity.function is not None:
        return _of_function(quantity.function, run)
    return _of_probe(quantity, run)


def _of_summary(path: str, summary: Any) -> float:
    at = summary
    for name in path.split("."):
        if not isinstance(at, dict) or name not in at:
            raise CannotGather(f"summary.json has no {path}")
        at = at[name]
    if not isinstance(at, (int, float)):
        raise CannotGather(f"{path} of summary.json is {at!r}, not a number")
    return float(at)


def function_of(where: str) -> Callable[[Run], Any]:
    """CannotGather: the file cannot be loaded, or has no such function. It may import what stands beside it."""
    file, _, name = where.rpartition(":")
    spec = importlib.util.spec_from_file_location("quantity", file)
    if spec is None or spec.loader is None:
        raise CannotGather(f"{file} is no file of Python")
    module = importlib.util.module_from_spec(spec)
    sys.path.insert(0, str(Path(file).parent))
    try:
        spec.loader.exec_module(module)
    except (Exception, SystemExit) as error:  # noqa: BLE001: whatever the user's file does
        raise CannotGather(f"{file}: {type(error).__name__}: {error}") from error
    finally:
        sys.path.pop(0)
    if not callable(getattr(module, name, None)):
        raise CannotGather(f"{file} has no function '{name}'")
    return getattr(module, name)


def called(where: str, *arguments: Any) -> Any:
    """CannotGather: whatever the user's function does wrong."""
    function = function_of(where)
    try:
        return function(*arguments)
    except (Exception, SystemExit) as error:  # noqa: BLE001
        raise CannotGather(f"{where}: {type(error).__name__}: {error}") from error


def points_of(where: str, returned: Any) -> tuple[np.ndarray, np.ndarray]:
    """Two arrays of one length that a function returned."""
    try:
        x, y = (np.asarray(part, float) for part in returned)
        if x.ndim == 1 and x.shape == y.shape:
            return x, y
    except (TypeError, ValueError):
        pass
    raise CannotGather(f"{where} did not return two arrays of the same length")


def gather_curve(curve: Curve, run: Run) -> dict[str, Any]:
    """x and y at the times at which both have values, and their units."""
    if curve.function is not None:
        x, y = points_of(curve.function, called(curve.function, run))
        units_found = ["-", "-"]
    else:
        try:
            columns = [run.probes.column(name) for name in (curve.x, curve.y)]
        except KeyError as error:
            raise CannotGather(error.args[0]) from error
        x, y = (column.values for column in columns)
        units_found = [column.unit for column in columns]
    there = np.isfinite(x) & np.isfinite(y)
    if not there.any():
        raise CannotGather("it has no point")
    return {"x": x[there].tolist(), "y": y[there].tolist(), "units": units_found}


def _of_function(where: str, run: Run) -> Value:
    value = called(where, run)
    if isinstance(value, bool) or not isinstance(value, (int, float, np.integer, np.floating)):
        raise CannotGather(f"{where} returned {value!r}, not a number")
    return Value(float(value))


def _of_probe(quantity: Quantity, run: Run) -> Value:
    try:
        column = run.probes.column(quantity.probe or "")
    except KeyError as error:
        raise CannotGather(error.args[0]) from error
    times, values = run.probes.sampled(column)
    if quantity.window is not None:
        first, last = (units.time(limit) for limit in quantity.window)
        slack = 1e-9 * max(abs(first), abs(last))
        period = float(np.diff(times).max(initial=0.0))
        if len(times) == 0 or times[0] > first + period + slack or times[-1] < last - period - slack:
            raise CannotGather(f"{quantity.probe} does not cover the window, {first:g} to {last:g} s")
        inside = (times >= first - slack) & (times <= last + slack)
        times, values = times[inside], values[inside]
    if len(values) == 0:
        raise CannotGather(f"{quantity.probe} has no value in the window")
    return TAKES[quantity.take](times, values, column.unit)


def _mean(times: np.ndarray, values: np.ndarray, unit: str) -> Value:
    """Over time, by trapezoids."""
    if len(values) == 1:
        return Value(float(values[0]), None, unit)
    return Value(float(np.trapz(values, times) / (times[-1] - times[0])), None, unit)


def _plateau(times: np.ndarray, values: np.ndarray, unit: str) -> Value:
    """Mean of the window's second half, and its standard error from the means of blocks in it."""
    late = times >= (times[0] + times[-1]) / 2
    value = _mean(times[late], values[late], unit)
    if late.sum() >= 2 * BLOCKS:
        means = [block.mean() for block in np.array_split(values[late], BLOCKS)]
        value.error = float(np.std(means, ddof=1) / math.sqrt(BLOCKS))
    return value


def _slope(times: np.ndarray, values: np.ndarray, unit: str) -> Value:
    """Of the straight line through all, by least squares."""
    if len(values) < 2:
        raise CannotGather("a slope needs two values")
    away = times - times.mean()
    return Value(float(away @ (values - values.mean()) / (away @ away)), None, f"{unit}/s")


TAKES: dict[str, Callable[[np.ndarray, np.ndarray, str], Value]] = {
    "mean": _mean,
    "plateau": _plateau,
    "slope": _slope,
    "last": lambda _, values, unit: Value(float(values[-1]), None, unit),
    "max": lambda _, values, unit: Value(float(values.max()), None, unit),
    "min": lambda _, values, unit: Value(float(values.min()), None, unit),
    "peak": lambda _, values, unit: Value(float(values[np.abs(values).argmax()]), None, unit),  # with its sign
}
