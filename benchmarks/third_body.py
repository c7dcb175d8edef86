#!/usr/bin/python3
"""The paper's third body, run whole: its observables beside the paper's, and its figures 7 to 12.

    benchmarks/third_body.py results/third_body     # writes benchmarks/results/third_body and docs/pictures/third_body_*

docs/third_body.md says how to make the run. A run that has not come to its end is told of as far as it went. The paper: G.
Mollon 2018, doi 10.1007/s40571-018-0187-6, section 7, read from its figures to 0.02.
"""

from __future__ import annotations

import argparse
import io
import json
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure
from PIL import Image

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / part) for part in ("verify", "verify/third_body", "scripts", "python")]

from pliant.frames import COMPLIANT
from pliant.order import clusters, like_fraction_at_random
from pliant.results import read_run
from plots import maps
from plots.curves import COLOURS
from plots.history import draw_history
from third_body_layer import PRESSED, Layer
from time_means import Mean
from verification import Run

RESULTS, PICTURES = ROOT / "benchmarks/results/third_body", ROOT / "docs/pictures"
PERIOD, PRESSURE = 87e-6, 1e9  # m, Pa
SNAPSHOTS = [1e-6, 2e-6, 6e-6, 18.5e-6]  # s, the paper's, but where the lattice gives way for its 1.5 us
SERIES = 10  # samples of 5 ns in a row of the series
SMALLEST = 5  # grains: smaller groups are not called clusters
MOST_BYTES = 125_000  # of a picture in docs/


def observables(layer: Layer) -> dict[str, object]:
    """What the paper shows, by name."""
    normal = -layer.between("force_lower.force_y", PRESSED, layer.end) / (PRESSURE * PERIOD)
    plateau = Mean(layer.plateau)
    summary = json.loads((layer.run.folder / "summary.json").read_text())
    dt, error = of_all_steps(layer.run, "dt"), of_all_steps(layer.run, "error")
    frames = {f"{round(1e6 * time)} us": i for i, time in enumerate(layer.frames.times) if is_whole(1e6 * time)}
    at_random, deviation = like_fraction_at_random(layer.neighbours[-1], layer.kinds)
    return {
        "end, us": 1e6 * layer.end,
        "steps": summary["steps"], "evaluations": summary["evaluations"],
        "wall seconds": round(summary["wall_seconds"]),
        "shares of time": shares(summary["phase_seconds"]),
        "balance error": layer.run.balance_error,
        "time step, ps: least, median, largest": [round(float(1e12 * q), 2) for q in np.quantile(dt, [0, 0.5, 1])],
        "error estimate: median, largest": [float(f"{q:.3g}") for q in np.quantile(error, [0.5, 1])],
        "normal force over pressure x period, sheared: mean, standard deviation":
            [round(float(normal.mean()), 4), round(float(normal.std()), 4)],
        "friction: peak": round(layer.peak, 3), "friction: time of the peak, us": round(1e6 * layer.peak_time, 3),
        "friction: fall within 0.1 us": round(layer.fall, 3),
        "friction: plateau": round(plateau.value, 3), "friction: plateau to": round(plateau.error, 3),
        "first neighbours kept": {name: round(float(layer.kept[i]), 3) for name, i in frames.items()},
        "|psi6|": {name: round(float(layer.order[i]), 3) for name, i in frames.items()},
        "like neighbours": {name: round(float(layer.like[i]), 3) for name, i in frames.items()},
        "like neighbours at random": [round(at_random, 3), round(deviation, 3)],
        "clusters of compliant grains, mean size": {name: round(mean_size(layer, i), 1) for name, i in frames.items()},
    }


def is_whole(number: float) -> bool:
    return abs(number - round(number)) < 1e-6


def of_all_steps(run: Run, name: str) -> np.ndarray:
    """A column of steps.csv with each row as often as it stands for steps: late ones are every tenth."""
    steps = run.steps("evaluations") - run.steps("rejections")
    return np.repeat(run.steps(name), np.diff(steps, prepend=steps[0] - 1).astype(int))


def shares(seconds: dict[str, float]) -> dict[str, float]:
    return {phase: round(value / sum(seconds.values()), 3) for phase, value in seconds.items()}


def mean_size(layer: Layer, frame: int) -> float:
    sizes = np.asarray(clusters(layer.neighbours[frame], layer.kinds == COMPLIANT))
    return float(sizes[sizes >= SMALLEST].mean())


def write_series(layer: Layer, file: Path) -> None:
    """Means over rows of 50 ns."""
    names = {"normal_force": "force_lower.force_y", "tangential_force": "force_lower.force_x"}
    times = layer.run.times("force_lower.force_y")
    count = len(times) // SERIES * SERIES
    columns = [times[:count].reshape(-1, SERIES).mean(axis=1)]
    columns += [-layer.run.probe(name)[:count].reshape(-1, SERIES).mean(axis=1) for name in names.values()]
    step_times = layer.run.steps("time")
    rows = count // SERIES
    edges = times[0] + (times[1] - times[0]) * SERIES * np.arange(rows + 1)
    bins = np.searchsorted(edges, step_times) - 1
    within = (bins >= 0) & (bins < rows)
    for name in ("dt", "error"):
        with np.errstate(invalid="ignore"):
            columns.append(np.bincount(bins[within], layer.run.steps(name)[within], rows)
                           / np.bincount(bins[within], minlength=rows))
    lines = [",".join(f"{value:.6g}" for value in row) for row in zip(*columns)]
    units = {"t": "s", "normal_force": "N/m", "tangential_force": "N/m", "dt": "s", "error": "1"}
    file.write_text("\n".join([",".join(f"{name} [{unit}]" for name, unit in units.items()), *lines]) + "\n")


def histories(layer: Layer) -> Figure:
    """Figures 8 and 9, and what figures 7 and 10 show of order."""
    figure, axes = plt.subplots(5, 1, figsize=(9, 9), sharex=True, layout="constrained")
    step_times = 1e6 * layer.run.steps("time")
    draw_history(axes[0], step_times, 1e12 * layer.run.steps("dt"), COLOURS[0])
    draw_history(axes[1], step_times, layer.run.steps("error"), COLOURS[1])
    axes[1].set_yscale("log")
    axes[1].set_ylim(*np.quantile(layer.run.steps("error"), [1e-3, 1]) * [0.5, 2])  # the first steps are tiny
    times = 1e6 * layer.run.times("force_lower.force_y")
    axes[2].plot(times, -layer.run.probe("force_lower.force_y") / (PRESSURE * PERIOD), color=COLOURS[0], linewidth=0.8)
    smooth_times, smooth = layer.smooth_friction
    axes[3].plot(1e6 * smooth_times, smooth, color=COLOURS[0], linewidth=1)
    for value, style in ((0.5, ":"), (0.25, "--")):
        axes[3].axhline(value, linestyle=style, color=COLOURS[7], linewidth=0.8)
    frames = 1e6 * layer.frames.times
    axes[4].plot(frames, layer.kept, "o-", color=COLOURS[0], markersize=3, label="first neighbours kept")
    axes[4].plot(frames, layer.order, "s:", color=COLOURS[1], markersize=3, label="mean |psi6|")
    axes[4].plot(frames, layer.like, "^--", color=COLOURS[2], markersize=3, label="neighbours of one kind")
    axes[4].legend(fontsize=8, frameon=False)
    names = ["time step [ps]", "error estimate", "normal force over\npressure x period",
             "friction factor\n(paper: peak, plateau)", "order"]
    for panel, name in zip(axes, names):
        panel.set_ylabel(name)
        panel.grid(alpha=0.3)
    axes[-1].set_xlabel("time [us]")
    figure.align_ylabels(axes)
    return figure


def draw(layer: Layer) -> None:
    run = read_run(layer.run.folder)
    chosen = [layer.frames.nearest(time) for time in SNAPSHOTS if time <= layer.end * 1.001]
    last = [len(layer.frames.times) - 1]
    chosen += [] if last[0] in chosen else last
    pictures = {"histories": histories(layer), "grains": maps.grains(run, chosen), "velocity": maps.velocity(run, last),
                "von_mises": maps.von_mises(run, last)}
    for name, figure in pictures.items():
        if figure is not None:
            save_small(figure, PICTURES / f"third_body_{name}.png")


def save_small(figure: Figure, file: Path) -> None:
    """With as many dots and colours as a page needs."""
    for dots_per_inch, colours in ((110, 128), (100, 64), (90, 48), (80, 32), (70, 24), (60, 16)):
        drawn, small = io.BytesIO(), io.BytesIO()
        figure.savefig(drawn, format="png", dpi=dots_per_inch)
        Image.open(drawn).convert("RGB").quantize(colours, dither=Image.Dither.NONE).save(small, "png", optimize=True)
        if len(small.getvalue()) <= MOST_BYTES:
            break
    file.write_bytes(small.getvalue())


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("run", type=Path, help="folder of a run of cases/third_body.toml")
    folder = options.parse_args().run
    if not (folder / "summary.json").is_file():
        print(f"error: {folder}: no results in there", file=sys.stderr)
        return 2
    layer = Layer("third body", Run(folder), PERIOD)
    RESULTS.mkdir(parents=True, exist_ok=True)
    found = observables(layer)
    (RESULTS / "observables.json").write_text(json.dumps(found, indent=1) + "\n")
    write_series(layer, RESULTS / "series.csv")
    draw(layer)
    print(json.dumps(found, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main())
