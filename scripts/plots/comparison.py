"""Probes of several runs, one curve each."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from pliant import units
from pliant.results import Column, Run
from plots.curves import COLOURS, panels
from plots.history import draw_history

MOST_PANELS = 14
MOST_RUNS = len(COLOURS)
STYLES = ["-", "--", "-.", ":"] * 2


def comparison(runs: list[Run]) -> Figure | None:
    """A panel for each column of probes that two of the runs have, those that differ most first, and their time steps."""
    columns = sorted(_shared(runs), key=lambda name: -_difference(runs, name))
    shown = columns[:MOST_PANELS]
    stepped = [run for run in runs if run.steps.get("dt") is not None]
    if not shown:
        return None
    figure, axes, factor = panels(len(shown) + (len(stepped) > 1), f"{runs[0].title}: {len(runs)} runs", _longest(runs))
    for panel, name in zip(axes, shown):
        _draw(panel, runs, factor, name)
    if len(stepped) > 1:
        _draw_steps(axes[-1], runs, factor)
    names = labels(runs)
    handles = [Line2D([], [], color=colour, linestyle=style) for colour, style in zip(COLOURS, STYLES)]
    axes[0].legend(handles[: len(runs)], names, loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=4, fontsize=9,
                   frameon=False)
    if len(columns) > len(shown):
        figure.supxlabel(f"{len(columns) - len(shown)} columns that differ less are left out", fontsize=9)
    return figure


def labels(runs: list[Run]) -> list[str]:
    """Shortest ends of the folders' paths that tell them apart."""
    paths = [run.folder.resolve().parts for run in runs]
    for length in range(1, max(map(len, paths)) + 1):
        ends = ["/".join(path[-length:]) for path in paths]
        if len(set(ends)) == len(ends):
            return ends
    return [f"{'/'.join(path[-1:])} ({number})" for number, path in enumerate(paths, 1)]


def _longest(runs: list[Run]) -> np.ndarray:
    """s"""
    return max((run.probes.time for run in runs), key=lambda time: time.max(initial=-np.inf))


def _column(run: Run, name: str) -> Column | None:
    return next((c for c in run.probes.columns if c.full_name == name), None)


def _shared(runs: list[Run]) -> list[str]:
    """Names that two runs have with any value but 0."""
    found: dict[str, int] = {}
    for run in runs:
        for column in run.probes.columns:
            if np.any(np.nan_to_num(column.values) != 0):
                found[column.full_name] = found.get(column.full_name, 0) + 1
    return [name for name, count in found.items() if count > 1]


def _difference(runs: list[Run], name: str) -> float:
    """Largest from the first run that has it, over its largest magnitude, at the times of the coarser one."""
    sampled = [run.probes.sampled(column) for run in runs if (column := _column(run, name)) is not None]
    sampled = [(time, values) for time, values in sampled if len(time) > 0]
    scale = max((np.abs(values).max() for _, values in sampled), default=0.0)
    if scale == 0.0:
        return 0.0
    time, values = sampled[0]
    apart = [np.abs(np.interp(time, *other, left=np.nan, right=np.nan) - values) for other in sampled[1:]]
    return float(max((np.nanmax(d, initial=0.0) for d in apart), default=0.0) / scale)


def _draw(axes: Axes, runs: list[Run], time_factor: float, name: str) -> None:
    columns = [_column(run, name) for run in runs]
    there = [column for column in columns if column is not None]
    largest = max(float(np.nanmax(np.abs(column.values), initial=0.0)) for column in there)
    factor, unit = units.scale(largest, there[0].unit)
    for column, run, colour, style in zip(columns, runs, COLOURS, STYLES):
        if column is None:
            continue
        time, values = run.probes.sampled(column)
        draw_history(axes, time * time_factor, values * factor, colour, style=style)
    axes.set_ylabel(units.label(name.replace(".", "\n", 1), unit), fontsize=8)


def _draw_steps(axes: Axes, runs: list[Run], time_factor: float) -> None:
    steps = [(run.steps, run.steps.get("dt")) for run in runs]
    factor, unit = units.scale(max(float(np.median(dt.values)) for _, dt in steps if dt is not None), "s")
    for (table, dt), colour, style in zip(steps, COLOURS, STYLES):
        if dt is not None:
            draw_history(axes, table.time * time_factor, dt.values * factor, colour, style=style)
    axes.set_ylim(bottom=0)
    axes.set_ylabel(units.label("time step", unit), fontsize=8)
