"""The third body of Mollon 2018: forces on the walls, friction, steps, order and mixing of the sheared layer."""

from __future__ import annotations

import math

import numpy as np
import pytest
from matplotlib.axes import Axes

from pictures import COLOURS, panels, save
from plots import curves, maps
from pliant.order import like_fraction_at_random
from pliant.results import read_run
from third_body_layer import AFTERMATH, BREAK, DIAMETER, PLATEAU, PRESSED, SAMPLING, SHORT_BLOCK, Layer
from time_means import Mean, block_means
from verification import FULL, ROOT, Case, Label, Run

CASE = Case(__file__, long=True, cost=6)

PITCH, ROW_PITCH = 0.87e-6, 1.002e-6  # m
COLUMNS, ROWS = 10, 20
PRESSURE, DENSITY = 1e9, 1200  # Pa, kg/m3
RAMP = 5e-8  # s, of the shear velocity
END = 4e-6  # s
NODES, SEEDS = 60, [1, 2] if FULL else [1]
FRAMES = 1e-7  # s
SLAB = 5e-6 * DENSITY  # kg/m2, mass of a wall per length
TOLERANCE = 1e-2  # of the engine's error estimate
VERLET = f'integrator = "verlet"\ntolerance = {TOLERANCE}'
TARGET, ALPHA, BETA = 1e-4, 2, 0.2  # parameters of the paper's scheme
DOUBLING = f'integrator = "step-doubling"\ntarget = {TARGET}\nalpha = {ALPHA}\nbeta = {BETA}'
ROUNDING = 1e-12  # 1e4 contact forces of up to a hundredth of the total, each to 2e-16, add up to 2e-14
PEAK, FLOW = 0.5, 0.25  # friction factors of the paper
READING = 0.02  # reading error of its curves
PEAK_SCATTER = 0.02  # standard deviation over assignments of angles: README.md
INTACT, GONE = 1.5e-6, 18.5e-6  # s, of the paper's snapshots with an intact and with a vanished lattice
BONDS, BONDS_ACROSS = 3 * ROWS - 2, 2  # pairs of neighbours per column, in total and from a row to the next
SLIDING = 1 / 3  # of a grain's neighbours stay with it in a row that slides as a whole
PAPER_PERIOD, PAPER_END = 87e-6, 3.9e-6  # m, s: end of an hour's run
FINISHED = ROOT / "results/third_body"  # output of `./pliant run cases/third_body.toml`, the paper's scene


def scene(seed: int, nodes: int = NODES, columns: int = COLUMNS, rows: int = ROWS, end: float = END,
          pressed: float = PRESSED, integrator: str = VERLET) -> str:
    return CASE.scene(columns=columns, rows=rows, nodes=nodes, seed=seed, end=end, integrator=integrator,
                      period=columns * PITCH, top=(rows + 0.5) * ROW_PITCH, pressed=pressed, sheared=pressed + RAMP,
                      sampling=SAMPLING, frames=FRAMES)


def solved(seed: int) -> Layer:
    return Layer(f"seed {seed}", CASE.engine(f"seed_{seed}", scene(seed)), COLUMNS * PITCH)


def of_the_repository() -> Layer:
    """cases/third_body_mini.toml itself, with 168 nodes."""
    text = (ROOT / "cases/third_body_mini.toml").read_text()
    return Layer("168 nodes", CASE.engine("mini", text), COLUMNS * PITCH)


def of_the_paper() -> Layer:
    """cases/third_body.toml, 2000 discs of 168 nodes: a finished run, or its beginning."""
    summary = FINISHED / "summary.json"
    if summary.exists() and '"finished"' in summary.read_text():
        return Layer("2000 discs", Run(FINISHED), PAPER_PERIOD)
    text = (ROOT / "cases/third_body.toml").read_text()
    return Layer("2000 discs", CASE.engine("paper", text, "--until", f"{PAPER_END} s"), PAPER_PERIOD)


@pytest.fixture(scope="module")
def small() -> list[Layer]:
    return [solved(seed) for seed in SEEDS]


@pytest.fixture(scope="module")
def paper() -> Layer:
    return of_the_paper()


@pytest.fixture(scope="module")
def mini() -> Layer:
    return of_the_repository()


@pytest.fixture(scope="module")
def groups(small: list[Layer], request: pytest.FixtureRequest) -> dict[str, list[Layer]]:
    """Layers that differ only in angles."""
    full = {"168 nodes": "mini", "2000 discs": "paper"} if FULL else {}
    return {f"{NODES} nodes": small, **{name: [request.getfixturevalue(layer)] for name, layer in full.items()}}


@pytest.fixture(scope="module")
def layers(groups: dict[str, list[Layer]]) -> list[Layer]:
    return [layer for group in groups.values() for layer in group]


def test_forces_balance(small: list[Layer]) -> None:
    for layer in small:
        whole = PRESSURE * layer.period
        for axis in ("x", "y"):
            rest = sum(layer.run.probe(f"{of}.{what}_{axis}") for of, what in
                       (("force_lower", "force"), ("force_upper", "force"), ("grains", "total_force")))
            CASE.check(Label.EXACT, f"{layer.name}: {axis} forces on walls and grains", np.abs(rest).max() / whole, 0,
                       ROUNDING, "contact forces on two bodies are opposite; rounding")
        pressed = ramp(layer.run.times("upper.acceleration_y")) * whole
        inertia = SLAB * layer.period * layer.run.probe("upper.acceleration_y")
        rest = layer.run.probe("force_upper.force_y") - pressed - inertia
        CASE.check(Label.EXACT, f"{layer.name}: y force on the upper wall less inertia and pressure",
                   np.abs(rest).max() / whole, 0, ROUNDING, "Newton's law; rounding")


def ramp(times: np.ndarray) -> np.ndarray:
    """Share of the pressure, 0 to 1."""
    return np.clip(times / PRESSED, 0, 1)


def test_normal_force_rises_and_stays(small: list[Layer]) -> None:
    for layer in small:
        for name, start, end in (("while pressed", 0.0, PRESSED), ("while sheared", PRESSED, layer.end)):
            mean = Mean(block_means(unbalanced_pressure(layer, start, end), SHORT_BLOCK))
            CASE.check(Label.EXACT, f"{layer.name}: normal force less change of momentum and pressure, {name}",
                       mean.value, 0, mean.error, f"momentum of grains and upper wall; by samples: {mean}")


def unbalanced_pressure(layer: Layer, start: float, end: float) -> np.ndarray:
    """By sample: normal force on the lower wall less the imposed one and the change of momentum since the last sample,
    over the full pressure. Momentum changes by the mean force, not by that of the sample, so only means vanish."""
    times = layer.times_between("force_lower.force_y", start, end)
    normal = -layer.between("force_lower.force_y", start, end) / (PRESSURE * layer.period)
    return normal - ramp(times) - np.diff(momentum(layer, start - SAMPLING / 2, end)) / (PRESSURE * SAMPLING)


def momentum(layer: Layer, start: float, end: float) -> np.ndarray:
    """Upward momentum of grains and upper wall, kg/(m s) per metre of the period; all grains have the same mass."""
    grains = ROWS * DENSITY * math.pi / 4 * DIAMETER**2 / PITCH
    return (SLAB * layer.between("upper_motion.velocity_y", start, end)
            + grains * layer.between("grains_motion.velocity_y", start, end))


def test_peak_of_friction(groups: dict[str, list[Layer]]) -> None:
    for name, group in groups.items():
        CASE.check(Label.INDEPENDENT, f"{name}: friction factor, peak", np.mean([layer.peak for layer in group]), PEAK,
                   READING + 3 * PEAK_SCATTER / math.sqrt(len(group)),
                   f"Mollon 2018, figure 9, read to {READING}; three standard errors of {len(group)} peaks, README.md")


def test_friction_falls_suddenly(layers: list[Layer]) -> None:
    """Friction reaches its plateau within the width of the paper's line, 0.1 us."""
    for layer in layers:
        block = layer.plateau.std(ddof=1)
        CASE.check(Label.INDEPENDENT, f"{layer.name}: friction factor, fall within {BREAK:.1g} s of the peak",
                   layer.fall, PEAK - FLOW, 2 * READING + 3 * math.hypot(PEAK_SCATTER, block),
                   "Mollon 2018, figure 9, two readings; three standard deviations of the peak and of means over "
                   f"{AFTERMATH - BREAK:.1g} s of the plateau, {block:.3f}")


def test_plateau_of_friction(groups: dict[str, list[Layer]]) -> None:
    for name, group in groups.items():
        mean = Mean(np.concatenate([layer.plateau for layer in group]))
        CASE.check(Label.INDEPENDENT, f"{name}: friction factor, plateau", mean.value, FLOW, READING + mean.error,
                   f"Mollon 2018, figure 9, read to {READING}; {mean}")


def test_energy(layers: list[Layer]) -> None:
    for layer in layers:
        CASE.check(Label.EXACT, f"{layer.name}: error of the energy balance", layer.run.balance_error, 0, 0.01,
                   "energy balance; time steps near the stability limit lose up to 1 %")


@pytest.fixture(scope="module")
def doubling() -> Run:
    """The paper's scheme on a layer of 24 discs, as its controller does not depend on the size."""
    return CASE.engine("doubling", scene(1, columns=4, rows=6, end=0.3e-6, pressed=0.2e-6, integrator=DOUBLING))


def test_step_doubling_holds_its_target(doubling: Run) -> None:
    error = doubling.steps("error") / TARGET
    CASE.check(Label.EXACT, "step doubling: largest error over target", error.max(), ALPHA / 2, ALPHA / 2,
               "steps above alpha targets are rejected")
    CASE.check(Label.INDEPENDENT, "step doubling: geometric mean of the error over the target",
               np.exp(np.log(error).mean()), 1, 0.02,
               "Mollon 2018, figure 8; changes of the step cancel over a run, except where 60 outputs shorten it")


def test_order(layers: list[Layer]) -> None:
    for layer in layers:
        CASE.check(Label.EXACT, f"{layer.name}: |psi6| at the start", layer.order[0], 1, 1e-4,
                   "hexagonal lattice of 0.87 by 1.002: angles of 60 degrees to 0.1")
        for time in (PRESSED, INTACT):
            CASE.check(Label.INDEPENDENT, f"{layer.name}: first neighbours kept at {1e6 * time:g} us",
                       layer.kept[layer.frames.nearest(time)], 1, 0.5 * BONDS_ACROSS / BONDS,
                       "Mollon 2018, figures 7c and 7d: the lattice is intact; half of the loss by one slipped row")
        CASE.check(Label.INDEPENDENT, f"{layer.name}: first neighbours kept, carried on to {1e6 * GONE:g} us",
                   kept_at_last(layer), 0, SLIDING,
                   "Mollon 2018, figure 7: no order; grains in rows that slide as wholes keep two of six neighbours")


def kept_at_last(layer: Layer) -> float:
    """Share of kept neighbours at GONE, extrapolated at the rate of the plateau."""
    first, last = (layer.frames.nearest(time) for time in (PLATEAU, layer.end))
    times, kept = layer.frames.times[[first, last]], layer.kept[[first, last]]
    return float(kept[1] * (kept[1] / kept[0]) ** ((GONE - times[1]) / (times[1] - times[0])))


def test_mixing(groups: dict[str, list[Layer]]) -> None:
    """The first lattice has rows of one kind; mixed kinds equal a random assignment. Clusters have no other cause."""
    for name, group in groups.items():
        for layer in group:
            CASE.check(Label.EXACT, f"{layer.name}: like neighbours at the start", layer.like[0], ROWS / BONDS, 1e-12,
                       "kinds in turn up columns of an even number of grains: only pairs in a row are alike")
        start, end = (np.mean([layer.like[frame] for layer in group]) for frame in (0, -1))
        mean, deviation = like_fraction_at_random(group[0].neighbours[-1], group[0].kinds)
        certain = 3 * deviation / math.sqrt(len(group))
        CASE.check(Label.INDEPENDENT, f"{name}: like neighbours at the end", end, 0.5 * (start + mean) + certain,
                   0.5 * (mean - start), f"order that becomes random: more than {start:.3f} at the start, not more "
                   f"than {mean:.3f} at random, each by three standard deviations of random assignments")


def test_pictures(layers: list[Layer], doubling: Run) -> None:
    figure, axes = panels(4, f"Third body, seeds with {NODES} nodes a disc: as figures 8 to 10 of Mollon 2018")
    for layer, colour in zip(layers, COLOURS):
        draw_histories(axes, layer, colour)
    decorate(axes, layers[0])
    save(CASE, figure, "histories")
    run = read_run(layers[0].run.folder)
    chosen = [layers[0].frames.nearest(time) for time in (0.0, INTACT, PLATEAU, layers[0].end)]
    save(CASE, maps.grains(run, chosen), "grains")
    save(CASE, curves.steps(read_run(doubling.folder)), "step_doubling")


def draw_histories(axes: list[Axes], layer: Layer, colour: str) -> None:
    """Normal force, friction factor, order and mixing over time."""
    times = 1e6 * layer.run.times("force_lower.force_y")
    force_x, force_y = (layer.run.probe(f"force_lower.force_{axis}") for axis in ("x", "y"))
    axes[0].plot(times, -force_y / (PRESSURE * layer.period), color=colour, linewidth=0.9, label=layer.name)
    sheared = times > 1e6 * PRESSED
    axes[1].plot(times[sheared], -(force_x / force_y)[sheared], color=colour, linewidth=0.6, alpha=0.4)
    middle, smooth = layer.smooth_friction
    label = f"{layer.name}: {layer.peak:.2f}, then {layer.plateau.mean():.2f}"
    axes[1].plot(1e6 * middle, smooth, color=colour, linewidth=1.2, label=label)
    frames = 1e6 * layer.frames.times
    axes[2].plot(frames, layer.kept, color=colour, linewidth=1.2, label=f"first neighbours kept, {layer.name}")
    axes[2].plot(frames, layer.order, ":", color=colour, linewidth=1.2, label=f"mean |psi6|, {layer.name}")
    axes[3].plot(frames, layer.like, color=colour, linewidth=1.2, label=layer.name)


def decorate(axes: list[Axes], layer: Layer) -> None:
    """Expected values and labels."""
    times = np.linspace(0, layer.end, 200)
    axes[0].plot(1e6 * times, ramp(times), "--", color=COLOURS[7], linewidth=0.8, label="imposed")
    for what, value, style in (("peak", PEAK, ":"), ("plateau", FLOW, "--")):
        axes[1].axhline(value, linestyle=style, color=COLOURS[7], linewidth=0.8, label=f"{what} of the paper")
    mean, deviation = like_fraction_at_random(layer.neighbours[-1], layer.kinds)
    axes[3].axhspan(mean - 2 * deviation, mean + 2 * deviation, color=COLOURS[6], alpha=0.25,
                    label="dealt at random, two standard deviations")
    names = ["normal force over\npressure x period", "friction factor\non the lower wall", "order", "like neighbours"]
    for panel, name in zip(axes, names):
        panel.set_ylabel(name)
        panel.legend(fontsize=8, frameon=False, ncols=2, loc="lower right")
    axes[1].set_ylim(-0.15, 0.55)
    axes[2].set_ylim(0.3, 1.03)
    axes[3].set_ylim(0.25, 0.6)
    axes[-1].set_xlabel("time [us]")
