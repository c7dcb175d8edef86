"""Coarse fields: solid fraction, velocity and pressure as means over cells, at the last of the times."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from pliant import units
from pliant.coarse import CoarseFields, coarse_fields
from pliant.results import Run
from plots.drawing import place, sheet
from plots.scenery import whole_box

CELL = 1.0  # mean diameters of the grains
FEWEST = 50  # grains, that cells say something


def coarse(run: Run, indices: list[int]) -> Figure | None:
    """None for few grains, and in a cell with two periods, which leans."""
    if run.frames.in_cell:
        return None
    index = indices[-1]
    grains = run.frames.bodies("grain")
    if len(grains) < FEWEST:
        return None
    fields = coarse_fields(run.frames, index, CELL * _mean_diameter(run, index))
    panels = _panels(fields)
    box = whole_box(run, [index])
    time = units.readable(run.frames.times[index], "s")
    figure, axes = sheet(box, len(panels), f"{run.title}: means over cells at t = {time}", beside=1.4)
    for panel, (name, values, unit, colours, symmetric) in zip(axes, panels):
        _draw(panel, fields, values, name, unit, colours, symmetric, box)
    columns = axes[0].get_gridspec().ncols
    for number, panel in enumerate(axes):
        lowest = number + columns >= len(axes)
        panel.tick_params(labelbottom=lowest, labelleft=number % columns == 0)
        panel.xaxis.label.set_visible(lowest)
        panel.yaxis.label.set_visible(number % columns == 0)
    return figure


def _mean_diameter(run: Run, index: int) -> float:
    """Of grains, of discs of the same area, from the triangles."""
    corners = run.frames.positions("bodies", index)[run.frames.grids["bodies"].cells]
    (ax, ay), (bx, by) = (np.moveaxis(corners[:, k] - corners[:, 0], 1, 0) for k in (1, 2))
    area = 0.5 * np.abs(ax * by - ay * bx).sum() / len(run.frames.bodies("grain"))
    return float(2 * np.sqrt(area / np.pi))


def _panels(fields: CoarseFields) -> list[tuple[str, np.ndarray, str, str, bool]]:
    """Name, values, unit, colours, and whether the scale is the same both ways."""
    panels = [("solid fraction", fields.solid_fraction, "-", "viridis", False)]
    if fields.velocity is not None:
        panels += [(f"velocity {axis}", fields.velocity[:, :, i], "m/s", "RdBu_r", True) for i, axis in enumerate("xy")]
    if fields.stress is not None:
        panels.append(("pressure of contacts", fields.pressure, "Pa", "inferno", False))
        panels.append(("shear stress of contacts", 0.5 * (fields.stress[:, :, 0, 1] + fields.stress[:, :, 1, 0]), "Pa",
                       "PuOr", True))
    return panels


def _draw(axes: Axes, fields: CoarseFields, values: np.ndarray, name: str, unit: str, colours: str, symmetric: bool,
          box: tuple[float, float, float, float]) -> None:
    largest = float(np.nanquantile(np.abs(values), 0.995)) or 1.0
    factor, scaled = units.scale(largest, unit)
    length, _ = units.scale(max(box[1] - box[0], box[3] - box[2]), "m")
    low = -largest if symmetric else min(0.0, float(np.nanquantile(values, 0.005)))
    picture = axes.imshow(values * factor, origin="lower", extent=np.multiply(fields.box, length), cmap=colours,
                          vmin=low * factor, vmax=largest * factor, interpolation="nearest", aspect="equal")
    place(axes, box)
    axes.figure.colorbar(picture, ax=axes, label=units.label(name, scaled), extend="both" if symmetric else "max",
                         shrink=0.8, pad=0.02)
