"""Figures of a study: asked for, and of its kind."""

from __future__ import annotations

import sys
from typing import Any

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from pliant.study.curves import draw_curve, mean_curves
from pliant.study.folder import Folder
from pliant.study.gather import CannotGather, called
from pliant.study.spec import number_of, units_of
from pliant.study.table import mean_of_replicas, means_of_replicas

COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7f7f7f", "#000000"]
MARKERS = "osD^vP"
MARKED = 8  # values at most that a logarithmic axis names one by one


def draw_all(folder: Folder) -> list[dict[str, str]]:
    """File and title of each, in figures/."""
    about, table = folder.read("study.json"), folder.read("table.json")
    (folder.path / "figures").mkdir(exist_ok=True)
    drawn = []
    for number, plot in enumerate(about["plots"], 1):
        figure, axes = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
        _plot(axes, plot, about, table["rows"])
        drawn.append(_save(folder, figure, f"{number}_{plot['y']}_over_{plot['x']}", f"{plot['y']} over {plot['x']}"))
    for curve in folder.curves():
        figure, axes = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
        draw_curve(axes, curve, mean_curves(folder, curve), COLOURS)
        drawn.append(_save(folder, figure, f"curve_{curve.name}", curve.name))
    for wanted in about["figures"]:
        figure, axes = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
        try:
            called(wanted["function"], axes, means_of_replicas(table["rows"], table["quantities"], about["parameters"]))
        except CannotGather as error:
            print(f"figure {wanted['name']}: {error}", file=sys.stderr)
            axes.text(0.5, 0.5, str(error), transform=axes.transAxes, ha="center", fontsize=7, wrap=True)
        drawn.append(_save(folder, figure, wanted["name"], wanted["name"]))
    if "orders" in table:
        for output in about["convergence"]["of"]:
            if all(o["limit"] is None for o in table["orders"] if o["quantity"] == output):
                continue  # a page without a point
            figure, axes = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
            _draw_order(axes, [o for o in table["orders"] if o["quantity"] == output], about["convergence"])
            drawn.append(_save(folder, figure, f"order_{output}", f"{output}: difference from its limit"))
    return drawn


def _save(folder: Folder, figure: Any, name: str, title: str) -> dict[str, str]:
    plain = "".join(c if c.isalnum() or c in "_-" else "_" for c in name)
    file = folder.path / "figures" / f"{plain[:80]}.png"
    figure.savefig(file, dpi=130)
    plt.close(figure)
    return {"file": f"figures/{file.name}", "title": title}


def _unit_of(values: list[Any]) -> str:
    """Of parameters such as "3 MPa": their own, which all share."""
    units = units_of(values)
    return f" [{units.pop()}]" if units != {""} and units else ""


def _plot(axes: Axes, plot: dict, about: dict, rows: list[dict]) -> None:
    inputs = list(about["parameters"])
    is_input = plot["x"] in inputs or plot["x"] == about["replicas"]
    if about["replicas"] and about["replicas"] in (plot["x"], plot["by"]):
        inputs.append(about["replicas"])
    points = mean_of_replicas(rows, plot["y"], inputs)
    if not is_input:
        across = {str(m["inputs"]): m["value"] for m in mean_of_replicas(rows, plot["x"], inputs)}
        points = [p for p in points if str(p["inputs"]) in across]
    labels = [p["inputs"][plot["x"]] for p in points] if is_input else []
    words = any(number_of(label) is None for label in labels)
    order = list(dict.fromkeys(map(str, labels)))
    series: dict[str, list[tuple[float, dict]]] = {}
    for p in points:
        if not is_input:
            x = across[str(p["inputs"])]
        else:
            x = order.index(str(p["inputs"][plot["x"]])) if words else number_of(p["inputs"][plot["x"]])
        series.setdefault(str(p["inputs"][plot["by"]]) if plot["by"] else "", []).append((x, p))
    for (label, members), colour, marker in zip(series.items(), COLOURS * 9, MARKERS * 12):
        members.sort(key=lambda member: member[0])
        x, y = [m[0] for m in members], [m[1]["value"] for m in members]
        error = [m[1]["error"] or 0.0 for m in members]
        all_inputs_shown = is_input and len(inputs) <= 1 + (plot["by"] is not None)
        style = "-" if all_inputs_shown else ""
        axes.errorbar(x, y, yerr=error if any(error) else None, fmt=marker + style, color=colour, capsize=3,
                      markersize=5, linewidth=1.2, label=f"{plot['by']} = {label}" if plot["by"] else None)
    axes.set_xscale("log" if "x" in plot["log"] else "linear")
    axes.set_yscale("log" if "y" in plot["log"] else "linear")
    if words:
        axes.set_xticks(range(len(order)), order, rotation=20)
    elif "x" in plot["log"] and is_input and 0 < len(order) <= MARKED:
        axes.set_xticks(*zip(*sorted({(number_of(label), f"{number_of(label):g}") for label in labels})))
        axes.set_xticks([], minor=True)
    unit = points[0]["unit"] if points else "-"
    axes.set_xlabel(plot["x"] + (_unit_of(labels) if is_input and not words else ""))
    axes.set_ylabel(plot["y"] + (f" [{unit}]" if unit != "-" else ""))
    counts = {p["count"] for p in points}
    if max(counts, default=1) > 1:
        axes.set_title(f"mean and standard error of {' to '.join(map(str, sorted({min(counts), max(counts)})))} runs",
                       fontsize=9, loc="left")
    if not points:
        axes.text(0.5, 0.5, "no run has it", transform=axes.transAxes, ha="center")
    if plot["by"] and points:
        axes.legend(fontsize=8, frameon=False)
    axes.grid(True, alpha=0.25)


def _draw_order(axes: Axes, orders: list[dict], settings: dict) -> None:
    for found, colour, marker in zip(orders, COLOURS * 9, MARKERS * 12):
        label = ", ".join(f"{name} = {value}" for name, value in found["of"].items())
        if found["limit"] is None:
            axes.plot([], [], marker, color=colour, label=f"{label} no order".strip())
            continue
        h, f = (np.array(found[key]) for key in ("sizes", "values"))
        order = np.argsort(h)
        away = np.abs(f - found["limit"])[order]
        doubt = ", not asymptotic" if found["asymptotic"] is False else ""
        axes.loglog(h[order], away, marker, color=colour, label=f"{label} order {found['order']:.2f}{doubt}".strip())
        ends = h[order][[0, -1]]
        axes.loglog(ends, away[0] * (ends / ends[0])**found["order"], color=colour, linewidth=0.8)
    power = settings["power"]
    axes.set_xlabel(settings["by"] if power == 1 else f"{settings['by']}^{power:g}")
    axes.set_ylabel("|value - limit|" + (f" [{orders[0]['unit']}]" if orders and orders[0]["unit"] != "-" else ""))
    axes.legend(fontsize=8, frameon=False)
    axes.grid(True, which="both", alpha=0.2)
