"""Two deformable bodies in contact at large strain: engine and reference solver against GetFEM and CalculiX."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from matplotlib.axes import Axes

from foreign.stored import distances_from_half
from make_two_bodies_oracles import by_getfem, calculix_rows
from pictures import COLOURS, MARKERS, legend, panels, save
from squeeze import NEWTON
from two_bodies_discs import APPROACHES, LONG_PAUSE, NAMES, Rests, Squeeze, by_engine, by_reference
from two_bodies_stored import Penalised, Stored, read_calculix, read_outlines, read_stored
from verification import FULL, Case, Label, observed_order, weights_of_limit

CASE = Case(__file__, cost=2)
LAWS = {"neo-hookean": [168, 340, 700], "melody": [168, 340, *([700] if FULL else [])]}  # nodes in the soft disc
SAME_NODES = 168 if FULL else 96  # of engine and reference
# Where Newton's methods stop: GetFEM at residuals of 1e-9 in each of some fifty nodes on a plate, over the least force;
# CalculiX at what steps four times shorter change.
GETFEM_STOPS, CALCULIX_STOPS = 1.5e-7, 3e-5
STIFF = 2.0  # times the contact stiffness
PERCENT = [f"{100 * approach:g} %" for approach in APPROACHES]


class Sizes:
    """Forces of one law by mesh size, both ways (corners and facets at the poles) and without penalty."""

    def __init__(self, law: str) -> None:
        self.nodes = LAWS[law]
        self.stored = read_stored(law)
        squeezes = [Squeeze(nodes, law=law) for nodes in self.nodes]
        self.spacings = np.array([squeeze.spacing for squeeze in squeezes])
        self.rests = [[by_engine(CASE, way) for way in squeeze.both_ways()] for squeeze in squeezes]
        ways = np.array([[rests.force for rests in pair] for pair in self.rests])  # [sizes x 2 x approaches]
        stiff = Squeeze(self.nodes[0], law=law, stiffness=3e3 * STIFF)
        harder = np.array([by_engine(CASE, way).force for way in stiff.both_ways()])
        lost = STIFF / (STIFF - 1) * (harder / ways[0] - 1)  # [2 x approaches] by the penalty, of order 1 / k
        self.penalty, self.penalty_error = lost.mean(axis=0), np.abs(lost[0] - lost[1]) / 2
        self.force = ways.mean(axis=1) * (1 + self.penalty)
        self.saw = np.abs(ways[:, 0] - ways[:, 1]) / 2 / self.stored.force  # [sizes x approaches]

    def errors(self) -> np.ndarray:
        """[sizes x approaches] relative."""
        return self.force / self.stored.force - 1

    def rms(self) -> np.ndarray:
        """[sizes] of errors, over the approaches."""
        return np.sqrt((self.errors() ** 2).mean(axis=1))

    def weights(self) -> np.ndarray:
        """[sizes]"""
        return weights_of_limit(self.spacings, 2)

    def limit(self) -> np.ndarray:
        """[approaches] forces at h = 0."""
        return self.weights() @ self.force

    def limit_error(self) -> np.ndarray:
        """[approaches] relative: saw tooth, penalty, stored error. At a single approach the saw tooth may be small by
        accident, so its largest is taken."""
        return np.abs(self.weights()) @ self.saw.max(axis=1) + self.penalty_error + self.stored.error

    def slope_error(self) -> float:
        """Of the order in h, from independent saw teeth of all sizes."""
        logs = np.log(self.spacings) - np.log(self.spacings).mean()
        share = np.sqrt((self.saw**2).mean(axis=1)) / self.rms()
        return float(np.sqrt(((logs * share) ** 2).sum()) / (logs**2).sum())


@pytest.fixture(scope="module")
def sizes() -> Callable[[str], Sizes]:
    known: dict[str, Sizes] = {}

    def of(law: str) -> Sizes:
        if law not in known:
            known[law] = Sizes(law)
        return known[law]

    return of


@pytest.fixture(scope="module")
def same_nodes() -> list[Rests]:
    squeeze = Squeeze(SAME_NODES, pause=LONG_PAUSE)
    return [by_engine(CASE, squeeze), by_reference(CASE, squeeze)]


def test_engine_and_reference(same_nodes: list[Rests]) -> None:
    engine, reference = same_nodes
    ratio, allowed = engine.force / reference.force, engine.unrest() + NEWTON
    worst = int((np.abs(ratio - 1) / allowed).argmax())
    CASE.check(Label.INDEPENDENT, "force, engine over reference, worst", ratio[worst], 1, allowed[worst],
               "the force of what still moves, from its kinetic energy by Cauchy and Schwarz; Newton's method")


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("level", range(len(APPROACHES)), ids=lambda i: f"{100 * APPROACHES[i]:g}")
def test_force(sizes: Callable[[str], Sizes], law: str, level: int) -> None:
    known = sizes(law)
    CASE.check(Label.INDEPENDENT, f"{law}: force at {PERCENT[level]}, engine at h = 0 over GetFEM",
               known.limit()[level] / known.stored.force[level], 1, known.limit_error()[level],
               "GetFEM 5.4.2 and its difference of two meshes; saw tooth between corners and facets, penalty")


@pytest.mark.parametrize("level", range(3), ids=lambda i: f"{100 * APPROACHES[i]:g}")
def test_calculix(sizes: Callable[[str], Sizes], level: int) -> None:
    known, calculix = sizes("melody"), read_calculix()
    force, error = calculix.force[level], calculix.error[level]
    CASE.check(Label.INDEPENDENT, f"melody: force at {PERCENT[level]}, engine at h = 0 over CalculiX",
               known.limit()[level] / force, 1, known.limit_error()[level] + error,
               "CalculiX 2.20, its mesh and penalty; saw tooth between corners and facets, penalty")
    CASE.check(Label.INDEPENDENT, f"melody: force at {PERCENT[level]}, GetFEM over CalculiX",
               known.stored.force[level] / force, 1, known.stored.error[level] + error, "mesh of both, penalty")


@pytest.mark.skipif(not FULL, reason="needs the solvers from elsewhere")
@pytest.mark.parametrize("law", LAWS)
def test_getfem_again(sizes: Callable[[str], Sizes], law: str) -> None:
    known = sizes(law)
    again = Stored(known.stored.rings[:2], np.array([by_getfem(law, int(n)).force for n in known.stored.rings[:2]]))
    off = np.abs(again.by_rings / known.stored.by_rings[:2] - 1)
    CASE.check(Label.FROZEN, f"{law}: GetFEM's forces, live over stored, worst", off.max(), 0, GETFEM_STOPS,
               "Newton's residuals of 1e-9 in some fifty nodes on a plate, over the least force")
    ratio, allowed = known.limit() / again.force, known.limit_error() + again.error
    worst = int((np.abs(ratio - 1) / allowed).argmax())
    CASE.check(Label.INDEPENDENT, f"{law}: engine at h = 0 over GetFEM live, worst", ratio[worst], 1, allowed[worst],
               "GetFEM's difference of two meshes; saw tooth between corners and facets, penalty")


@pytest.mark.skipif(not FULL, reason="needs the solvers from elsewhere")
def test_calculix_again() -> None:
    stored, again = read_calculix(), Penalised(np.array(calculix_rows(CASE.out)))
    off = np.abs(again.rows[:, 2:] / stored.rows[:, 2:] - 1)
    CASE.check(Label.FROZEN, "melody: CalculiX's forces, live over stored, worst", off.max(), 0, CALCULIX_STOPS,
               "where its Newton's method stops: what steps four times shorter change")


def test_order(sizes: Callable[[str], Sizes]) -> None:
    known = sizes("neo-hookean")
    CASE.check_rate("force over GetFEM, rms of approaches", list(known.spacings), list(known.rms()), 2,
                    known.slope_error(), "linear consistency and a polygon for a circle; the saw tooth's scatter")


@pytest.mark.parametrize("level", range(len(APPROACHES)), ids=lambda i: f"{100 * APPROACHES[i]:g}")
def test_shape(sizes: Callable[[str], Sizes], level: int) -> None:
    known = sizes("neo-hookean")
    finest = known.rests[-1][0]
    for name, own in zip(NAMES, Squeeze(known.nodes[-1]).outlines):
        off = distances_from_half(finest.outline(name, level), read_outlines("neo-hookean")[name][level])
        CASE.check(Label.INDEPENDENT, f"{name} disc at {PERCENT[level]}: nodes from GetFEM's outline, rms",
                   np.sqrt((off**2).mean()), 0, shape_error(known, own, level),
                   "corners of the polygon of the circle's area; overlap of the penalty; mesh as of the force")


def shape_error(known: Sizes, corners: int, level: int) -> float:
    """R. A plate's approach that changes the force by its error of the mesh; corners stand out by x^2/12, the contact's
    overlap is the penalty's part of the approach."""
    force, approach = known.stored.force, np.array(APPROACHES)
    approach_by_force = 4 / np.gradient(np.log(force), approach)[level]
    lost = np.abs(known.errors()[-1, level]) + known.penalty[level] + known.saw[-1].max()
    return float((2 * np.pi / corners) ** 2 / 12 + lost * approach_by_force / 2)


def draw_forces(axes: Axes, known: Sizes) -> None:
    axes.plot(100 * np.array(APPROACHES), known.stored.force, "s-", color=COLOURS[0], fillstyle="none", label="GetFEM")
    axes.plot(100 * np.array(APPROACHES), known.limit(), "x", color=COLOURS[1], label="engine, h = 0")
    axes.set_xlabel("approach over the diameters [%]")
    axes.set_ylabel("force over mu R")
    legend(axes)


def draw_errors(axes: Axes, known: Sizes) -> None:
    for i, (percent, marker) in enumerate(zip(PERCENT, MARKERS)):
        axes.loglog(known.spacings, np.abs(known.errors()[:, i]), marker=marker, markersize=4, linewidth=1.0,
                    color=COLOURS[i], label=percent)
    order = observed_order(list(known.spacings), list(known.rms()))
    axes.loglog(known.spacings, known.rms(), "k-", linewidth=1.8, label=f"rms: {order:.2f}")
    axes.set_xticks(known.spacings, [f"{h:.3f}" for h in known.spacings])
    axes.set_xticks([], minor=True)
    axes.set_xlabel("spacing of the outlines over R")
    axes.set_ylabel("|force over GetFEM - 1|")
    legend(axes)


def draw_others(axes: Axes, known: Sizes) -> None:
    """Meshes of the solvers from elsewhere, by rings of triangles in the soft disc."""
    stored, calculix, getfem = known.stored, read_calculix(), read_stored("melody")
    for i, percent in enumerate(PERCENT):
        axes.loglog(stored.rings[:-1], np.abs(stored.by_rings[:-1, i] / stored.force[i] - 1), "o-", color=COLOURS[i],
                    markersize=4, linewidth=1.0, label=f"GetFEM, {percent}")
        if i < len(calculix.force):
            axes.loglog(calculix.rings, np.abs(calculix.by_rings[:, i] / getfem.force[i] - 1), "s:", color=COLOURS[i],
                        markersize=4, linewidth=1.0, label=f"CalculiX, {percent}")
    ticks = sorted({*calculix.rings, *stored.rings[:-1]})
    axes.set_xticks(ticks, [f"{rings:g}" for rings in ticks])
    axes.set_xticks([], minor=True)
    axes.set_ylim(1e-6, 1e-1)
    axes.set_xlabel("rings of triangles")
    axes.set_ylabel("|force over GetFEM's of 64 rings (CalculiX: 16) - 1|")
    axes.legend(fontsize=8, frameon=False, ncols=2, loc="upper center")


def draw_outlines(axes: Axes, known: Sizes) -> None:
    rests = known.rests[-1][0]
    for level, colour in zip((0, len(APPROACHES) - 1), COLOURS):
        for name in NAMES:
            places, stored = rests.outline(name, level), read_outlines("neo-hookean")[name][level]
            for side in (1, -1):
                axes.plot(side * stored[:, 0], stored[:, 1], "-", color=colour, linewidth=1.0,
                          label=f"GetFEM, {PERCENT[level]}" if side == 1 and name == NAMES[0] else "")
            axes.plot(places[::3, 0], places[::3, 1], ".", color=colour, markersize=3,
                      label=f"engine, {PERCENT[level]}" if name == NAMES[0] else "")
    axes.set_aspect("equal")
    axes.set_ylim(-2.1, 3.4)
    legend(axes)


def test_picture(sizes: Callable[[str], Sizes]) -> None:
    known = sizes("neo-hookean")
    figure, axes = panels(4, "Two discs between plates, the upper one twice as stiff", across=True)
    draw_forces(axes[0], known)
    draw_errors(axes[1], known)
    draw_others(axes[2], known)
    draw_outlines(axes[3], known)
    save(CASE, figure, "discs")
