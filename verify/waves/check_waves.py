"""Speeds of P and S waves in a laterally supported bar: standing and travelling waves, three solvers."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest
from dolfinx.fem import assemble_scalar, dirichletbc, locate_dofs_topological
from dolfinx.mesh import locate_entities_boundary
from matplotlib.axes import Axes
from scipy.optimize import brentq, least_squares
from ufl import sin

from fem.compiled import compile_form
from fem.dynamics import Explicit
from fem.meshes import rectangle
from fem.solid import Material, Solid
from motion import Motion, read_motion
from pictures import COLOURS, describe, draw_orders, legend, panels, save
from verification import FULL, Case, Label, Run

CASE = Case(__file__)

LENGTH, WIDTH = 2.0, 0.5
MU, LAME = 1.0, 4.0
STIFFNESS = 2e4  # of the supports
SPACINGS = [1 / 8, 1 / 12, 1 / 16, 1 / 24] + ([1 / 32] if FULL else [])
PERIODS, SAMPLES = 4, 20  # of the first mode; frames per period
AMPLITUDE = 1e-5  # velocity over wave speed: strains of 1e-5, so nonlinear terms are some 1e-5 of it
# Linear triangles with lumped mass carry S waves almost without error, as those of mass and stiffness cancel, so no
# rate is measurable. With corrected mass both errors have the same sign.
CONVERGE = [("mls", "lumped"), ("mls-gauss", "lumped"), ("t3", "corrected"), ("es-t3", "lumped")]
OTHERS = [("mls", "corrected"), ("t3", "lumped"), ("es-t3", "corrected")]
# Dispersion of a chain of lumped masses in the first mode, which corrected mass removes.
LUMPED_DISPERSION = (np.pi / LENGTH * SPACINGS[-1])**2 / 24
ASKED = "closed form; specified: a tenth of a percent"


@dataclass(frozen=True)
class Wave:
    """P or S wave: direction of motion, and support of the long sides."""

    name: str
    axis: int
    modulus: float
    support: float  # stress carried by the sides, over the wave's strain

    @property
    def speed(self) -> float:
        return float(np.sqrt(self.modulus))

    @property
    def held(self) -> int:
        return 1 - self.axis

    @property
    def frequency(self) -> float:
        """Frequency of the first mode with free ends, u = sin(pi x / L) about the middle, rad/s."""
        return np.pi * self.speed / LENGTH

    @property
    def softening(self) -> float:
        """Speed over that between rigid sides. Springs that deform by stress / k reduce the modulus to
        modulus - 2 support^2 / (k W) (first order in 1 / k, any wavelength)."""
        return float(np.sqrt(1 - 2 * self.support**2 / (STIFFNESS * WIDTH * self.modulus)))

    def gradient(self) -> list[list[float]]:
        """Gradient of the initial velocity along x, 1/s."""
        rate = 2 * AMPLITUDE * self.speed / LENGTH
        return [[rate, 0], [0, 0]] if self.axis == 0 else [[0, 0], [rate, 0]]


WAVES = {"P": Wave("P", 0, LAME + 2 * MU, LAME), "S": Wave("S", 1, MU, MU)}


@dataclass(frozen=True)
class Sine:
    """A sine fitted to a history by least squares."""

    frequency: float  # rad/s
    overtones: float  # amplitude of an overtone with the fit's residual, over the sine's
    turned: float  # phase from the first to the last value, rad

    @property
    def error(self) -> float:
        """Relative bound of the frequency error by overtones from the third on.

        To first order the fit changes w by the component of e cos(W t + p) along (t - T/2) cos(w t), whose square
        integrates to T^3/24. By parts this is 24/T^3 e T/2 (1/(W - w) + 1/(W + w)). With W = 3 w it is 9 e/(w T)^2 of
        w; higher overtones contribute less.
        """
        return 9 * self.overtones / self.turned**2


def fitted_sine(times: np.ndarray, values: np.ndarray, guess: float) -> Sine:
    def misfit(factor: np.ndarray) -> np.ndarray:
        phase = factor[0] * guess * times
        waves = np.column_stack([np.cos(phase), np.sin(phase)])
        return (waves @ np.linalg.lstsq(waves, values, rcond=None)[0] - values) / np.abs(values).max()

    found = least_squares(misfit, [1.0], diff_step=1e-6, xtol=1e-14, ftol=1e-14)
    frequency = float(found.x[0] * guess)
    return Sine(frequency, float(np.sqrt(2 * np.mean(found.fun**2))), frequency * float(times[-1] - times[0]))


def standing_scene(wave: Wave, method: str, mass: str, spacing: float) -> str:
    period = 2 * np.pi / wave.frequency
    return CASE.scene("standing.toml", end=float(PERIODS * period), method=method, mass=mass, spacing=spacing,
                      gradient=wave.gradient(), axis="xy"[wave.held], stiffness=STIFFNESS,
                      period=float(period / SAMPLES))


def mode_sine(wave: Wave, motion: Motion) -> Sine:
    """Sine fitted to the first mode."""
    shape = np.sin(np.pi * motion.positions[0][:, 0] / LENGTH)
    return fitted_sine(motion.times, motion.modal(wave.axis, shape), wave.frequency)


def mode_frequency(wave: Wave, motion: Motion) -> float:
    """Frequency of the first mode between rigid sides, rad/s."""
    return mode_sine(wave, motion).frequency / wave.softening


@cache
def engine_run(wave: Wave, method: str, mass: str, spacing: float) -> Run:
    scene = standing_scene(wave, method, mass, spacing)
    return CASE.engine(f"{wave.name}_{method}_{mass}_{spacing:.4f}", scene)


def engine_speed(wave: Wave, *variant: str | float) -> float:
    """Wave speed over the closed form."""
    return mode_frequency(wave, read_motion(engine_run(wave, *variant))) / wave.frequency


@pytest.fixture(scope="module", params=WAVES.values(), ids=lambda w: w.name)
def wave(request: pytest.FixtureRequest) -> Wave:
    return request.param


@pytest.fixture(scope="module")
def errors() -> dict[tuple[str, str, str], list[float]]:
    """Relative errors of the engine's wave speeds, by wave, method and mass, for SPACINGS."""
    return {(wave.name, *variant): [engine_speed(wave, *variant, h) - 1 for h in SPACINGS]
            for wave in WAVES.values() for variant in CONVERGE}


@pytest.mark.parametrize("variant", CONVERGE, ids=lambda v: "-".join(v))
def test_standing_waves_converge(wave: Wave, variant: tuple[str, str], errors: dict) -> None:
    name, found = f"{wave.name}, {' '.join(variant)}", errors[wave.name, *variant]
    CASE.check(Label.EXACT, f"{name}: standing wave, spacing 1/{1 / SPACINGS[-1]:.0f}", 1 + found[-1], 1, 1e-3, ASKED)
    CASE.check_rate(f"{name}: standing wave", SPACINGS, np.abs(found).tolist(), 2, 0.4,
                    "dispersion is even in wave number times spacing: second order; nodes along the outline contribute "
                    "third order, up to 0.3; meshes scatter each error by a tenth")


@pytest.mark.parametrize("variant", OTHERS, ids=lambda v: "-".join(v))
def test_standing_waves_of_other_variants(wave: Wave, variant: tuple[str, str]) -> None:
    found = engine_speed(wave, *variant, SPACINGS[-1])
    name = f"{wave.name}, {' '.join(variant)}: standing wave, spacing 1/{1 / SPACINGS[-1]:.0f}"
    if variant[1] == "corrected":
        CASE.check(Label.EXACT, name, found, 1, LUMPED_DISPERSION,
                   "closed form; corrected mass removes the dispersion of lumped masses, (q h)^2/24")
    else:
        CASE.check(Label.EXACT, name, found, 1, 1e-3, ASKED)


REFERENCE_SPACING = 1 / 24
REFERENCE_STEPS = 40  # a period


def without_newmark(frequency: float, dt: float) -> float:
    """Inverse of the frequency error of Newmark's method, which turns w into 2/dt atan(w dt/2)."""
    return float(np.tan(frequency * dt / 2) / (dt / 2))


def without_verlet(frequency: float, steps: np.ndarray) -> float:
    """Inverse of the frequency error of Verlet's method, which turns w into 2/dt asin(w dt/2); unequal steps count by
    the mean of dt^2."""
    dt = np.sqrt(np.average(steps**2, weights=steps))
    return float(np.sin(frequency * dt / 2) / (dt / 2))


@cache
def reference_sine(wave: Wave) -> Sine:
    """Sine of the reference, corrected for the effect of time steps on its frequency."""
    dt = 2 * np.pi / wave.frequency / REFERENCE_STEPS
    scene = standing_scene(wave, "mls", "lumped", REFERENCE_SPACING)
    sine = mode_sine(wave, read_motion(CASE.reference(f"{wave.name}_reference", scene, "--dt", repr(float(dt)))))
    return replace(sine, frequency=without_newmark(sine.frequency, dt))


def reference_speed(wave: Wave) -> float:
    """Wave speed over the closed form."""
    return reference_sine(wave).frequency / wave.softening / wave.frequency


def test_standing_waves_of_the_reference(wave: Wave) -> None:
    """Both solvers are corrected for the effect of time steps. The spatial error remains, the same in both."""
    reference, run = reference_sine(wave), engine_run(wave, "mls", "lumped", REFERENCE_SPACING)
    engine = mode_sine(wave, read_motion(run))
    CASE.check(Label.EXACT, f"{wave.name}, reference: standing wave, spacing 1/24", reference_speed(wave), 1, 1e-3,
               ASKED)
    CASE.check(Label.INDEPENDENT, f"{wave.name}: standing wave, reference over engine - 1",
               reference.frequency / without_verlet(engine.frequency, run.steps("dt")) - 1, 0,
               reference.error + engine.error,
               "the same nodes, both corrected for time steps; effect of overtones of the measured amplitudes on fits")


ELEMENT_COLUMNS = 8  # quadratic triangles of LENGTH / 8
ELEMENT_ERROR = 3e-5  # (q h)^4 / 1440 = 2e-5, plus nonlinear terms, 1e-5


@cache
def finite_element_speed(wave: Wave, steps: int = 20) -> float:
    """Wave speed over the closed form; sides held exactly, corrected for Verlet's frequency error."""
    solid = Solid(rectangle(LENGTH, WIDTH, ELEMENT_COLUMNS, ELEMENT_COLUMNS // 4), Material(MU, LAME))
    motion = Explicit(solid, solid.strain_energy(), held_sides(solid, wave))
    (xx, xy), (yx, yy) = wave.gradient()
    motion.v.interpolate(lambda x: np.stack([xx * (x[0] - LENGTH / 2), yx * (x[0] - LENGTH / 2)]))
    coordinate = compile_form(solid.u[wave.axis] * sin(np.pi / LENGTH * (solid.X[0] - LENGTH / 2)) * solid.dx)
    motion.start()
    dt = 2 * np.pi / wave.frequency / (SAMPLES * steps)
    values = [0.0]
    for _ in range(SAMPLES * PERIODS):
        for _ in range(steps):
            motion.step(dt)
        values.append(assemble_scalar(coordinate))
    seen = fitted_sine(dt * steps * np.arange(len(values)), np.array(values), wave.frequency).frequency
    return without_verlet(seen, np.array([dt])) / wave.frequency


def held_sides(solid: Solid, wave: Wave) -> list:
    def on_sides(x: np.ndarray) -> np.ndarray:
        return (x[1] < 1e-9) | (x[1] > WIDTH - 1e-9)

    space = solid.space.sub(wave.held)
    edges = locate_entities_boundary(solid.domain, 1, on_sides)
    return [dirichletbc(0.0, locate_dofs_topological(space, 1, edges), space)]


def test_standing_waves_of_finite_elements(wave: Wave) -> None:
    CASE.check(Label.EXACT, f"{wave.name}, finite elements: standing wave", finite_element_speed(wave), 1, ELEMENT_ERROR,
               "closed form; quadratic triangles of 1/4: (q h)^4 / 1440 = 2e-5, plus nonlinear terms, 1e-5")


# A raised-cosine pulse of this length travels from the left end.
PULSE = 1.2
GAUGES = (-0.6, 0.2)  # where it has passed before its reflection from the right end arrives
TRAVELLING_SPACING = 1 / 24


def travelling_scene(wave: Wave) -> str:
    duration, end = PULSE / wave.speed, 2.8 / wave.speed
    times = np.linspace(0, duration, 41)
    pulse = AMPLITUDE * wave.modulus * (1 - np.cos(2 * np.pi * times / duration)) / 2
    return CASE.scene("travelling.toml", end=end, method="mls", mass="corrected", spacing=TRAVELLING_SPACING,
                      axis="xy"[wave.held], stiffness=STIFFNESS, period=end / 280,
                      direction=[1, 0] if wave.axis == 0 else [0, 1],
                      pulse=[[float(t), float(p)] for t, p in zip(times, pulse)])


def arrivals(wave: Wave, motion: Motion) -> tuple[np.ndarray, np.ndarray]:
    """Positions of nodes between the gauges, and arrival times of the pulse s(t) there: T of the largest integral of
    v(t) s(t - T)."""
    x, duration = motion.positions[0][:, 0], PULSE / wave.speed
    chosen = (x > GAUGES[0]) & (x < GAUGES[1])
    velocities = motion.velocities[:, chosen, wave.axis]

    def slope(start: float, velocity: np.ndarray) -> float:
        """Derivative of the integral, up to a factor."""
        phase = np.clip((motion.times - start) / duration, 0, 1)
        return float(velocity @ np.sin(2 * np.pi * phase))

    guesses = (x[chosen] + LENGTH / 2) / wave.speed
    found = [brentq(slope, t - 0.2 * duration, t + 0.2 * duration, args=(v,)) for t, v in zip(guesses, velocities.T)]
    return x[chosen], np.array(found)


def travelling_speed(wave: Wave, motion: Motion) -> float:
    """Wave speed over the closed form, from a line through the arrivals at all nodes between the gauges."""
    slope = np.polyfit(*arrivals(wave, motion), 1)[0]
    return float(1 / slope / wave.speed / wave.softening)


@pytest.fixture(scope="module")
def travelling() -> dict[str, Motion]:
    return {wave.name: read_motion(CASE.engine(f"{wave.name}_travelling", travelling_scene(wave)))
            for wave in WAVES.values()}


def test_travelling_waves(wave: Wave, travelling: dict[str, Motion]) -> None:
    CASE.check(Label.EXACT, f"{wave.name}, mls corrected: travelling wave, spacing 1/24",
               travelling_speed(wave, travelling[wave.name]), 1, 1e-3,
               f"{ASKED}; dispersion at the pulse's wave number, 3.3 times the standing wave's, is 3e-4")


def test_picture_of_travelling_waves(travelling: dict[str, Motion]) -> None:
    figure, axes = panels(2, "Pulses in a bar that is held sideways: velocity over its amplitude", across=True)
    for panel, wave in zip(axes, WAVES.values()):
        draw_pulses(panel, wave, travelling[wave.name])
    save(CASE, figure, "travelling")


def draw_pulses(axes: Axes, wave: Wave, motion: Motion) -> None:
    """At five nodes, offset by position; theory is the pulse shifted by x / c, until its reflection."""
    points, way = motion.positions[0], np.linspace(0, PULSE, 100)
    for i, place in enumerate(np.linspace(-0.75, 0.25, 5)):
        node = int(np.argmin(np.hypot(points[:, 0] - place, points[:, 1])))
        x, speed = points[node, 0], motion.velocities[:, node, wave.axis]
        axes.plot(motion.times * wave.speed, x + 0.2 * speed / (AMPLITUDE * wave.speed), color=COLOURS[0],
                  linewidth=1.2, label="" if i else "engine, mls corrected, 1/24")
        axes.plot(1 + x + way, x + 0.1 * (1 - np.cos(2 * np.pi * way / PULSE)), "--", color=COLOURS[1], linewidth=1.2,
                  label="" if i else "closed form")
    describe(axes, f"{wave.name}, c = {wave.speed:.3f}", "c x time", "place along the bar")
    axes.set_ylim(-0.9, 0.9)
    legend(axes)


def test_picture_of_convergence(errors: dict) -> None:
    figure, axes = panels(2, "Speed of standing waves: error over the spacing of nodes", across=True)
    for panel, wave in zip(axes, WAVES.values()):
        curves = [(" ".join(v), SPACINGS, np.abs(errors[wave.name, *v]).tolist()) for v in CONVERGE]
        draw_orders(panel, f"{wave.name}, c = {wave.speed:.3f}", curves, [2])
        panel.plot(REFERENCE_SPACING, abs(reference_speed(wave) - 1), "kx", markersize=8,
                   label="reference, mls lumped")
        node_distance = LENGTH / ELEMENT_COLUMNS / 2
        panel.errorbar(node_distance, abs(finite_element_speed(wave) - 1), [[0], [ELEMENT_ERROR]], fmt="k*", capsize=3,
                       label="finite elements and their error")
        legend(panel)
        panel.axhline(1e-3, color=COLOURS[7], linewidth=0.8)
        panel.set_xticks(SPACINGS, [f"1/{1 / h:.0f}" for h in SPACINGS])
        panel.set_xlabel("spacing (bar: 2 x 0.5); line: a tenth of a percent")
    save(CASE, figure, "convergence")
