"""The frames of a film, one by one: the picture, and under it a curve over time with a mark at the frame's time."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from pliant import units
from plots.camera import Camera
from plots.curves import COLOURS
from plots.drawing import draw, outline_width, place
from plots.fields import Field, Kinds
from plots.friction import force_sources, loaded
from plots.history import draw_history
from plots.scenery import scenery
from pliant.results import Column, Run

# Inches. Letters are as large as on a sheet of paper in films of the usual width, and never too small to be read.
_USUAL_WIDTH, _DOTS_PER_INCH, _FEWEST_DOTS = 1280, 100, 75
_LEFT, _RIGHT, _TOP, _BELOW = 0.75, 0.25, 0.42, 0.55
_BAR, _BAR_PLACE, _LEGEND = 0.14, 0.75, 0.22
_CURVE, _CURVE_TITLE = 1.0, 0.3
_HIGHEST = 0.62  # of the picture, over the film's width


@dataclass
class Curve:
    """A column of the probes in the time of the film."""

    title: str
    time: np.ndarray
    values: np.ndarray


def curve_of(run: Run, column: Column, start: float, end: float) -> Curve | None:
    """None: it has no values there. A friction factor counts where its wall is pressed."""
    table = run.probes
    time, values = table.sampled(column)
    of = run.probe_of.get(column.source, "")
    if column.name == "friction_factor":
        for source in force_sources(table):
            if run.probe_of.get(source, source) == (of or column.source):
                values = np.where(loaded(table, source, time), values, np.nan)
    there = (time >= start) & (time <= end)
    time, values = time[there], values[there]
    if not np.isfinite(values).any():
        return None
    factor, unit = units.scale(float(np.nanmax(np.abs(values))), column.unit)
    quantity = column.name.replace("_", " ")
    name = f"{quantity} of '{of}'" if of else f"{column.source}: {quantity}".removeprefix(": ")
    return Curve(units.label(name, unit), time, values * factor)


class Film:
    """Draws what stands still once, and on it what moves."""

    def __init__(self, run: Run, indices: Sequence[int], camera: Camera, shown: Kinds | Field, curve: Curve | None,
                 width: int) -> None:
        self._run, self._indices, self._camera, self._shown = run, indices, camera, shown
        self._times = run.frames.times[list(indices)]
        self._factor, self._unit = units.scale(float(self._times[-1]), "s")
        self._decimals = _decimals(self._times * self._factor)
        self._dots = _DOTS_PER_INCH * max(width / _USUAL_WIDTH, _FEWEST_DOTS / _DOTS_PER_INCH)
        self._lay_out(width, curve)
        self._line_width = outline_width(scenery(run, indices[0], camera.box, camera.origins[0]))
        self._canvas.draw()
        self._still = self._canvas.copy_from_bbox(self._figure.bbox)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height, pixels."""
        return self._canvas.get_width_height()

    def _lay_out(self, width: int, curve: Curve | None) -> None:
        left, right, low, high = self._camera.box
        bar = isinstance(self._shown, Field)
        room, ratio = width / self._dots - _LEFT - (_BAR_PLACE if bar else _RIGHT), (right - left) / (high - low)
        map_height = min(room / ratio, _HIGHEST * width / self._dots)
        map_left = _LEFT + 0.5 * (room - map_height * ratio)
        below = _BELOW + (0.0 if bar else _LEGEND) + (_CURVE_TITLE + _CURVE + _BELOW if curve else 0.0)
        rows = 2 * round(0.5 * self._dots * (below + map_height + _TOP))
        self._page = np.array([width, rows]) / self._dots
        self._figure = Figure(figsize=(self._page + 0.1 / self._dots), dpi=self._dots)  # rounds down to these pixels
        self._canvas = FigureCanvasAgg(self._figure)
        self._map = self._axes(map_left, below, map_height * ratio, map_height)
        place(self._map, self._camera.box, self._camera.names)
        for axis, inches in ((self._map.xaxis, 1.0 * map_height * ratio), (self._map.yaxis, 2.0 * map_height)):
            axis.set_major_locator(MaxNLocator(int(np.clip(inches, 3, 9)), steps=[1, 2, 5, 10]))
        self._add_texts()
        if bar:
            self._add_bar(self._axes(map_left + map_height * ratio + 0.12, below, _BAR, map_height))
        self._marks = self._add_curve(curve, self._axes(_LEFT, _BELOW, room, _CURVE)) if curve else []

    def _axes(self, left: float, bottom: float, width: float, height: float) -> Axes:
        """In inches from the lower left corner."""
        return self._figure.add_axes(np.array([left, bottom, width, height]) / np.tile(self._page, 2))

    def _add_texts(self) -> None:
        width, height = self._page
        line, right = 1 - 0.5 * _TOP / height, 1 - _RIGHT / width
        self._clock = self._figure.text(right, line, self._time_text(-1), ha="right", va="center", fontsize=11)
        self._clock.set_animated(True)
        shown = self._shown.label if isinstance(self._shown, Field) else self._shown.title
        title = self._figure.text(_LEFT / width, line, "", va="center", fontsize=11)
        renderer = self._canvas.get_renderer()
        room = self._clock.get_window_extent(renderer).x0 - (_LEFT + 0.2) * self._dots
        for run_title in _shortened(self._run.title):
            title.set_text(f"{run_title}: {shown}")
            if title.get_window_extent(renderer).width <= room:
                break
        if isinstance(self._shown, Kinds):
            row = self._map.get_position().y0 - (_BELOW + 0.8 * _LEGEND) / height
            self._figure.legend(handles=self._shown.legend, loc="lower right", bbox_to_anchor=(right, row), ncols=3,
                                frameon=False, fontsize=9, borderaxespad=0, borderpad=0, columnspacing=1.2)

    def _add_bar(self, axes: Axes) -> None:
        bar = self._shown.scale.bar(self._figure, cax=axes)
        bar.ax.tick_params(labelsize=9)

    def _add_curve(self, curve: Curve, axes: Axes) -> list[Artist]:
        """The marks that move on it."""
        self._curve = curve
        draw_history(axes, curve.time * self._factor, curve.values, COLOURS[0])
        axes.set_xlim(self._times[0] * self._factor, self._times[-1] * self._factor)
        axes.set_title(curve.title, fontsize=9, loc="left", pad=4)
        axes.set_xlabel(units.label("time", self._unit))
        axes.xaxis.set_major_locator(MaxNLocator(9, steps=[1, 2, 5, 10]))
        axes.yaxis.set_major_locator(MaxNLocator(4, steps=[1, 2, 5, 10]))
        axes.grid(alpha=0.3)
        line = axes.axvline(self._times[0] * self._factor, color=COLOURS[1], linewidth=1.3, animated=True)
        dot = axes.plot([], [], "o", color=COLOURS[1], markersize=5, animated=True, clip_on=False)[0]
        return [line, dot]

    def _time_text(self, number: int) -> str:
        """As wide as that of the last frame: figure spaces are as wide as figures."""
        last, text = (f"{self._times[n] * self._factor:.{self._decimals}f}" for n in (-1, number))
        return f"t = {text.rjust(len(last), chr(0x2007))} {self._unit}"

    def frame(self, number: int) -> bytes:
        """Rows of pixels from the top, four bytes each: red, green, blue, and one without meaning."""
        self._canvas.restore_region(self._still)
        index, box = self._indices[number], self._camera.box
        scene = scenery(self._run, index, box, self._camera.origins[number])
        painting = self._shown.paint(scene, index, box)
        artists = draw(self._map, scene, painting, box, self._line_width, self._camera.body)
        for artist in sorted(artists, key=lambda a: a.get_zorder()):
            self._map.draw_artist(artist)
            artist.remove()
        for spine in self._map.spines.values():
            self._map.draw_artist(spine)
        self._clock.set_text(self._time_text(number))
        self._figure.draw_artist(self._clock)
        self._move_marks(number)
        return bytes(self._canvas.buffer_rgba())

    def _move_marks(self, number: int) -> None:
        if not self._marks:
            return
        time, (line, dot) = self._times[number], self._marks
        line.set_xdata([time * self._factor] * 2)
        there = np.isfinite(self._curve.values)
        value = np.interp(time, self._curve.time[there], self._curve.values[there], left=np.nan, right=np.nan)
        dot.set_data([time * self._factor], [value])
        for mark in self._marks:
            mark.axes.draw_artist(mark)


def _decimals(times: np.ndarray) -> int:
    """That tell one frame from the next."""
    step = np.diff(times).min()
    return next((d for d in range(4) if np.abs(times - times.round(d)).max() < 0.05 * step), 4)


def _shortened(title: str) -> list[str]:
    """The title, and less and less of it."""
    return [title, *(f"{title[:count].rstrip()}..." for count in range(len(title) - 1, 0, -1))]
