"""37 discs in a free ring without damping, 200,000 steps (--full: a million): conservation of energy and momenta."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection

from contact_network import Outlines
from fields import frames_of
from motion import SINGLE, Motion, plane, read_motion
from pictures import COLOURS, legend, panels, save
from time_means import Mean, block_means
from verification import FULL, Case, Label, Run

CASE = Case(__file__)

METHODS = ["mls", "es-t3"]  # the first is the default
STEPS = {method: 1_000_000 if FULL else steps for method, steps in (("mls", 200_000), ("es-t3", 50_000))}
STEP = {"mls": 0.0412, "es-t3": 0.0391}  # s, slightly more than the engine's, so that there are at least STEPS
SAMPLES = 100
DIAMETER, PITCH, NODES = 1.5, 1.7, 30
INNER, OUTER, SLIT, SIDES = 6.0, 6.6, 0.02, 96  # radii of the ring; half the angle of its slit; sides of each circle
SPEED, TURN = 0.1, 0.03  # m/s, rms of each random component; rad/s, rotation of all discs about the centre
BLOCK = 10  # samples per block, thousands of collisions


def places() -> np.ndarray:
    """[37 x 2] three rings around one."""
    return np.array([(PITCH * (i + j / 2), PITCH * np.sqrt(0.75) * j) for j in range(-3, 4) for i in range(-3, 4)
                     if abs(i + j) < 4])


HARD = places()[1::3]
SOFT = np.array([place for i, place in enumerate(places()) if i % 3 != 1])
RIGID = [*(f"hard_{i}" for i in range(len(HARD))), "ring"]


def ring() -> np.ndarray:
    """One counter-clockwise outline: the outer circle, and back along the inner one."""
    angle = np.linspace(SLIT, 2 * np.pi - SLIT, SIDES + 1)
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return np.concatenate([OUTER * circle, INNER * circle[::-1]])


def grains() -> str:
    """A table for each disc with its own velocity; the total momentum of soft and hard discs vanishes."""
    random = SPEED * np.random.default_rng(1).standard_normal((len(SOFT) + len(HARD), 2))
    centres = np.concatenate([SOFT, HARD])
    velocity = random - random.mean(axis=0) + TURN * np.stack([-centres[:, 1], centres[:, 0]], axis=1)
    kinds = [("soft", i, "compliant") for i in range(len(SOFT))] + [("hard", i, "rigid") for i in range(len(HARD))]
    return "\n".join(f"""[[grains]]
name = "{kind}_{i}"
shape = "disc"
body = "{body}"
material = "{kind}"
packing = {{ kind = "positions", positions = [{at.tolist()}] }}
velocity = {{ uniform = {v.tolist()} }}
""" for (kind, i, body), at, v in zip(kinds, centres, velocity))


def of_polygon(points: np.ndarray) -> tuple[float, np.ndarray, float]:
    """Area, centre, and second moment about the centre."""
    (x, y), (u, v) = points.T, np.roll(points, -1, axis=0).T
    cross = x * v - y * u
    area = cross.sum() / 2
    centre = np.array([((x + u) * cross).sum(), ((y + v) * cross).sum()]) / (6 * area)
    about_origin = (cross * (x**2 + x * u + u**2 + y**2 + y * v + v**2)).sum() / 12
    return float(area), centre, float(about_origin - area * centre @ centre)


def scene(method: str) -> str:
    end = STEPS[method] * STEP[method]
    period = end / SAMPLES
    probes = "".join(f'\n[[probes]]\nname = "{name}_{quantity}"\nquantity = "{quantity}"\n'
                     f'of = "{name}"\nperiod = {period!r}\n' for name in RIGID for quantity in ("position", "velocity"))
    return CASE.scene(end=end, method=method, diameter=DIAMETER, nodes=NODES, ring=ring().tolist(), grains=grains(),
                      centre=of_polygon(ring())[1].tolist(),
                      period=period, probes=probes)


@cache
def run_of(method: str) -> Run:
    return CASE.engine(method, scene(method))


def energy(method: str) -> np.ndarray:
    """[samples] energy over the initial one, less 1."""
    run = run_of(method)
    total = sum(run.probe(f"energy.{part}") for part in ("kinetic", "strain", "contact"))
    return total / total[0] - 1


@cache
def kept_by_verlet(method: str) -> np.ndarray:
    """[samples] dt^2/8 times the sum of m |a|^2 over the soft discs' nodes, over the energy; approximate for `mls`."""
    run, frames = run_of(method), frames_of(run_of(method))
    mass = soft_motion(run)[1]
    squares = [mass @ (plane(frames, i, "acceleration") ** 2).sum(axis=1) for i in range(len(frames.times))]
    start = sum(run.probe(f"energy.{part}")[0] for part in ("kinetic", "strain", "contact"))
    return run.steps("dt").max() ** 2 / 8 * np.array(squares) / start


@pytest.mark.parametrize("method", METHODS)
def test_energy(method: str) -> None:
    steps, errors = run_of(method).summary["steps"], energy(method)
    CASE.check(Label.EXACT, f"{method}: {STEPS[method]} steps and more", float(steps >= STEPS[method]), 1, 0,
               "specified")
    CASE.check(Label.EXACT, f"{method}: energy over that of the start - 1, largest", np.abs(errors).max(), 0,
               1e-2 + kept_by_verlet(method).max(), "specified for contacts; Verlet conserves K + U - dt^2 sum "
               "F^2/8m: ringing discs have forces")
    CASE.check(Label.EXACT, f"{method}: forces and moments of contacts and stresses, what does not cancel",
               run_of(method).summary["momentum_error"], 0, 1e-12, "specified")


@pytest.mark.skipif(not FULL, reason="the first hundred time units, in which discs begin to ring, are a tenth of the run")
@pytest.mark.parametrize("method", METHODS)
def test_no_drift(method: str) -> None:
    # K + U - dt^2 sum F^2/8m + (dt^2 sum F F_before/m - sum dx dF)/12: for slow vibrations each of the last two terms
    # is dt^2 F^2/m in the mean
    errors = energy(method) + kept_by_verlet(method) / 3
    halves = [Mean(block_means(half, BLOCK)) for half in (errors[1 : SAMPLES // 2 + 1], errors[SAMPLES // 2 + 1 :])]
    CASE.check(Label.EXACT, f"{method}: what Verlet keeps, mean of the second half less that of the first",
               halves[1].value - halves[0].value, 0, halves[0].error + halves[1].error,
               f"no drift: both are means of one motion, {halves[0]} each")


@pytest.mark.parametrize("method", METHODS)
def test_discs_collide(method: str) -> None:
    """Discs exchange their positions."""
    at = np.array([part[2] for part in rigid_parts(run_of(method))[:-1]])
    ways = np.linalg.norm(at[:, -1, :2] - at[:, 0, :2], axis=1)
    CASE.check(Label.EXACT, f"{method}: hard discs have gone further than a place, rms", float(
        np.sqrt((ways**2).mean()) > PITCH), 1, 0, "otherwise they would not collide")


def rigid_parts(run: Run) -> list[tuple[float, float, np.ndarray, np.ndarray]]:
    """For each rigid body: mass, moment of inertia, positions and velocities, [samples x 3] with angles."""
    frames = frames_of(run)
    grid = frames.grids["outlines"]
    outlines = Outlines.of(frames.positions("outlines", 0)[:, :2], grid.cells, grid.body)
    parts = []
    for i, name in enumerate(RIGID):
        area, _, second = of_polygon(outlines.of_body(len(SOFT) + i))
        at, v = (np.stack([run.probe(f"{name}_{of}") for of in columns], axis=1) for columns in (
            ("position.position_x", "position.position_y", "position.angle"),
            ("velocity.velocity_x", "velocity.velocity_y", "velocity.angular_velocity")))
        parts.append((area, second, at, v))
    return parts


def soft_motion(run: Run) -> tuple[Motion, np.ndarray]:
    """Motion of all bodies, and masses of the soft ones' nodes: a third of the triangles around each."""
    motion, grid = read_motion(run), frames_of(run).grids["bodies"]
    soft = Motion(motion.times, motion.positions, motion.displacements, motion.velocities, grid.cells[grid.kind == 0])
    return soft, soft.node_areas()


@cache
def momenta() -> tuple[np.ndarray, np.ndarray]:
    """[samples x 3] momentum and angular momentum about the origin, with `es-t3`, and [3] sums of their magnitudes."""
    run = run_of("es-t3")
    motion, mass = soft_motion(run)
    x, v = motion.positions[:, :, :2], motion.velocities
    turning = x[..., 0] * v[..., 1] - x[..., 1] * v[..., 0]
    total = np.column_stack([np.einsum("i,tik->tk", mass, v), turning @ mass])
    size = np.array([*(mass @ np.abs(v[0])), mass @ (np.linalg.norm(x[0], axis=1) * np.linalg.norm(v[0], axis=1))])
    for area, second, at, velocity in rigid_parts(run):
        total[:, :2] += area * velocity[:, :2]
        total[:, 2] += area * (at[:, 0] * velocity[:, 1] - at[:, 1] * velocity[:, 0]) + second * velocity[:, 2]
    return total, size


def test_momenta() -> None:
    total, size = momenta()
    reach = np.linalg.norm(np.array([at[:, :2] for *_, at, _ in rigid_parts(run_of("es-t3"))]), axis=2).max()
    for column, what in enumerate(("momentum along x", "momentum along y", "angular momentum")):
        scale = size[column] * (1 if column < 2 else max(1.0, reach / OUTER))
        CASE.check(Label.EXACT, f"es-t3: {what}, largest change over the sum of magnitudes",
                   np.abs(total[:, column] - total[0, column]).max() / scale, 0, 4 * SINGLE,
                   "contacts and stresses have no moment; positions and velocities of frames in single precision")


def test_picture() -> None:
    figure, axes = panels(3, f"37 discs in a free ring, {STEPS[METHODS[0]]} steps, nothing damped", across=True)
    draw_discs(axes[0])
    for method, colour in zip(METHODS, COLOURS):
        times = run_of(method).times("energy.kinetic")
        axes[1].plot(times, 1e4 * energy(method), ".-", color=colour, linewidth=0.6, markersize=3, label=method)
    axes[1].set_title("energy over its start - 1 [1e-4]", fontsize=10, loc="left")
    total, size = momenta()
    for column, what in enumerate(("momentum along x", "momentum along y", "angular momentum")):
        change = (total[:, column] - total[0, column]) / size[column]
        axes[2].plot(run_of("es-t3").times("energy.kinetic"), 1e8 * change, color=COLOURS[column], linewidth=0.8,
                     label=what)
    axes[2].set_title("es-t3: change over sums of magnitudes [1e-8]", fontsize=10, loc="left")
    for panel in axes[1:]:
        panel.set_xlabel("time [s]")
        legend(panel)
    save(CASE, figure, "undamped")


def draw_discs(axes: Axes) -> None:
    frames = frames_of(run_of("mls"))
    grid = frames.grids["outlines"]
    last = Outlines.of(frames.positions("outlines", len(frames.times) - 1)[:, :2], grid.cells, grid.body)
    soft = len(SOFT)
    shapes = [last.of_body(body) for body in range(soft + len(RIGID))]
    colours = ["#cfe3f1" if body < soft else "#a8a8a8" for body in range(len(shapes))]
    axes.add_collection(PolyCollection(shapes, facecolors=colours, edgecolors="0.3", linewidths=0.6))
    axes.autoscale_view()
    axes.set_aspect("equal")
    axes.set_title("at the end; dark: rigid", fontsize=10, loc="left")
