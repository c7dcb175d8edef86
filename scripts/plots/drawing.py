"""Draws sceneries onto panels, and lays panels out."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection, TriMesh
from matplotlib.colors import to_rgba_array
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.tri import Triangulation

from pliant import units
from plots.scenery import Scenery
from pliant.frames import WALL

KIND_COLOURS = ["#f2c079", "#4a4a4a", "#a6a6a6"]  # compliant, rigid, wall
EDGE = "#2b2b2b"
Box = tuple[float, float, float, float]  # x and y limits, m


def draw(axes: Axes, scene: Scenery, triangles: np.ndarray, colours: np.ndarray, box: Box, line_width: float) -> None:
    """`triangles` [n x 3 x 2] in `colours` ([n x 4], or [n x 3 x 4] for the corners), outlines of grains, and walls."""
    factor, unit = units.scale(max(box[1] - box[0], box[3] - box[2]), "m")
    inside = _inside(triangles, box)
    _draw_triangles(axes, triangles[inside] * factor, colours[inside])
    _draw_lines(axes, scene.edges[_inside(scene.edges, box)] * factor, line_width)
    _draw_walls(axes, scene, box, factor)
    axes.set_xlim(box[0] * factor, box[1] * factor)
    axes.set_ylim(box[2] * factor, box[3] * factor)
    axes.set_aspect("equal")
    axes.set_xlabel(units.label("x", unit))
    axes.set_ylabel(units.label("y", unit))


def draw_coloured(axes: Axes, segments: np.ndarray, colours: np.ndarray, box: Box, width: float) -> None:
    """Segments [n x 2 x 2] in colours [n x 4], upon what `draw` drew."""
    factor, _ = units.scale(max(box[1] - box[0], box[3] - box[2]), "m")
    axes.add_collection(LineCollection(segments * factor, colors=colours, linewidths=width, capstyle="round"))


def _draw_triangles(axes: Axes, triangles: np.ndarray, colours: np.ndarray) -> None:
    """One mesh whose triangles share no corner: faster than a collection of polygons, and without seams."""
    corners = triangles.reshape(-1, 2)
    if len(corners) == 0:
        return
    mesh = TriMesh(Triangulation(*corners.T, np.arange(len(corners)).reshape(-1, 3)))
    mesh.set_facecolor(np.broadcast_to(colours.reshape(len(triangles), -1, 4), (len(triangles), 3, 4)).reshape(-1, 4))
    # Neither layout nor limits shall ask for its extent, which would make a path of each triangle.
    mesh.set_in_layout(False)
    axes.add_collection(mesh, autolim=False)


def _draw_lines(axes: Axes, segments: np.ndarray, width: float) -> None:
    """One path with gaps, for the same reason."""
    gaps = np.full((len(segments), 1, 2), np.nan)
    points = np.concatenate([segments, gaps], axis=1).reshape(-1, 2)
    axes.plot(*points.T, color=EDGE, linewidth=width, zorder=2, solid_capstyle="round")


def _inside(polygons: np.ndarray, box: Box) -> np.ndarray:
    low, high = polygons.min(axis=1), polygons.max(axis=1)
    return (high[:, 0] >= box[0]) & (low[:, 0] <= box[1]) & (high[:, 1] >= box[2]) & (low[:, 1] <= box[3])


def _draw_walls(axes: Axes, scene: Scenery, box: Box, factor: float) -> None:
    """Walls are solid on the side away from the grains: each segment's column is filled to the edge of the picture."""
    if len(scene.walls) == 0:
        return
    grains = scene.triangles[scene.kind != WALL]
    middle = grains[:, :, 1].mean() if len(grains) else scene.walls[:, :, 1].mean()
    below = scene.walls[:, :, 1].mean(axis=1) < middle
    columns = np.concatenate([scene.walls, scene.walls[:, ::-1]], axis=1)
    columns[:, 2:, 1] = np.where(below, box[2], box[3])[:, None]
    colour = KIND_COLOURS[WALL]
    axes.add_collection(PolyCollection(columns * factor, facecolors=colour, edgecolors="none", antialiased=False))
    _draw_lines(axes, scene.walls * factor, 0.8)


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


def whole_and_window(scene: Scenery, window: Box, title: str) -> tuple[Figure, list[Axes]]:
    """One above the other when the scene is wide, side by side otherwise; the window is marked in the whole."""
    ratios = [scene.width / scene.height, (window[1] - window[0]) / (window[3] - window[2])]
    if ratios[0] > 1.4:
        heights = [11 / ratio for ratio in ratios]
        size, grid = (12.7, sum(heights) + 1.6), {"nrows": 2, "height_ratios": heights}
    else:
        size, grid = (7 * sum(ratios) + 2.8, 8.0), {"ncols": 2, "width_ratios": ratios}
    figure, axes = plt.subplots(figsize=size, layout="compressed", **grid)
    figure.suptitle(title)
    factor = units.scale(max(scene.width, scene.height), "m")[0]
    corner, width, height = (window[0], window[2]), window[1] - window[0], window[3] - window[2]
    frame = Rectangle(np.multiply(corner, factor), width * factor, height * factor, fill=False, edgecolor="#1f77b4",
                      linewidth=1.5, zorder=5, clip_on=False)
    axes[0].add_patch(frame)
    return figure, list(axes)
