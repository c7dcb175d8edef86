"""Maps of bodies: kinds, velocity norm, von Mises stress, damage of bonds, fragments, and any other field."""

import numpy as np
from matplotlib.figure import Figure

from pliant import units
from plots.drawing import draw, finish_sheet, outline_width, place, sheet, whole_and_window
from plots.fields import FRAGMENT, Field, Fragments, Kinds
from plots.scenery import Scenery, scenery, whole_box
from plots.wrapping import Box
from pliant.frames import COMPLIANT, WALL, Frames
from pliant.results import Run


def grains(run: Run, indices: list[int]) -> Figure:
    """Compliant and rigid grains at several times (the paper's figure 7 and 10)."""
    kinds = Kinds(run.frames)
    figure = _sheet(run, indices, kinds)
    strip = 0.35 / figure.get_figheight()
    figure.get_layout_engine().set(rect=(0, strip, 1, 1 - strip))
    figure.legend(handles=kinds.legend, loc="lower right", ncols=3, frameon=False)
    return figure


def _sheet(run: Run, indices: list[int], shown: Kinds | Field | Fragments) -> Figure:
    """Several times on one scale."""
    box = whole_box(run, indices)
    bar = isinstance(shown, Field)
    figure, axes = sheet(box, len(indices), f"{run.title}: {shown.title}", beside=1.4 * bar)
    for panel, index in zip(axes, indices):
        scene = scenery(run, index, box)
        place(panel, box)
        draw(panel, scene, shown.paint(scene, index, box), box, outline_width(scene))
    finish_sheet(axes, [run.frames.times[index] for index in indices])
    if bar:
        _add_colour_bar(figure, axes, shown)
    return figure


def _add_colour_bar(figure: Figure, axes: list, shown: Field) -> None:
    shown.scale.bar(figure, ax=axes, label=shown.label, shrink=0.8, aspect=30, pad=0.02)


def _has(frames: Frames, name: str) -> bool:
    return any(name in frames.names(grid) for grid in frames.grids)


def velocity(run: Run, indices: list[int]) -> Figure | None:
    """Norm of the velocity."""
    return _sheet(run, indices, Field(run.frames, "velocity", indices)) if _has(run.frames, "velocity") else None


def others(frames: Frames) -> list[str]:
    """Fields of bodies and outlines that have no picture of their own."""
    own = {"velocity", "von_mises", "bond_damage", FRAGMENT, "material", "scale"}
    return [name for grid in frames.grids for name in frames.names(grid) if name not in own]


def field(run: Run, indices: list[int], name: str) -> Figure:
    """Any field, vectors by their norm."""
    return _sheet(run, indices, Field(run.frames, name, indices))


def damage(run: Run, indices: list[int]) -> Figure | None:
    """Bonds on the outlines that they join, from whole to torn."""
    return _sheet(run, indices, Field(run.frames, "bond_damage", indices)) if _has(run.frames, "bond_damage") else None


def fragments(run: Run, indices: list[int]) -> Figure | None:
    """Grains, and cells that bonds hold together, each in its colour."""
    return _sheet(run, indices, Fragments(run.frames)) if _has(run.frames, FRAGMENT) else None


def _window(box: Box, grain_size: float) -> Box:
    """Some ten grains in the middle, with the shape of a picture."""
    wide, high = box[1] - box[0], box[3] - box[2]
    width = min(wide, 18 * grain_size)
    height = min(high, 0.5 * width if wide > high else width)
    x, y = 0.5 * (box[0] + box[1]), 0.5 * (box[2] + box[3])
    return x - width / 2, x + width / 2, y - height / 2, y + height / 2


def _grain_size(scene: Scenery, frames: Frames) -> float:
    """Diameter of the disc with the mean area of a grain, m."""
    a, b, c = scene.triangles.transpose(1, 0, 2)
    area = 0.5 * np.abs((b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])).sum()
    grid = frames.grids["bodies"]
    return float(np.sqrt(4 / np.pi * area / max(len(np.unique(grid.body[grid.kind != WALL])), 1)))


def von_mises(run: Run, indices: list[int]) -> Figure | None:
    """Von Mises stress of compliant grains; rigid ones, which have none, are grey.

    Scenes of many grains: the whole and a window at the last time; others: all times on one scale.
    """
    if not _has(run.frames, "von_mises") or not (run.frames.grids["bodies"].kind == COMPLIANT).any():
        return None
    scene, box = scenery(run, indices[-1]), whole_box(run, indices[-1:])
    window = _window(box, _grain_size(scene, run.frames))
    if (window[1] - window[0]) * (window[3] - window[2]) >= 0.6 * (box[1] - box[0]) * (box[3] - box[2]):
        return _sheet(run, indices, Field(run.frames, "von_mises", indices))
    shown = Field(run.frames, "von_mises", indices[-1:])
    time = units.readable(run.frames.times[indices[-1]], "s")
    figure, axes = whole_and_window(box, window, f"{run.title}: {shown.title} at t = {time}")
    for panel, part, width in zip(axes, (box, window), (outline_width(scene), 0.6)):
        place(panel, part)
        seen = scenery(run, indices[-1], part)
        draw(panel, seen, shown.paint(seen, indices[-1], part), part, width)
    _add_colour_bar(figure, axes, shown)
    return figure
