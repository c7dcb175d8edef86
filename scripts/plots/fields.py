"""What colours mean: kinds of bodies, or a field of the frames on a scale that several frames share."""

from collections.abc import Sequence
from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colorbar import Colorbar
from matplotlib.colors import Colormap, ListedColormap, Normalize, to_rgba_array
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from pliant import units
from plots.drawing import EDGE, KIND_COLOURS, Painting
from plots.scenery import Scenery, refined
from plots.wrapping import Box
from pliant.frames import COMPLIANT, RIGID, WALL, BadFolder, Frames
from pliant.results import Run

NEUTRAL = "#c9c9c9"
KINDS, FRAGMENT = "kinds", "fragment"
UNITS = {"displacement": "m", "velocity": "m/s", "acceleration": "m/s2", "strain_energy_density": "J/m3", "temperature_rise": "K",
         **dict.fromkeys(("von_mises", "tresca", "pressure", "stress_xx", "stress_yy", "stress_xy", "stress_zz",
                          "principal_stress_1", "principal_stress_2", "contact_pressure", "contact_shear"), "Pa"),
         **dict.fromkeys(("contact_gap", "contact_slip"), "m")}
_TITLES = {"von_mises": "von Mises stress", "tresca": "Tresca stress", "jacobian": "volume over that at the start",
           "plastic_strain": "equivalent plastic strain", "temperature_rise": "rise of temperature since the start",
           "bond_damage": "damage of bonds: 0 whole, 1 torn"}
_COLOURS = {"velocity": "cividis", "displacement": "cividis", "acceleration": "cividis", "bond_damage": "turbo",
            "contact_count": "viridis", "material": "viridis", "scale": "viridis"}
_OF_ANY_GRAIN = {"temperature_rise", "contact_count", "material", "scale"}  # other fields of cells are of what deforms
# Colours of a quantity that is not linear over a triangle are exact at this share of the picture's width.
_RESOLUTION = 1 / 200
_MOST_VALUES = 500_000  # of a frame, for the scale


class Kinds:
    """Compliant and rigid grains, and walls."""

    title = "grains"

    def __init__(self, frames: Frames) -> None:
        there = np.unique(np.concatenate([grid.kind for grid in frames.grids.values()]))
        names = {COMPLIANT: "compliant", RIGID: "rigid", WALL: "wall"}
        self.legend = [Patch(facecolor=KIND_COLOURS[k], edgecolor=EDGE, label=names[k]) for k in names if k in there]

    def paint(self, scene: Scenery, index: int, box: Box) -> Painting:
        return Painting(scene.triangles, to_rgba_array(KIND_COLOURS)[scene.kind])


class Fragments:
    """Grains, and cells that bonds hold together: a colour for each number."""

    title = "fragments"
    _TURN = (5**0.5 - 1) / 2  # golden section: hues of consecutive numbers are far apart

    def __init__(self, frames: Frames) -> None:
        self.frames = frames

    def paint(self, scene: Scenery, index: int, box: Box) -> Painting:
        number = self.frames.field("bodies", index, FRAGMENT)[scene.cells]
        colours = plt.get_cmap("hsv")(number * self._TURN % 1)
        colours[:, :3] = 0.35 + 0.65 * colours[:, :3]
        colours[number < 0] = to_rgba_array(NEUTRAL)
        return Painting(scene.triangles, colours)


@dataclass
class Scale:
    """Colours of numbers, in a unit that suits them."""

    mappable: ScalarMappable
    factor: float  # from SI
    unit: str
    beyond: str  # where some values lie outside: "neither", "min", "max", "both"

    def colours(self, values: np.ndarray) -> np.ndarray:
        return self.mappable.to_rgba(values * self.factor)

    def bar(self, figure: Figure, **places: Axes | list[Axes] | float | str) -> Colorbar:
        bar = figure.colorbar(self.mappable, extend=self.beyond, **places)
        bar.formatter.set_useOffset(False)
        return bar


def scale_of(values: np.ndarray, unit: str, colours: str, centre: float = 0.0) -> Scale:
    """Between quantiles, so that a few extremes do not darken the rest: from the centre where nearly all values lie
    above it, else as far to either side of it in colours that tell the sides apart."""
    low, high = np.quantile(values - centre, [0.005, 0.995]) if len(values) else (0.0, 0.0)
    colour_map = plt.get_cmap(colours)
    if centre != 0 or low < -0.05 * abs(high):
        low, high = min(low, 0.0), max(high, 0.0)
        colour_map = _about_zero(low, high)
    else:
        low = 0.0
    reach = max(-low, high)
    if reach == 0:
        high = reach = 1.0
    factor, scaled = units.scale(abs(centre) + reach, unit)
    sides = (bool(np.any(values < centre + low - 1e-3 * reach)), bool(np.any(values > centre + high + 1e-3 * reach)))
    beyond = {(False, False): "neither", (True, False): "min", (False, True): "max", (True, True): "both"}[sides]
    norm = Normalize((centre + low) * factor, (centre + high) * factor)
    return Scale(ScalarMappable(norm, colour_map), factor, scaled, beyond)


def _about_zero(low: float, high: float) -> Colormap:
    """Blue below and red above, the same distance as strong on either side; what neither side needs is cut off."""
    both = plt.get_cmap("RdBu_r")
    reach = max(-low, high) or 1.0
    return ListedColormap(both(np.linspace(0.5 + 0.5 * low / reach, 0.5 + 0.5 * high / reach, 256)))


class Field:
    """One field of the frames: over grains by points or cells, or along outlines."""

    def __init__(self, frames: Frames, name: str, sample: Sequence[int]) -> None:
        """`sample`: the frames that the scale is made of."""
        self.frames, self.name = frames, name
        self.grid = next(grid for grid in frames.grids if name in frames.names(grid))
        vector = self._raw(sample[0]).ndim == 2
        self.title = _TITLES.get(name, name.replace("_", " ") + " norm" * vector)
        colours = _COLOURS.get(name, "inferno" if self.grid == "bodies" else "YlOrRd")
        if name == "bond_damage":
            self.scale = Scale(ScalarMappable(Normalize(0, 1), plt.get_cmap(colours)), 1.0, "-", "neither")
        else:
            found = np.concatenate([self._shown(index) for index in sample])
            self.scale = scale_of(found, UNITS.get(name, "-"), colours, centre=1.0 if name == "jacobian" else 0.0)

    @property
    def label(self) -> str:
        return units.label(self.title, self.scale.unit)

    def paint(self, scene: Scenery, index: int, box: Box) -> Painting:
        if self.grid == "outlines":
            return self._along_outlines(scene, index)
        grid, raw = self.frames.grids["bodies"], self._raw(index)
        if len(raw) == len(grid.cells):
            colours = self.scale.colours(raw[scene.cells])
            if self.name not in _OF_ANY_GRAIN:
                colours[scene.kind != COMPLIANT] = to_rgba_array(NEUTRAL)
            return Painting(scene.triangles, colours)
        corners = raw.reshape(len(raw), -1)[grid.cells[scene.cells]]
        triangles, values = refined(scene.triangles, corners, _RESOLUTION * (box[1] - box[0]))
        return Painting(triangles, self.scale.colours(_norm(values) if raw.ndim == 2 else values[:, :, 0]))

    def _along_outlines(self, scene: Scenery, index: int) -> Painting:
        ends = self.frames.grids["outlines"].cells[scene.edge_cells]
        values, shown = self._values(index), self._is_shown(index)
        there = shown[ends].all(axis=1)
        grey = np.tile(to_rgba_array(NEUTRAL), (len(scene.triangles), 1))
        return Painting(scene.triangles, grey, scene.edges[there], self.scale.colours(values[ends[there]].mean(axis=1)))

    def _raw(self, index: int) -> np.ndarray:
        raw = self.frames.field(self.grid, index, self.name)
        if raw is None:
            raise BadFolder(f"{self.frames.path}: frame {index} of '{self.grid}' has no {self.name}")
        return raw

    def _values(self, index: int) -> np.ndarray:
        raw = self._raw(index)
        return _norm(raw) if raw.ndim == 2 else raw

    def _is_shown(self, index: int) -> np.ndarray:
        """Of points of outlines: those in touch, or bonded."""
        values = self._values(index)
        return np.isfinite(values) & ((values != 0) | (self.name == "bond_damage"))

    def _shown(self, index: int) -> np.ndarray:
        """Values that count for the scale."""
        values, grid = self._values(index), self.frames.grids[self.grid]
        if self.grid == "outlines":
            values = values[self._is_shown(index)]
        elif len(values) == len(grid.cells) and self.name not in _OF_ANY_GRAIN:
            values = values[grid.kind == COMPLIANT]
        return values[:: len(values) // _MOST_VALUES + 1].astype(float)


def _norm(vectors: np.ndarray) -> np.ndarray:
    return np.linalg.norm(vectors, axis=-1)


def names(run: Run) -> list[str]:
    """All that colours can show of a run with frames."""
    return [KINDS, *(name for grid in run.frames.grids for name in run.frames.names(grid))]
