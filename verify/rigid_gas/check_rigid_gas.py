"""Twenty rigid grains in a box with some thousand impacts: energy at times without contact."""

from __future__ import annotations

import numpy as np
import pytest

from pictures import COLOURS, legend, panels, save
from verification import FULL, Case, Label, Run

CASE = Case(__file__)
GRAINS = ["disc", "square"]
END = 176.0 if FULL else 35.0  # 1e5 or 2e4 steps at the default safety
PERIOD = 0.05
SAFETY = 0.8
SIDE, COUNT = 8.0, 20
BARS = [("lying", 4.0, -0.5), ("lying", 4.0, 8.5), ("upright", -0.5, 4.0), ("upright", 8.5, 4.0)]


def scene(grain: str) -> str:
    random = np.random.default_rng(5)
    radius = 0.5 if grain == "disc" else 0.45 * np.sqrt(2)
    centres: list[np.ndarray] = []
    while len(centres) < COUNT:
        centre = random.uniform(radius + 0.05, SIDE - radius - 0.05, 2)
        if all(np.hypot(*(centre - other)) > 2 * radius + 0.02 for other in centres):
            centres.append(centre)
    grains = []
    for i, (x, y) in enumerate(centres):
        way, speed = random.uniform(0, 2 * np.pi), random.uniform(0.5, 1.5)
        velocity = [float(speed * np.cos(way)), float(speed * np.sin(way))]
        grains.append(body(f"grain-{i}", grain, float(x), float(y), f"angle = {random.uniform(0, 6)!r}\nvelocity = "
                           f"{{ uniform = {velocity}, rotation = {random.uniform(-1, 1)!r} }}\n"))
    bars = [body(f"bar-{i}", shape, x, y) + f'[[boundary]]\nof = "bar-{i}"\nx = "fixed"\ny = "fixed"\nangle = "fixed"\n'
            for i, (shape, x, y) in enumerate(BARS)]
    return CASE.scene(grain=grain, grains="\n".join(grains), bars="\n".join(bars), end=END, period=PERIOD, safety=SAFETY)


def body(name: str, shape: str, x: float, y: float, rest: str = "") -> str:
    return (f'[[grains]]\nname = "{name}"\nshape = "{shape}"\nbody = "rigid"\nmaterial = "hard"\n'
            f'packing = {{ kind = "positions", positions = [[{x!r}, {y!r}]] }}\n{rest}')


@pytest.fixture(scope="module")
def runs() -> dict[str, Run]:
    return {grain: CASE.engine(grain, scene(grain)) for grain in GRAINS}


def off(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """Times without contact, and the relative deviation of the kinetic energy from its initial value."""
    kinetic, free = run.probe("energies.kinetic"), run.probe("energies.contact") == 0
    return run.times("energies.kinetic")[free], np.abs(kinetic[free] / kinetic[0] - 1)


@pytest.mark.parametrize("grain", GRAINS)
def test_keeps_its_energy(runs: dict[str, Run], grain: str) -> None:
    _, errors = off(runs[grain])
    CASE.check(Label.EXACT, f"{grain}s: kinetic energy when nothing touches, most", errors.max(), 0, 1e-2,
               "conserved; specified: 1 % during the run, as pairs just separated may still have an energy error")
    CASE.check(Label.EXACT, f"{grain}s: the same, median", float(np.median(errors)), 0, 1e-10,
               "corrected to rounding: some 1e4 sums of energies, each to 1e-15 of the total")


def test_picture(runs: dict[str, Run]) -> None:
    figure, axes = panels(1, "Rigid grains in a box: kinetic energy when nothing touches, over the start's, less 1")
    for (grain, run), colour in zip(runs.items(), COLOURS):
        times, errors = off(run)
        axes[0].semilogy(times, np.maximum(errors, 1e-16), ".", color=colour, markersize=3, label=f"{grain}s")
    axes[0].set_xlabel("time")
    legend(axes[0])
    save(CASE, figure, "rigid_gas")
