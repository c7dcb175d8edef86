"""Von Mises plasticity at large strains: a necking bar, Cook's membrane, a ring and a disc, by all methods, against
GetFEM, a closed form and each other."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np
import pytest

from pictures import COLOURS, MARKERS, describe, draw_rate, legend, panels, save
from verification import FULL, Case, Label, Run

CASE = Case(__file__, long=True, cost=8)
ORACLES = Path(__file__).resolve().parent / "oracles"
METHODS = ["mls", "es-t3", "t3"]
FINE = METHODS if FULL else ["mls"]  # of the bar on the finer mesh, two thirds of the cost of the case

# Necking bar, mm and MN/m
HALF_LENGTH, STRETCH = 26.667, 5.0
BAR_END, BAR_SLOW = 4e-3, 8e-3  # s
BAR_SPACINGS = [1.6, 0.8]
BEFORE_NECK = np.arange(1.0, 6.01, 0.5)  # elongations up to the largest force
IN_NECK = 8.0
# Of the force: mass damping of 5e3 /s at 1.3 m/s takes 7800 kg/m3 x 5e3 x 1.3 x 13 mm = 0.7 MPa of 700 in the mean.
BAR_DRAG = 1e-3

# Cook's membrane, mm and MN/m
PANEL_END, PANEL_FORCE, EDGE = 12e-3, 3.0, 16e-3
PANEL_SPACINGS = [4.0, 2.8, 2.0]
TIPS = np.array([0.17110654, 0.57840733, 2.6889401, 8.3456289])  # of GetFEM at 0.5, 1.5, 2 and 2.5 MN/m
# Of the force: mass damping of 500 /s at 4 m/s takes 7800 x 500 x 4 x 1440 mm2 x 1/2 = 11 kN/m of 2 MN/m.
PANEL_DRAG = 6e-3

# Ring
INSIDE, OUTSIDE, RING_END, RING_HARDENING, RING_PRESSURE = 1.0, 2.0, 60.0, 3.0, 0.88
RING_SPACINGS = [0.25, 0.125]
RING_RADII = np.array([1.03, 1.06, 1.1, 1.15])
RING_ERROR = 1e-3 + 2e-3 + 5e-3

# Disc
DISC_END, APPROACH = 60.0, 0.1
APPROACHES = np.arange(0.02, 0.1001, 0.01)
DISC_NODES = [150, 300]


def oracle(name: str) -> dict[str, np.ndarray]:
    with (ORACLES / f"{name}.csv").open() as stream:
        header, *rows = csv.reader(line for line in stream if not line.startswith("#"))
    return {title: np.array([float(row[i]) for row in rows]) for i, title in enumerate(header)}


def way(t: np.ndarray, end: float) -> np.ndarray:
    """Displacement of the bar's end, mm: it starts slowly."""
    return np.interp(t, *bar_history(end))


def bar_history(end: float) -> tuple[np.ndarray, np.ndarray]:
    """Times and displacements: with constant acceleration for a tenth of the time, then with constant velocity."""
    start = np.linspace(0, 0.1, 21)
    return np.array([*end * start, end]), np.array([*STRETCH * start**2 / 0.2 / 0.95, STRETCH])


def bar(method: str, spacing: float, end: float = BAR_END) -> Run:
    times, ways = bar_history(end)
    history = [[float(t), float(1e-3 * w)] for t, w in zip(times, ways)]
    return CASE.engine(f"bar_{method}_{spacing:g}_{1e3 * end:g}ms",
                       CASE.scene("necking.toml", method=method, spacing=spacing, end=end, displacement=history,
                                  clock=end / 200))


def bar_force(run: Run, elongations: np.ndarray, end: float = BAR_END) -> np.ndarray:
    """Force of the whole bar, MN/m: the mean of sigma_xx over the area is the force times the length, as only the ends
    do work along x."""
    moved = way(run.times("mean.stress_xx"), end)
    force = 2 * run.probe("mean.stress_xx") * run.probe("bar.area") / (1e-3 * (HALF_LENGTH + moved)) / 1e6
    return np.interp(elongations, 2 * moved, force)


def panel(method: str, spacing: float) -> Run:
    sides = [math.hypot(48, 44), 16.0]  # from the first corner to the tip
    tip = sum(math.ceil(side / spacing - 1e-9) for side in sides)
    return CASE.engine(f"panel_{method}_{spacing:g}",
                       CASE.scene("cook.toml", method=method, spacing=spacing, end=PANEL_END, tip=tip,
                                  traction=PANEL_FORCE * 1e6 / EDGE, clock=PANEL_END / 300))


def panel_force(run: Run, tips: np.ndarray) -> np.ndarray:
    """Force at displacements of the tip, MN/m."""
    t = run.times("tip.displacement_y")
    return np.interp(tips, 1e3 * run.probe("tip.displacement_y"), PANEL_FORCE * t / PANEL_END)


def ring(method: str, spacing: float) -> Run:
    def arc(radius: float) -> list[tuple[float, float]]:
        count = round(math.pi / 2 * radius / spacing)
        return [(radius * math.cos(math.pi / 2 * k / count), radius * math.sin(math.pi / 2 * k / count))
                for k in range(count + 1)]

    points = [[round(x, 15), round(y, 15)] for x, y in [*arc(OUTSIDE), *arc(INSIDE)[::-1]]]
    points = [points[-1], *points[:-1]]
    return CASE.engine(f"ring_{method}_{spacing:g}",
                       CASE.scene("ring.toml", method=method, spacing=spacing, points=points, end=RING_END,
                                  pressure=RING_PRESSURE, hardening=RING_HARDENING, clock=RING_END / 200))


def disc(nodes: int) -> Run:
    velocity = [[0, 0], [0.1 * DISC_END, -APPROACH / (0.95 * DISC_END)]]
    return CASE.engine(f"disc_{nodes}", CASE.scene("disc.toml", nodes=nodes, end=DISC_END, velocity=velocity,
                                                   clock=DISC_END / 400))


def disc_force(run: Run, approaches: np.ndarray) -> np.ndarray:
    """Mean force of both plates at these approaches."""
    force = 0.5 * (np.abs(run.probe("floor.force_y")) + np.abs(run.probe("lid.force_y")))
    return np.interp(approaches, -run.probe("way.displacement_y"), force)


@pytest.fixture(scope="module")
def bars() -> dict[tuple[str, float], Run]:
    coarse, fine = BAR_SPACINGS
    return ({(method, coarse): bar(method, coarse) for method in METHODS} |
            {(method, fine): bar(method, fine) for method in FINE})


@pytest.fixture(scope="module")
def slow_bar() -> Run:
    return bar("mls", BAR_SPACINGS[0], BAR_SLOW)


@pytest.fixture(scope="module")
def membranes() -> dict[tuple[str, float], Run]:
    return {(method, spacing): panel(method, spacing) for method in METHODS for spacing in PANEL_SPACINGS}


@pytest.fixture(scope="module")
def discs() -> dict[int, Run]:
    return {nodes: disc(nodes) for nodes in DISC_NODES}


def relative(force: np.ndarray, expected: np.ndarray) -> float:
    return float(np.abs(force / expected - 1).max())


def test_bar_up_to_the_largest_force(bars: dict[tuple[str, float], Run]) -> None:
    table = oracle("necking")
    expected = np.interp(BEFORE_NECK, table["elongation"], table["force"])
    for (method, spacing), run in bars.items():
        CASE.check(Label.INDEPENDENT, f"bar, force from 1 to 6 mm, {method}, {spacing:g} mm",
                   relative(bar_force(run, BEFORE_NECK), expected), 0, BAR_DRAG,
                   "GetFEM, error 5e-5; all meshes have nearly uniform strains, and mass damping carries 1e-3")


def test_bar_in_the_neck(bars: dict[tuple[str, float], Run], slow_bar: Run) -> None:
    table, at = oracle("necking"), np.array([IN_NECK])
    expected = float(np.interp(IN_NECK, table["elongation"], table["force"]))
    of = {key: float(bar_force(run, at)[0]) / expected - 1 for key, run in bars.items()}
    slow = float(bar_force(slow_bar, at, BAR_SLOW)[0]) / expected - 1
    coarse, fine = BAR_SPACINGS
    by_speed = 2 * abs(of["mls", coarse] - slow)  # what is left at half the speed falls with the speed
    for method in FINE:
        by_mesh = 2 * abs(of[method, coarse] - of[method, fine])
        CASE.check(Label.INDEPENDENT, f"bar, force at 8 mm, {method}, {fine:g} mm", of[method, fine], 0,
                   by_speed + by_mesh + BAR_DRAG,
                   "GetFEM, error 4e-5; twice what halves of spacing and speed change, as both errors fall at least "
                   "linearly")
    CASE.check(Label.INDEPENDENT, "bar, force at 8 mm: t3 is stiffer than es-t3 on the same nodes",
               float(of["t3", coarse] > of["es-t3", coarse] + 0.002), 1, 0,
               "linear triangles lock in flow at constant volume")


def test_energy_balance(bars: dict[tuple[str, float], Run], membranes: dict[tuple[str, float], Run]) -> None:
    for name, run in (("bar", bars["mls", BAR_SPACINGS[0]]), ("membrane", membranes["mls", PANEL_SPACINGS[0]])):
        CASE.check(Label.EXACT, f"balance of energy, {name}", run.balance_error, 0, 1e-5,
                   "of second order in the strain of a step, 1e-5, with 1e5 steps; loads enter by their work")


def test_membrane(membranes: dict[tuple[str, float], Run]) -> None:
    table = oracle("cook")
    expected = np.interp(TIPS, table["tip_y"], table["force"])
    errors = {key: relative(panel_force(run, TIPS), expected) for key, run in membranes.items()}
    finest, coarser = PANEL_SPACINGS[-1], PANEL_SPACINGS[-2]
    for method in METHODS:
        difference = relative(panel_force(membranes[method, finest], TIPS), panel_force(membranes[method, coarser],
                                                                                        TIPS))
        CASE.check(Label.INDEPENDENT, f"membrane, force at four displacements, {method}, {finest:g} mm",
                   errors[method, finest], 0, difference / (coarser / finest - 1) + PANEL_DRAG,
                   "GetFEM, error 2e-3 of the force; what the last refinement changes, extrapolated in first order; and "
                   "the drag of mass damping")
        CASE.check(Label.INDEPENDENT, f"membrane, {method}: error falls with the spacing",
                   float(errors[method, finest] < errors[method, PANEL_SPACINGS[0]]), 1, 0, "convergence to GetFEM")
    CASE.check(Label.INDEPENDENT, f"membrane: t3 is stiffer than es-t3 and mls, {finest:g} mm",
               float(errors["t3", finest] > 2 * max(errors["mls", finest], errors["es-t3", finest])), 1, 0,
               "linear triangles lock in flow at constant volume")


def swollen(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """Inner radius of the ring, that of a circle of the same area, and the pressure inside."""
    pressure = RING_PRESSURE * run.times("balance.work_of_loads") / RING_END
    work = run.probe("balance.work_of_loads")
    swept = np.concatenate([[0], np.cumsum(np.diff(work) / (0.5 * (pressure[1:] + pressure[:-1])))])
    return np.sqrt(INSIDE**2 + 4 / math.pi * swept), pressure


def ring_pressure(inside: float) -> float:
    """Pressure in a plastic ring whose inner radius has come to `inside`: 2/sqrt(3) int Y(a) dr/r with
    a = 2/sqrt(3) ln(r/R) at the present radius r of what was at R, r^2 - R^2 = inside^2 - INSIDE^2. Without hardening it
    is 2/sqrt(3) Y ln(b/a)."""
    shift = inside**2 - INSIDE**2
    r = np.exp(np.linspace(math.log(inside), 0.5 * math.log(OUTSIDE**2 + shift), 401))
    strain = 1 / math.sqrt(3) * np.log(r**2 / (r**2 - shift))
    return float(2 / math.sqrt(3) * np.trapz(1 + RING_HARDENING * strain, np.log(r)))


def test_ring() -> None:
    for method in ["mls", "es-t3"]:
        of = {}
        for spacing in RING_SPACINGS:
            inside, pressure = swollen(ring(method, spacing))
            expected = np.array([ring_pressure(a) for a in RING_RADII])
            of[spacing] = np.interp(RING_RADII, inside, pressure) / expected - 1
        coarse, fine = (of[spacing] for spacing in RING_SPACINGS)
        CASE.check(Label.EXACT, f"ring, pressure inside at {RING_RADII[0]:g} to {RING_RADII[-1]:g} of the inner radius, "
                   f"{method}", float(np.abs(fine).max()), 0, RING_ERROR + float(np.abs(coarse - fine).max()),
                   "integral of 2/sqrt(3) Y dr/r over a ring of constant area; Y/E 1e-3, facets of the inner arc 2e-3, "
                   "mass damping 0.1 x 0.05 = 5e-3, and what half the spacing changes, as errors fall at least linearly")


def test_disc(discs: dict[int, Run]) -> None:
    table = oracle("disc")
    expected = np.interp(APPROACHES, table["approach"], table["force"])
    for nodes, run in discs.items():
        spacing = math.sqrt(math.pi / 4 / nodes)
        widths = 2 * np.sqrt(0.5 * APPROACHES / 2 * 2)  # of contact, by the circle cut off on both sides
        CASE.check(Label.INDEPENDENT, f"disc between plates, force from 2 to 10 %, {nodes} nodes",
                   relative(disc_force(run, APPROACHES), expected), 0, float((0.5 * spacing / widths).max()),
                   "GetFEM, error 1.5 %; half a segment of the outline more or less in contact")
    other = oracle("disc_calculix")
    of_calculix = np.interp(APPROACHES, other["approach"], other["force"])
    CASE.check(Label.INDEPENDENT, "disc between plates: CalculiX against GetFEM, 2 to 10 %",
               relative(of_calculix, expected), 0, float((np.interp(APPROACHES, other["approach"], other["error_force"])
                                                          / of_calculix).max()),
               "both solvers' own error, from meshes, steps and penalty; the elastic laws differ by Y/E = 1e-3")


def test_picture(bars: dict[tuple[str, float], Run], membranes: dict[tuple[str, float], Run],
                 discs: dict[int, Run]) -> None:
    figure, axes = panels(3, "Von Mises plasticity: engine (lines) and GetFEM (dots)", across=True)
    table = oracle("necking")
    axes[0].plot(table["elongation"][::2], table["force"][::2], "k.", markersize=5, label="GetFEM")
    elongations = np.linspace(0, 10, 200)
    for method, colour in zip(METHODS, COLOURS):
        spacing = min(size for name, size in bars if name == method)
        axes[0].plot(elongations, bar_force(bars[method, spacing], elongations), color=colour, linewidth=1.1,
                     label=f"{method}, {spacing:g} mm")
    describe(axes[0], "necking bar", "elongation [mm]", "force [MN/m]")
    table = oracle("cook")
    axes[1].plot(table["tip_y"], table["force"], "k.", markersize=5, label="GetFEM")
    tips = np.linspace(0, table["tip_y"][-1], 200)
    for method, colour in zip(METHODS, COLOURS):
        axes[1].plot(tips, panel_force(membranes[method, PANEL_SPACINGS[0]], tips), color=colour, linewidth=1.1,
                     label=f"{method}, {PANEL_SPACINGS[0]:g} mm")
    describe(axes[1], "Cook's membrane", "displacement of the tip [mm]", "force [MN/m]")
    table = oracle("disc")
    axes[2].plot(table["approach"], table["force"], "k.", markersize=5, label="GetFEM")
    table = oracle("disc_calculix")
    axes[2].plot(table["approach"], table["force"], "kx", markersize=4, label="CalculiX")
    approaches = np.linspace(0, APPROACH, 300)
    for (nodes, run), colour in zip(discs.items(), COLOURS):
        axes[2].plot(approaches, disc_force(run, approaches), color=colour, linewidth=1.1, label=f"{nodes} nodes")
    describe(axes[2], "disc between plates", "approach over diameter", "force")
    for panel_axes in axes:
        legend(panel_axes)
    save(CASE, figure, "plasticity")
