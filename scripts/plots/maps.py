"""Maps of bodies: kinds, velocity norm, von Mises stress."""

from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection, TriMesh
from matplotlib.colors import Normalize, to_rgba_array
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.tri import Triangulation

from plots import units
from plots.run_data import COMPLIANT, RIGID, WALL, Frames, Run
from plots.wrapping import body_shifts, edge_copies, wrapped_segments

KIND_COLOURS = ["#f2c079", "#4a4a4a", "#a6a6a6"]  # compliant, rigid, wall
NEUTRAL = "#c9c9c9"
EDGE = "#2b2b2b"


@dataclass
class Scenery:
    """One frame, ready to be drawn: bodies in one period, all lengths in metres."""

    triangles: np.ndarray  # [triangles x 3 x 2]
    cells: np.ndarray  # [triangles] cell of the grid each is a picture of
    kind: np.ndarray  # [triangles]
    edges: np.ndarray  # [segments x 2 x 2] outlines of grains
    walls: np.ndarray  # [segments x 2 x 2]
    box: tuple[float, float, float, float]  # x and y limits

    @property
    def width(self) -> float:
        return self.box[1] - self.box[0]

    @property
    def height(self) -> float:
        return self.box[3] - self.box[2]


def scenery(run: Run, index: int) -> Scenery:
    frames = run.frames
    assert frames is not None
    triangles, cells = _polygons(frames, "bodies", index, run.period)
    kind = frames.grids["bodies"].kind[cells]
    edges, walls = np.empty((0, 2, 2)), np.empty((0, 2, 2))
    if "outlines" in frames.grids:
        segments, originals = _polygons(frames, "outlines", index, run.period)
        of_wall = frames.grids["outlines"].kind[originals] == WALL
        edges, walls = segments[~of_wall], segments[of_wall]
        if run.period is not None:
            walls = wrapped_segments(walls, run.period)
    return Scenery(triangles, cells, kind, edges, walls, _box(triangles[kind != WALL], walls, run.period))


def _polygons(frames: Frames, grid: str, index: int, period: float | None) -> tuple[np.ndarray, np.ndarray]:
    """Cells of a grid as polygons [n x corners x 2], grains wrapped, and the cell each is a picture of."""
    topology = frames.grids[grid]
    points = frames.positions(grid, index)
    if period is None:
        return points[topology.cells], np.arange(len(topology.cells))
    movable = np.zeros(topology.body.max(initial=-1) + 1, dtype=bool)
    movable[topology.body[topology.kind != WALL]] = True
    used = len(topology.point_body)
    points[:used, 0] += body_shifts(points[:used], topology.point_body, movable, period)
    if grid == "outlines":
        return _copied_grains(points[topology.cells], topology.body, topology.kind != WALL, period)
    return edge_copies(points[topology.cells], topology.body, period)


def _copied_grains(
    polygons: np.ndarray, bodies: np.ndarray, grain: np.ndarray, period: float
) -> tuple[np.ndarray, np.ndarray]:
    """Copies at the edges for grains alone: walls are wrapped segment by segment."""
    copies, index = edge_copies(polygons[grain], bodies[grain], period)
    walls = np.flatnonzero(~grain)
    return np.concatenate([copies, polygons[walls]]), np.concatenate([np.flatnonzero(grain)[index], walls])


def _box(grains: np.ndarray, walls: np.ndarray, period: float | None) -> tuple[float, float, float, float]:
    corners = np.concatenate([grains.reshape(-1, 2), walls.reshape(-1, 2)])
    (left, low), (right, high) = corners.min(axis=0), corners.max(axis=0)
    if period is not None:
        left, right = 0.0, period
    margin = 0.04 * max(high - low, 0.25 * (right - left))
    # Neither a thread nor a needle: at most 6 to 1.
    above = max(margin, 0.5 * ((right - left) / 6 - (high - low)))
    beside = 0.0 if period is not None else max(margin, 0.5 * ((high - low) / 6 - (right - left)))
    return left - beside, right + beside, low - above, high + above


def common_box(sceneries: list[Scenery]) -> tuple[float, float, float, float]:
    boxes = np.array([s.box for s in sceneries])
    return boxes[:, 0].min(), boxes[:, 1].max(), boxes[:, 2].min(), boxes[:, 3].max()


def draw(axes: Axes, scene: Scenery, colours: np.ndarray | None, box: tuple[float, ...], line_width: float) -> None:
    """Grains in `colours` (one a triangle of the scenery; None: by kind), their outlines, and filled walls."""
    factor, unit = units.scale(max(box[1] - box[0], box[3] - box[2]), "m")
    faces = to_rgba_array(KIND_COLOURS)[scene.kind] if colours is None else colours
    inside = _inside(scene.triangles, box)
    _draw_triangles(axes, scene.triangles[inside] * factor, faces[inside])
    _draw_lines(axes, scene.edges[_inside(scene.edges, box)] * factor, line_width)
    _draw_walls(axes, scene, box, factor)
    axes.set_xlim(box[0] * factor, box[1] * factor)
    axes.set_ylim(box[2] * factor, box[3] * factor)
    axes.set_aspect("equal")
    axes.set_ylabel(units.label("y", unit))


def _draw_triangles(axes: Axes, triangles: np.ndarray, colours: np.ndarray) -> None:
    """One mesh whose triangles share no corner: faster than a collection of polygons, and without seams."""
    corners = triangles.reshape(-1, 2)
    if len(corners) == 0:
        return
    mesh = TriMesh(Triangulation(*corners.T, np.arange(len(corners)).reshape(-1, 3)))
    mesh.set_facecolor(np.repeat(colours, 3, axis=0))
    # Neither layout nor limits shall ask for its extent, which would make a path of each triangle.
    mesh.set_in_layout(False)
    axes.add_collection(mesh, autolim=False)


def _draw_lines(axes: Axes, segments: np.ndarray, width: float) -> None:
    """One path with gaps, for the same reason."""
    gaps = np.full((len(segments), 1, 2), np.nan)
    axes.plot(*np.concatenate([segments, gaps], axis=1).reshape(-1, 2).T, color=EDGE, linewidth=width, zorder=2)


def _inside(polygons: np.ndarray, box: tuple[float, ...]) -> np.ndarray:
    low, high = polygons.min(axis=1), polygons.max(axis=1)
    return (high[:, 0] >= box[0]) & (low[:, 0] <= box[1]) & (high[:, 1] >= box[2]) & (low[:, 1] <= box[3])


def _draw_walls(axes: Axes, scene: Scenery, box: tuple[float, ...], factor: float) -> None:
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


def _layout(box: tuple[float, ...], count: int) -> tuple[int, int, float, float]:
    """Rows, columns, and the size of one picture in inches: wide scenes are stacked, others stand side by side."""
    ratio = (box[1] - box[0]) / (box[3] - box[2])
    columns = min(count, 1 if ratio > 2.2 else 2 if ratio > 0.7 else 4)
    height = min(11.0 / columns / ratio, 9.0)
    return -(-count // columns), columns, height * ratio, height


def _sheet(box: tuple[float, ...], count: int, title: str, beside: float = 0.0) -> tuple[Figure, list[Axes]]:
    """`beside`: inches left for a colour bar."""
    rows, columns, width, height = _layout(box, count)
    size = (max(columns * (width + 0.65) + beside, 5.0), rows * (height + 0.45) + 0.75)
    figure, axes = plt.subplots(rows, columns, figsize=size, squeeze=False, layout="constrained")
    figure.suptitle(title)
    for spare in axes.flat[count:]:
        spare.set_visible(False)
    for low in axes[-1]:
        low.set_xlabel(units.label("x", units.scale(max(box[1] - box[0], box[3] - box[2]), "m")[1]))
    return figure, list(axes.flat[:count])


def _inches(axes: Axes) -> float:
    """Rough height of a panel."""
    rows = axes.get_subplotspec().get_gridspec().nrows
    return axes.figure.get_figheight() / rows - 0.6


def _outline_width(scene: Scenery) -> float:
    """Outlines fade in scenes of many grains, where they would hide the colours."""
    return float(np.clip(60.0 / np.sqrt(len(scene.edges) + 1.0), 0.15, 0.8))


def grains(run: Run, indices: list[int]) -> Figure:
    """Compliant and rigid grains at several times (the paper's figure 7 and 10)."""
    assert run.frames is not None
    sceneries = [scenery(run, index) for index in indices]
    box = common_box(sceneries)
    figure, axes = _sheet(box, len(indices), f"{run.title}: grains")
    for panel, scene, index in zip(axes, sceneries, indices):
        draw(panel, scene, None, box, _outline_width(scene))
        panel.set_title(f"t = {units.readable(run.frames.times[index], 's')}", fontsize=10, loc="left")
    shown = [k for k in (COMPLIANT, RIGID, WALL) if k in sceneries[0].kind or (k == WALL and len(sceneries[0].walls))]
    names = {COMPLIANT: "compliant", RIGID: "rigid", WALL: "wall"}
    handles = [Patch(facecolor=KIND_COLOURS[k], edgecolor=EDGE, label=names[k]) for k in shown]
    last = axes[-1]
    last.legend(handles=handles, loc="upper right", bbox_to_anchor=(1, -0.4 / _inches(last)), ncols=3, frameon=False)
    return figure


def _velocity_norms(frames: Frames, index: int) -> np.ndarray | None:
    """[cells] mean over the points of a triangle, m/s."""
    velocity = frames.field("bodies", index, "velocity")
    if velocity is None:
        return None
    return np.linalg.norm(velocity, axis=1)[frames.grids["bodies"].cells].mean(axis=1)


def _colour_scale(values: np.ndarray, unit: str, name: str, colours: str) -> tuple[ScalarMappable, float, str]:
    """A map from 0 to the 99.5 % quantile, so that a few extremes do not darken the rest."""
    largest = float(np.quantile(values, 0.995)) if len(values) else 0.0
    factor, scaled = units.scale(largest, unit)
    norm = Normalize(0.0, largest * factor if largest > 0 else 1.0)
    return ScalarMappable(norm, plt.get_cmap(colours)), factor, units.label(name, scaled)


def velocity(run: Run, indices: list[int]) -> Figure | None:
    """Norm of the velocity at several times, one scale for all."""
    assert run.frames is not None
    norms = [_velocity_norms(run.frames, index) for index in indices]
    if any(values is None for values in norms):
        return None
    sceneries = [scenery(run, index) for index in indices]
    box = common_box(sceneries)
    figure, axes = _sheet(box, len(indices), f"{run.title}: velocity", beside=1.2)
    mappable, factor, name = _colour_scale(np.concatenate(norms), "m/s", "velocity norm", "cividis")
    for panel, scene, values, index in zip(axes, sceneries, norms, indices):
        draw(panel, scene, mappable.to_rgba(values[scene.cells] * factor), box, 0.5 * _outline_width(scene))
        panel.set_title(f"t = {units.readable(run.frames.times[index], 's')}", fontsize=10, loc="left")
    figure.colorbar(mappable, ax=axes, label=name, extend="max", shrink=0.6)
    return figure


def _zoom_box(scene: Scenery, grain_size: float) -> tuple[float, float, float, float]:
    """A window of some ten grains in the middle, with the shape of a picture."""
    width = min(scene.width, 18 * grain_size)
    height = min(scene.height, 0.5 * width if scene.width > scene.height else width)
    x, y = 0.5 * (scene.box[0] + scene.box[1]), 0.5 * (scene.box[2] + scene.box[3])
    return x - width / 2, x + width / 2, y - height / 2, y + height / 2


def _grain_size(scene: Scenery, frames: Frames) -> float:
    """Diameter of the disc with the mean area of a grain, m."""
    a, b, c = scene.triangles[scene.kind != WALL].transpose(1, 0, 2)
    area = 0.5 * np.abs((b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])).sum()
    grid = frames.grids["bodies"]
    return float(np.sqrt(4 / np.pi * area / max(len(np.unique(grid.body[grid.kind != WALL])), 1)))


def von_mises(run: Run, index: int) -> Figure | None:
    """Von Mises stress of compliant grains, the whole and a window; rigid ones, which have none, are grey."""
    assert run.frames is not None
    stress = run.frames.field("bodies", index, "von_mises")
    if stress is None:
        return None
    scene = scenery(run, index)
    zoom = _zoom_box(scene, _grain_size(scene, run.frames))
    compliant = scene.kind == COMPLIANT
    mappable, factor, name = _colour_scale(stress[scene.cells[compliant]], "Pa", "von Mises stress", "inferno")
    colours = mappable.to_rgba(stress[scene.cells] * factor)
    colours[~compliant] = to_rgba_array(NEUTRAL)
    time = units.readable(run.frames.times[index], "s")
    figure, axes = _whole_and_window(scene, zoom, f"{run.title}: von Mises stress at t = {time}")
    for panel, box in zip(axes, (scene.box, zoom)):
        draw(panel, scene, colours, box, _outline_width(scene) if box == scene.box else 0.6)
    figure.colorbar(mappable, ax=axes, label=name, extend="max", shrink=0.6)
    return figure


def _whole_and_window(scene: Scenery, zoom: tuple[float, ...], title: str) -> tuple[Figure, list[Axes]]:
    """One above the other when the scene is wide, side by side otherwise; the window is marked in the whole."""
    ratios = [scene.width / scene.height, (zoom[1] - zoom[0]) / (zoom[3] - zoom[2])]
    if ratios[0] > 1.4:
        heights = [11 / ratio for ratio in ratios]
        figure, axes = plt.subplots(
            2, 1, figsize=(12.7, sum(heights) + 1.6), height_ratios=heights, layout="constrained"
        )
    else:
        figure, axes = plt.subplots(
            1, 2, figsize=(7 * sum(ratios) + 2.8, 8.0), width_ratios=ratios, layout="constrained"
        )
    figure.suptitle(title)
    for panel, box in zip(axes, (scene.box, zoom)):
        panel.set_xlabel(units.label("x", units.scale(max(box[1] - box[0], box[3] - box[2]), "m")[1]))
    factor = units.scale(max(scene.width, scene.height), "m")[0]
    frame = plt.Rectangle(
        (zoom[0] * factor, zoom[2] * factor),
        (zoom[1] - zoom[0]) * factor,
        (zoom[3] - zoom[2]) * factor,
        fill=False,
        edgecolor="#1f77b4",
        linewidth=1.5,
        zorder=5,
    )
    axes[0].add_patch(frame)
    return figure, list(axes)
