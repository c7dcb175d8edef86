"""Curves of a study: means over replicas, their table and their figure."""

from __future__ import annotations

import csv
import io
import math
import shutil
import sys
from dataclasses import dataclass
from itertools import cycle
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from pliant.study.folder import Folder, replace
from pliant.study.gather import CannotGather, called, points_of
from pliant.study.spec import Curve

POINTS = 200  # of a mean of several curves


@dataclass
class MeanCurve:
    """Of the runs that differ in the replica alone."""

    inputs: dict[str, Any]
    x: np.ndarray
    y: np.ndarray
    error: np.ndarray | None  # standard error of y; None: of one run
    runs: int
    units: list[str]  # of x and y
    beside: np.ndarray | None = None  # at the same x; NaN where there is none
    problem: str = ""  # why there is no mean, or nothing beside it


def advancing(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The points at which x exceeds all before, or falls below all before if it falls on the whole."""
    way = x if x[-1] >= x[0] else -x
    new = np.concatenate(([True], way[1:] > np.maximum.accumulate(way)[:-1]))
    x, y = x[new], y[new]
    return (x, y) if x[-1] >= x[0] else (x[::-1], y[::-1])


Mean = tuple[np.ndarray, np.ndarray, np.ndarray]  # x, mean and standard error of y


def mean_of_points(curves: list[dict[str, Any]]) -> Mean:
    """The first points of all, the second, and so on, as far as all have them."""
    count = min(len(curve["x"]) for curve in curves)
    x, y = (np.array([curve[axis][:count] for curve in curves]) for axis in "xy")
    return x.mean(axis=0), y.mean(axis=0), y.std(axis=0, ddof=1) / math.sqrt(len(curves))


def mean_at_x(curves: list[dict[str, Any]], logarithmic: bool) -> Mean | None:
    """Where all curves have values, by linear interpolation; None: nowhere."""
    parts = [advancing(np.array(curve["x"]), np.array(curve["y"])) for curve in curves]
    first, last = max(x[0] for x, _ in parts), min(x[-1] for x, _ in parts)
    if not first < last or (logarithmic and first <= 0):
        return None
    x = np.geomspace(first, last, POINTS) if logarithmic else np.linspace(first, last, POINTS)
    y = np.array([np.interp(x, *part) for part in parts])
    return x, y.mean(axis=0), y.std(axis=0, ddof=1) / math.sqrt(len(parts))


def mean_curves(folder: Folder, curve: Curve) -> list[MeanCurve]:
    """In the order of the study; without the inputs that no run has the curve of."""
    about = folder.read("study.json")
    groups: dict[str, tuple[dict[str, Any], list[dict[str, Any]]]] = {}
    for name in about["runs"]:
        found = folder.read(f"runs/{name}/quantities.json")["curves"].get(curve.name)
        values = folder.point(name).values
        inputs = {key: values[key] for key in about["parameters"] if key in values}
        if curve.by == about["replicas"] and curve.by is not None:
            inputs[curve.by] = values[curve.by]
        if found is not None:
            groups.setdefault(str(inputs), (inputs, []))[1].append(found)
    means = [_mean_curve(curve, inputs, members) for inputs, members in groups.values()]
    for mean in means:
        if curve.beside is not None and not mean.problem:
            try:
                mean.beside = points_of(curve.beside, (mean.x, called(curve.beside, mean.x, mean.y)))[1]
            except CannotGather as error:
                mean.problem = str(error)
    return means


def _mean_curve(curve: Curve, inputs: dict[str, Any], members: list[dict[str, Any]]) -> MeanCurve:
    units = members[0]["units"]
    if len(members) == 1:
        return MeanCurve(inputs, np.array(members[0]["x"]), np.array(members[0]["y"]), None, 1, units)
    mean = mean_of_points(members) if curve.average == "points" else mean_at_x(members, "x" in curve.log)
    if mean is None:
        problem = f"{inputs}: replicas have no {curve.x} in common{' above 0' * ('x' in curve.log)}"
        return MeanCurve(inputs, np.array([]), np.array([]), None, len(members), units, None, problem)
    return MeanCurve(inputs, *mean, len(members), units)


def write_curves(folder: Folder) -> None:
    """curves/NAME.csv of each. Says what is missing."""
    shutil.rmtree(folder.path / "curves", ignore_errors=True)
    for curve in folder.curves():
        means = mean_curves(folder, curve)
        replace(folder.path / "curves" / f"{curve.name}.csv", _as_csv(curve, means))
        for mean in means:
            if mean.problem:
                print(f"curve {curve.name}: {mean.problem}", file=sys.stderr)


def _titles(curve: Curve, units: list[str]) -> list[str]:
    return [name + (f" [{unit}]" if unit != "-" else "") for name, unit in zip((curve.x, curve.y), units)]


def _as_csv(curve: Curve, means: list[MeanCurve]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    inputs = list(means[0].inputs) if means else []
    units = means[0].units if means else ["-", "-"]
    writer.writerow([*inputs, *_titles(curve, units), "standard error", "runs", *(["beside"] if curve.beside else [])])
    for mean in means:
        for i, (x, y) in enumerate(zip(mean.x, mean.y)):
            beside = [] if mean.beside is None else [f"{mean.beside[i]:.8g}" if np.isfinite(mean.beside[i]) else ""]
            error = "" if mean.error is None else f"{mean.error[i]:.3g}"
            writer.writerow([*mean.inputs.values(), f"{x:.8g}", f"{y:.8g}", error, mean.runs, *beside])
    return text.getvalue()


def draw_curve(axes: Axes, curve: Curve, means: list[MeanCurve], colours: list[str]) -> None:
    """One colour per value of `by`, one line style per combination of the other inputs, a band of one standard error;
    `beside` is dashed."""
    def value_of(mean: MeanCurve) -> str:
        return f"{curve.by} = {mean.inputs[curve.by]}" if curve.by else ""

    def others_of(mean: MeanCurve) -> str:
        return ", ".join(f"{name} = {value}" for name, value in mean.inputs.items() if name != curve.by)

    colour_of = dict(zip(dict.fromkeys(map(value_of, means)), cycle(colours)))
    style_of = dict(zip(dict.fromkeys(map(others_of, means)), cycle(["-", ":", "-."])))
    styled = len(means) > len(colour_of)  # else the value of `by` tells the others
    for mean in means:
        value = value_of(mean)
        axes.plot(mean.x, mean.y, style_of[others_of(mean)] if styled else "-", color=colour_of[value], linewidth=1.3)
        if mean.error is not None:
            axes.fill_between(mean.x, mean.y - mean.error, mean.y + mean.error, color=colour_of[value], alpha=0.2,
                              linewidth=0)
        if mean.beside is not None:
            axes.plot(mean.x, mean.beside, "--", color=colour_of[value], linewidth=1)
        if mean.problem:
            axes.text(0.02, 0.02, mean.problem, transform=axes.transAxes, fontsize=7, wrap=True)
    axes.set_xscale("log" if "x" in curve.log else "linear")
    axes.set_yscale("log" if "y" in curve.log else "linear")
    if not means:
        axes.text(0.5, 0.5, "no run has it", transform=axes.transAxes, ha="center")
        return
    across, up = _titles(curve, means[0].units)
    axes.set_xlabel(across)
    axes.set_ylabel(up)
    if max(mean.runs for mean in means) > 1:
        axes.set_title("mean and standard error over replicas", fontsize=9, loc="left")
    lines = [Line2D([], [], color=colour, label=value) for value, colour in colour_of.items() if value]
    if styled:
        lines += [Line2D([], [], color="#7f7f7f", linestyle=style, label=others) for others, style in style_of.items()]
    if lines:
        axes.legend(handles=lines, fontsize=8, frameon=False)
    axes.grid(True, alpha=0.25)
