#!/usr/bin/python3
"""Draws a shape function of moving least squares beside one of radial point interpolation.

    ./pliant shape-functions --out docs/shape_functions.png

As in Fig. 2 of Mollon 2018 (doi 10.1007/s40571-018-0187-6): the function of an inner node, its section, and the jump that radial
point interpolation makes wherever a node enters the support. Both come from the engine, on the same disc.
"""

import argparse
import csv
import io
import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np

BAD_INPUT, OUTPUT_FAILED = 2, 4
NAMES = {"mls": "moving least squares", "rpim": "radial point interpolation"}


@dataclass
class ShapeFunction:
    nodes: np.ndarray  # [nodes x 2], mean node distances
    node: np.ndarray  # the function's own node
    x: np.ndarray  # [grid points]
    y: np.ndarray
    phi: np.ndarray

    def grid(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Axes and phi[y, x], nan outside the disc."""
        xs, ys = np.unique(self.x), np.unique(self.y)
        phi = np.full((len(ys), len(xs)), np.nan)
        phi[np.searchsorted(ys, self.y), np.searchsorted(xs, self.x)] = self.phi
        return xs, ys, phi


def evaluate(engine: Path, method: str, nodes: int, support: int, grid: int) -> ShapeFunction:
    command = [str(engine), "shape-function", "--method", method, "--nodes", str(nodes), "--support", str(support), "--grid", str(grid)]
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode != 0:
        sys.stderr.write(result.stderr)
        raise SystemExit(result.returncode)
    rows = list(csv.DictReader(io.StringIO(result.stdout)))
    nodal = [row for row in rows if row["kind"] == "node"]
    values = [row for row in rows if row["kind"] == "value"]
    positions = np.array([[float(row["x"]), float(row["y"])] for row in nodal])
    own = next(i for i, row in enumerate(nodal) if float(row["phi"]) == 1)
    x, y, phi = (np.array([float(row[key]) for row in values]) for key in ("x", "y", "phi"))
    return ShapeFunction(positions, positions[own], x, y, phi)


def largest_jump(function: ShapeFunction) -> float:
    """Largest change of phi between neighbours of the grid: falls with the grid's step where phi is continuous."""
    _, _, phi = function.grid()
    return float(max(np.nanmax(np.abs(np.diff(phi, axis=0))), np.nanmax(np.abs(np.diff(phi, axis=1)))))


def draw(functions: dict[str, ShapeFunction]) -> plt.Figure:
    figure, axes = plt.subplots(2, 3, figsize=(13, 7.5), constrained_layout=True)
    span = 3.6
    for row, (method, function) in zip(axes, functions.items()):
        xs, ys, phi = function.grid()
        cx, cy = function.node
        top = np.nanmax(phi)
        image = row[0].pcolormesh(xs - cx, ys - cy, phi, cmap="viridis", vmin=min(0, np.nanmin(phi)), vmax=top, shading="nearest")
        row[0].plot(*(function.nodes - function.node).T, ".", color="white", markersize=3)
        row[0].set(xlim=(-span, span), ylim=(-span, span), aspect="equal", title=f"{NAMES[method]}: $\\phi$", xlabel="x / d", ylabel="y / d")
        figure.colorbar(image, ax=row[0], shrink=0.85)
        line = phi[np.argmin(np.abs(ys - cy))]
        row[1].plot(xs - cx, line, color="tab:blue", linewidth=1)
        row[1].axhline(0, color="grey", linewidth=0.5)
        row[1].set(xlim=(-span, span), ylim=(-0.15, 1.1), title="section through its node", xlabel="x / d", ylabel="$\\phi$")
        row[2].plot(xs - cx, line, ".", color="tab:blue", markersize=2)
        row[2].axhline(0, color="grey", linewidth=0.5)
        row[2].set(xlim=(0.4, span), ylim=(-0.09, 0.16), title="the same, closer", xlabel="x / d")
        row[2].text(0.97, 0.95, f"least {np.nanmin(phi):.3f}, largest {top:.3f}\nlargest step from point to point {largest_jump(function):.3f}",
                    ha="right", va="top", transform=row[2].transAxes)
    figure.suptitle("Shape function of an inner node; dots: field nodes, d: their mean distance")
    return figure


def parse_arguments(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="pliant shape-functions", description="Draws a shape function of mls beside one of rpim.",
                                     epilog="example: ./pliant shape-functions --out shape_functions.png")
    parser.add_argument("--out", type=Path, default=Path("shape_functions.png"), help="picture (default: shape_functions.png)")
    parser.add_argument("--nodes", type=int, default=168, help="nodes of the disc (default: 168)")
    parser.add_argument("--support", type=int, default=9, help="nodes in a support (default: 9)")
    parser.add_argument("--grid", type=int, default=701, help="points along either axis (default: 701)")
    return parser.parse_args(arguments)


def main(arguments: list[str]) -> int:
    options = parse_arguments(arguments)
    engine = Path(os.environ.get("PLIANT_ENGINE", Path(__file__).resolve().parents[1] / "build/release/pliant_engine"))
    functions = {method: evaluate(engine, method, options.nodes, options.support, options.grid) for method in NAMES}
    try:
        draw(functions).savefig(options.out, dpi=130)
    except (OSError, ValueError) as error:
        print(f"error: {options.out}: {error}", file=sys.stderr)
        return OUTPUT_FAILED
    print(options.out)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
