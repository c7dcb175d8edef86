"""Energy over a hundred periods of free oscillation and in a bounce: Newmark, what HHT takes out, the engine."""

from __future__ import annotations

import numpy as np
import pytest

from order_study import check_steps
from pictures import COLOURS, legend, panels, save
from verification import Case, Label, Run

CASE = Case(__file__)
ALPHAS = [0.0, -0.1, -0.3]
STEPS = [0.04, 0.02, 0.01]
LONG_STEP = 0.04
PERIOD = 2.7  # of the oval mode, with lumped mass


def total(run: Run) -> np.ndarray:
    """Kinetic, strain and contact energy."""
    return sum(run.probe(f"clock.{name}") for name in ("kinetic", "strain", "contact"))


def error(run: Run) -> np.ndarray:
    energy = total(run)
    return energy / energy[0] - 1


def runs_of(template: str, dt: float, alphas: list[float], **values: float) -> dict[str, Run]:
    name = "_".join([template.removesuffix(".toml"), *(f"{value:g}" for value in (dt, *values.values()))])
    scene = CASE.scene(template, dt=dt, **values)
    runs = {"engine": CASE.engine(f"{name}_engine", scene)}
    check_steps(runs["engine"], dt)
    for alpha in alphas:
        label = f"HHT {alpha:g}" if alpha else "Newmark"
        runs[label] = CASE.reference(f"{name}_reference_{abs(alpha):g}", scene, "--dt", repr(dt), "--hht", repr(alpha))
    return runs


@pytest.fixture(scope="module")
def free() -> dict[str, Run]:
    """A hundred periods."""
    return runs_of("free.toml", LONG_STEP, ALPHAS, end=100 * PERIOD)


@pytest.fixture(scope="module")
def swings() -> dict[float, dict[str, Run]]:
    """The first ten of them."""
    return {dt: runs_of("free.toml", dt, ALPHAS[:1], end=10 * PERIOD) for dt in STEPS}


@pytest.fixture(scope="module")
def bounce() -> dict[float, dict[str, Run]]:
    return {dt: runs_of("bounce.toml", dt, ALPHAS) for dt in STEPS}


@pytest.mark.parametrize("name", ["engine", "Newmark"])
def test_free_oscillation_keeps_its_energy(free: dict[str, Run], name: str) -> None:
    """Errors swing but do not grow: mean of the last tenth against that of the first."""
    values = error(free[name])
    tenth = len(values) // 10
    drift = values[-tenth:].mean() - values[:tenth].mean()
    CASE.check(Label.EXACT, f"free, {name}: drift over 100 periods over the swings", drift / np.abs(values).max(), 0,
               0.5, "swings do not add up: a drift of half of them would be seen")
    CASE.check(Label.EXACT, f"free, {name}: largest error", np.abs(values).max(), 0, 0.01, "promised: 1 %")


@pytest.mark.parametrize("name", ["engine", "Newmark"])
def test_swings_of_the_energy(swings: dict[float, dict[str, Run]], name: str) -> None:
    swing = [float(error(runs[name]).std()) for runs in swings.values()]
    CASE.check_rate(f"free, {name}: rms of the swings in ten periods", STEPS, swing, 2, 0.25,
                    "second order; a tenth of ten periods is one, for slow swings that have not come around")


def test_hht_takes_energy_out(free: dict[str, Run]) -> None:
    """The more the larger alpha; balance errors of the books are just that loss."""
    losses = [-error(free[name])[-1] for name in ("HHT -0.1", "HHT -0.3")]
    for alpha, loss, name in zip(ALPHAS[1:], losses, ("HHT -0.1", "HHT -0.3")):
        CASE.check(Label.EXACT, f"free, {name}: balance error over the loss", free[name].balance_error / loss, 1,
                   1e-9, "no other loss; rounding")
    CASE.check(Label.EXACT, "free: HHT -0.3 takes more than -0.1, which takes some",
               float(losses[1] > losses[0] > 0.01), 1, 0, "dissipative by design")


@pytest.mark.parametrize("name", ["engine", "Newmark"])
def test_bounce_loses_little(bounce: dict[float, dict[str, Run]], name: str) -> None:
    errors = [float(np.abs(error(bounce[dt][name])).max()) for dt in STEPS]
    CASE.check_rate(f"bounce, {name}: largest error", STEPS, errors, 2, 0.5,
                    "second order; kinks of the contact scatter it")


def test_picture(free: dict[str, Run], bounce: dict[float, dict[str, Run]]) -> None:
    figure, axes = panels(3, "Energy over its start, less 1", across=True)
    for (name, run), colour in zip(free.items(), COLOURS):
        times = run.times("clock.kinetic")
        axes[0].plot(times / PERIOD, error(run), color=colour, linewidth=1.1, label=name)
        if name in ("engine", "Newmark"):
            axes[1].plot(times / PERIOD, error(run), color=colour, linewidth=0.5, label=name)
    for (name, run), colour in zip(bounce[STEPS[1]].items(), COLOURS):
        axes[2].plot(run.times("clock.kinetic"), error(run), color=colour, linewidth=1.1, label=name)
    for panel, title in zip(axes, ("free oscillation", "those without dissipation", f"bounce, step {STEPS[1]:g}")):
        panel.set_title(title, fontsize=10, loc="left")
        panel.set_xlabel("periods of the oval mode")
        legend(panel)
    axes[2].set_xlabel("time [s]")
    save(CASE, figure, "energy_drift")
