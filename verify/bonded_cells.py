"""Cells of breakable grains from frames: damage of the edges between them, and pictures of fragments and cracks."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection

from pliant.frames import COMPLIANT, Frames
from plots.curves import COLOURS

TURN = (5**0.5 - 1) / 2  # golden section: hues of consecutive numbers are far apart


def edges(frames: Frames) -> np.ndarray:
    """[edges x 2] points of the outlines at the ends of the segments that two cells have in common at the start."""
    grid = frames.grids["outlines"]
    segments = grid.cells[grid.kind == COMPLIANT]
    middles = frames.positions("outlines", 0)[segments, :2].mean(axis=1)
    size = np.ptp(middles, axis=0).max()
    _, first, count = np.unique(np.round(middles / (1e-6 * size)), axis=0, return_index=True, return_counts=True)
    return segments[first[count == 2]]


def damage(frames: Frames, segments: np.ndarray, index: int) -> np.ndarray:
    """[edges] the larger of both ends."""
    return frames.field("outlines", index, "bond_damage").astype(float)[segments].max(axis=1)


def draw_fragments(axes: Axes, frames: Frames, index: int, unit: float = 1e-3) -> None:
    """Cells in colours of their fragments, in millimetres by default."""
    bodies = frames.bodies("compliant", 0)
    grid = frames.grids["bodies"]
    number = np.zeros(grid.body.max() + 1)
    number[grid.body] = frames.field("bodies", index, "fragment")
    colours = plt.get_cmap("hsv")(number[bodies] * TURN % 1)
    colours[:, :3] = 0.45 + 0.55 * colours[:, :3]
    polygons = [polygon[:, :2] / unit for polygon in frames.polygons(index, bodies)]
    axes.add_collection(PolyCollection(polygons, facecolors=colours, edgecolors="0.45", linewidths=0.25))
    axes.autoscale_view()
    axes.set_aspect("equal")
    axes.grid(False)


def draw_cracks(axes: Axes, frames: Frames, index: int, unit: float = 1e-3) -> None:
    """Damaged edges at their initial places: black where torn."""
    segments = edges(frames)
    lines, values = frames.positions("outlines", 0)[segments, :2] / unit, damage(frames, segments, index)
    for low, high, colour, width in ((-1, 0, "0.85", 0.3), (0, 0.999, COLOURS[1], 0.9), (0.999, 2, "black", 1.4)):
        axes.add_collection(LineCollection(lines[(values > low) & (values <= high)], colors=colour, linewidths=width))
    axes.autoscale_view()
    axes.set_aspect("equal")
    axes.grid(False)
