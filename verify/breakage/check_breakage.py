"""Strength of discs of bonded cells in the Brazilian test, and Weibull's distribution of strengths."""

from __future__ import annotations

from functools import cache
from math import gamma

import numpy as np
import pytest

from bonded_cells import damage, draw_cracks, draw_fragments, edges
from fields import frames_of
from pictures import COLOURS, describe, legend, panels, save
from verification import FULL, Case, Label, Run

CASE = Case(__file__, long=True, cost=12 if FULL else 6)

RADIUS, STRENGTH, COHESION = 0.005, 4e6, 12e6  # m, Pa, Pa
MODULUS = 1e9 / (1 - 0.25**2)  # E', Pa
ZONE = 0.1 * 2 * RADIUS  # E' G/strength^2, m
ENERGY = ZONE * STRENGTH**2 / MODULUS
SPACING = 2 * RADIUS / 40
SEEDS = [1, 2, 3]
SIZES = [20, 60] + ([120, 180] if FULL else [])
LOAD = np.pi * RADIUS * STRENGTH  # N/m, of a point load whose tension across the loaded diameter is the strength


def halves() -> str:
    """Two halves of the disc, bonded along the loaded diameter."""
    count = round(np.pi * RADIUS / SPACING)
    angles = np.pi / 2 + np.pi * np.arange(count + 1) / count
    left = RADIUS * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    left[[0, -1], 0] = 0
    return "".join(
        f'[shapes.{name}]\nkind = "polygon"\npoints = {points.tolist()}\nspacing = {SPACING}\n\n'
        f'[[grains]]\nname = "{name}"\nshape = "{name}"\nbody = "compliant"\nmaterial = "stone"\n'
        'packing = { kind = "in place" }\n\n' for name, points in (("left", left), ("right", -left)))


def cells(count: int, seed: int) -> str:
    return (f'[shapes.disc]\nkind = "disc"\ndiameter = {2 * RADIUS}\nspacing = {SPACING}\n\n[[grains]]\nname = "disc"\n'
            f'shape = "disc"\nbody = "compliant"\nmaterial = "stone"\ncells = {count}\nseed = {seed}\n'
            'packing = { kind = "positions", positions = [[0, 0]] }\n')


def crushed(name: str, grain: str, end: float) -> Run:
    return CASE.engine(name, CASE.scene("splitting.toml", end=end, grain=grain, energy=ENERGY, shear_energy=4 * ENERGY,
                                        cohesion=COHESION, frame=1e-5))


@cache
def along_the_diameter() -> Run:
    return crushed("halves", halves(), 0.0008)


@cache
def of_cells(count: int, seed: int) -> Run:
    return crushed(f"cells_{count}_{seed}", cells(count, seed), 0.0014)


def load(run: Run) -> np.ndarray:
    """Mean of both plates, over the load whose tension is the strength."""
    return (np.abs(run.probe("floor.force_y")) + np.abs(run.probe("lid.force_y"))) / 2 / LOAD


def strengths(count: int) -> np.ndarray:
    return np.array([load(of_cells(count, seed)).max() for seed in SEEDS])


def test_crack_along_the_diameter() -> None:
    """Hertz' pressure on a half width a takes (a/R)^2 = 4 P/(pi E' R) from the tension at the centre."""
    width = 4 * STRENGTH / MODULUS
    run = along_the_diameter()
    CASE.check(Label.EXACT, "halves: peak load over pi R strength", load(run).max(), 1 / (1 - width), 0.05,
               "Hertz, to 1.5 % by strains; load that grows while the crack runs, 3 %; cohesive zone, 1 %")
    CASE.check(Label.EXACT, "halves: balance of energy", run.balance_error, 0, 1e-3, "specified")


# Horizontal opening of an edge at an angle t to the load, in its strength: sqrt(cos^2 t + (c/s)^2 sin^2 t). Paths along
# the edges of a honeycomb turn by 60 degrees at each corner. Two of its directions give the least and the largest mean.
RATIO = COHESION / STRENGTH
TILTED = [np.hypot(np.cos(t), RATIO * np.sin(t)) for t in np.radians([30, 60])]
LARGEST = max(TILTED[0] / np.cos(np.radians(30)), (1 + TILTED[1]) / (1 + np.cos(np.radians(60))))


@pytest.mark.parametrize("count", SIZES)
def test_strength_of_cells(count: int) -> None:
    CASE.check(Label.EXACT, f"{count} cells: peak load over pi R strength, mean", strengths(count).mean(),
               (LARGEST + 1) / 2, (LARGEST - 1) / 2,
               "no edge fails below its strength; all edges of a zigzag at their strength at once bear most")
    worst = max(of_cells(count, seed).balance_error for seed in SEEDS)
    CASE.check(Label.EXACT, f"{count} cells: balance of energy", worst, 0, 1e-3, "specified")


def side(count: int) -> float:
    """Of hexagons with the area of the cells, m."""
    return 2 * RADIUS * np.sqrt(np.pi / 4 / count / (1.5 * np.sqrt(3)))


def scatter(count: int) -> float:
    """Standard error of the mean strength. Edges resist anything between both bounds, equally likely. A crack across
    the disc has D/(0.8 s) of them, with the side s of a hexagon."""
    return (LARGEST - 1) / np.sqrt(12) / np.sqrt(2 * RADIUS / (0.8 * side(count))) / np.sqrt(len(SEEDS))


# The process zone averages over the angles of edges only where it is longer than an edge.
RESOLVED = [count for count in SIZES if side(count) < ZONE]


@pytest.mark.parametrize("count", RESOLVED[1:])
def test_strength_does_not_depend_on_the_cells(count: int) -> None:
    tolerance = 2 * np.hypot(scatter(RESOLVED[0]), scatter(count))
    CASE.check(Label.EXACT, f"strength with {count} cells less that with {RESOLVED[0]}",
               strengths(count).mean() - strengths(RESOLVED[0]).mean(), 0, tolerance,
               "same fracture energy; twice the scatter of the angles of edges")


@pytest.mark.parametrize("count", SIZES)
def test_crack_runs_along_the_load(count: int) -> None:
    CASE.check(Label.EXACT, f"{count} cells: distance of the crack from the loaded diameter over R, mean",
               np.mean([off_the_diameter(of_cells(count, seed)) for seed in SEEDS]), 0, 2 / (3 * np.pi),
               "half of 4/(3 pi), that of edges torn everywhere")


def crossing(run: Run) -> int:
    """Last frame with no more torn edges than a straight crack across the disc has."""
    frames = frames_of(run)
    segments = edges(frames)
    torn = [np.sum(damage(frames, segments, k) > 0.999) for k in range(len(frames.times))]
    return int(np.flatnonzero(np.array(torn) <= 2 * RADIUS / SPACING)[-1])


def off_the_diameter(run: Run) -> float:
    frames = frames_of(run)
    segments = edges(frames)
    torn = damage(frames, segments, crossing(run)) > 0.999
    return float(np.abs(frames.positions("outlines", 0)[segments, 0].mean(axis=1)[torn]).mean() / RADIUS)


def test_weibull() -> None:
    """Pairs of squares pulled apart. A pair tears at the opening 2 w G/strength, with the factor w of its strength."""
    modulus, pairs, last = 4, 1600, 2.5
    whole = 2 * 5e-4 / 0.01  # opening at which w = 1 tears
    run = CASE.engine("weibull", CASE.scene("weibull.toml", end=last * whole / 1e-3, speed=1e-3, strength=0.01,
                                            energy=5e-4, modulus=modulus, period=10 * whole))
    torn, factor = run.probe("bonds.torn_bonds"), run.times("bonds.torn_bonds") * 1e-3 / whole
    mean = gamma(1 + 1 / modulus)
    expected = 1 - np.exp(-(mean * factor) ** modulus)
    CASE.check(Label.EXACT, "strengths against Weibull's distribution of mean 1, largest difference",
               np.abs(torn / torn[-1] - expected).max(), 0, 1.63 / np.sqrt(pairs), "Kolmogorov and Smirnov, 1 %")
    square = gamma(1 + 2 / modulus) / mean**2
    spread = np.sqrt((gamma(1 + 4 / modulus) / mean**4 - square**2) / pairs)
    CASE.check(Label.EXACT, "energy of torn bonds over that of equal ones", run.probe("works.dissipated_by_bonds")[-1] /
               (pairs * 5e-4), square, 3 * spread, "mean of w^2; three standard deviations")


def test_picture() -> None:
    count = SIZES[-1]
    run = of_cells(count, 1)
    frames, frame = frames_of(run), crossing(run) + 1
    figure, (loads, cracks, pieces) = panels(3, "Brazilian test of bonded cells", across=True)
    runs = {"two halves": along_the_diameter(), **{f"{n} cells": of_cells(n, 1) for n in SIZES}}
    for (name, each), colour in zip(runs.items(), COLOURS):
        loads.plot(-1000 * each.probe("approach.displacement_y"), load(each), color=colour, linewidth=1.1, label=name)
    for bound in (1, LARGEST):
        loads.axhline(bound, color="0.5", linewidth=0.8, linestyle="--")
    describe(loads, "dashed: bounds of the strength", "approach of the plates [mm]", "load / (pi R strength)")
    legend(loads)
    draw_cracks(cracks, frames, frame)
    describe(cracks, f"{count} cells: torn (black), damaged (orange) edges", "x [mm]", "y [mm]")
    later = min(frame + 10, len(frames.times) - 1)
    draw_fragments(pieces, frames, later)
    describe(pieces, f"fragments, {1e6 * (frames.times[later] - frames.times[frame]):.0f} us later", "x [mm]")
    save(CASE, figure, "breakage")
