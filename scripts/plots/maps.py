"""Maps of bodies: kinds, velocity norm, von Mises stress, damage of bonds."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize, to_rgba_array
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from pliant import units
from plots.drawing import EDGE, KIND_COLOURS, Box, draw, draw_coloured, finish_sheet, outline_width, sheet, whole_and_window
from plots.scenery import Scenery, common_box, refined, scenery
from pliant.frames import COMPLIANT, RIGID, WALL, Frames
from pliant.results import Run

NEUTRAL = "#c9c9c9"
# Colours of a quantity that is not linear over a triangle are exact at this share of the picture's width.
_RESOLUTION = 1 / 200


def _times(run: Run, indices: list[int]) -> list[float]:
    assert run.frames is not None
    return [run.frames.times[index] for index in indices]


def grains(run: Run, indices: list[int]) -> Figure:
    """Compliant and rigid grains at several times (the paper's figure 7 and 10)."""
    sceneries = [scenery(run, index) for index in indices]
    box = common_box(sceneries)
    figure, axes = sheet(box, len(indices), f"{run.title}: grains")
    for panel, scene in zip(axes, sceneries):
        draw(panel, scene, scene.triangles, to_rgba_array(KIND_COLOURS)[scene.kind], box, outline_width(scene))
    finish_sheet(axes, _times(run, indices))
    shown = [k for k in (COMPLIANT, RIGID, WALL) if k in sceneries[0].kind or (k == WALL and len(sceneries[0].walls))]
    names = {COMPLIANT: "compliant", RIGID: "rigid", WALL: "wall"}
    handles = [Patch(facecolor=KIND_COLOURS[k], edgecolor=EDGE, label=names[k]) for k in shown]
    strip = 0.35 / figure.get_figheight()
    figure.get_layout_engine().set(rect=(0, strip, 1, 1 - strip))
    figure.legend(handles=handles, loc="lower right", ncols=3, frameon=False)
    return figure


def _colour_scale(values: np.ndarray, unit: str, name: str, colours: str) -> tuple[ScalarMappable, float, str]:
    """A map from 0 to the 99.5 % quantile, so that a few extremes do not darken the rest."""
    largest = float(np.quantile(values, 0.995)) if len(values) else 0.0
    factor, scaled = units.scale(largest, unit)
    norm = Normalize(0.0, largest * factor if largest > 0 else 1.0)
    return ScalarMappable(norm, plt.get_cmap(colours)), factor, units.label(name, scaled)


def _add_colour_bar(figure: Figure, axes: list[Axes], mappable: ScalarMappable, name: str, largest: float) -> None:
    """With an arrow where some values lie above the scale."""
    beyond = "max" if largest > 1.001 * mappable.norm.vmax else "neither"
    figure.colorbar(mappable, ax=axes, label=name, extend=beyond, shrink=0.8, aspect=30, pad=0.02)


def velocity(run: Run, indices: list[int]) -> Figure | None:
    """Norm of the velocity at several times, one scale for all."""
    assert run.frames is not None
    fields = [run.frames.field("bodies", index, "velocity") for index in indices]
    if any(field is None for field in fields):
        return None
    sceneries = [scenery(run, index) for index in indices]
    box = common_box(sceneries)
    figure, axes = sheet(box, len(indices), f"{run.title}: velocity", beside=1.4)
    norms = np.concatenate([np.linalg.norm(field, axis=1) for field in fields])
    mappable, factor, name = _colour_scale(norms, "m/s", "velocity norm", "cividis")
    for panel, scene, field in zip(axes, sceneries, fields):
        corners = field[run.frames.grids["bodies"].cells][scene.cells]
        triangles, vectors = refined(scene.triangles, corners, _RESOLUTION * (box[1] - box[0]))
        colours = mappable.to_rgba(np.linalg.norm(vectors, axis=2) * factor)
        draw(panel, scene, triangles, colours, box, 0.5 * outline_width(scene))
    finish_sheet(axes, _times(run, indices))
    _add_colour_bar(figure, axes, mappable, name, norms.max() * factor)
    return figure


def _window(scene: Scenery, grain_size: float) -> Box:
    """Some ten grains in the middle, with the shape of a picture."""
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


def von_mises(run: Run, indices: list[int]) -> Figure | None:
    """Von Mises stress of compliant grains; rigid ones, which have none, are grey.

    Scenes of many grains: the whole and a window at the last time; others: all times on one scale.
    """
    assert run.frames is not None
    last = scenery(run, indices[-1])
    window = _window(last, _grain_size(last, run.frames))
    windowed = (window[1] - window[0]) * (window[3] - window[2]) < 0.6 * last.width * last.height
    chosen = indices[-1:] if windowed else indices
    stresses = [run.frames.field("bodies", index, "von_mises") for index in chosen]
    compliant = run.frames.grids["bodies"].kind == COMPLIANT
    if any(stress is None for stress in stresses) or not compliant.any():
        return None
    sceneries = [last] if windowed else [scenery(run, index) for index in chosen]
    values = np.concatenate([stress[compliant] for stress in stresses])
    mappable, factor, name = _colour_scale(values, "Pa", "von Mises stress", "inferno")
    colours = [_stress_colours(scene, stress * factor, mappable) for scene, stress in zip(sceneries, stresses)]
    title, times = f"{run.title}: von Mises stress", _times(run, chosen)
    if windowed:
        figure, axes = whole_and_window(last, window, f"{title} at t = {units.readable(times[0], 's')}")
        draw(axes[0], last, last.triangles, colours[0], last.box, outline_width(last))
        draw(axes[1], last, last.triangles, colours[0], window, 0.6)
    else:
        box = common_box(sceneries)
        figure, axes = sheet(box, len(chosen), title, beside=1.4)
        for panel, scene, colour in zip(axes, sceneries, colours):
            draw(panel, scene, scene.triangles, colour, box, outline_width(scene))
        finish_sheet(axes, times)
    _add_colour_bar(figure, axes, mappable, name, values.max() * factor)
    return figure


def damage(run: Run, indices: list[int]) -> Figure | None:
    """Bonds of the first frame, on the outlines that they join: from whole to torn. Bonds never form later."""
    assert run.frames is not None
    fields = {index: run.frames.field("outlines", index, "contact_damage") for index in {0, *indices}}
    if any(field is None for field in fields.values()):
        return None
    bonded = fields[0] < 1
    if not bonded.any():
        return None
    sceneries = [scenery(run, index) for index in indices]
    box = common_box(sceneries)
    figure, axes = sheet(box, len(indices), f"{run.title}: damage of bonds", beside=1.4)
    mappable = ScalarMappable(Normalize(0, 1), plt.get_cmap("turbo"))
    ends = run.frames.grids["outlines"].cells
    for panel, scene, index in zip(axes, sceneries, indices):
        draw(panel, scene, scene.triangles, np.tile(to_rgba_array(NEUTRAL), (len(scene.triangles), 1)), box, 0)
        joined = bonded[ends[scene.edge_cells]].all(axis=1)
        values = fields[index][ends[scene.edge_cells[joined]]].mean(axis=1)
        draw_coloured(panel, scene.edges[joined], mappable.to_rgba(values), box, 4 * outline_width(scene))
    finish_sheet(axes, _times(run, indices))
    figure.colorbar(mappable, ax=axes, label="damage: 0 whole, 1 torn", shrink=0.8, aspect=30, pad=0.02)
    return figure


def _stress_colours(scene: Scenery, stress: np.ndarray, mappable: ScalarMappable) -> np.ndarray:
    """[triangles x 4]"""
    colours = mappable.to_rgba(stress[scene.cells])
    colours[scene.kind != COMPLIANT] = to_rgba_array(NEUTRAL)
    return colours
