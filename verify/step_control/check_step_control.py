"""Time steps: conserved quantities of an oscillator under each integrator; steps by error control and stability."""

from __future__ import annotations

import numpy as np
import pytest

from pictures import COLOURS, draw_orders, legend, panels, save
from verification import Case, Label, Run

CASE = Case(__file__, fast=True)

SQUARED = 1050.0  # w^2, 1/s2: stiffness times contact length, (1.1 of the block + 1 of the floor)/2, over the mass 1
OMEGA = np.sqrt(SQUARED)
DEPTH = 1 / SQUARED  # equilibrium of weight and springs
AMPLITUDE = 0.8 * DEPTH  # released from rest below that: the block stays in contact
SPACING = 0.1  # of the outline, to which errors of steps refer
PERIOD = 2 * np.pi / OMEGA
ROUNDING = 1e-9  # positions near 0.5 with 1e-16 of rounding, amplitude 8e-4: 2e-13, over 1e4 steps
TOLERANCE = (0.1**3) * AMPLITUDE / (6 * SPACING)  # for a step of 0.1 / w
STEPS = [0.004, 0.002, 0.001, 0.0005]
DISC_STEPS = [0.02, 0.01, 0.005, 0.0025]
EQUAL = 10 * PERIOD  # after this time steps at the stability bound are equal
SAFETY, OUTPUT = 0.8, 5.3 * PERIOD  # of the run at the bound
WHOLE_OUTLINE = 1000 * 4.0  # w^2, 1/s2, with all four sides of the block in contact; it does not turn
DROP, DROP_TOLERANCE = 0.005, 1e-5  # above the floor; landing at the stable step has an error of up to 3e-3


def run(name: str, control: str, end: float, period: float) -> Run:
    scene = CASE.scene(control=control, end=end, height=0.5 - DEPTH - AMPLITUDE, period=period)
    return CASE.engine(name, scene)


def motion(result: Run) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times, displacement from equilibrium and velocity."""
    position = result.probe("block.position_y") - 0.5 + DEPTH
    return result.times("block.position_y"), position, result.probe("speed.velocity_y")


@pytest.fixture(scope="module")
def doubling() -> dict[float, Run]:
    """Steps that end at outputs, for any error."""
    control = 'integrator = "step-doubling"\ntarget = 1'
    return {dt: run(f"doubling_{dt:g}", control, 20 * PERIOD, dt) for dt in STEPS}


@pytest.fixture(scope="module")
def controlled() -> Run:
    control = f'integrator = "verlet"\ntolerance = {TOLERANCE!r}\nsafety = 1'
    return run("controlled", control, 20 * PERIOD, 20 * PERIOD)


@pytest.fixture(scope="module")
def stable() -> Run:
    return run("stable", f'integrator = "verlet"\ntolerance = 1\nsafety = {SAFETY}', 1000 * PERIOD, OUTPUT)


@pytest.fixture(scope="module")
def landing() -> Run:
    """A few bounces. No estimate predicts the contact after a step of free flight, so such steps are rejected."""
    control = f'integrator = "verlet"\ntolerance = {DROP_TOLERANCE!r}'
    return CASE.engine("landing", CASE.scene(control=control, end=1.0, height=0.5 + DROP, period=1.0))


def test_verlet_conserves_its_quadratic_form() -> None:
    """v^2 + w^2 x^2 (1 - (w dt)^2 / 4) of a linear oscillator with equal steps; the first ones are shorter."""
    dt = 0.01
    t, x, v = motion(run("verlet", 'integrator = "verlet"\ntolerance = 1\nsafety = 1', 50 * PERIOD, dt))
    form = (v**2 + SQUARED * x**2 * (1 - SQUARED * dt**2 / 4))[t > 20 * dt]
    CASE.check(Label.EXACT, "verlet: change of its quadratic form", np.ptp(form) / form[0], 0, ROUNDING,
               "its matrix conserves v^2 + w^2 x^2 (1 - (w dt)^2/4) exactly; rounding")


def test_step_doubling_conserves_its_quadratic_form(doubling: dict[float, Run]) -> None:
    """v^2 + w^2 x^2 - h w^2 x v of semi-implicit Euler with steps h, half of those of step doubling."""
    for dt, result in doubling.items():
        t, x, v = motion(result)
        form = (v**2 + SQUARED * x**2 - 0.5 * dt * SQUARED * x * v)[t > 20 * dt]
        CASE.check(Label.EXACT, f"step doubling, {1e3 * dt:g} ms: change of its quadratic form", np.ptp(form) / form[0],
                   0, ROUNDING, "two steps dt/2 of semi-implicit Euler conserve it exactly; rounding")


def errors(doubling: dict[float, Run]) -> list[float]:
    """Largest errors against the closed form within two periods, over the amplitude."""
    result = []
    for run_ in doubling.values():
        t, x, _ = motion(run_)
        early = t < 2 * PERIOD
        result.append(float(np.abs(x[early] + AMPLITUDE * np.cos(OMEGA * t[early])).max() / AMPLITUDE))
    return result


def test_step_doubling_is_of_first_order(doubling: dict[float, Run]) -> None:
    CASE.check_rate("step doubling: position", STEPS, errors(doubling), 1, 0.1,
                    "semi-implicit Euler is of first order; the second adds w dt/4 = 3 % at the largest step")


def shadow_changes() -> list[float]:
    """Changes of the energy less (h/2) dU/dt of a compliant disc, over the initial energy; h = dt/2 is the step of
    semi-implicit Euler."""
    changes = []
    for dt in DISC_STEPS:
        result = CASE.engine(f"disc_{dt:g}", CASE.scene("disc.toml", dt=dt))
        t, strain = result.times("energy.strain"), result.probe("energy.strain")
        kinetic = result.probe("energy.kinetic")
        form = kinetic + strain - 0.25 * dt * np.gradient(strain, t)
        changes.append(float(np.ptp(form[(t > 0.3) & (t < 1.5)]) / kinetic[0]))
    return changes


def test_step_doubling_keeps_the_energy_of_a_disc_to_second_order() -> None:
    CASE.check_rate("step doubling: energy of a disc, corrected by its first order", DISC_STEPS, shadow_changes(), 2,
                    0.3, "the shadow energy of semi-implicit Euler is K + U - (h/2) dU/dt + O(h^2); explicit Euler has "
                    "none; the third order is a share w dt of it")


def test_error_control_holds_its_tolerance(controlled: Run) -> None:
    """The largest jerk w^3 A determines the step: dt^2 |da| / (6 d) with |da| = w^3 A dt."""
    time = controlled.steps("time")
    # Without the short first steps. Steps are equal parts of the remaining time, shorter by up to one of the 630 parts
    # that remain here.
    middle = (time > PERIOD) & (time < 10 * PERIOD)
    expected = (6 * SPACING * TOLERANCE / (OMEGA**3 * AMPLITUDE)) ** (1 / 3)
    CASE.check(Label.EXACT, "least step over that of the largest jerk",
               controlled.steps("dt")[middle].min() / expected, 1, 0.003 + 1 / 630,
               "a step of 0.1/w lies within half a step of the crest, 1.3e-3 of the jerk, and averages over it, 4e-4; "
               "the energy oscillates by (w dt/2)^2, 1.3e-3 of the jerk: a third of the sum, twice")
    CASE.check(Label.EXACT, "largest error over the tolerance", controlled.steps("error")[middle].max() / TOLERANCE, 1,
               0.003 + 3 / 630, "the largest jerk of the last 64 to 128 steps counts, and half a period has 31 steps: "
               "it includes crests, as above; the error is proportional to the cube of the step")


def test_verlet_rejects_beyond_twice_the_tolerance(landing: Run) -> None:
    share = landing.steps("error").max() / (2 * DROP_TOLERANCE)
    CASE.check(Label.EXACT, "verlet, landings: largest error over twice the tolerance", share, 0.75, 0.25,
               "steps above twice the tolerance are rejected, and the largest accepted error is close to it")


def test_steps_at_the_stability_bound(stable: Run) -> None:
    """The bound assumes contact of the block's whole outline: w_b^2 = stiffness x its length / mass. Steps between
    outputs are equal."""
    later = stable.steps("time") > PERIOD
    largest = SAFETY * 2 / np.sqrt(WHOLE_OUTLINE)
    expected = OUTPUT / np.ceil(OUTPUT / largest)
    dt = stable.steps("dt")[later].max()
    CASE.check(Label.EXACT, "largest step over that of the bound", dt / expected, 1, ROUNDING,
               f"safety x 2/w_b, in {np.ceil(OUTPUT / largest):.0f} equal steps per output; rounding")
    t, x, v = motion(stable)
    form = (v**2 + SQUARED * x**2 * (1 - SQUARED * dt**2 / 4))[t > EQUAL]
    CASE.check(Label.EXACT, "verlet at the stability bound, 1000 periods: change of its quadratic form",
               np.ptp(form) / form[0], 0, ROUNDING,
               "its matrix conserves the form; equal steps, 41 per output; rounding")


def test_step_doubling_rejects_beyond_alpha() -> None:
    result = run("rejecting", 'integrator = "step-doubling"\ntarget = 1e-5\nalpha = 2', 5 * PERIOD, PERIOD)
    share = result.steps("error").max() / 2e-5
    CASE.check(Label.EXACT, "step doubling: largest error over alpha target", share, 0.75, 0.25,
               "steps above alpha target are rejected, and the largest accepted error is close to it")


def test_picture(doubling: dict[float, Run], controlled: Run) -> None:
    figure, axes = panels(2, "Time steps of an oscillator", across=True)
    draw_orders(axes[0], "step doubling against the closed form", [("position", STEPS, errors(doubling))], [1])
    time = controlled.steps("time") / PERIOD
    axes[1].plot(time, OMEGA * controlled.steps("dt"), color=COLOURS[0], linewidth=1.1, label="step x w")
    axes[1].plot(time, 0.1 * controlled.steps("error") / TOLERANCE, color=COLOURS[1], linewidth=0.8, label="error / (10 tolerance)")
    axes[1].set_xlabel("time over the period")
    axes[1].set_xlim(0, 5)
    axes[1].set_ylim(0, 0.15)
    axes[1].set_title("error control", fontsize=10, loc="left")
    legend(axes[1])
    save(CASE, figure, "step_control")
