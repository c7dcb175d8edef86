"""Compression of breakable grains: void ratio over pressure, and sizes of their fragments.

The pressure is the mean of those on lid and floor, averaged over SMOOTHED of lid travel. The void ratio is that of outlines,
so overlaps count twice.
"""

from __future__ import annotations

import re

import numpy as np

from pliant import Run

GRAINS = 100
PERIOD = 0.1  # m
DIAMETER = 0.01  # m, mean of the grains
LEAST, LARGEST = 0.85, 1.15  # sizes of grains over DIAMETER
DENSITY = 2500.0  # kg/m3
SPEED = 0.5  # m/s, of the lid
SMOOTHED = 11  # samples of 0.05 ms
BROKEN = 2  # fragments per grain at yield


def smooth(values: np.ndarray) -> np.ndarray:
    return np.convolve(values, np.ones(SMOOTHED) / SMOOTHED, "valid")


def pressure(run: Run) -> np.ndarray:
    """Pa"""
    return smooth(np.abs(run.values("floor.force_y")) + np.abs(run.values("lid.force_y"))) / (2 * PERIOD)


def void_ratio(run: Run) -> np.ndarray:
    return smooth(1 / run.values("packing.solid_fraction") - 1)


def strength(run: Run) -> float:
    """Pa, of the bonds."""
    return 1e6 * float(re.search(r'^strength = "([\d.]+) MPa"', (run.folder / "scene.toml").read_text(), re.M)[1])


def per_grain(run: Run) -> np.ndarray:
    return smooth(run.values("fragments.fragments")) / GRAINS


def compression(run: Run) -> tuple[np.ndarray, np.ndarray]:
    return pressure(run) / 1e6, void_ratio(run)


def breakage(run: Run) -> tuple[np.ndarray, np.ndarray]:
    return pressure(run) / strength(run), per_grain(run)


def yielded(run: Run) -> int:
    return int(np.argmax(per_grain(run) > BROKEN))


def yield_pressure(run: Run) -> float:
    """Largest one before there are BROKEN fragments per grain, over the strength of the bonds."""
    return float(pressure(run)[:yielded(run)].max() / strength(run))


def reached(run: Run, over_strength: float) -> int:
    """The sample from which the pressure over the strength of the bonds stays above this; that after the last: none."""
    below = np.flatnonzero(pressure(run) < over_strength * strength(run))
    return int(below[-1]) + 1


def at(run: Run, values: np.ndarray, over_strength: float) -> float:
    """NaN: the pressure is not reached."""
    return float(np.append(values, np.nan)[reached(run, over_strength)])


def void_ratio_at_2(run: Run) -> float:
    return at(run, void_ratio(run), 2)


def void_ratio_at_10(run: Run) -> float:
    return at(run, void_ratio(run), 10)


def fragments_at_2(run: Run) -> float:
    return at(run, per_grain(run), 2)


def fragments_at_10(run: Run) -> float:
    return at(run, per_grain(run), 10)


def sizes(run: Run, frame: int) -> np.ndarray:
    """Diameters of the fragments, of circles of the same area, over DIAMETER; sorted."""
    number = run.frames.field("bodies", frame, "fragment").astype(int)
    corners = run.frames.positions("bodies", frame)[run.frames.grids["bodies"].cells]
    one, two = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    of_grain = number >= 0
    area = np.bincount(number[of_grain], np.abs(one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0])[of_grain] / 2)
    return np.sort(np.sqrt(4 / np.pi * area[area > 0])) / DIAMETER


def shares(run: Run, over_strength: float) -> tuple[np.ndarray, np.ndarray]:
    """Sizes of fragments and the share of the mass up to each, in the first frame at this pressure."""
    time = np.append(smooth(run.probes.time), np.inf)[reached(run, over_strength)]
    found = sizes(run, min(int(np.searchsorted(run.frames.times, time)), len(run.frames.times) - 1))
    return found, np.cumsum(found**2) / (found**2).sum()


def grading(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """At twice the strength of the bonds."""
    return shares(run, 2)


def grading_at_10(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """At ten times the strength of the bonds."""
    return shares(run, 10)


def median_size(run: Run) -> float:
    size, share = grading(run)
    return float(np.interp(0.5, share, size))


def before(size: np.ndarray, _: np.ndarray) -> np.ndarray:
    """The grading of the grains, whose diameters are distributed evenly by number."""
    share = (size**3 - LEAST**3) / (LARGEST**3 - LEAST**3)
    return np.where((size > LEAST) & (size < LARGEST), share, np.nan)


def inertial(run: Run) -> float:
    """Inertial number at the yield pressure: rate of strain times d sqrt(density/pressure)."""
    height = (1 + void_ratio(run)[0]) * GRAINS * np.pi / 4 * DIAMETER**2 / PERIOD
    return float(SPEED / height * DIAMETER * np.sqrt(DENSITY / (yield_pressure(run) * strength(run))))


def kinetic(run: Run) -> float:
    """Largest kinetic energy since yield over the work of the lid up to there."""
    return float((run.values("energy.kinetic") / np.maximum(run.values("works.work_of_loads"), 1e-9))[yielded(run):].max())


def damped(run: Run) -> float:
    """Share of the work of the lid that the damping of the cells takes."""
    return float(run.values("works.dissipated_by_damping")[-1] / run.values("works.work_of_loads")[-1])


def overlap(run: Run) -> float:
    """Largest share of the area that overlaps can take at the end: they are thin, so twice the energy of contacts over their
    pressure, which is at least that of the layer."""
    area = GRAINS * np.pi / 4 * DIAMETER**2
    return float(2 * run.values("energy.contact")[-1] / pressure(run)[-1] / area)
