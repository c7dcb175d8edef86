"""Histories: steps, forces, energies, other probes."""

from collections.abc import Callable

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogFormatterSciNotation, MaxNLocator

from pliant import units
from plots.friction import force_sources, friction, loaded
from plots.history import DENSE, draw_history
from pliant.results import Column, Run, Table

# Okabe and Ito's colours, told apart by the colour-blind.
COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7f7f7f", "#000000"]
# A curve this much smaller than the largest of its panel is a line at zero: it is named, not drawn.
_NEGLIGIBLE = 1e-9
_LEGEND_COLUMNS = 6
# Estimates of nearly nothing (free flight, a start at rest) shall not squeeze the others.
_DECADES = 8


def panels(count: int, title: str, time: np.ndarray) -> tuple[Figure, list[Axes], float]:
    """Panels above one another with a common axis of time, and the factor of time."""
    figure, axes = plt.subplots(
        count, 1, figsize=(9, 1.2 + 2.1 * count), sharex=True, squeeze=False, layout="constrained"
    )
    figure.suptitle(title)
    factor, unit = units.scale(float(time.max()), "s")
    axes[-1, 0].set_xlabel(units.label("time", unit))
    start = time.min() if time.min() > 0.05 * time.max() else 0.0
    axes[-1, 0].set_xlim(start * factor, time.max() * factor)
    for panel in axes.flat:
        panel.grid(alpha=0.3)
    figure.align_ylabels(axes)
    return figure, list(axes.flat), factor


def _logarithmic(axes: Axes, values: np.ndarray) -> None:
    """Labels between the decades where there are few of them, and no more decades than can be read."""
    axes.set_yscale("log")
    axes.yaxis.set_minor_formatter(LogFormatterSciNotation(minor_thresholds=(2, 0.5)))
    largest = values.max()
    axes.set_ylim(max(10.0**-_DECADES * largest, np.quantile(values, 0.005) / 2), 2 * largest)


def legend(axes: Axes, curves: int) -> None:
    """In a line above the panel: it hides nothing there, and all panels keep one width."""
    if curves > 0:
        axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=min(curves, _LEGEND_COLUMNS), fontsize=9,
                    frameon=False, borderpad=0.1, columnspacing=1.2, handlelength=1.4)


def steps(run: Run) -> Figure | None:
    """Error estimate, time step, rejections and contacts against time (the paper's figure 8)."""
    table = run.steps
    wanted = {"error": "error estimate", "dt": "time step", "rejections": "rejections so far", "contacts": "contacts"}
    columns = [c for name in wanted if (c := table.get(name)) is not None and _tells(c)]
    if not columns:
        return None
    figure, axes, factor = panels(len(columns), f"{run.title}: steps", table.time)
    for panel, column, colour in zip(axes, columns, COLOURS):
        _draw_step_column(panel, table, column, factor, colour, wanted[column.name])
        if column.name == "error" and run.tolerance is not None:
            panel.axhline(run.tolerance, color=COLOURS[7], linewidth=0.8, linestyle="--", label="tolerance")
            panel.set_ylim(top=max(panel.get_ylim()[1], 2 * run.tolerance))
            legend(panel, 1)
    notes = [_rejection_note(table), "line: mean, band: least to largest" if len(table.time) > DENSE else ""]
    figure.supxlabel("; ".join(note for note in notes if note), fontsize=9)
    return figure


def _tells(column: Column) -> bool:
    """Rejections that never came need no panel: the note below says so."""
    return column.name != "rejections" or bool(np.any(column.values > 0))


def _draw_step_column(axes: Axes, table: Table, column: Column, time_factor: float, colour: str, name: str) -> None:
    time, values = table.sampled(column)
    factor, unit = units.scale(float(np.median(values)) if len(values) else 0.0, column.unit)
    if column.name == "error" and np.any(values > 0):
        time, values = time[values > 0], values[values > 0]
        _logarithmic(axes, values)
    elif column.name in ("rejections", "contacts"):
        axes.yaxis.set_major_locator(MaxNLocator(integer=True, nbins=6))
    draw_history(axes, time * time_factor, values * factor, colour)
    if column.name in ("rejections", "dt"):
        axes.set_ylim(bottom=0)
    axes.set_ylabel(units.label(name, unit))


def _rejection_note(table: Table) -> str:
    rejections, evaluations = table.get("rejections"), table.get("evaluations")
    if rejections is None or evaluations is None:
        return ""
    rejected, evaluated = rejections.values[-1], evaluations.values[-1]
    if rejected == 0:
        return f"no rejections in {evaluated:.0f} force evaluations"
    return f"{rejected:.0f} rejections in {evaluated:.0f} force evaluations ({100 * rejected / evaluated:.2g} %)"


def _caption(name: str, unit: str, time: np.ndarray, values: np.ndarray) -> str:
    """Largest magnitude, with its time, and the mean over the last quarter of the time."""
    peak = int(np.nanargmax(np.abs(values)))
    last = time >= time[0] + 0.75 * (time[-1] - time[0])
    return (
        f"{name}: peak {units.readable(float(values[peak]), unit)} at {units.readable(float(time[peak]), 's')}, "
        f"mean of the last quarter {units.readable(float(np.nanmean(values[last])), unit)}"
    )


def forces(run: Run) -> Figure | None:
    """Normal and tangential force and friction factor of each wall with a force probe (the paper's figure 9)."""
    table = run.probes
    sources = force_sources(table)
    if not sources:
        return None
    rubbed = [source for source in sources if _friction_matters(run, table, source)]
    figure, axes, factor = panels(len(sources) + len(rubbed), f"{run.title}: forces", table.time)
    left = iter(axes)
    for source in sources:
        _draw_forces(next(left), run, table, source, factor)
        if source in rubbed:
            _draw_friction(next(left), run, table, source, factor)
    return figure


def _friction_matters(run: Run, table: Table, source: str) -> bool:
    """Not on a wall without friction, where the polygons' corners leave a trace of it."""
    time, values = friction(run, table, source)
    there = loaded(table, source, time) if len(time) else np.zeros(0, dtype=bool)
    return bool(np.any(np.abs(values[there]) > 0.005))


def _draw_forces(axes: Axes, run: Run, table: Table, source: str, time_factor: float) -> None:
    normal, tangential = table.get("force_y", source), table.get("force_x", source)
    assert normal is not None and tangential is not None
    largest = max(np.nanmax(np.abs(c.values), initial=0.0) for c in (normal, tangential))
    factor, unit = units.scale(float(largest), normal.unit)
    captions = []
    for column, name, colour in ((normal, "normal", COLOURS[0]), (tangential, "tangential", COLOURS[1])):
        time, values = table.sampled(column)
        if np.abs(values).max(initial=0.0) <= _NEGLIGIBLE * largest:
            captions.append(f"{name}: 0")
            continue
        if column is normal and values.mean() < 0:
            values = -values  # compression is positive on either wall
        draw_history(axes, time * time_factor, values * factor, colour, name)
        captions.append(_caption(name, column.unit, time, values))
    axes.set_ylabel(units.label("force", unit))
    axes.set_title(f"wall '{run.probe_of.get(source) or source}'\n" + "\n".join(captions), fontsize=9, loc="left")
    legend(axes, len(axes.get_legend_handles_labels()[0]))


def _draw_friction(axes: Axes, run: Run, table: Table, source: str, time_factor: float) -> None:
    time, values = friction(run, table, source)
    values = np.where(loaded(table, source, time), values, np.nan)
    draw_history(axes, time * time_factor, values, COLOURS[2])
    axes.set_ylabel("friction factor")
    axes.set_title(_caption("friction factor", "-", time, values), fontsize=9, loc="left")


def energy(run: Run) -> Figure | None:
    """Booked energies, and below them the errors of the balances of energy and momentum."""
    table = run.probes
    kinetic = table.get("kinetic")
    if kinetic is None:
        return None
    columns = [c for c in table.columns if c.source == kinetic.source]
    errors = [c for c in columns if c.name.endswith("_error") and np.any(np.abs(c.values) > 0)]
    figure, axes, time_factor = panels(1 + len(errors), f"{run.title}: energy", table.time)
    energies = [c for c in columns if c.unit == kinetic.unit]
    _draw_together(axes[0], table, energies, time_factor, "energy", lambda c: c.name.replace("_", " "))
    for panel, column, colour in zip(axes[1:], errors, COLOURS):
        _draw_error(panel, table, column, time_factor, colour)
    return figure


def _draw_together(
    axes: Axes, table: Table, columns: list[Column], time_factor: float, quantity: str, name_of: Callable[[Column], str]
) -> None:
    """Columns of one unit in one panel; those that vanish beside the others are named in its title."""
    largest = max(np.nanmax(np.abs(c.values), initial=0.0) for c in columns)
    factor, unit = units.scale(float(largest), columns[0].unit)
    vanishing = []
    for column, colour in zip(columns, COLOURS * len(columns)):
        time, values = table.sampled(column)
        if np.abs(values).max(initial=0.0) <= _NEGLIGIBLE * largest:
            vanishing.append(name_of(column))
            continue
        style = "--" if column.name == "external_work" else "-"  # what came in lies on what is stored in slow scenes
        draw_history(axes, time * time_factor, values * factor, colour, name_of(column), style)
    axes.set_ylabel(units.label(quantity, unit))
    legend(axes, len(columns) - len(vanishing))
    if vanishing:
        axes.set_title(f"zero: {', '.join(vanishing)}", fontsize=9, loc="left")


def _draw_error(axes: Axes, table: Table, column: Column, time_factor: float, colour: str) -> None:
    """Magnitude on a logarithmic axis; exact zeros have no place there."""
    time, values = table.sampled(column)
    there = values != 0
    name = column.name.removesuffix("_error").replace("_", " ")
    draw_history(axes, time[there] * time_factor, np.abs(values[there]), colour)
    _logarithmic(axes, np.abs(values[there]))
    axes.set_ylabel(units.label(f"{name} error", column.unit))
    unit = "" if column.unit == "-" else f" {column.unit}"
    title = f"{name} error: largest {np.abs(values).max():.1e}{unit}, at the end {abs(values[-1]):.1e}{unit}"
    axes.set_title(title, fontsize=9, loc="left")


def probes(run: Run) -> Figure | None:
    """What forces and energies leave over; a panel for each quantity and unit, whatever number of probes it has."""
    table = run.probes
    kinetic = table.get("kinetic")
    taken = set(force_sources(table)) | ({kinetic.source} if kinetic is not None else set())
    shown = {run.probe_of.get(source, source) for source in force_sources(table)}  # their friction is in forces.png
    groups: dict[tuple[str, str], list[Column]] = {}
    for column in table.columns:
        drawn = column.name == "friction_factor" and run.probe_of.get(column.source, column.source) in shown
        if column.source not in taken and not drawn and np.isfinite(column.values).any():
            quantity = run.probe_quantity.get(column.source, "").replace("_", " ") or _quantity(column)
            groups.setdefault((quantity, column.unit), []).append(column)
    groups = {key: columns for key, columns in groups.items() if any(np.any(c.values != 0) for c in columns)}
    if not groups:
        return None
    figure, axes, factor = panels(len(groups), f"{run.title}: probes", table.time)
    for panel, ((quantity, _), columns) in zip(axes, groups.items()):
        names = {_quantity(c) for c in columns}
        title = names.pop() if len(names) == 1 else quantity
        _draw_together(panel, table, columns, factor, title, lambda c: _probe_label(run, c, columns))
    return figure


def _quantity(column: Column) -> str:
    return column.name.removesuffix("_x").removesuffix("_y").replace("_", " ")


def _probe_label(run: Run, column: Column, beside: list[Column]) -> str:
    """Whose, and which component: "left x". Probes of the same bodies go by their own names, columns by theirs."""
    of = run.probe_of.get(column.source) or column.source
    alike = {c.source for c in beside if (run.probe_of.get(c.source) or c.source) == of}
    whose = column.source if len(alike) > 1 else of
    if len({_quantity(c) for c in beside}) > 1:
        which = column.name.replace("_", " ")
    else:
        which = column.name[-1] if column.name.endswith(("_x", "_y")) else ""
    several = len({c.source for c in beside}) > 1 or not which
    return f"{whose if several or len(which) == 1 else ''} {which}".strip()
