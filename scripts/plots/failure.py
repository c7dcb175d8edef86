"""The place where a run ended."""

import textwrap

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from pliant import units
from plots.drawing import EDGE
from pliant.results import Run, read_json

COLOURS = ["#f2c079", "#9fc3d9"]
SEGMENTS = 12  # that a picture is wide


def failure(run: Run) -> Figure | None:
    """Outlines of the bodies that it is about in the last good state, some segments around the place; all of them where
    no place is known."""
    file = run.folder / "failure.json"
    report = read_json(file) if file.exists() else {}
    good = report.get("last_good_state", {})
    outlines = {name: np.array(points, dtype=float) for name, points in good.get("outlines", {}).items()}
    if not outlines:
        return None
    place = report["place"] or good.get("deepest_contact", {}).get("place")
    if place is not None and None in place:
        place = None
    points = np.concatenate(list(outlines.values()))
    segment = np.median(np.concatenate([np.hypot(*np.diff(p, axis=0).T) for p in outlines.values()]))
    middle = 0.5 * (np.nanmin(points, axis=0) + np.nanmax(points, axis=0)) if place is None else np.array(place)
    half = 0.55 * np.ptp(points, axis=0).max() if place is None else 0.5 * SEGMENTS * segment
    factor, unit = units.scale(2 * half, "m")
    message = textwrap.wrap(report["message"], 96)
    figure, axes = plt.subplots(figsize=(7, 7.4 + 0.15 * len(message)), layout="constrained")
    for (name, outline), colour in zip(outlines.items(), COLOURS):
        closed = np.vstack([outline, outline[:1]]) * factor
        axes.fill(*closed.T, facecolor=colour, alpha=0.6, label=name)
        axes.plot(*closed.T, color=EDGE, linewidth=1.0, marker=".", markersize=4)
    if place is not None:
        axes.plot(*(np.array(place) * factor), "x", color="#c0392b", markersize=12, markeredgewidth=2.5,
                  label=report["cause"])
    axes.set_xlim(*(middle[0] + np.array([-half, half])) * factor)
    axes.set_ylim(*(middle[1] + np.array([-half, half])) * factor)
    axes.set_aspect("equal")
    axes.set_xlabel(units.label("x", unit))
    axes.set_ylabel(units.label("y", unit))
    axes.legend(loc="upper right")
    title = "\n".join([f"{run.title}: last good state, t = {good['time']:.6g} s", *message])
    axes.set_title(title, fontsize=8, loc="left")
    return figure
