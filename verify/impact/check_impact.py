"""A disc hits a rigid frictionless wall: engine and reference solver against finite elements with the same penalty."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.axes import Axes

from fem.impact import velocities
from fields import frames_of
from pictures import COLOURS, MARKERS, describe, draw_rate, legend, panels, save, set_ticks
from verification import FULL, Case, Label, Run

CASE = Case(__file__)

END, PERIOD, FRAMES = 4.5, 0.02, 0.5
TIMES = PERIOD * np.arange(round(END / PERIOD) + 1)
STIFFNESS, START = 1000.0, 1.002  # penalty and initial height of the centre in the scene
SPEEDS = [0.1, 0.2, 0.3]
SPEED = 0.2  # of the studies
NODES = [168, 340, 700, 1400] + ([2800] if FULL else [])
VARIANTS = [("mls", "lumped"), ("mls", "corrected"), ("t3", "lumped"), ("es-t3", "corrected")]
CHOSEN = [VARIANTS[0], VARIANTS[3]]  # at all speeds
SAFETY = 0.8
RINGS = (9, 12)
SMOOTH = 5  # periods over which momentum is differenced for the force

OWN = ("finite elements with the same penalty: difference of their two meshes (order 3 or more), plus that of the "
       "engine's 700 and 1400 nodes (second order)")


def engine_run(variant: tuple[str, str], nodes: int, speed: float, safety: float = SAFETY) -> Run:
    name = f"{'_'.join(variant)}_{nodes}_{speed:g}_{safety:g}"
    return CASE.engine(name, scene(variant, nodes, speed, safety))


def scene(variant: tuple[str, str], nodes: int, speed: float, safety: float = SAFETY, corrects: bool = True) -> str:
    return CASE.scene(end=END, period=PERIOD, frames=FRAMES, method=variant[0], mass=variant[1], nodes=nodes,
                      speed=-speed, safety=safety, corrects=str(corrects).lower())


def velocity(run: Run) -> np.ndarray:
    """Velocity of the centre of mass at TIMES: the impulse so far over the mass, without the force's chatter."""
    return run.at("disc.velocity_y", TIMES)


def contact_time(velocities: np.ndarray) -> float:
    """Time from 0.01 to 0.99 of the momentum's change, s."""
    share = (velocities - velocities[0]) / (velocities[-1] - velocities[0])
    begin, end = (int(np.argmax(share > limit)) for limit in (0.01, 0.99))
    return float(crossing(share, end, 0.99) - crossing(share, begin, 0.01))


def crossing(share: np.ndarray, index: int, limit: float) -> float:
    """Time at which the share crosses the limit, between index - 1 and index."""
    return TIMES[index - 1] + PERIOD * (limit - share[index - 1]) / (share[index] - share[index - 1])


def time_error(velocities: np.ndarray, error: float) -> float:
    """Error of contact_time from a velocity error, which is divided by the slopes at begin and end."""
    share = (velocities - velocities[0]) / (velocities[-1] - velocities[0])
    slopes = np.gradient(velocities, PERIOD)
    return float(sum(error / slopes[int(np.argmax(share > limit))] for limit in (0.01, 0.99)))


@pytest.fixture(scope="module")
def elements() -> dict[float, list[np.ndarray]]:
    """Velocity of the centre of mass at TIMES, by two meshes."""
    return {speed: [velocities(rings, STIFFNESS, speed, START, PERIOD, len(TIMES) - 1) for rings in RINGS]
            for speed in SPEEDS}


@pytest.fixture(scope="module")
def runs() -> dict[tuple[tuple[str, str], float], dict[int, Run]]:
    studies = {(variant, SPEED): {n: engine_run(variant, n, SPEED) for n in NODES} for variant in VARIANTS}
    others = [(variant, speed) for variant in CHOSEN for speed in SPEEDS if speed != SPEED]
    return studies | {key: {n: engine_run(key[0], n, key[1]) for n in (700, 1400)} for key in others}


@pytest.mark.parametrize("speed", SPEEDS)
@pytest.mark.parametrize("variant", CHOSEN, ids="-".join)
def test_impact(runs: dict, elements: dict, variant: tuple[str, str], speed: float) -> None:
    coarse, fine = (velocity(runs[variant, speed][n]) for n in (700, 1400))
    expected, name = elements[speed][1], f"{' '.join(variant)}, speed {speed:g}"
    error = np.abs(fine - coarse).max() + np.abs(expected - elements[speed][0]).max()
    CASE.check(Label.INDEPENDENT, f"{name}: momentum's history", np.abs(fine - expected).max() / speed, 0,
               error / speed, OWN)
    CASE.check(Label.INDEPENDENT, f"{name}: speed after over before", fine[-1] / speed, expected[-1] / speed,
               error / speed, OWN)
    CASE.check(Label.INDEPENDENT, f"{name}: contact time", contact_time(fine), contact_time(expected),
               time_error(expected, error), OWN)
    balance = np.abs(runs[variant, speed][1400].probe("energy.balance_error"))
    CASE.check(Label.EXACT, f"{name}: balance of energy, after", balance[-1], 0, 1e-3,
               "energy conservation; the default safety keeps the error of a bounce to 0.1 % (docs/notes/impacts.md)")
    CASE.check(Label.EXACT, f"{name}: balance of energy, on the way", balance.max(), 0, 1e-2,
               "specified: 1 %; Verlet's conserved energy differs by dt^2 sum m a^2 / 8; corrections are incomplete")


@pytest.mark.parametrize("variant", VARIANTS, ids="-".join)
def test_converges(runs: dict, elements: dict, variant: tuple[str, str]) -> None:
    CASE.check_rate(f"{' '.join(variant)}: momentum's history", [spacing(n) for n in NODES],
                    differences(runs[variant, SPEED], elements), 2, 0.5,
                    "second order in space and of the polygon's poles; successive first contacts of nodes scatter each "
                    "error by a third")


def spacing(nodes: int) -> float:
    return float(np.sqrt(np.pi / nodes))


def differences(found: dict[int, Run], elements: dict) -> list[float]:
    """Rms difference from finite elements, over the initial speed."""
    return [float(np.sqrt(np.mean((velocity(found[n]) - elements[SPEED][1])**2)) / SPEED) for n in NODES]


STEPS = (0.02, 0.01)  # of the reference


@pytest.fixture(scope="module")
def references() -> list[np.ndarray]:
    text = scene(VARIANTS[0], NODES[0], SPEED)
    return [velocity(CASE.reference(f"reference_{dt:g}", text, "--dt", repr(dt))) for dt in STEPS]


def test_reference(runs: dict, references: list[np.ndarray]) -> None:
    """With the same nodes, the solvers differ only in time integration."""
    long, short = velocity(runs[VARIANTS[0], SPEED][NODES[0]]), velocity(engine_run(VARIANTS[0], NODES[0], SPEED,
                                                                                  SAFETY / 2))
    error = np.abs(references[1] - references[0]).max() + np.abs(long - short).max()
    CASE.check(Label.INDEPENDENT, f"mls lumped, {NODES[0]} nodes: momentum's history, engine - reference",
               np.abs(short - references[1]).max() / SPEED, 0, error / SPEED,
               "change by halving the step in either, which exceeds the remaining error from first order on")


def wall_overlaps(outline: np.ndarray, wall: np.ndarray) -> np.ndarray:
    """[wall nodes] vertical component of the depth in a disc's outline [nodes x 2], along its nearest side's normal."""
    sides = np.roll(outline, -1, axis=0) - outline
    lengths = np.hypot(*sides.T)
    from_corner = wall[:, None] - outline
    along = (from_corner * sides).sum(axis=2) / lengths**2
    depth = (sides[:, 0] * from_corner[:, :, 1] - sides[:, 1] * from_corner[:, :, 0]) / lengths
    depth[(along < 0) | (along >= 1) | (depth < 0) | (depth > lengths / 2)] = np.inf  # belongs to the far side
    nearest = depth.argmin(axis=1)
    deep = depth[np.arange(len(wall)), nearest]
    return np.where(np.isfinite(deep), deep * sides[nearest, 0] / lengths[nearest], 0)


def overlap(run: Run, frame: int) -> float:
    """Depths in the wall and of the wall, weighted by the nodes' initial lengths; mean of both passes, m2."""
    frames = frames_of(run)
    of_disc = frames.grids["outlines"].point_body == 0
    start, now = (frames.positions("outlines", i)[:, :2].astype(float) for i in (0, frame))
    sides = np.hypot(*(np.roll(start[of_disc], -1, axis=0) - start[of_disc]).T)
    in_wall = (0.5 * (sides + np.roll(sides, 1)) * np.clip(-now[of_disc][:, 1], 0, None)).sum()
    wall = now[~of_disc][np.argsort(now[~of_disc][:, 0])]
    return float(in_wall + np.diff(wall[:, 0]).mean() * wall_overlaps(now[of_disc], wall).sum()) / 2


@pytest.mark.parametrize("solver", ["engine", "reference"])
def test_force_of_the_overlap(references: list[np.ndarray], solver: str) -> None:
    """The motion is insensitive to the contact stiffness, as depths are a thousandth of the disc's squeeze. Depths show
    it when the energy correction of contacts is off."""
    run = (CASE.engine("law_alone", scene(VARIANTS[0], 340, SPEED, corrects=False)) if solver == "engine" else
           Run(CASE.out / f"reference_{STEPS[1]:g}"))
    times = FRAMES * np.arange(1, 7)  # during contact
    forces = -run.at("wall.force_y", times)
    areas = np.array([overlap(run, 1 + i) for i in range(len(times))])
    off = np.abs(forces / (STIFFNESS * areas) - 1).max()
    CASE.check(Label.EXACT, f"{solver}, in touch: force over stiffness x overlap, largest error", off, 0, 2e-5,
               "p = kn x depth, half in each pass; frames round x near 3 to 1.2e-7, on slopes of 0.05 over depths of "
               "4e-4")


def test_picture(runs: dict, elements: dict, references: list[np.ndarray]) -> None:
    figure, axes = panels(3, "A disc hits a rigid wall", across=True)
    for speed, colour in zip(SPEEDS, COLOURS):
        axes[0].plot(TIMES, velocity(runs[CHOSEN[0], speed][1400]) / speed, color=colour, linewidth=1.3,
                     label=f"engine, {speed:g}")
        axes[0].plot(TIMES, elements[speed][1] / speed, ":", color=COLOURS[7], linewidth=1.3)
    axes[0].set_title("momentum over that before; dots: finite elements", fontsize=10, loc="left")
    draw_forces(axes[1], runs, elements, references)
    for panel in axes[:2]:
        panel.set_xlabel("time over R sqrt(density / mu)")
        legend(panel)
    draw_convergence(axes[2], runs, elements)
    save(CASE, figure, "impact")


def force(velocities: np.ndarray) -> np.ndarray:
    """Mean force over SMOOTH periods, over mu R."""
    return np.pi * (velocities[SMOOTH:] - velocities[:-SMOOTH]) / (SMOOTH * PERIOD)


def draw_forces(axes: Axes, runs: dict, elements: dict, references: list[np.ndarray]) -> None:
    middle = TIMES[:-SMOOTH] + SMOOTH * PERIOD / 2
    curves = {"engine, mls lumped, 1400": velocity(runs[CHOSEN[0], SPEED][1400]),
              "engine, mls lumped, 168": velocity(runs[CHOSEN[0], SPEED][168]),
              "reference, mls lumped, 168": references[1]}
    for (name, values), colour, style in zip(curves.items(), COLOURS, ("-", "-", "--")):
        axes.plot(middle, force(values), style, color=colour, linewidth=1.0, label=name)
    coarse, fine = (force(values) for values in elements[SPEED])
    axes.errorbar(middle[::8], fine[::8], np.abs(fine - coarse)[::8], fmt=".", color=COLOURS[7], markersize=4,
                  capsize=2, label="finite elements")
    describe(axes, f"force on the wall, speed {SPEED:g}, means over {SMOOTH * PERIOD:g}", y="force over mu R")
    axes.set_ylim(top=1.35 * fine.max())


def draw_convergence(axes: Axes, runs: dict, elements: dict) -> None:
    steps = [spacing(n) for n in NODES]
    for variant, colour, marker in zip(VARIANTS, COLOURS, MARKERS):
        errors = differences(runs[variant, SPEED], elements)
        draw_rate(axes, steps, errors, " ".join(variant), colour, marker)
    own = np.sqrt(np.mean((elements[SPEED][1] - elements[SPEED][0])**2)) / SPEED
    axes.axhline(own, color=COLOURS[7], linewidth=0.8, linestyle="--", label="finite elements, two meshes")
    set_ticks(axes, steps, [str(n) for n in NODES])
    describe(axes, "momentum - finite elements, rms; slopes", "nodes")
    axes.legend(fontsize=8, frameon=False, loc="upper left")
