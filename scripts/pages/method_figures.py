#!/usr/bin/python3
"""Draws the figures of docs/method.md: regions of contact at corners, and integration cells.

    /usr/bin/python3 scripts/pages/method_figures.py       docs/pictures/method_regions.png, docs/pictures/method_cells.png
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.tri import Triangulation

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from pages.pictures import shrink

PICTURES = Path(__file__).resolve().parents[2] / "docs/pictures"
Point = Sequence[float]
BODY, INSIDE, FAN, FACES = "#e4e4e4", (0, 0, 0, 0.12), "#f3cf9a", ("#bcd4ea", "#c9e4c0")
MASTER, SLAVE, RULE = "black", "#b03030", "#555555"


def region(axes: Axes, corners: Sequence[Point], colour: object) -> None:
    axes.fill(*np.array(corners).T, color=colour, linewidth=0, zorder=0)


def line(axes: Axes, a: Point, b: Point, **style: object) -> None:
    axes.plot([a[0], b[0]], [a[1], b[1]], **style)


def outline(axes: Axes, points: Sequence[Point]) -> None:
    axes.plot(*np.array(points).T, color=MASTER, linewidth=2.5, marker="o", markersize=5, zorder=3)


def depth(axes: Axes, point: Point, foot: Point) -> None:
    axes.annotate("", foot, point, arrowprops={"arrowstyle": "->", "color": SLAVE, "shrinkA": 0, "shrinkB": 0})


def slave(axes: Axes, a: Point, b: Point, cuts: Sequence[float]) -> None:
    a, b = np.array(a), np.array(b)
    line(axes, a, b, color=SLAVE, linewidth=2, marker="s", markersize=5, zorder=4)
    across = np.array([b[1] - a[1], a[0] - b[0]]) / np.hypot(*(b - a)) * 0.06
    for s in cuts:
        line(axes, a + s * (b - a) - across, a + s * (b - a) + across, color=SLAVE, linewidth=1.5, zorder=4)


def convex_corner(axes: Axes) -> None:
    """The master fills x < 0, y < 0; segment a comes up to the node, b leaves it to the left."""
    region(axes, [(0, 0), (-1, -1), (0, -1)], FACES[0])
    region(axes, [(0, 0), (-1, -1), (-1, 0)], FACES[1])
    region(axes, [(0, 0), (0, 1), (1, 1), (1, 0)], FAN)
    region(axes, [(0, 0), (1, 0), (1, -1), (0, -1)], FACES[0])
    region(axes, [(0, 0), (0, 1), (-1, 1), (-1, 0)], FACES[1])
    region(axes, [(0, 0), (-1, 0), (-1, -1), (0, -1)], INSIDE)
    outline(axes, [(0, -0.95), (0, 0), (-0.95, 0)])
    line(axes, (0, 0), (-0.95, -0.95), color=RULE, linestyle="--")
    for end in ((0.95, 0), (0, 0.95)):
        line(axes, (0, 0), end, color=RULE, linestyle=":")
    a, b = (-0.85, -0.2), (0.6, -0.45)
    bisected = (a[1] - a[0]) / ((a[1] - a[0]) - (b[1] - b[0]))
    slave(axes, a, b, [bisected, -a[0] / (b[0] - a[0])])
    at = lambda s: (a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]))
    depth(axes, at(0.15), (at(0.15)[0], 0)), depth(axes, at(0.5), (0, at(0.5)[1]))
    for x, y, text in [(-0.72, 0.35, "face region of b\n$g = h_b > 0$"), (0.5, 0.5, "vertex region\n(fan), $g = r$"),
                       (0.5, -0.8, "face region of a\n$g = h_a > 0$"), (-0.74, -0.42, "$g = h_b < 0$"),
                       (-0.26, -0.72, "$g = h_a < 0$"), (-0.8, -0.62, "bisector"), (0.09, -0.22, "a"), (-0.42, 0.08, "b")]:
        axes.text(x, y, text, ha="center", va="center", zorder=5)
    axes.set_title("convex corner (inside darker)")


def reentrant_corner(axes: Axes) -> None:
    """Outside is x > 0, y > 0; segment a comes from the right to the node, b leaves it upwards."""
    region(axes, [(0, 0), (1, 0), (1, 1)], FACES[0])
    region(axes, [(0, 0), (0, 1), (1, 1)], FACES[1])
    region(axes, [(0, 0), (-1, 0), (-1, -1), (0, -1)], FAN)
    region(axes, [(0, 0), (1, 0), (1, -1), (0, -1)], FACES[0])
    region(axes, [(0, 0), (0, 1), (-1, 1), (-1, 0)], FACES[1])
    region(axes, [(0, 0), (1, 0), (1, -1), (-1, -1), (-1, 1), (0, 1)], INSIDE)
    outline(axes, [(0.95, 0), (0, 0), (0, 0.95)])
    line(axes, (0, 0), (0.95, 0.95), color=RULE, linestyle="--")
    for end in ((-0.95, 0), (0, -0.95)):
        line(axes, (0, 0), end, color=RULE, linestyle=":")
    a, b = (0.8, -0.25), (-0.6, -0.4)
    zero = a[0] / (a[0] - b[0])
    slave(axes, a, b, [zero])
    at = lambda s: (a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]))
    depth(axes, at(0.25), (at(0.25)[0], 0)), depth(axes, at(0.8), (0, 0))
    for x, y, text in [(0.62, 0.25, "$g = h_a > 0$"), (0.28, 0.85, "$g = h_b > 0$"), (0.5, 0.66, "bisector"),
                       (0.52, -0.72, "face region of a\n$g = h_a < 0$"), (-0.52, 0.5, "face region of b\n$g = h_b < 0$"),
                       (-0.5, -0.72, "vertex region\n(fan), $g = -r$"), (0.3, 0.07, "a"), (-0.08, 0.3, "b")]:
        axes.text(x, y, text, ha="center", va="center", zorder=5)
    axes.set_title("re-entrant corner")


def draw_regions() -> plt.Figure:
    figure, both = plt.subplots(1, 2, figsize=(10, 5.4))
    for axes, draw in zip(both, (convex_corner, reentrant_corner)):
        draw(axes)
        axes.set(xlim=(-1, 1), ylim=(-1, 1), aspect="equal")
        axes.axis("off")
    return figure


def disc_mesh() -> Triangulation:
    """Rings of nodes."""
    nodes = [(0.0, 0.0)]
    for ring in (1, 2, 3):
        angles = 2 * np.pi * (np.arange(6 * ring) + 0.5 * (ring % 2)) / (6 * ring)
        nodes += [(ring / 3 * np.cos(t), ring / 3 * np.sin(t)) for t in angles]
    return Triangulation(*np.array(nodes).T)


def mesh(axes: Axes, disc: Triangulation) -> None:
    axes.triplot(disc, color="#aaaaaa", linewidth=0.8, zorder=1)
    axes.plot(disc.x, disc.y, "o", color="black", markersize=3, zorder=3)


def corners(disc: Triangulation, triangle: int) -> np.ndarray:
    return np.column_stack([disc.x, disc.y])[disc.triangles[triangle]]


def near(disc: Triangulation, place: Point) -> int:
    """Triangle whose centroid is nearest to a place."""
    centroids = np.array([corners(disc, t).mean(axis=0) for t in range(len(disc.triangles))])
    return int(np.argmin(np.hypot(*(centroids - place).T)))


def one_point(axes: Axes, disc: Triangulation) -> None:
    mesh(axes, disc)
    t = near(disc, (0.2, 0.15))
    region(axes, corners(disc, t), FACES[0])
    centre = corners(disc, t).mean(axis=0)
    for k in range(len(disc.triangles)):
        axes.plot(*corners(disc, k).mean(axis=0), "x", color=SLAVE, markersize=4)
    distance = np.hypot(disc.x - centre[0], disc.y - centre[1])
    reached = distance < 0.62
    axes.plot(disc.x[reached], disc.y[reached], "o", color="none", markeredgecolor=SLAVE, markersize=8)
    axes.set_title("t3, mls: a point a triangle;\nrings: neighbours of one with mls", fontsize=10)


def three_points(axes: Axes, disc: Triangulation) -> None:
    mesh(axes, disc)
    region(axes, corners(disc, near(disc, (0.2, 0.15))), FACES[0])
    for t in range(len(disc.triangles)):
        for k in range(3):
            axes.plot(*(np.roll([4 / 6, 1 / 6, 1 / 6], k) @ corners(disc, t)), "x", color=SLAVE, markersize=3)
    axes.set_title("mls-gauss, rpim:\n1, 3 or 6 points a triangle", fontsize=10)


def edge_cells(axes: Axes, disc: Triangulation) -> None:
    mesh(axes, disc)
    places = np.column_stack([disc.x, disc.y])
    shown = {0: FACES[0], 1: FACES[1]}
    inner = np.argmin(np.hypot(*(places[disc.edges].mean(axis=1) - (0.15, 0.2)).T))
    rim = np.argmin(np.hypot(*(places[disc.edges].mean(axis=1) - (0.7, -0.7)).T))
    for number, colour in zip((inner, rim), shown.values()):
        a, b = disc.edges[number]
        beside = [corners(disc, t).mean(axis=0) for t, nodes in enumerate(disc.triangles) if {a, b} <= set(nodes)]
        for centre in beside:
            region(axes, [places[a], places[b], centre], colour)
    axes.plot(*places[disc.edges].mean(axis=1).T, "x", color=SLAVE, markersize=4)
    axes.set_title("es-t3: a point an edge;\nits cell: thirds of the triangles beside", fontsize=10)


def path_through_the_body(axes: Axes) -> None:
    body = np.array([(-1, -1), (1, -1), (1, 1), (0.15, 1), (0.15, -0.35), (-0.15, -0.35), (-0.15, 1), (-1, 1)])
    axes.fill(*body.T, color=BODY, zorder=0)
    axes.plot(*np.vstack([body, body[:1]]).T, color=MASTER, linewidth=2)
    x, node = np.array((-0.5, 0.3)), np.array((0.5, 0.1))
    axes.plot(*np.array([x, (-0.15, -0.35), (0.15, -0.35), node]).T, color=SLAVE, linewidth=2)
    line(axes, x, node, color=RULE, linestyle=":")
    axes.plot(*x, "x", color=SLAVE, markersize=9, markeredgewidth=2)
    axes.plot(*node, "o", color="black", markersize=7)
    axes.text(-0.62, 0.38, "$x$"), axes.text(0.55, 0.18, "$X_i$")
    axes.text(0.0, -0.62, "length $d_i(x)$", ha="center", color=SLAVE)
    axes.set_title("distance through the body:\nno support spans the gap", fontsize=10)


def draw_cells() -> plt.Figure:
    figure, all_axes = plt.subplots(2, 2, figsize=(8, 8.4))
    disc = disc_mesh()
    all_axes = all_axes.ravel()
    for axes, draw in zip(all_axes, (one_point, three_points, edge_cells)):
        draw(axes, disc)
    path_through_the_body(all_axes[3])
    for axes in all_axes:
        axes.set_aspect("equal")
        axes.axis("off")
    return figure


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        for name, draw in (("method_regions", draw_regions), ("method_cells", draw_cells)):
            figure = draw()
            figure.tight_layout()
            figure.savefig(Path(folder) / f"{name}.png", dpi=160, bbox_inches="tight")
            target = PICTURES / f"{name}.png"
            shrink(Path(folder) / f"{name}.png", target)
            print(target, f"{target.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
