"""Histories: steps, forces, energies."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from plots import units
from plots.run_data import Column, Run, Table

# Okabe and Ito's colours, told apart by the colour-blind.
COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7f7f7f", "#000000"]
# More rows than this are drawn as a band from least to largest with the mean in it.
_DENSE = 4000
_BINS = 800


def _binned(time: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, ...]:
    """Centres of equal bins of time, and least, mean, largest value of those that have any."""
    edges = np.linspace(time[0], time[-1], _BINS + 1)
    index = np.clip(np.searchsorted(edges, time, side="right") - 1, 0, _BINS - 1)
    count = np.bincount(index, minlength=_BINS)
    least, largest = np.full(_BINS, np.inf), np.full(_BINS, -np.inf)
    np.minimum.at(least, index, values)
    np.maximum.at(largest, index, values)
    filled = count > 0
    mean = np.bincount(index, values, minlength=_BINS)[filled] / count[filled]
    return (0.5 * (edges[1:] + edges[:-1])[filled], least[filled], mean, largest[filled])


def _draw_history(axes: Axes, time: np.ndarray, values: np.ndarray, colour: str, name: str | None = None) -> None:
    if len(time) <= _DENSE:
        axes.plot(time, values, color=colour, linewidth=1.1, label=name)
        return
    centre, least, mean, largest = _binned(time, values)
    axes.fill_between(centre, least, largest, color=colour, alpha=0.25, linewidth=0)
    axes.plot(centre, mean, color=colour, linewidth=1.1, label=name)


def _panels(count: int, title: str, table: Table) -> tuple[Figure, list[Axes], float]:
    """Panels above one another with a common axis of time, and the factor of time."""
    figure, axes = plt.subplots(
        count, 1, figsize=(9, 1.2 + 2.3 * count), sharex=True, squeeze=False, layout="constrained"
    )
    figure.suptitle(title)
    factor, unit = units.scale(float(table.time.max()), "s")
    axes[-1, 0].set_xlabel(units.label("time", unit))
    for panel in axes.flat:
        panel.grid(alpha=0.3)
    return figure, list(axes.flat), factor


def steps(run: Run) -> Figure | None:
    """Error estimate, time step, rejections and contacts against time (the paper's figure 8)."""
    table = run.steps
    wanted = {"error": "error estimate", "dt": "time step", "rejections": "rejections so far", "contacts": "contacts"}
    columns = [] if table is None else [c for name in wanted if (c := table.get(name)) is not None]
    if table is None or not columns:
        return None
    figure, axes, factor = _panels(len(columns), f"{run.title}: steps", table)
    for panel, column, colour in zip(axes, columns, COLOURS):
        _draw_step_column(panel, table, column, factor, colour, wanted[column.name])
    figure.supxlabel(_rejection_caption(table), fontsize=9)
    return figure


def _draw_step_column(axes: Axes, table: Table, column: Column, time_factor: float, colour: str, name: str) -> None:
    time, values = table.sampled(column)
    factor, unit = units.scale(float(np.median(values)) if len(values) else 0.0, column.unit)
    if column.name == "error" and np.any(values > 0):
        axes.set_yscale("log")
        time, values = time[values > 0], values[values > 0]
        axes.set_ylim(np.quantile(values, 0.002) / 2, 2 * values.max())  # the first steps' errors are near zero
    if column.name in ("rejections", "dt"):
        largest = max(1.0, float(values.max(initial=0.0)) * factor)
        axes.set_ylim(-0.03 * largest, 1.05 * largest)
    _draw_history(axes, time * time_factor, values * factor, colour)
    axes.set_ylabel(units.label(name, unit))


def _rejection_caption(table: Table) -> str:
    rejections, evaluations = table.get("rejections"), table.get("evaluations")
    if rejections is None or evaluations is None:
        return ""
    rejected, evaluated = rejections.values[-1], evaluations.values[-1]
    share = 100 * rejected / evaluated if evaluated > 0 else 0.0
    return f"{rejected:.0f} rejections, {evaluated:.0f} force evaluations: {share:.2g} in 100"


def _force_sources(table: Table) -> list[str]:
    """Names of the probes that hold both components of a force."""
    return [c.source for c in table.columns if c.name == "force_x" and table.get("force_y", c.source) is not None]


def _friction(run: Run, table: Table, source: str) -> tuple[np.ndarray, np.ndarray]:
    """Times and friction factor of a wall: its own probe where there is one, else the ratio of its forces."""
    wall = run.probe_of.get(source, source)
    for column in table.columns:
        if column.name == "friction_factor" and run.probe_of.get(column.source, column.source) == wall:
            return table.sampled(column)
    force_x, force_y = table.get("force_x", source), table.get("force_y", source)
    assert force_x is not None and force_y is not None
    loaded = np.isfinite(force_x.values) & (np.abs(force_y.values) > 0)
    return table.time[loaded], force_x.values[loaded] / np.abs(force_y.values[loaded])


def _peak_and_plateau(time: np.ndarray, values: np.ndarray) -> tuple[float, float, float]:
    """Time and value of the largest magnitude, and the mean over the last quarter of the time."""
    peak = int(np.abs(values).argmax())
    last = time >= time[0] + 0.75 * (time[-1] - time[0])
    return float(time[peak]), float(values[peak]), float(values[last].mean())


def _caption(name: str, unit: str, time: np.ndarray, values: np.ndarray) -> str:
    when, peak, plateau = _peak_and_plateau(time, values)
    return (
        f"{name}: peak {units.readable(peak, unit)} at {units.readable(when, 's')}, "
        f"plateau {units.readable(plateau, unit)} (mean of the last quarter)"
    )


def _loaded(table: Table, source: str, time: np.ndarray) -> np.ndarray:
    """Where a wall carries at least 5 % of its largest normal force: elsewhere a friction factor is 0 over 0."""
    force = table.get("force_y", source)
    assert force is not None
    sampled_time, values = table.sampled(force)
    magnitude = np.abs(np.interp(time, sampled_time, values))
    return magnitude >= 0.05 * np.abs(values).max(initial=0.0)


def forces(run: Run) -> Figure | None:
    """Normal and tangential force and friction factor of each wall with a force probe (the paper's figure 9)."""
    table = run.probes
    sources = [] if table is None else _force_sources(table)
    if table is None or not sources:
        return None
    figure, axes, factor = _panels(2 * len(sources), f"{run.title}: forces", table)
    for i, source in enumerate(sources):
        _draw_forces(axes[2 * i], run, table, source, factor)
        _draw_friction(axes[2 * i + 1], run, table, source, factor)
    return figure


def _draw_forces(axes: Axes, run: Run, table: Table, source: str, time_factor: float) -> None:
    normal, tangential = table.get("force_y", source), table.get("force_x", source)
    assert normal is not None and tangential is not None
    largest = max(np.nanmax(np.abs(c.values), initial=0.0) for c in (normal, tangential))
    factor, unit = units.scale(float(largest), normal.unit)
    captions = []
    for column, name, colour in ((normal, "normal", COLOURS[0]), (tangential, "tangential", COLOURS[1])):
        time, values = table.sampled(column)
        if len(time) == 0:
            continue
        if column is normal and values.mean() < 0:
            values = -values  # compression is positive on either wall
        _draw_history(axes, time * time_factor, values * factor, colour, name)
        captions.append(_caption(name, column.unit, time, values))
    axes.set_ylabel(units.label("force", unit))
    axes.set_title(f"wall '{run.probe_of.get(source) or source}'\n" + "\n".join(captions), fontsize=9)
    axes.legend(loc="best", fontsize=9)


def _draw_friction(axes: Axes, run: Run, table: Table, source: str, time_factor: float) -> None:
    time, values = _friction(run, table, source)
    axes.set_ylabel("friction factor")
    there = _loaded(table, source, time) if len(time) else np.zeros(0, dtype=bool)
    if not there.any():
        axes.set_title("friction factor: the wall carries no normal force", fontsize=9)
        return
    _draw_history(axes, time[there] * time_factor, values[there], COLOURS[2])
    axes.set_title(_caption("friction factor", "-", time[there], values[there]), fontsize=9)


def energy(run: Run) -> Figure | None:
    """Booked energies, and below them the errors of the balances of energy and momentum."""
    table = run.probes
    kinetic = None if table is None else table.get("kinetic")
    if table is None or kinetic is None:
        return None
    columns = [c for c in table.columns if c.source == kinetic.source]
    errors = [c for c in columns if c.name.endswith("_error") and np.any(np.abs(c.values) > 0)]
    figure, axes, time_factor = _panels(1 + len(errors), f"{run.title}: energy", table)
    _draw_energies(axes[0], table, [c for c in columns if c.unit == kinetic.unit], time_factor)
    for panel, column, colour in zip(axes[1:], errors, COLOURS):
        _draw_error(panel, table, column, time_factor, colour)
    return figure


def _draw_energies(axes: Axes, table: Table, columns: list[Column], time_factor: float) -> None:
    largest = max(np.nanmax(np.abs(c.values), initial=0.0) for c in columns)
    factor, unit = units.scale(float(largest), columns[0].unit)
    for column, colour in zip(columns, COLOURS):
        time, values = table.sampled(column)
        _draw_history(axes, time * time_factor, values * factor, colour, column.name.replace("_", " "))
    axes.set_ylabel(units.label("energy", unit))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=9)


def _draw_error(axes: Axes, table: Table, column: Column, time_factor: float, colour: str) -> None:
    """Magnitude on a logarithmic axis; exact zeros have no place there."""
    time, values = table.sampled(column)
    there = values != 0
    name = column.name.removesuffix("_error").replace("_", " ")
    _draw_history(axes, time[there] * time_factor, np.abs(values[there]), colour)
    axes.set_yscale("log")
    axes.set_ylabel(units.label(f"{name} error", column.unit))
    worst = float(np.abs(values).max())
    axes.set_title(f"largest {name} error: {worst:.1e}" + ("" if column.unit == "-" else f" {column.unit}"), fontsize=9)
