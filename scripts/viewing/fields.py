"""What the fields of frames are called, and the scale of each over all frames."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

STEPS = 1000  # that a colour scale is divided into; values beyond it are kept in the same steps
QUANTILE = 0.995
CONTACT_QUANTILE = 0.98  # of what acts along outlines: corners carry many times what faces do
_ONE_SIDED = 0.02  # a scale has one side where the other holds less than this share of it
_PER_OCTAVE, _OCTAVES = 64, 300


@dataclass(frozen=True)
class Look:
    """How a field is shown; docs/probes.md has the table of fields."""

    label: str
    unit: str
    colours: str = "inferno"  # of a scale with one side
    of_compliant: bool = True  # rigid bodies have none
    centre: float = 0.0
    span: tuple[float, float] | None = None  # where it is known beforehand
    step: float | None = None  # of whole numbers
    quantile: float = QUANTILE  # of magnitudes, that a scale ends at
    at: str = "cells"  # of the bodies' grid, or its "points", where a vector stands, or points of "outlines"

    @property
    def fixed(self) -> bool:
        """Its scale says all."""
        return self.step is not None or self.span is not None

    @property
    def grid(self) -> str:
        return "outlines" if self.at == "outlines" else "bodies"


def _motion(label: str, unit: str) -> Look:
    return Look(label, unit, "cividis", of_compliant=False, at="points")


def _number(label: str) -> Look:
    return Look(label, "-", "viridis", of_compliant=False, step=1.0)


def _contact(label: str, unit: str) -> Look:
    return Look(label, unit, "YlOrRd", of_compliant=False, quantile=CONTACT_QUANTILE, at="outlines")


LOOKS = {
    "displacement": _motion("displacement", "m"),
    "velocity": _motion("velocity", "m/s"),
    "acceleration": _motion("acceleration", "m/s2"),
    "von_mises": Look("von Mises stress", "Pa"),
    "tresca": Look("Tresca stress", "Pa"),
    "pressure": Look("pressure", "Pa"),
    "jacobian": Look("J, volume over that at the start", "-", centre=1.0),
    "strain_energy_density": Look("strain energy density", "J/m3"),
    "plastic_strain": Look("equivalent plastic strain", "-"),
    "temperature_rise": Look("rise of temperature", "K", of_compliant=False),
    "contact_count": _number("bodies in touch"),
    "material": _number("material"),
    "scale": Look("size over that of the shape", "-", "viridis", of_compliant=False),
    "contact_pressure": _contact("contact pressure", "Pa"),
    "contact_shear": _contact("contact shear", "Pa"),
    "bond_damage": Look("bond damage, 1 torn", "-", "turbo", of_compliant=False, span=(0.0, 1.0), at="outlines"),
    "fragment": Look("number of the fragment", "-", "prism", of_compliant=False, step=1.0),
    "contact_gap": _contact("contact gap", "m"),
    "contact_slip": _contact("contact slip", "m"),
    **{f"stress_{axes}": Look(f"stress {axes}", "Pa") for axes in ("xx", "yy", "xy", "zz")},
    **{f"principal_stress_{i}": Look(f"principal stress {i}", "Pa") for i in (1, 2)},
    **{f"strain_{axes}": Look(f"strain {axes}", "-") for axes in ("xx", "yy", "xy")},
}


@dataclass
class Scale:
    """Colours go from low to high; a value is stored as centre + step times a whole number."""

    low: float
    high: float
    centre: float
    step: float
    least: float  # of all values
    largest: float

    @property
    def two_sided(self) -> bool:
        return self.low < self.centre < self.high

    @property
    def negative(self) -> bool:
        return self.low < self.centre == self.high

    def codes(self, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Whole numbers, and where there is no value."""
        missing = ~np.isfinite(values)
        steps = np.rint((np.where(missing, self.centre, values) - self.centre) / self.step)
        return np.clip(steps, -(2.0**40), 2.0**40).astype(np.int64), missing


def rounded_up(value: float) -> float:
    """To two digits: scales end at numbers that can be read."""
    if value <= 0:
        return 1.0
    unit = 10.0 ** (math.floor(math.log10(value)) - 1)
    return math.ceil(value / unit * (1 - 1e-9)) * unit


@dataclass
class Spread:
    """Magnitudes on either side of a centre, counted in bins of a 64th of an octave: whatever the number of frames."""

    centre: float
    counts: np.ndarray = field(default_factory=lambda: np.zeros((2, _PER_OCTAVE * _OCTAVES), dtype=np.int64))
    least: float = math.inf
    largest: float = -math.inf

    def add(self, values: np.ndarray) -> None:
        values = values[np.isfinite(values)]
        if len(values) == 0:
            return
        self.least, self.largest = min(self.least, float(values.min())), max(self.largest, float(values.max()))
        apart = values[values != self.centre] - self.centre
        bins = np.floor(_PER_OCTAVE * (np.log2(np.abs(apart)) + _OCTAVES // 2)).astype(int)
        bins = np.clip(bins, 0, self.counts.shape[1] - 1)
        for side, chosen in enumerate((apart > 0, apart < 0)):
            self.counts[side] += np.bincount(bins[chosen], minlength=self.counts.shape[1])

    @staticmethod
    def _quantile(counts: np.ndarray, share: float) -> float:
        """Upper edge of the bin where it lies, 0 without values."""
        if counts.sum() == 0:
            return 0.0
        index = int(np.searchsorted(counts.cumsum(), share * counts.sum()))
        return 2.0 ** ((index + 1) / _PER_OCTAVE - _OCTAVES // 2)

    def scale(self, look: Look) -> Scale:
        """From the centre, or on both sides of it, to what all but some values stay in."""
        least, largest = (self.centre, self.centre) if self.least > self.largest else (self.least, self.largest)
        if look.span is not None:
            low, high = look.span
        else:
            low, high = self._limits(look)
        return Scale(low, high, self.centre, look.step or (high - low) / STEPS, least, largest)

    def _limits(self, look: Look) -> tuple[float, float]:
        above, below = (self._quantile(counts, look.quantile) for counts in self.counts)
        extremes = self.largest - self.centre, self.centre - self.least
        if look.step is not None:
            return 0.0, max(1.0, self.largest)
        if below <= _ONE_SIDED * above:
            return self.centre, self.centre + self._end(above, extremes[0])
        if above <= _ONE_SIDED * below:
            return self.centre - self._end(below, extremes[1]), self.centre
        end = self._end(self._quantile(self.counts.sum(axis=0), look.quantile), max(extremes))
        return self.centre - end, self.centre + end

    @staticmethod
    def _end(quantile: float, extreme: float) -> float:
        """The extreme itself where it is hardly further: then nothing lies beyond."""
        return rounded_up(extreme if extreme <= 1.25 * quantile else quantile)
