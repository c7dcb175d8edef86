"""Chains of forces: a line from centre to centre through each contact, as wide as its force is large."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize, to_rgba_array
from matplotlib.figure import Figure

from pliant import units
from pliant.network import Network, of_frame
from pliant.results import Run
from plots.drawing import Painting, draw, finish_sheet, place, sheet
from plots.scenery import scenery, whole_box
from plots.wrapping import Box, images

PALE = ["#fbeedd", "#c8c8c8", "#a6a6a6"]  # compliant, rigid, wall
WIDEST = 0.35  # of the mean branch: line of the largest force


def chains(run: Run, indices: list[int]) -> Figure | None:
    """Forces between bodies at several times; blue where they press, red where they pull; one scale for all."""
    if any(run.frames.contacts(index) is None for index in indices):
        return None
    networks = [of_frame(run.frames, index) for index in indices]
    magnitudes = np.concatenate([network.magnitude for network in networks])
    if len(magnitudes) == 0:
        return None
    largest = float(np.quantile(magnitudes, 0.995)) or 1.0
    factor, unit = units.scale(largest, "N/m")
    mappable = ScalarMappable(Normalize(-largest * factor, largest * factor), plt.get_cmap("RdBu"))
    box = whole_box(run, indices)
    figure, axes = sheet(box, len(indices), f"{run.title}: contact forces", beside=1.4)
    for panel, index, network in zip(axes, indices, networks):
        scene = scenery(run, index, box)
        place(panel, box)
        draw(panel, scene, Painting(scene.triangles, to_rgba_array(PALE)[scene.kind]), box, 0.15)
        _draw_lines(panel, network, run.frames.periods(index), box, largest, mappable, factor)
    finish_sheet(axes, [run.frames.times[index] for index in indices])
    figure.colorbar(mappable, ax=axes, label=units.label("force, pressing positive", unit), extend="both", shrink=0.8,
                    aspect=30, pad=0.02)
    return figure


def _draw_lines(axes: Axes, network: Network, periods: np.ndarray, box: Box, largest: float, mappable: ScalarMappable,
                factor: float) -> None:
    """The strongest last, upon the others."""
    lengths = np.linalg.norm(network.arms, axis=2)
    width = WIDEST * 2 * np.nanmean(lengths) if np.isfinite(lengths).any() else 0.0
    points = network.contacts.point
    # An arm of no length where a wall has none.
    lines = np.stack([points - np.nan_to_num(network.arms[:, 0]), points, points - np.nan_to_num(network.arms[:, 1])], 1)
    signed = np.sign(network.compression) * network.magnitude
    order = np.argsort(network.magnitude)
    lines, signed = lines[order], signed[order]
    if len(periods) == 2:
        index, shifts = images(lines.min(axis=1), lines.max(axis=1), periods, box)
        lines, signed = lines[index] + shifts[:, None], signed[index]
    elif len(periods) == 1:
        lines, signed = _in_the_period(lines, signed, periods[0, 0])
    scale, _ = units.scale(max(box[1] - box[0], box[3] - box[2]), "m")
    drawn = LineCollection(lines * scale, colors=mappable.to_rgba(signed * factor), capstyle="round", zorder=3)
    axes.add_collection(drawn, autolim=False)
    share = np.minimum(np.abs(signed) / largest, 1.0)
    drawn.set_linewidths(np.maximum(share * width * scale * _points_a_unit(axes), 0.1))


def _points_a_unit(axes: Axes) -> float:
    """Of a line's width, for a unit of the axes."""
    axes.figure.draw_without_rendering()
    left, right = axes.get_xlim()
    return axes.get_window_extent().width / axes.figure.dpi * 72 / (right - left)


def _in_the_period(lines: np.ndarray, values: np.ndarray, period: float) -> tuple[np.ndarray, np.ndarray]:
    """Lines [n x 3 x 2] with their middle in the period, and copies of those that stand out of it."""
    placed = lines.copy()
    placed[:, :, 0] -= (np.floor(lines[:, 1, 0] / period) * period)[:, None]
    copies, of = [placed], [values]
    for side in (-1, 1):
        out = (placed[:, :, 0] < 0).any(axis=1) if side > 0 else (placed[:, :, 0] > period).any(axis=1)
        copies.append(placed[out] + np.array([side * period, 0.0]))
        of.append(values[out])
    return np.concatenate(copies), np.concatenate(of)
