"""Scenes that are hard on contact, on large strains or on the time step: each meets its bounds with the defaults."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest
from matplotlib.colors import LogNorm

from fields import frames_of
from pictures import describe, panels, save
from verification import FULL, Case, Label, Run

CASE = Case(__file__, cost=3)

METHODS = ["mls", "mls-gauss", "es-t3"]
SAMPLES = 40  # per run
ENERGY, DEPTH, MOMENTUM = 0.01, 0.25, 1e-12


@dataclass
class Hard:
    """A scene, and its bounds where they differ from the defaults."""

    name: str
    end: float = 0  # s, if the scene does not set it
    energy: float = ENERGY  # of the largest energy of the run
    depth: float = DEPTH  # of the shortest segment
    momentum: float = MOMENTUM  # of the largest forces
    source: str = "specified"


# 1e6 steps with --full, 2e5 otherwise.
REST = 47_000.0 if FULL else 9_400.0

CASES = [
    Hard("corner_on_corner"),
    Hard("corner_past_corner"),
    Hard("sliver"),
    Hard("nearly_incompressible"),
    Hard("mass_ratio"),
    Hard("stiffness_ratio"),
    Hard("fast_impact"),
    Hard("squeezed_flat"),
    Hard("deep_overlap", depth=0.8, source="initial depth"),
    Hard("gear"),
    Hard("around_and_around"),
    Hard("torn_cluster"),
    Hard("bonded_gap"),
    # In a step of touch, elastic slip stores kt v^2 dt^2/2 times the face, 3.7 % of the energy. A contact of one step
    # gives it back w^2 dt^2 - 1 times and counts it as lost, with w^2 dt^2 up to 4 safety^2.
    Hard("cohesive_slide", energy=0.06, source="elastic slip in one step of touch"),
    Hard("at_rest", end=REST),
    # Verlet conserves K + U - dt^2 sum F^2 / (8 m): (1 - w^2 dt^2 / 4) of a mode's energy, nothing of the fastest.
    Hard("at_the_limit", energy=0.05, source="at the limit the energy of the fastest mode is not conserved, one of "
                                             "twenty excited by a bounce"),
    Hard("faster_impact", depth=0.5, source="p = rho c v of a plane wave is 0.13 of a segment on kn = 8 E/h; doubled "
                                            "on reflection, and doubled where the wave focuses at the pole"),
    Hard("wedge"),
    Hard("needle", depth=1.0, source="one node carries all load: contact is not lost"),
    Hard("extrusion"),
    Hard("hooks"),
    Hard("fast_spin"),
    Hard("column"),
    Hard("to_and_fro"),
    Hard("closing_ring"),
    Hard("high_friction"),
    Hard("three_tips", momentum=1e-10, source="forces of three tips cancel to a hundredth"),
    Hard("small_in_pore"),
]


def ends_at(text: str) -> float:
    return float(text.split("\nend = ")[1].split()[0])


def with_quadrature(text: str, quadrature: str) -> str:
    key = f'quadrature = "{quadrature}"\n'
    if "\n[contact]\n" in text:
        return text.replace("\n[contact]\n", f"\n[contact]\n{key}", 1)
    return text.replace("\n[time]\n", f"\n[contact]\n{key}\n[time]\n", 1)


def scene(hard: Hard, method: str) -> str:
    """The scene with probes and frames for the bounds."""
    text = CASE.scene(f"{hard.name}.toml", method=method, **({"end": hard.end} if hard.end else {}))
    period = ends_at(text) / SAMPLES
    probes = "".join(f'\n[[probes]]\nname = "{quantity}"\nquantity = "{quantity}"\n{options}period = {period!r}\n'
                     for quantity, options in (("energy", ""), ("contact_gap", 'of = "all"\nreduce = "min"\n'),
                                               ("jacobian", 'of = "all"\nreduce = "min"\n')))
    return f"{text}{probes}\n[frames]\nperiod = {ends_at(text)!r}\nfields = []\n"


@cache
def engine(name: str, method: str, quadrature: str = "auto") -> Run:
    hard = next(h for h in CASES if h.name == name)
    return CASE.engine(f"{name}_{method}_{quadrature}", with_quadrature(scene(hard, method), quadrature))


def energy_error(run: Run) -> float:
    """Largest energy error over the largest energy of the run."""
    held = sum(run.probe(f"energy.{part}") for part in ("kinetic", "strain", "contact", "boundary"))
    lost, work = run.probe("energy.dissipated"), run.probe("energy.external_work")
    gained = held + lost - work - held[0]
    return float(np.abs(gained).max() / max(np.abs(work).max(), held.max(), lost.max()))


def shortest_segment(run: Run) -> float:
    """Shortest initial segment of all grain outlines, m."""
    frames = frames_of(run)
    grid = frames.grids["outlines"]
    points = frames.positions("outlines", 0)[:, :2]
    segments = points[grid.cells[:, 1]] - points[grid.cells[:, 0]]
    return float(np.hypot(*segments.T).min())


@pytest.mark.parametrize("method, quadrature", [*((method, "auto") for method in METHODS), (METHODS[0], "segments")])
@pytest.mark.parametrize("hard", CASES, ids=lambda hard: hard.name)
def test_bounds(hard: Hard, method: str, quadrature: str) -> None:
    run = engine(hard.name, method, quadrature)
    name = f"{hard.name}, {method}" + (", integrated" if quadrature == "segments" else "")
    depth = -np.nanmin(np.append(run.probe("contact_gap.contact_gap"), 0)) / shortest_segment(run)
    CASE.check(Label.EXACT, f"{name}: energy", energy_error(run), 0, hard.energy, hard.source)
    CASE.check(Label.EXACT, f"{name}: depth over the shortest segment", depth, 0, hard.depth, hard.source)
    CASE.check(Label.EXACT, f"{name}: momentum", run.summary["momentum_error"], 0, hard.momentum, hard.source)
    least = float(run.probe("jacobian.jacobian").min())
    CASE.check(Label.EXACT, f"{name}: no element turned inside out", float(least > 0), 1, 0, "J > 0, and no NaN")


# ---- against the reference solver, where motions are not chaotic

REFERENCE = [("mass_ratio", 0.04, "nodes"), ("nearly_incompressible", 0.04, "nodes"), ("wedge", 0.1, "nodes"), ("hooks", 0.1, "nodes"),
             ("wedge", 0.1, "segments"), ("hooks", 0.1, "segments")]


@pytest.mark.parametrize("name, dt, quadrature", REFERENCE)
def test_reference(name: str, dt: float, quadrature: str) -> None:
    """Energies over time; both solvers run with one step and with half of it."""
    hard = next(h for h in CASES if h.name == name)
    text = with_quadrature(scene(hard, "mls"), quadrature).split("\n[frames]")[0]
    short = CASE.engine(f"{name}_{quadrature}_short", text.replace("\nend = ", "\nsafety = 0.4\nend = ", 1))
    rough, fine = (CASE.reference(f"{name}_{quadrature}_{step:g}", text, "--dt", repr(step)) for step in (dt, dt / 2))
    long = engine(name, "mls", quadrature)
    size = max(long.probe(f"energy.{part}").max() for part in ("kinetic", "strain"))
    shown = name if quadrature == "nodes" else f"{name}, integrated"
    for part in ("kinetic", "strain"):
        a, b, c, d = (run.probe(f"energy.{part}") for run in (long, short, rough, fine))
        CASE.check(Label.INDEPENDENT, f"{shown}: {part} energy, engine less reference over the largest",
                   np.abs(b - d).max() / size, 0, (np.abs(a - b).max() + np.abs(c - d).max()) / size,
                   "change by halving the step in either: at least first order, so it bounds the remaining error")


# ---- limits of the default settings: a disc hits a soft disc

SPEEDS = [0.05, 0.1, 0.2, 0.4, 0.8, 1.6, 2.4]  # over the soft disc's S waves; P waves run at 2.45
USUAL = 0.8
RATIOS = [1.0, 10.0, 100.0, 1000.0]
SAFETIES = [0.4, 0.8, 1.0]


@cache
def impact(speed: float, ratio: float, safety: float) -> float:
    """Energy error; infinite if the run stops early."""
    end = 0.2 / speed + 4
    text = CASE.scene("impact.toml", speed=-speed, young=2.8 * ratio, safety=safety, end=end, period=end / SAMPLES)
    try:
        return energy_error(CASE.engine(f"impact_{speed:g}_{ratio:g}_{safety:g}", text))
    except RuntimeError:
        return np.inf


def test_map_of_impacts() -> None:
    for safety in (0.4, 0.8):
        worst = max(impact(speed, ratio, safety) for speed in SPEEDS for ratio in RATIOS if speed <= USUAL)
        CASE.check(Label.EXACT, f"impacts at safety {safety:g}: energy, worst of speeds up to {USUAL:g} and ratios of stiffness",
                   worst, 0, ENERGY, "specified")


def test_picture() -> None:
    figure, axes = panels(len(SAFETIES), "A disc hits a soft one: error of the energy", across=True)
    for panel, safety in zip(axes, SAFETIES):
        error = np.array([[impact(speed, ratio, safety) for ratio in RATIOS] for speed in SPEEDS])
        panel.grid(False)
        shown = panel.pcolormesh(np.where(np.isfinite(error), error, np.nan), norm=LogNorm(1e-6, 1e-1), cmap="viridis")
        for (i, j), value in np.ndenumerate(error):
            panel.text(j + 0.5, i + 0.5, f"{value:.0e}" if np.isfinite(value) else "fails", ha="center", va="center",
                       fontsize=8, color="white" if value < 1e-3 else "black")
        panel.set_xticks(np.arange(len(RATIOS)) + 0.5, [f"{ratio:g}" for ratio in RATIOS])
        panel.set_yticks(np.arange(len(SPEEDS)) + 0.5, [f"{speed:g}" for speed in SPEEDS])
        describe(panel, f"safety {safety:g}", "ratio of stiffness")
    axes[0].set_ylabel("speed over that of S waves")
    figure.colorbar(shown, ax=axes[-1])
    save(CASE, figure, "impacts")
