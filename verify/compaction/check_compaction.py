"""Soft discs compacted to a solid fraction of 0.98: pressure and coordination over solid fraction."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from scipy.optimize import curve_fit

from contact_network import Outlines
from fields import frames_of
from histories import speeds
from packing import FORCES, Stage, read_stages
from pictures import COLOURS, MARKERS, legend, panels, save
from verification import FULL, Case, Label, Run

CASE = Case(__file__, cost=2)

DISCS, NODES, OUTLINE = (256, 100, 48) if FULL else (64, 60, 32)
LARGE = 1.4  # diameter; the small one is 1
LAWS = {"frictionless": '"frictionless"', "friction 0.3": '"mohr-coulomb"\nfriction = 0.3'}
AREA = DISCS / 2 * math.pi / 4 * (1 + LARGE**2)
# Initial disc areas over the box area: the ratio exceeds 1 as the discs are compressed.
START, CLOSING = 0.76, [0.82, 0.84, 0.86, 0.88, 0.9, 0.93, 0.96, 0.99, 1.02, 1.06, 1.1, 1.14]
PAUSE, RAMP = 60.0, 30.0  # s between stages; s of wall motion in each
STIFFNESS = 80.0  # about automatic, 8 E/h
CLEARANCE = 0.02  # between a wall's end and the next wall
DENSE = 0.98
POSITION = 1e-6  # rounding of frames' positions (verify/jamming)
JAMMED = 4  # contacts of a frictionless disc at jamming
JAMS_AT = 0.842  # O'Hern et al. 2003
OPEN = slice(None, 10)  # stages before tips of three bodies meet at the walls, where the engine tests for opposition
SOLID = slice(5, None)  # stages without rearrangements: the pressure's work is stored
BEARING = slice(3, None)  # stages with permanent neighbours
SQUARES, SAMPLES = 3, 400  # of the bootstrap; squares across the box


def half_width(share: float) -> float:
    return 0.5 * math.sqrt(AREA / share)


def scene(law: str) -> str:
    """The scene of jamming, with a pinwheel of walls."""
    half = half_width(START)
    closing = speeds([-half_width(share) for share in (START, *CLOSING)], PAUSE, RAMP)
    length = 2 * half + 2
    middle = half - CLEARANCE - length / 2
    return CASE.scene("../jamming/scene.toml", end=PAUSE * len(CLOSING), pause=PAUSE, seed=1, nodes=NODES, damping=0.3,
                      count=DISCS, poisson=0.4, law=LAWS[law], outline_nodes=OUTLINE, stiffness=STIFFNESS,
                      length=length, low=-half, high=half, core=[[-2.0, -2.0], [2.0, 2.0]],
                      bottom=[middle, -half - 0.5], right=[half + 0.5, middle], top=[-middle, half + 0.5],
                      left=[-half - 0.5, -middle], closing=closing,
                      opening=[[time, -speed] for time, speed in closing])


@cache
def compacted(law: str) -> tuple[Run, list[Stage]]:
    run = CASE.engine(law.replace(" ", "_"), scene(law))
    return run, read_stages(run, DISCS, STIFFNESS, LARGE)


def columns(law: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """[stages] solid fraction, pressure over E, coordination."""
    stages = compacted(law)[1]
    names = ("solid_fraction", "pressure", "coordination")
    return tuple(np.array([getattr(s, name) for s in stages]) for name in names)


@pytest.mark.parametrize("law", LAWS)
def test_dense_and_at_rest(law: str) -> None:
    run, stages = compacted(law)
    CASE.check(Label.EXACT, f"{law}: solid fraction of {DENSE} is reached", float(stages[-1].solid_fraction >= DENSE),
               1, 0, "overlaps are counted once")
    CASE.check(Label.EXACT, f"{law}: kinetic over stored energy, last stages", max(s.kinetic for s in stages[SOLID]), 0,
               1e-3, "the kinetic contribution is a thousandth of the pressure")
    CASE.check(Label.EXACT, f"{law}: balance of energy", run.balance_error, 0, 1e-2, "specified")


def test_outlines_alone_give_the_same_forces() -> None:
    """A second contact search, which also gives the overlaps subtracted from the solid fraction."""
    run, stages = compacted("frictionless")
    found = np.array([walls_of(stage) for stage in stages])[OPEN]
    engine = np.abs(np.stack([run.probe(name)[1:] for name in FORCES], axis=1))[OPEN]
    in_touch = 4 * half_width(START)  # length of a wall, from either side
    CASE.check(Label.EXACT, "forces on walls while pores are open, by outlines less engine, over the largest",
               np.abs(found - engine).max() / engine.max(), 0, 0.5 * STIFFNESS * in_touch * POSITION / engine.max(),
               "penalty law; rounding of all outline positions at a wall")


def walls_of(stage: Stage) -> np.ndarray:
    """[4] outward forces, in the order of FORCES."""
    bottom, right, top, left = stage.network.resultants()[-4:]
    return np.array([-bottom[1], right[0], top[1], -left[0]])


def test_pressure_is_the_derivative_of_the_energy() -> None:
    """Without rearrangements, the stored energy is the work of the pressure on the box less the damping loss."""
    run, stages = compacted("frictionless")
    stored = (run.probe("energy.strain") + run.probe("energy.contact"))[1:][SOLID]
    lost = run.probe("energy.dissipated")[1:][SOLID]
    box, pressure = (np.array([getattr(s, name) for s in stages[SOLID]]) for name in ("box", "pressure"))
    work = -np.trapezoid(pressure, box) if hasattr(np, "trapezoid") else -np.trapz(pressure, box)
    smooth = np.polynomial.Polynomial.fit(-box, pressure, 4).integ()
    fitted = smooth(-box[-1]) - smooth(-box[0])
    CASE.check(Label.EXACT, "stored energy over work of the pressure, the denser half of the stages",
               (stored[-1] - stored[0]) / fitted, 1, (lost[-1] - lost[0] + abs(work - fitted)) / fitted,
               "dU = -P dA; damping loss plus difference of fourth-order and piecewise linear curves of the pressure")


def square_root(fraction: np.ndarray, factor: float, jammed: float) -> np.ndarray:
    return JAMMED + factor * np.sqrt(np.maximum(fraction - jammed, 0))


def logarithm(fraction: np.ndarray, factor: float, densest: float) -> np.ndarray:
    return -factor * np.log((densest - fraction) / (densest - JAMS_AT))


def drawn() -> np.ndarray:
    """[squares x samples] counts of each square of the box in bootstrap samples."""
    return np.random.default_rng(1).multinomial(SQUARES**2, np.full(SQUARES**2, SQUARES**-2), SAMPLES).T


def test_coordination_grows_with_a_square_root() -> None:
    """From the isostatic value on; the residual of a two-parameter fit is within the sample's standard error."""
    fraction, _, coordination = (column[BEARING] for column in columns("frictionless"))
    fitted = curve_fit(square_root, fraction, coordination, [5.0, 0.84])[0]
    scatter = np.mean([s.drawn_anew(SQUARES, drawn()).std() for s in compacted("frictionless")[1][BEARING]])
    CASE.check(Label.INDEPENDENT, "frictionless: Z less 4 + factor x root of the excess, rms over stages",
               np.sqrt(np.mean((square_root(fraction, *fitted) - coordination) ** 2)), 0, scatter,
               "Cardenas-Barrantes et al. 2020, 2021: square root; standard error of the discs, by bootstrap")


@pytest.mark.parametrize("law", LAWS)
def test_pressure_grows_as_a_logarithm(law: str) -> None:
    """The limiting solid fraction, without pores, lies between the densest packing reached and 1."""
    fraction, pressure, _ = columns(law)
    densest = fit_of_pressure(law)[1]
    CASE.check(Label.INDEPENDENT, f"{law}: solid fraction where the pressure diverges", densest, (1 + fraction[-1]) / 2,
               (1 - fraction[-1]) / 2, "Cantor et al. 2020, Cardenas-Barrantes et al. 2020: the logarithm diverges "
               "between the largest value reached and 1, the value without pores")


def fit_of_pressure(law: str) -> np.ndarray:
    """Factor over E, and the solid fraction at which the pressure diverges."""
    fraction, pressure, _ = columns(law)
    return curve_fit(logarithm, fraction[1:], pressure[1:], [0.1, 1.0],
                     bounds=([0, fraction[-1] + 1e-4], [np.inf, np.inf]))[0]


def test_pictures() -> None:
    figure, axes = panels(2, f"{DISCS} frictionless discs: mean pressure over E", across=True)
    figure.set_size_inches(13, 6.4)
    for panel, stage in zip(axes, (3, len(CLOSING) - 1)):
        draw_packing(panel, stage)
    save(CASE, figure, "packing")
    figure, axes = panels(2, f"{DISCS} discs compacted to a solid fraction of {DENSE}", across=True)
    for law, colour, marker in zip(LAWS, COLOURS, MARKERS):
        draw_law(axes, law, colour, marker)
    draw_published(axes)
    for panel in axes:
        panel.set_xlabel("solid fraction, off the walls")
        legend(panel)
    save(CASE, figure, "compaction")


def draw_law(axes: list[Axes], law: str, colour: str, marker: str) -> None:
    fraction, pressure, coordination = columns(law)
    fine = np.linspace(JAMS_AT, fraction[-1], 300)
    factor, densest = fit_of_pressure(law)
    axes[0].plot(fraction, pressure, marker, color=colour, markersize=4, label=law)
    axes[0].plot(fine, logarithm(fine, factor, densest), color=colour, linewidth=1,
                 label=f"-{factor:.3f} ln(({densest:.3f} - x)/({densest:.3f} - {JAMS_AT}))")
    axes[1].plot(fraction, coordination, marker, color=colour, markersize=4, label=law)


def draw_published(axes: list[Axes]) -> None:
    axes[0].set_title("pressure on the walls over E", fontsize=10, loc="left")
    fraction, _, coordination = (column[BEARING] for column in columns("frictionless"))
    factor, jammed = curve_fit(square_root, fraction, coordination, [5.0, 0.84])[0]
    fine = np.linspace(jammed, 1, 300)
    axes[1].plot(fine, square_root(fine, factor, jammed), "--", color=COLOURS[0], linewidth=1,
                 label=f"4 + {factor:.1f} root of (x - {jammed:.3f})")
    near = np.linspace(JAMS_AT, JAMS_AT + 0.06, 100)
    axes[1].plot(near, square_root(near, 3.6, JAMS_AT), ":", color=COLOURS[6], linewidth=1.5,
                 label="O'Hern et al. 2003, near jamming")
    axes[1].set_title("contacts a disc, without rattlers", fontsize=10, loc="left")


def draw_packing(axes: Axes, stage: int) -> None:
    run, stages = compacted("frictionless")
    frames = frames_of(run)
    grid, cells = frames.grids["outlines"], frames.grids["bodies"]
    outlines = Outlines.of(frames.positions("outlines", stage + 1), grid.cells, grid.body)
    sums = np.bincount(cells.body, frames.field("bodies", stage + 1, "pressure"))
    mean = (sums / np.bincount(cells.body))[:DISCS]
    discs = PolyCollection([outlines.of_body(disc) for disc in range(DISCS)], array=mean, cmap="YlOrRd",
                           edgecolors="#666666", linewidths=0.5)
    axes.figure.colorbar(axes.add_collection(discs), ax=axes, shrink=0.8)
    found = stages[stage]
    axes.set_title(f"solid fraction {found.solid_fraction:.3f}, P = {found.pressure:.2g} E, Z = {found.coordination:.2f}",
                   fontsize=10, loc="left")
    half = np.sqrt(found.box) / 2
    axes.set_xlim(-1.02 * half, 1.02 * half)
    axes.set_ylim(-1.02 * half, 1.02 * half)
    axes.set_aspect("equal")
    axes.grid(False)
