"""A free disc with the initial velocity 0.5 (X, -Y)."""

from __future__ import annotations

import numpy as np
from dolfinx import fem
from scipy.interpolate import CubicSpline

from fem.compiled import compile_form
from fem.dynamics import Explicit
from fem.meshes import disc
from fem.solid import Material, Solid

RATE = 0.5  # of the initial velocity, cs / R


class Oscillation:
    """Runs in this number of steps, or with half of the stable step. `times`, `energies`, s = sqrt(Ixx / Ixx0) and
    diameter are those of each step."""

    def __init__(self, rings: int, until: float, material: Material = Material(), steps: int | None = None) -> None:
        solid = Solid(disc(rings), material)
        motion = Explicit(solid, solid.strain_energy())
        motion.v.interpolate(lambda x: np.stack([RATE * x[0], -RATE * x[1]]))
        self._inertia = compile_form((solid.X[0] + solid.u[0]) ** 2 * solid.dx)
        self._right = int(solid.component_at((1, 0), 0)[0])
        self._solid = solid
        steps = steps or int(np.ceil(until * motion.largest_frequency()))
        motion.start()
        rows = [self._row(motion)]
        for _ in range(steps):
            motion.step(until / steps)
            rows.append(self._row(motion))
        self.times, self.energies, inertia, self.diameter = np.array(rows).T
        self.s = np.sqrt(inertia / inertia[0])

    def _row(self, motion: Explicit) -> list[float]:
        energy = motion.kinetic_energy() + motion.potential()
        return [motion.time, energy, fem.assemble_scalar(self._inertia), 2 * (1 + self._solid.u.x.array[self._right])]

    def value(self, quantity: str, time: float) -> float:
        """`quantity` as in disc_oscillation.csv: "s", "horizontal_diameter_over_R", the nearest "extreme_of_s"."""
        if quantity == "horizontal_diameter_over_R":
            return float(CubicSpline(self.times, self.diameter)(time))
        curve = CubicSpline(self.times, self.s)
        if quantity == "s":
            return float(curve(time))
        extremes = curve.derivative().roots(extrapolate=False)
        return float(curve(extremes[np.abs(extremes - time).argmin()]))
