"""A spinning compliant disc: its stretch at small and large spins, and a hundred turns."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest
from matplotlib.axes import Axes

from cylinder import Cylinder, linear_strains, spinning_at, spun_up_to
from fields import frames_of
from motion import SINGLE, read_motion
from pictures import COLOURS, MARKERS, describe, draw_rate, legend, panels, save, set_ticks
from verification import Case, Label, Run

CASE = Case(__file__, long=True, cost=2)

SLOW, FAST = 0.05, 1.4  # rad/s, of the initially round disc: rims at 0.05 and 1.4 of S waves
MASSES = ["lumped", "corrected"]
VARIANTS = [("mls", "lumped"), ("mls", "corrected"), ("es-t3", "lumped")]
NODES = [168, 340, 700, 1400]
VISCOSITY = 0.2
REST = 40.0  # s: the slowest ringing decays as exp(-0.19 t), to 5e-4; axisymmetric modes vanish
PERIOD = 0.5  # of probes: less than half a turn
SCATTER = 0.2  # relative, of errors between meshes (verify/oscillation)
TURNS = 100
SETTLED = 150.0  # s: exp(-0.19 t) is 4e-13
EPSILON = np.finfo(float).eps


def scene(method: str, mass: str, nodes: int, spin: float, end: float, viscosity: float = VISCOSITY) -> str:
    return CASE.scene(method=method, mass=mass, nodes=nodes, spin=spin, end=end, viscosity=viscosity, period=PERIOD,
                      frames=end)


@dataclass
class Spun:
    """Results of a run in steady spin."""

    spin: float  # rad/s, of the orientation
    rim: float  # root of the area inside the outline, over the initial one
    energy: float  # of strain
    inertia: float  # of the round disc over the circle's: from the initial kinetic energy
    places: np.ndarray  # [cells] initial distance of cells from the centre
    strains: np.ndarray  # [cells x 2] Green-Lagrange, radial and hoop

    def shape_error(self, exact: Cylinder) -> float:
        """Rms of both strains over all cells, over the largest of the exact ones."""
        stretches = np.stack(exact.stretches(self.places), axis=1)
        return float(np.sqrt(np.mean((self.strains - (stretches**2 - 1) / 2) ** 2)) / (exact.rim**2 - 1) * 2)


@cache
def spun(method: str, mass: str, nodes: int, spin: float) -> Spun:
    run = CASE.engine(f"{method}_{mass}_{nodes}_{spin:g}", scene(method, mass, nodes, spin, REST))
    area, kinetic = run.probe("inside.area"), run.probe("energy.kinetic")[0]
    return Spun(turning(run, REST / 2), float(np.sqrt(area[-1] / np.pi)), float(run.probe("energy.strain")[-1]),
                float(kinetic / (np.pi / 4 * spin**2)), *polar_strains(run))


def turning(run: Run, since: float) -> float:
    """Rate of the orientation from a time on, rad/s."""
    times, angles = run.times("disc.rotation"), np.unwrap(run.probe("disc.rotation"))
    first = int(np.searchsorted(times, since - 1e-9))
    return float((angles[-1] - angles[first]) / (times[-1] - times[first]))


def polar_strains(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """Polar strains of the last frame. Green-Lagrange strains are independent of the rotation."""
    frames = frames_of(run)
    grid = frames.grids["bodies"]
    centres = frames.positions("bodies", 0)[:, :2][grid.cells].mean(axis=1)
    distance = np.hypot(*centres.T)
    x, y = centres.T / distance
    last = len(frames.times) - 1
    xx, yy, xy = (frames.field("bodies", last, f"strain_{of}").astype(float) for of in ("xx", "yy", "xy"))
    across = x**2 * xx + y**2 * yy + 2 * x * y * xy
    return distance, np.stack([across, xx + yy - across], axis=1)


@cache
def exact_at(spin: float) -> Cylinder:
    return spinning_at(spin)


def spacings(nodes: list[int]) -> list[float]:
    return [float(np.sqrt(np.pi / n)) for n in nodes]


def slope_error(share: float) -> float:
    """Two standard errors of a slope through errors with that relative scatter."""
    logarithms = np.log(spacings(NODES))
    return float(2 * share / np.sqrt(((logarithms - logarithms.mean()) ** 2).sum()))


def rim_errors(method: str, mass: str, spin: float) -> list[float]:
    runs = [spun(method, mass, n, spin) for n in NODES]
    return [(run.rim - 1) / (exact_at(run.spin).rim - 1) - 1 for run in runs]


def test_closed_form_is_the_limit_of_the_equation() -> None:
    """The finite-strain equation at two small spins, less the closed form: second order in the strain."""
    shares = [(spinning_at(spin).rim - 1) / linear_strains(spin, np.ones(1))[1][0] - 1 for spin in (SLOW, SLOW / 2)]
    CASE.check(Label.EXACT, "rim by the equation over the closed form, to no spin", (4 * shares[1] - shares[0]) / 3, 0,
               shares[0] ** 2, "a series in spin^2 without its first term")


@pytest.mark.parametrize("method, mass", VARIANTS)
def test_small_spin(method: str, mass: str) -> None:
    """Virial theorem: with consistent gradients the mean dilation is that of the exact disc with the mesh's inertia."""
    closed = linear_strains(SLOW, np.ones(1))[1][0]
    for nodes in NODES:
        run = spun(method, mass, nodes, SLOW)
        closed, exact = linear_strains(run.spin, np.ones(1))[1][0], exact_at(run.spin)
        second, load = (exact.rim - 1) / closed - 1, run.inertia - 1
        CASE.check(Label.EXACT, f"{method} {mass}, {nodes} nodes: stretch of the rim over closed form and inertia",
                   (run.rim - 1) / closed / run.inertia / (1 + second), 1,
                   2 * second * (abs(load) + run.shape_error(exact) ** 2),
                   "sum of forces x positions; second-order terms, a share of the stretch, change by twice the error "
                   "of the load and by the square of the shape's")


@pytest.mark.parametrize("method, mass", VARIANTS)
@pytest.mark.parametrize("spin", [SLOW, FAST])
def test_converges(method: str, mass: str, spin: float) -> None:
    order, name = 2 if mass == "lumped" else 3, f"{method} {mass}, spin {spin:g}"
    CASE.check_rate(f"{name}: stretch of the rim", spacings(NODES), np.abs(rim_errors(method, mass, spin)).tolist(),
                    order, slope_error(SCATTER), "as the inertia: second moments of lumped mass h^2, of corrected mass "
                    "h^3; two standard errors for a scatter of a fifth between meshes")
    shapes = [run.shape_error(exact_at(run.spin)) for run in (spun(method, mass, n, spin) for n in NODES)]
    CASE.check_rate(f"{name}: strains, rms", spacings(NODES), shapes, 1.75, 0.25 + slope_error(SCATTER / np.sqrt(48)),
                    "strains in the middle of cells: h^2 inside, h in a boundary layer of width h, which is h^1.5 in "
                    "the rms: from 1.5 to 2; scatter decreases with the number of cells on the rim")


@pytest.mark.parametrize("method, mass", VARIANTS)
def test_large_spin(method: str, mass: str) -> None:
    """At zero spacing, against the equation with the initial angular momentum."""
    runs, exact = [spun(method, mass, n, FAST) for n in NODES], spun_up_to(FAST)
    for what, values, expected in (("spin that is left", [run.spin for run in runs], exact.spin),
                                   ("stretch of the rim", [run.rim - 1 for run in runs], exact.rim - 1),
                                   ("strain energy", [run.energy for run in runs], exact.strain_energy)):
        limit, error = to_no_spacing(values, [2] if mass == "lumped" else [2, 3])
        CASE.check(Label.INDEPENDENT, f"{method} {mass}, spin {FAST:g}: {what} at h = 0 over the equation's",
                   limit / expected, 1, error / expected, "neo-Hookean cylinder, ordinary differential equation to "
                   "1e-11; limit of two meshes, whose errors scatter by a fifth; order 2 or 3 for corrected mass")


def to_no_spacing(values: list[float], orders: list[int]) -> tuple[float, float]:
    """Limit from the two finest meshes, and its error for scattered errors and for either order."""
    coarse, fine = values[-2:]
    limits, scatters = [], []
    for order in orders:
        few, many = (n ** (order / 2) for n in NODES[-2:])
        limits.append((many * fine - few * coarse) / (many - few))
        scatters.append(SCATTER * np.hypot(few * (coarse - limits[-1]), many * (fine - limits[-1])) / (many - few))
    return float(np.mean(limits)), float(max(scatters) + np.ptp(limits) / 2)


# ---- a hundred turns

@cache
def long_run(method: str, mass: str, viscosity: float) -> Run:
    spin = spun_up_to(FAST).spin
    end = PERIOD * np.ceil(((SETTLED if viscosity else 0) + TURNS * 2 * np.pi / spin) / PERIOD)
    return CASE.engine(f"long_{method}_{mass}_{viscosity:g}", scene(method, mass, 168, FAST, float(end), viscosity))


@pytest.mark.parametrize("mass", MASSES)
def test_settled_disc_stays_as_it_is(mass: str) -> None:
    run = long_run("mls", mass, VISCOSITY)
    since = np.searchsorted(run.times("disc.rotation"), SETTLED)
    rounding = run.summary["steps"] * EPSILON
    for what, column, size in (("angular momentum over inertia", "disc.rotation_rate", 1.0),
                               ("kinetic energy", "energy.kinetic", 1.0), ("strain energy", "energy.strain", 0.1),
                               ("area", "inside.area", 1.0), ("strain xx", "mean.strain_xx", 0.1),
                               ("strain yy", "mean.strain_yy", 0.1)):
        values = run.probe(column)[since:]
        CASE.check(Label.EXACT, f"mls {mass}: {what}, change in {TURNS} turns", np.ptp(values) / abs(values[0]), 0,
                   rounding / size, "rounding of each step, ten times larger for strains than for positions")


@pytest.mark.parametrize("mass", MASSES)
def test_spin_is_the_angular_momentum_over_inertia(mass: str) -> None:
    """Velocities of Verlet are chords of two steps, so they are below the orientation's rate by sin(a)/a."""
    run = long_run("mls", mass, VISCOSITY)
    spin, rate = turning(run, SETTLED), run.probe("disc.rotation_rate")[-1]
    steps = run.steps("dt")[run.steps("time") > SETTLED]
    short = [1 - np.sin(spin * dt) / (spin * dt) for dt in (steps.mean(), steps.min(), steps.max())]
    CASE.check(Label.EXACT, f"mls {mass}: 1 - angular momentum over inertia and orientation's rate, {TURNS} turns",
               1 - rate / spin, short[0], short[2] - short[1] + run.summary["steps"] * EPSILON,
               "chords of two steps on a circle; variation of steps, which end at probes' times")


@pytest.mark.parametrize("mass", MASSES)
def test_ringing_disc_keeps_energy_and_momentum(mass: str) -> None:
    run = long_run("es-t3", mass, 0.0)
    energy = run.probe("energy.kinetic") + run.probe("energy.strain")
    CASE.check(Label.EXACT, f"es-t3 {mass}, nothing damped: energy over its start - 1, largest in {TURNS} turns",
               np.abs(energy / energy[0] - 1).max(), 0, (FAST * run.steps("dt").max()) ** 2,
               "Verlet conserves K + U - dt^2 sum F^2/8m; F is 0 at first and at most twice the centripetal force")
    start, end = (angular_momentum(run, frame, mass) for frame in (0, -1))
    CASE.check(Label.EXACT, f"es-t3 {mass}, nothing damped: angular momentum over that of the start, {TURNS} turns",
               end / start, 1, 4 * SINGLE, "internal forces have no moment; positions and velocities of two frames in "
               "single precision")


def angular_momentum(run: Run, frame: int, mass: str) -> float:
    """Angular momentum of linear triangles."""
    motion = read_motion(run)
    momenta = motion.momenta(motion.velocities[frame], mass)
    x, y = motion.positions[frame, :, :2].T
    return float((x * momenta[:, 1] - y * momenta[:, 0]).sum())


def test_picture() -> None:
    figure, axes = panels(3, "A spinning disc", across=True)
    draw_strains(axes[0])
    for (method, mass), colour in zip(VARIANTS, COLOURS):
        for spin, style, marker in ((SLOW, "-", MARKERS[0]), (FAST, "--", MARKERS[1])):
            errors = np.abs(rim_errors(method, mass, spin))
            draw_rate(axes[1], spacings(NODES), errors, f"{method} {mass}, {spin:g}", colour, marker, style)
    set_ticks(axes[1], spacings(NODES), [f"{h:.3f}" for h in spacings(NODES)])
    describe(axes[1], "error of the rim's stretch", "spacing of nodes over R")
    draw_energies(axes[2])
    for panel in axes:
        legend(panel)
    save(CASE, figure, "spinning")


def draw_strains(axes: Axes) -> None:
    R = np.linspace(1e-3, 1, 200)
    for spin, colour, factor in ((SLOW, COLOURS[0], 1e3), (FAST, COLOURS[1], 1)):
        run = spun("mls", "corrected", 700, spin)
        for column, marker in enumerate(("x", ".")):
            exact = (exact_at(run.spin).stretches(R)[column] ** 2 - 1) / 2
            name = f"spin {run.spin:.3g}{', x 1000' if factor > 1 else ''}: {('across', 'around')[column]}"
            axes.plot(run.places, factor * run.strains[:, column], marker, markersize=3, color=colour, label=name)
            axes.plot(R, factor * exact, color="k", linewidth=1)
    describe(axes, "strains, mls corrected, 700 nodes; lines: exact", "distance from the middle over R, at the start")


def draw_energies(axes: Axes) -> None:
    for mass, colour in zip(MASSES, COLOURS):
        run = long_run("es-t3", mass, 0.0)
        energy = run.probe("energy.kinetic") + run.probe("energy.strain")
        axes.plot(run.times("energy.kinetic"), 1e4 * (energy / energy[0] - 1), color=colour, linewidth=0.7, label=mass)
    describe(axes, "nothing damped, es-t3: energy over its start - 1 [1e-4]", f"time [s], {TURNS} turns")
