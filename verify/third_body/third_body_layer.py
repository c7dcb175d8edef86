"""A run of the third body's scene, evaluated from its probes and frames."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pliant.frames import Frames
from pliant.order import Neighbours, bond_order, kept_fraction, like_fraction, neighbours
from time_means import block_means
from verification import Run

DIAMETER = 1e-6  # m
NEIGHBOUR = 1.3  # diameters between centres: between the hexagonal packing's first neighbours, 1, and second, 1.73
PRESSED = 1e-6  # s, when the pressure is complete and shear begins
SAMPLING = 5e-9  # s, of forces
SMOOTHED = 10  # samples of forces per mean: 50 ns, as the paper's curves are smooth
PLATEAU = 2.4e-6  # s: 0.35 us after failure of the lattice, more than three diameters of slip
BLOCK = 40  # samples, 0.2 us: four to nine times the correlation time of friction on the plateau
SHORT_BLOCK = 10  # samples, 50 ns: eight times that of the normal force less the change of momentum
BREAK = 1e-7  # s: width of the line in the paper's figure 9
AFTERMATH = 3e-7  # s after the peak: friction is that of the broken lattice from BREAK until then


@dataclass
class Layer:
    name: str
    run: Run
    period: float  # m

    @cached_property
    def frames(self) -> Frames:
        return Frames(self.run.folder / "frames.h5", self.period)

    @cached_property
    def grains(self) -> np.ndarray:
        return self.frames.bodies("grain")

    @cached_property
    def kinds(self) -> np.ndarray:
        """[grains] 0 compliant, 1 rigid."""
        return self.frames.kinds[self.grains]

    @cached_property
    def neighbours(self) -> list[Neighbours]:
        """By frame."""
        return [neighbours(self.frames.centres(i)[self.grains], NEIGHBOUR * DIAMETER, self.period)
                for i in range(len(self.frames.times))]

    @cached_property
    def order(self) -> np.ndarray:
        """[frames] mean |psi6|."""
        return np.array([np.nanmean(bond_order(of)) for of in self.neighbours])

    @cached_property
    def kept(self) -> np.ndarray:
        """[frames] share of the first neighbours that are still neighbours."""
        return np.array([kept_fraction(self.neighbours[0], of) for of in self.neighbours])

    @cached_property
    def like(self) -> np.ndarray:
        """[frames] share of neighbours of one kind."""
        return np.array([like_fraction(of, self.kinds) for of in self.neighbours])

    def between(self, name: str, start: float, end: float) -> np.ndarray:
        """A probe's values in start < t <= end."""
        return self.run.probe(name)[self._within(name, start, end)]

    def times_between(self, name: str, start: float, end: float) -> np.ndarray:
        return self.run.times(name)[self._within(name, start, end)]

    def _within(self, name: str, start: float, end: float) -> np.ndarray:
        times = self.run.times(name)
        return (times > start * (1 + 1e-9)) & (times <= end * (1 + 1e-9))

    @property
    def end(self) -> float:
        return float(self.run.times("force_lower.force_y")[-1])

    def friction(self, start: float, end: float) -> np.ndarray:
        """Friction factor on the lower wall, positive in the direction of the upper wall's motion."""
        force_x, force_y = (self.between(f"force_lower.force_{axis}", start, end) for axis in ("x", "y"))
        return -force_x / force_y

    @cached_property
    def smooth_friction(self) -> tuple[np.ndarray, np.ndarray]:
        """Times, s, and friction factors during shear; means of 50 ns."""
        weights = np.ones(SMOOTHED) / SMOOTHED
        times, friction = self.times_between("force_lower.force_y", PRESSED, self.end), self.friction(PRESSED, self.end)
        return np.convolve(times, weights, "valid"), np.convolve(friction, weights, "valid")

    @property
    def peak(self) -> float:
        return float(self.smooth_friction[1].max())

    @property
    def peak_time(self) -> float:
        times, friction = self.smooth_friction
        return float(times[friction.argmax()])

    @property
    def fall(self) -> float:
        """Fall of friction from its peak to its mean from BREAK to AFTERMATH later."""
        return self.peak - float(self.friction(self.peak_time + BREAK, self.peak_time + AFTERMATH).mean())

    @property
    def plateau(self) -> np.ndarray:
        """Block means of friction on the plateau."""
        return block_means(self.friction(PLATEAU, self.end), BLOCK)
