"""Draws sceneries onto panels, and lays panels out."""

from dataclasses import dataclass, field

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backend_bases import RendererBase
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from matplotlib.transforms import IdentityTransform

from pliant import units
from plots.scenery import Scenery
from plots.wrapping import Box
from pliant.frames import WALL

KIND_COLOURS = ["#f2c079", "#4a4a4a", "#a6a6a6"]  # compliant, rigid, wall
EDGE, MARK, CELL = "#2b2b2b", "#56b4e9", "#0072b2"


class Triangles(Artist):
    """Triangles [n x 3 x 2] that share no corner, in colours [n x 4] or [n x 3 x 4]: without seams, and in half of the
    time that matplotlib's own mesh takes for as many."""

    def __init__(self, triangles: np.ndarray, colours: np.ndarray) -> None:
        super().__init__()
        self.set_in_layout(False)
        self._triangles = triangles
        self._colours = np.broadcast_to(colours if colours.ndim == 3 else colours[:, None], (len(triangles), 3, 4))

    def draw(self, renderer: RendererBase) -> None:
        if len(self._triangles) == 0:
            return
        context = renderer.new_gc()
        self._set_gc_clip(context)
        corners = self.get_transform().transform(self._triangles.reshape(-1, 2)).reshape(-1, 3, 2)
        renderer.draw_gouraud_triangles(context, corners, np.ascontiguousarray(self._colours), IdentityTransform())
        context.restore()


@dataclass
class Painting:
    """What shows a quantity in one frame, lengths in metres."""

    triangles: np.ndarray  # [n x 3 x 2]
    colours: np.ndarray  # [n x 4], or [n x 3 x 4] for the corners
    lines: np.ndarray = field(default_factory=lambda: np.empty((0, 2, 2)))  # [m x 2 x 2], along outlines
    line_colours: np.ndarray = field(default_factory=lambda: np.empty((0, 4)))  # [m x 4]


def place(axes: Axes, box: Box, names: tuple[str, str] = ("x", "y")) -> None:
    """Limits, and labels with units."""
    factor, unit = _scale(box)
    axes.set_xlim(box[0] * factor, box[1] * factor)
    axes.set_ylim(box[2] * factor, box[3] * factor)
    axes.set_aspect("equal")
    axes.set_xlabel(units.label(names[0], unit))
    axes.set_ylabel(units.label(names[1], unit))


def draw(axes: Axes, scene: Scenery, painting: Painting, box: Box, line_width: float,
         marked: int | None = None) -> list[Artist]:
    """The painting with outlines of grains, that of one of them marked, and walls."""
    factor, _ = _scale(box)
    artists = [axes.add_artist(Triangles(painting.triangles * factor, painting.colours))]
    artists += _draw_lines(axes, scene.edges * factor, line_width)
    if len(painting.lines):
        coloured = LineCollection(painting.lines * factor, colors=painting.line_colours, linewidths=4 * line_width,
                                  capstyle="round", zorder=2.5)
        artists.append(axes.add_collection(coloured, autolim=False))
    if marked is not None:
        artists += _draw_lines(axes, scene.edges[scene.edge_body == marked] * factor, 2.0, MARK, 3)
    if len(scene.cell):
        sides = np.stack([scene.cell, np.roll(scene.cell, -1, axis=0)], axis=1)
        artists += _draw_lines(axes, sides * factor, 1.2, CELL, 4)
    return artists + _draw_walls(axes, scene, box, factor)


def _scale(box: Box) -> tuple[float, str]:
    return units.scale(max(box[1] - box[0], box[3] - box[2]), "m")


def _draw_lines(axes: Axes, segments: np.ndarray, width: float, colour: str = EDGE, zorder: float = 2) -> list[Artist]:
    """One path with gaps, whose extent nobody asks for: both are faster."""
    gaps = np.full((len(segments), 1, 2), np.nan)
    points = np.concatenate([segments, gaps], axis=1).reshape(-1, 2)
    line = Line2D(*points.T, color=colour, linewidth=width, zorder=zorder, solid_capstyle="round")
    line.set_in_layout(False)
    return [axes.add_artist(line)]


def _draw_walls(axes: Axes, scene: Scenery, box: Box, factor: float) -> list[Artist]:
    """Walls are solid on the side away from the grains: each segment's column is filled to the edge of the picture."""
    if len(scene.walls) == 0:
        return []
    columns = np.concatenate([scene.walls, scene.walls[:, ::-1]], axis=1)
    columns[:, 2:, 1] = np.where(scene.wall_below, box[2], box[3])[:, None]
    solid = PolyCollection(columns * factor, facecolors=KIND_COLOURS[WALL], edgecolors="none", antialiased=False)
    return [axes.add_collection(solid, autolim=False), *_draw_lines(axes, scene.walls * factor, 0.8)]


def _layout(box: Box, count: int) -> tuple[int, int, float, float]:
    """Rows, columns, and the size of one picture in inches: wide scenes are stacked, others stand side by side."""
    ratio = (box[1] - box[0]) / (box[3] - box[2])
    columns = min(count, 1 if ratio > 2.75 else 2 if ratio > 0.7 else 4)
    height = min(11.0 / columns / ratio, 9.0)
    return -(-count // columns), columns, height * ratio, height


def sheet(box: Box, count: int, title: str, beside: float = 0.0) -> tuple[Figure, list[Axes]]:
    """Panels of one scene at several times. `beside`: inches left for a colour bar."""
    rows, columns, width, height = _layout(box, count)
    size = (max(columns * width + 0.25 * (columns - 1) + 0.9 + beside, 5.0), rows * (height + 0.35) + 0.8)
    figure, axes = plt.subplots(
        rows, columns, figsize=size, squeeze=False, sharex=True, sharey=True, layout="compressed"
    )
    figure.suptitle(title)
    for spare in axes.flat[count:]:
        spare.set_visible(False)
    return figure, list(axes.flat[:count])


def finish_sheet(panels: list[Axes], times: list[float]) -> None:
    """Titles with the time, and labels on the outer axes alone."""
    for panel, time in zip(panels, times):
        panel.set_title(f"t = {units.readable(time, 's')}", fontsize=10, loc="left")
        panel.label_outer()


def outline_width(scene: Scenery) -> float:
    """Outlines fade in scenes of many grains, where they would hide the colours."""
    return float(np.clip(60.0 / np.sqrt(len(scene.edges) + 1.0), 0.15, 0.8))


def whole_and_window(box: Box, window: Box, title: str) -> tuple[Figure, list[Axes]]:
    """One above the other when the scene is wide, side by side otherwise; the window is marked in the whole."""
    ratios = [(b[1] - b[0]) / (b[3] - b[2]) for b in (box, window)]
    if ratios[0] > 1.4:
        heights = [11 / ratio for ratio in ratios]
        size, grid = (12.7, sum(heights) + 1.6), {"nrows": 2, "height_ratios": heights}
    else:
        size, grid = (7 * sum(ratios) + 2.8, 8.0), {"ncols": 2, "width_ratios": ratios}
    figure, axes = plt.subplots(figsize=size, layout="compressed", **grid)
    figure.suptitle(title)
    factor, _ = _scale(box)
    corner, width, height = (window[0], window[2]), window[1] - window[0], window[3] - window[2]
    frame = Rectangle(np.multiply(corner, factor), width * factor, height * factor, fill=False, edgecolor="#1f77b4",
                      linewidth=1.5, zorder=5, clip_on=False)
    axes[0].add_patch(frame)
    return figure, list(axes)
