"""Pictures of cases, in the colours and sizes of scripts/plots."""

from __future__ import annotations

from collections.abc import Sequence

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from order_study import Quantity, Study
from plots.curves import COLOURS
from verification import Case, Run, observed_order

DOTS_PER_INCH = 200
MARKERS = ["o", "s", "^", "D", "v", "P"]
Curve = tuple[str, list[float], list[float]]  # name, steps, errors


def panels(count: int, title: str, across: bool = False) -> tuple[Figure, list[Axes]]:
    """Panels above one another with a common x axis, or side by side, in rows of at most three."""
    rows = (count + 2) // 3 if across else count
    columns = -(-count // rows)
    size = (4.6 * columns, 4.2 * rows + 0.2) if across else (9, 1.2 + 2.4 * rows)
    figure, axes = plt.subplots(rows, columns, figsize=size, sharex=not across, squeeze=False, layout="constrained")
    figure.suptitle(title)
    for panel in axes.flat:
        panel.grid(alpha=0.3)
    return figure, list(axes.flat)


def legend(axes: Axes) -> None:
    axes.legend(fontsize=9, frameon=False, borderpad=0.1, handlelength=1.6)


def describe(axes: Axes, title: str = "", x: str = "", y: str = "") -> None:
    """Sets the given title and labels."""
    if title:
        axes.set_title(title, fontsize=10, loc="left")
    axes.set(**{name: text for name, text in (("xlabel", x), ("ylabel", y)) if text})


def set_ticks(axes: Axes, places: Sequence[float], labels: list[str]) -> None:
    """Sets these ticks of x and no others."""
    axes.set_xticks(places, labels)
    axes.set_xticks([], minor=True)


def draw_rate(axes: Axes, steps: Sequence[float], errors: Sequence[float], name: str, colour: str, marker: str,
              style: str = "-") -> None:
    """Errors over steps, with their order in the legend."""
    axes.loglog(steps, errors, style, marker=marker, markersize=4, linewidth=1.1, color=colour,
                label=f"{name}: {observed_order(list(steps), list(errors)):.2f}")


def draw_both(axes: Axes, runs: dict[str, Run], probe: str, factor: float = 1, what: str = "", first: int = 0) -> None:
    """The engine's curve, and the reference's as a dashed line."""
    for (name, run), colour, style in zip(runs.items(), COLOURS[first:], ("-", "--")):
        axes.plot(run.times(probe), factor * run.probe(probe), style, color=colour, linewidth=1.1, label=what + name)


def draw_differences(axes: Axes, study: Study, quantities: list[Quantity]) -> None:
    curves = [(quantity.name, study.all_steps(), study.all_differences(quantity)) for quantity in quantities]
    draw_orders(axes, "engine - reference", curves, [1, 2])


def draw_orders(axes: Axes, title: str, curves: list[Curve], orders: list[float]) -> None:
    """Errors over steps with their slopes, and lines of the theoretical orders."""
    for (name, steps, errors), colour, marker in zip(curves, COLOURS, MARKERS):
        draw_rate(axes, steps, errors, name, colour, marker)
    ends = np.array([min(min(steps) for _, steps, _ in curves), max(max(steps) for _, steps, _ in curves)])
    lowest = min(min(errors) for _, _, errors in curves)
    for order, style in zip(orders, ("--", ":")):
        axes.loglog(ends, 0.5 * lowest * (ends / ends[0]) ** order, style, color=COLOURS[6], linewidth=1.0,
                    label=f"slope {order:g}")
    ticks = sorted({step for _, steps, _ in curves for step in steps})
    set_ticks(axes, ticks, [f"{1e3 * step:g}" for step in ticks])
    describe(axes, title, "time step [ms]", "relative error")
    legend(axes)


def draw_ratios(axes: Axes, percent: np.ndarray, engine: dict[str, np.ndarray], references: dict[str, np.ndarray],
                elements: np.ndarray, error: float) -> None:
    """By method [approaches]: ratio to finite elements less 1, in percent. Bars show the finite elements' own error."""
    for (method, force), colour, marker in zip(engine.items(), COLOURS, MARKERS):
        axes.plot(percent, 100 * (force / elements - 1), marker=marker, markersize=4, linewidth=1.1, color=colour,
                  label=f"engine, {method}")
    for i, force in enumerate(references.values()):
        axes.plot(percent, 100 * (force / elements - 1), "kx", markersize=5, label="" if i else "reference")
    axes.errorbar(percent, 0 * percent, 100 * error, fmt="none", ecolor="0.3", capsize=3,
                  label="finite elements and their error")
    axes.set_xlabel("approach over the diameter [%]")


def draw_cells(figure: Figure, axes: Axes, triangles: np.ndarray, values: np.ndarray, colours: str,
               limits: tuple[float, float], title: str) -> None:
    """One value per triangle, [triangles x 3 x 2] and [triangles], in colours between two limits."""
    cells = PolyCollection(list(triangles), array=values, cmap=colours, edgecolors="face", linewidths=0.1)
    cells.set_clim(*limits)
    axes.add_collection(cells)
    axes.set_xlim(-1.03, 1.03)
    axes.set_ylim(-1.03, 1.03)
    axes.set_aspect("equal")
    axes.set_title(title, fontsize=10, loc="left")
    figure.colorbar(cells, ax=axes, shrink=0.8)


def save(case: Case, figure: Figure, name: str) -> None:
    figure.savefig(case.out / f"{name}.png", dpi=DOTS_PER_INCH)
    plt.close(figure)
