"""Energy over a hundred periods of free oscillation and in a bounce: Newmark, HHT dissipation, the engine."""

from __future__ import annotations

import subprocess
from dataclasses import dataclass

import numpy as np
import pytest

from hht_recurrence import energies, modes_of
from motion import SINGLE, read_motion
from order_study import check_steps
from pictures import COLOURS, describe, legend, panels, save
from verification import ENGINE, Case, Label, Run

CASE = Case(__file__)
ALPHAS = [0.0, -0.1, -0.3]
STEPS = [0.04, 0.02, 0.01]
LONG_STEP = 0.04
PERIOD = 2.7  # of the oval mode, with lumped mass
RATE = 0.3  # initial strain rate, 1/s
SMALL = [1e-3, 5e-4, 2.5e-4]  # rates
LARGE_STEP, LARGE_STEPS = 0.2, 270  # twenty periods
FRAMES = '\n[frames]\nperiod = 1\nfields = ["displacement"]\n'


def total(run: Run) -> np.ndarray:
    """Kinetic, strain and contact energy."""
    return sum(run.probe(f"clock.{name}") for name in ("kinetic", "strain", "contact"))


def error(run: Run) -> np.ndarray:
    energy = total(run)
    return energy / energy[0] - 1


def scene_of(dt: float, end: float, rate: float = RATE) -> str:
    return CASE.scene("free.toml", dt=dt, end=end, rate=rate, contrary=-rate)


def runs_of(name: str, scene: str, dt: float, alphas: list[float]) -> dict[str, Run]:
    runs = {"engine": CASE.engine(f"{name}_engine", scene)}
    check_steps(runs["engine"], dt)
    for alpha in alphas:
        label = f"HHT {alpha:g}" if alpha else "Newmark"
        runs[label] = CASE.reference(f"{name}_reference_{abs(alpha):g}", scene, "--dt", repr(dt), "--hht", repr(alpha))
    return runs


@pytest.fixture(scope="module")
def free() -> dict[str, Run]:
    """A hundred periods."""
    return runs_of("free_long", scene_of(LONG_STEP, 100 * PERIOD), LONG_STEP, ALPHAS[:1])


@pytest.fixture(scope="module")
def swings() -> dict[float, dict[str, Run]]:
    """The first ten periods."""
    return {dt: runs_of(f"free_{dt:g}", scene_of(dt, 10 * PERIOD), dt, ALPHAS[:1]) for dt in STEPS}


@pytest.fixture(scope="module")
def bounce() -> dict[float, dict[str, Run]]:
    return {dt: runs_of(f"bounce_{dt:g}", CASE.scene("bounce.toml", dt=dt), dt, ALPHAS) for dt in STEPS}


@pytest.mark.parametrize("name", ["engine", "Newmark"])
def test_free_oscillation_keeps_its_energy(free: dict[str, Run], name: str) -> None:
    """Errors oscillate but do not grow: mean of the last tenth against that of the first."""
    values = error(free[name])
    tenth = len(values) // 10
    drift = values[-tenth:].mean() - values[:tenth].mean()
    CASE.check(Label.EXACT, f"free, {name}: drift over 100 periods over the swings", drift / np.abs(values).max(), 0,
               0.5, "oscillations do not accumulate: a drift of half their amplitude would be seen")
    CASE.check(Label.EXACT, f"free, {name}: largest error", np.abs(values).max(), 0, 0.01, "specified: 1 %")


@pytest.mark.parametrize("name", ["engine", "Newmark"])
def test_swings_of_the_energy(swings: dict[float, dict[str, Run]], name: str) -> None:
    swing = [float(error(runs[name]).std()) for runs in swings.values()]
    CASE.check_rate(f"free, {name}: rms of the swings in ten periods", STEPS, swing, 2, 0.25,
                    "second order; a tenth, one of ten periods, for incomplete slow oscillations")


@dataclass
class Damped:
    """Remaining energy of an oscillation with HHT, over the initial one."""

    times: np.ndarray
    found: dict[float, np.ndarray]  # by initial strain rate, 1/s
    expected: np.ndarray

    @property
    def losses(self) -> list[float]:
        """Final losses over the expected one."""
        return [float((1 - found[-1]) / (1 - self.expected[-1])) for found in self.found.values()]


@pytest.fixture(scope="module")
def damped() -> dict[float, Damped]:
    """Results by alpha."""
    motions = small_motions()
    return {alpha: damped_by(alpha, *motions) for alpha in ALPHAS[1:]}


def small_motions() -> tuple[np.ndarray, np.ndarray]:
    """Modes and modal velocities of an oscillation of rate 1."""
    run = CASE.engine("small", scene_of(LONG_STEP, LONG_STEP, SMALL[0]) + FRAMES)
    command = [str(ENGINE), "modes", str(CASE.out / "small.toml"), "--count", "1", "--matrices", str(CASE.out / "matrices")]
    subprocess.run(command, capture_output=True, check=True, stdin=subprocess.DEVNULL)
    return modes_of(CASE.out / "matrices", (read_motion(run).positions[0] * [1, -1]).ravel())


def damped_by(alpha: float, squares: np.ndarray, speeds: np.ndarray) -> Damped:
    runs = {rate: CASE.reference(f"small_{rate:g}_{abs(alpha):g}", scene_of(LARGE_STEP, LARGE_STEP * LARGE_STEPS, rate),
                                 "--dt", repr(LARGE_STEP), "--hht", repr(alpha)) for rate in SMALL}
    left = energies(squares, speeds, alpha, LARGE_STEP, LARGE_STEPS)
    return Damped(LARGE_STEP * np.arange(LARGE_STEPS + 1), {rate: 1 + error(run) for rate, run in runs.items()},
                  left / left[0])


@pytest.mark.parametrize("alpha", ALPHAS[1:])
def test_hht_takes_out_what_its_recurrence_says(damped: dict[float, Damped], alpha: float) -> None:
    """HHT damps each small mode as a function of step over period."""
    losses = np.array(damped[alpha].losses)
    before, limit = 2 * losses[1:] - losses[:-1]
    CASE.check(Label.EXACT, f"small swings, HHT {alpha:g}: loss over that of the recurrence on the disc's own modes",
               limit, 1, abs(limit - before) + 2 * SINGLE,
               "extrapolation to zero rate removes the first nonlinear order; of the second, a third of the change by "
               "halving the rates remains; nodes in single precision")


@pytest.mark.parametrize("name", ["engine", "Newmark"])
def test_bounce_loses_little(bounce: dict[float, dict[str, Run]], name: str) -> None:
    errors = [float(np.abs(error(bounce[dt][name])).max()) for dt in STEPS]
    CASE.check_rate(f"bounce, {name}: largest error", STEPS, errors, 2, 0.5,
                    "second order; scatter by kinks of the contact force")


def test_picture(free: dict[str, Run], damped: dict[float, Damped], bounce: dict[float, dict[str, Run]]) -> None:
    figure, axes = panels(3, "Energy over its start, less 1", across=True)
    for (name, run), colour in zip(free.items(), COLOURS):
        axes[0].plot(run.times("clock.kinetic") / PERIOD, error(run), color=colour, linewidth=0.5, label=name)
    for (alpha, swing), colour in zip(damped.items(), COLOURS[2:]):
        axes[1].plot(swing.times / PERIOD, swing.found[SMALL[-1]] - 1, color=colour, linewidth=1.1, label=f"HHT {alpha:g}")
        axes[1].plot(swing.times / PERIOD, swing.expected - 1, ":", color=COLOURS[6], linewidth=1.5,
                     label=f"recurrence, {alpha:g}")
    for (name, run), colour in zip(bounce[STEPS[1]].items(), COLOURS):
        axes[2].plot(run.times("clock.kinetic"), error(run), color=colour, linewidth=1.1, label=name)
    titles = "large free swings", f"small ones, step {LARGE_STEP:g}", f"bounce, step {STEPS[1]:g}"
    for panel, title in zip(axes, titles):
        describe(panel, title, "periods of the oval mode")
        legend(panel)
    axes[2].set_xlabel("time [s]")
    save(CASE, figure, "energy_drift")
