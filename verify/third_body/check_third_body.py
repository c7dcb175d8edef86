"""The third body of Mollon 2018: forces on the walls, friction, steps, order and mixing of the sheared layer."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pytest
from matplotlib.axes import Axes

from pictures import COLOURS, panels, save
from plots import curves, maps
from plots.run_data import WALL, Frames, read_run
from third_body_order import (Neighbours, bond_order, kept_fraction, like_fraction, like_fraction_at_random,
                              neighbours)
from verification import FULL, ROOT, Case, Label, Run

CASE = Case(__file__, cost=4)

DIAMETER, PITCH, ROW_PITCH = 1e-6, 0.87e-6, 1.002e-6  # m
COLUMNS, ROWS = 10, 20
PRESSURE = 1e9  # Pa
PRESSED, SHEARED = 1e-6, 1.05e-6  # s, when the pressure is whole, and the speed of shear
END = 3.5e-6  # s
PLATEAU = 2e-6  # s: the layer has been sheared by half of its height
NODES, SEEDS = 60, [1, 2]
SAMPLING, FRAMES = 5e-9, 1e-7  # s
SLAB = 5e-6 * 1200  # kg/m2, mass of a wall by its length
TOLERANCE = 1e-2  # of the engine's error estimate
VERLET = f'integrator = "verlet"\ntolerance = {TOLERANCE}'
TARGET, ALPHA, BETA = 1e-4, 2, 0.2  # the paper's of its scheme
DOUBLING = f'integrator = "step-doubling"\ntarget = {TARGET}\nalpha = {ALPHA}\nbeta = {BETA}'
ROUNDING = 1e-12  # 1e4 contact forces of up to a hundredth of the whole, each to 2e-16, add up to 2e-14
SMOOTHED = 10  # samples of forces in a mean
PAPER = {"peak": 0.5, "plateau": 0.25}
INTACT, HALF_SHEARED = 1.5e-6, 6e-6  # s, of the paper's snapshots
PEAK_SCATTER = 0.02  # of the highest friction factors of cycles of stick and slip
READING, CYCLE = 0.02, 3e-7  # of the paper's curves; s, of stick and slip on the plateau
PAPER_PERIOD, PAPER_END = 87e-6, 3e-6  # m, s: as far as an hour takes it
FINISHED = ROOT / "results/third_body"  # where `./pliant run cases/third_body.toml` leaves the paper's scene


def scene(seed: int, nodes: int = NODES, columns: int = COLUMNS, rows: int = ROWS, end: float = END,
          pressed: float = PRESSED, integrator: str = VERLET) -> str:
    return CASE.scene(columns=columns, rows=rows, nodes=nodes, seed=seed, end=end, integrator=integrator,
                      period=columns * PITCH, top=(rows + 0.5) * ROW_PITCH, pressed=pressed,
                      sheared=pressed + SHEARED - PRESSED, sampling=SAMPLING, frames=FRAMES)


@dataclass
class Layer:
    """A run of the scene, and what its frames tell."""

    name: str
    run: Run
    period: float

    @cached_property
    def frames(self) -> Frames:
        return Frames(self.run.folder / "frames.h5", self.period)

    @cached_property
    def grains(self) -> np.ndarray:
        grid = self.frames.grids["outlines"]
        return np.unique(grid.body[grid.kind != WALL])

    @cached_property
    def kinds(self) -> np.ndarray:
        """[grains] 0 compliant, 1 rigid."""
        grid = self.frames.grids["outlines"]
        return np.array([grid.kind[grid.body == grain][0] for grain in self.grains])

    def centres(self, index: int) -> np.ndarray:
        """[grains x 2] m, means of the outlines."""
        body = self.frames.grids["outlines"].point_body
        points = self.frames.positions("outlines", index)[: len(body)]
        sums = np.stack([np.bincount(body, column) for column in points.T], axis=1)
        return (sums / np.bincount(body)[:, None])[self.grains]

    @cached_property
    def neighbours(self) -> list[Neighbours]:
        """By frame."""
        return [neighbours(self.centres(i), self.period, DIAMETER) for i in range(len(self.frames.times))]

    @cached_property
    def order(self) -> np.ndarray:
        """[frames] mean |psi6|."""
        return np.array([np.nanmean(bond_order(of)) for of in self.neighbours])

    @cached_property
    def kept(self) -> np.ndarray:
        """[frames] share of the first neighbours that still are."""
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
        """On the lower wall, positive as the upper one moves; means of 50 ns, as the paper's curves are smooth."""
        force_x, force_y = (self.between(f"force_lower.force_{axis}", start, end) for axis in ("x", "y"))
        return np.convolve(-force_x / force_y, np.ones(SMOOTHED) / SMOOTHED, "valid")

    @property
    def peak(self) -> float:
        return float(self.friction(PRESSED, self.end).max())

    @property
    def plateau(self) -> float:
        return float(self.friction(PLATEAU, self.end).mean())


def solved(seed: int) -> Layer:
    return Layer(f"seed {seed}", CASE.engine(f"seed_{seed}", scene(seed)), COLUMNS * PITCH)


def of_the_repository() -> Layer:
    """cases/third_body_mini.toml as it is, with 168 nodes."""
    text = (ROOT / "cases/third_body_mini.toml").read_text()
    return Layer("168 nodes", CASE.engine("mini", text), COLUMNS * PITCH)


def of_the_paper() -> Layer:
    """cases/third_body.toml, 2000 discs of 168 nodes: as it was run, or its beginning."""
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
def layers(small: list[Layer], request: pytest.FixtureRequest) -> list[Layer]:
    return [*small, *([request.getfixturevalue(name) for name in ("mini", "paper")] if FULL else [])]


def test_forces_balance(small: list[Layer]) -> None:
    for layer in small:
        whole = PRESSURE * layer.period
        for axis in ("x", "y"):
            rest = sum(layer.run.probe(f"{of}.{what}_{axis}") for of, what in
                       (("force_lower", "force"), ("force_upper", "force"), ("grains", "total_force")))
            CASE.check(Label.EXACT, f"{layer.name}: {axis} forces on walls and grains", np.abs(rest).max() / whole, 0,
                       ROUNDING, "contacts act on two bodies oppositely; rounding")
        pressed = ramp(layer.run.times("upper.acceleration_y")) * whole
        inertia = SLAB * layer.period * layer.run.probe("upper.acceleration_y")
        rest = layer.run.probe("force_upper.force_y") - pressed - inertia
        CASE.check(Label.EXACT, f"{layer.name}: y force on the upper wall less inertia and pressure",
                   np.abs(rest).max() / whole, 0, ROUNDING, "Newton's law; rounding")


def ramp(times: np.ndarray) -> np.ndarray:
    """Of the pressure, 0 to 1."""
    return np.clip(times / PRESSED, 0, 1)


def test_normal_force_rises_and_stays(layers: list[Layer]) -> None:
    for layer in layers:
        for name, start, end in (("while pressed", 0.0, PRESSED), ("while sheared", PRESSED, layer.end)):
            times = layer.times_between("force_lower.force_y", start, end)
            ratio = -layer.between("force_lower.force_y", start, end) / (PRESSURE * layer.period) / ramp(times).mean()
            scatter = np.std(ratio - ramp(times) / ramp(times).mean())
            CASE.check(Label.EXACT, f"{layer.name}: normal force over pressure x period, {name}", ratio.mean(), 1,
                       3 * scatter / math.sqrt(len(ratio)) + 1e-4,
                       "momentum: scatter of samples, and 1e-4 that walls and grains may keep at 10 m/s")


def check_friction(layer: Layer, what: str) -> None:
    scatter = layer.friction(PLATEAU, layer.end).std()
    cycles = (layer.end - PLATEAU) / CYCLE
    tolerance, of = {"plateau": (3 * scatter / math.sqrt(cycles), f"{cycles:.1f} cycles of stick and slip"),
                     "peak": (3 * PEAK_SCATTER, "one stick-slip peak")}[what]
    CASE.check(Label.INDEPENDENT, f"{layer.name}: friction factor, {what}", getattr(layer, what), PAPER[what],
               tolerance + READING, f"Mollon 2018, figure 9, read to 0.02; three standard errors of {of}")


def test_plateau_of_friction(small: list[Layer]) -> None:
    for layer in small:
        check_friction(layer, "plateau")


@pytest.mark.xfail(strict=True, raises=AssertionError, reason="half of the paper's peak: see README.md")
def test_peak_of_friction(small: list[Layer]) -> None:
    """Red: it shall stay in sight until it is understood. Of the seed that comes nearest."""
    check_friction(max(small, key=lambda layer: layer.peak), "peak")


@pytest.mark.skipif(not FULL, reason="long")
@pytest.mark.xfail(strict=True, raises=AssertionError,
                   reason="half of the paper's peak, three to four fifths of its plateau: see README.md")
@pytest.mark.parametrize("what", PAPER)
@pytest.mark.parametrize("which", ["mini", "paper"])
def test_friction_of_the_papers_nodes(which: str, what: str, request: pytest.FixtureRequest) -> None:
    check_friction(request.getfixturevalue(which), what)


def test_energy(layers: list[Layer]) -> None:
    for layer in layers:
        CASE.check(Label.EXACT, f"{layer.name}: error of the energy balance", layer.run.balance_error, 0, 0.01,
                   "books of energy; time steps near the stability limit lose up to 1 %")


@pytest.fixture(scope="module")
def doubling() -> Run:
    """The paper's scheme, on a layer of 24 discs: what its controller does does not depend on the size."""
    return CASE.engine("doubling", scene(1, columns=4, rows=6, end=0.3e-6, pressed=0.2e-6, integrator=DOUBLING))


def test_step_doubling_holds_its_target(doubling: Run) -> None:
    error = doubling.steps("error") / TARGET
    CASE.check(Label.EXACT, "step doubling: largest error over target", error.max(), ALPHA / 2, ALPHA / 2,
               "steps above alpha targets are rejected")
    CASE.check(Label.INDEPENDENT, "step doubling: geometric mean of the error over the target",
               np.exp(np.log(error).mean()), 1, 0.02,
               "Mollon 2018, figure 8; changes of the step cancel over a run, but where 60 outputs cut it short")


def test_order(layers: list[Layer]) -> None:
    for layer in layers:
        CASE.check(Label.EXACT, f"{layer.name}: |psi6| at the start", layer.order[0], 1, 1e-4,
                   "hexagonal lattice of 0.87 by 1.002: angles of 60 degrees to 0.1")
        intact, later = (layer.kept[layer.frames.nearest(time)] for time in (INTACT, min(HALF_SHEARED, layer.end)))
        CASE.check(Label.INDEPENDENT, f"{layer.name}: neighbours kept at 1.5 us", intact, 1, 0.1,
                   "Mollon 2018, figure 7: order intact; a tenth is seen as a line of defects")
        rate = np.log2(intact / later) / (min(HALF_SHEARED, layer.end) - INTACT)
        CASE.check(Label.INDEPENDENT, f"{layer.name}: log2 of the rate of halving of neighbours, over once in 4.5 us",
                   np.log2(rate * (HALF_SHEARED - INTACT)), 0, 1,
                   "Mollon 2018, figure 7: half of the layer sheared from 1.5 to 6 us, by eye: to a factor of two")


def test_mixing(layers: list[Layer]) -> None:
    """Neighbours of a kind at the start are as many as the deal of kinds makes, within its scatter."""
    for layer in layers:
        mean, deviation = like_fraction_at_random(layer.neighbours[0], layer.kinds)
        CASE.check(Label.EXACT, f"{layer.name}: like neighbours at the start", layer.like[0], mean, 3 * deviation,
                   "(n/2 - 1)/(n - 1); three standard deviations of 1000 deals of the kinds")


def test_pictures(layers: list[Layer], doubling: Run) -> None:
    figure, axes = panels(4, f"Third body, seeds with {NODES} nodes a disc: as figures 8 to 10 of Mollon 2018")
    for layer, colour in zip(layers, COLOURS):
        draw_histories(axes, layer, colour)
    decorate(axes, layers[0])
    save(CASE, figure, "histories")
    run = read_run(layers[0].run.folder)
    chosen = [layers[0].frames.nearest(time) for time in (0.0, PRESSED, INTACT, layers[0].end)]
    save(CASE, maps.grains(run, chosen), "grains")
    save(CASE, curves.steps(read_run(doubling.folder)), "step_doubling")


def draw_histories(axes: list[Axes], layer: Layer, colour: str) -> None:
    """Normal force, friction factor, order, mixing against time."""
    times = 1e6 * layer.run.times("force_lower.force_y")
    force_x, force_y = (layer.run.probe(f"force_lower.force_{axis}") for axis in ("x", "y"))
    axes[0].plot(times, -force_y / (PRESSURE * layer.period), color=colour, linewidth=0.9, label=layer.name)
    sheared = times > 1e6 * PRESSED
    axes[1].plot(times[sheared], -(force_x / force_y)[sheared], color=colour, linewidth=0.6, alpha=0.4)
    smooth = layer.friction(PRESSED, layer.end)
    middle = times[sheared][SMOOTHED // 2 :][: len(smooth)]
    label = f"{layer.name}: {layer.peak:.2f}, then {layer.plateau:.2f}"
    axes[1].plot(middle, smooth, color=colour, linewidth=1.2, label=label)
    frames = 1e6 * layer.frames.times
    axes[2].plot(frames, layer.kept, color=colour, linewidth=1.2, label=f"first neighbours kept, {layer.name}")
    axes[2].plot(frames, layer.order, ":", color=colour, linewidth=1.2, label=f"mean |psi6|, {layer.name}")
    axes[3].plot(frames, layer.like, color=colour, linewidth=1.2, label=layer.name)


def decorate(axes: list[Axes], layer: Layer) -> None:
    """What is expected, and labels."""
    times = np.linspace(0, layer.end, 200)
    axes[0].plot(1e6 * times, ramp(times), "--", color=COLOURS[7], linewidth=0.8, label="imposed")
    for what, style in (("peak", ":"), ("plateau", "--")):
        axes[1].axhline(PAPER[what], linestyle=style, color=COLOURS[7], linewidth=0.8, label=f"{what} of the paper")
    mean, deviation = like_fraction_at_random(layer.neighbours[0], layer.kinds)
    axes[3].axhspan(mean - 2 * deviation, mean + 2 * deviation, color=COLOURS[6], alpha=0.25,
                    label="dealt at random, two standard deviations")
    names = ["normal force over\npressure x period", "friction factor\non the lower wall", "order", "like neighbours"]
    for panel, name in zip(axes, names):
        panel.set_ylabel(name)
        panel.legend(fontsize=8, frameon=False, ncols=2, loc="lower right")
    axes[1].set_ylim(-0.15, 0.55)
    axes[2].set_ylim(0.3, 1.03)
    axes[3].set_ylim(0.3, 0.6)
    axes[-1].set_xlabel("time [us]")
