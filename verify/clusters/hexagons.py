"""Scenes of hexagonal clusters of grains that are bonded facet to facet."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from histories import speeds

# Outline nodes of the three sorts are multiples of six, so every sort has a facet towards each neighbour. Half a facet
# has the length tan(pi / sides).
SIDES = {60: (18, 24, 30), 168: (30, 42, 54)}
# Displacement gradient of the outermost ring's centres: facets are compressed and sheared equally.
PUSH = np.array([[-0.03, 0.02], [0.005, -0.02]])


@dataclass
class Grain:
    """A grain of a cluster; `sort` is the number of its shape."""

    name: str
    centre: np.ndarray
    sort: int
    rigid: bool
    outer: bool


def cluster(rings: int, mixed: bool) -> list[Grain]:
    """1 + 3 rings (rings + 1) grains; neighbours are of different sorts. `mixed`: grains of one sort are rigid."""
    grains = []
    for i in range(-rings, rings + 1):
        for j in range(-rings, rings + 1):
            if abs(i + j) > rings:
                continue
            centre = np.array([2.0 * i + j, np.sqrt(3) * j])
            sort = (i - j) % 3
            outer = max(abs(i), abs(j), abs(i + j)) == rings
            grains.append(Grain(f"grain{len(grains)}", centre, sort, mixed and sort == 1, outer))
    return grains


def diameter(sides: int) -> float:
    """Diameter of the disc whose equal-area polygon has its facets at the distance 1 from the centre."""
    corner = 1 / np.cos(np.pi / sides)
    return float(2 * corner * np.sqrt(sides * np.sin(2 * np.pi / sides) / (2 * np.pi)))


def shapes(nodes: int) -> str:
    return "\n".join(f"""[shapes.sort{sort}]
kind = "disc"
diameter = {diameter(sides)!r}
nodes = {nodes}
outline_nodes = {sides}
""" for sort, sides in enumerate(SIDES[nodes]))


def grain_tables(grains: list[Grain], nodes: int, ramp: float) -> str:
    return "\n".join(grain_table(grain, nodes) + (push(grain, ramp) if grain.outer else "") for grain in grains)


def grain_table(grain: Grain, nodes: int) -> str:
    """Table of a grain, turned so that a facet faces along x."""
    body, material = ("rigid", "hard") if grain.rigid else ("compliant", "soft")
    return f"""[[grains]]
name = "{grain.name}"
shape = "sort{grain.sort}"
body = "{body}"
material = "{material}"
angle = {np.pi / SIDES[nodes][grain.sort]!r}
packing = {{ kind = "positions", positions = [[{grain.centre[0]!r}, {grain.centre[1]!r}]] }}
"""


def push(grain: Grain, ramp: float) -> str:
    """Prescribed motion of the outer half of a compliant grain, or of a whole rigid one, which may turn."""
    outward = float(np.arctan2(grain.centre[1], grain.centre[0]))
    x, y = (f"{{ velocity = {speeds([0.0, float(part)], ramp, ramp)} }}" for part in PUSH @ grain.centre)
    part = "" if grain.rigid else f"part = {{ angles = [{outward - 1.6!r}, {outward + 1.6!r}] }}\nstiffness = 1\n"
    return f"""
[[boundary]]
of = "{grain.name}"
{part}x = {x}
y = {y}
"""


def probe(name: str, quantity: str, of: str, period: float, more: str = "") -> str:
    return f"""[[probes]]
name = "{name}"
quantity = "{quantity}"
of = "{of}"
period = {period!r}
{more}
"""


def probes(grains: list[Grain], nodes: int, period: float) -> str:
    """Centres, and contact forces on all outline nodes."""
    tables = []
    for grain in grains:
        tables.append(probe(grain.name, "position", grain.name, period))
        for node in range(SIDES[nodes][grain.sort]):
            tables.append(probe(f"{grain.name}-{node}", "force", grain.name, period, f"node = {node}"))
    return "\n".join(tables)
