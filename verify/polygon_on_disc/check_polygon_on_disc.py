"""A hexagon pressed into a disc without friction, a corner or a face first: engine and reference against GetFEM and
CalculiX."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.axes import Axes

from foreign.stored import distances_from_half
from make_polygon_on_disc_oracles import COARSE, DEPTHS, FIRST, RINGS, SOFT, STIFF, by_calculix, by_getfem
from pictures import COLOURS, MARKERS, legend, panels, save
from polygon_on_disc_runs import LONG_PAUSE, NAMES, SIZES, Press, Rests, by_engine, by_reference
from polygon_on_disc_stored import largest_from_here, read_calculix, read_outlines, read_stored
from squeeze import NEWTON
from verification import FULL, Case, Label, observed_order, weights_of_limit

CASE = Case(__file__, cost=2)
CHOSEN = {"neo-hookean": [size for size in SIZES if FULL or size < 28],
          "melody": [size for size in SIZES if size < (28 if FULL else 20)]}
LAWS = tuple(CHOSEN)
GETFEM_STOPS = 1e-6  # Newton's residuals of 1e-9 in the fifty nodes of a support, over the least force
CALCULIX_STOPS = 3e-4  # what load steps half as long change, at most (a corner at 0.1 R, K = 300)
HARDER = 2.0  # times the contact stiffness
LEVELS = range(1, len(DEPTHS))  # at 0.1 R a corner's contact is two segments wide


class Sizes:
    """Forces of one law by mesh size, four meshes each, without penalty; a corner or a face first."""

    def __init__(self, first: str, law: str) -> None:
        self.stored = read_stored(first, law)
        presses = [Press(first, size, law=law) for size in CHOSEN[law]]
        self.spacings = np.array([press.spacing for press in presses])
        self.rests = [[by_engine(CASE, way) for way in press.ways()] for press in presses]
        ways = np.array([[rests.force for rests in each] for each in self.rests])  # [sizes x meshes x depths]
        harder = [replace(way, stiffness=way.stiffness * HARDER) for way in presses[0].ways()]
        lost = HARDER / (HARDER - 1) * (np.array([by_engine(CASE, way).force for way in harder]) / ways[0] - 1)
        self.penalty, self.penalty_error = lost.mean(axis=0), np.ptp(lost, axis=0) / 2
        self.force = ways.mean(axis=1) * (1 + self.penalty)
        # [sizes x depths] twice the error of the mean
        self.scatter = 2 * ways.std(axis=1, ddof=1) / np.sqrt(ways.shape[1]) / self.stored.force

    def errors(self) -> np.ndarray:
        """[sizes x depths] relative."""
        return self.force / self.stored.force - 1

    def rms(self) -> np.ndarray:
        """[sizes] of errors, over the depths."""
        return np.sqrt((self.errors()[:, LEVELS] ** 2).mean(axis=1))

    def weights(self) -> np.ndarray:
        """[2 x sizes] of what straight lines in the spacing and in its square take from each for h = 0."""
        return np.array([weights_of_limit(self.spacings, order) for order in (1, 2)])

    def limit(self) -> np.ndarray:
        """[depths] forces at h = 0: beside corners errors are of first order, elsewhere of second."""
        return (self.weights() @ self.force).mean(axis=0)

    def limit_error(self) -> np.ndarray:
        """[depths] relative: the order, saw tooth, penalty."""
        first, second = self.weights() @ self.force
        scatter = np.abs(self.weights().mean(axis=0)) @ largest_from_here(self.scatter)
        return np.abs(first - second) / 2 / self.stored.force + scatter + self.penalty_error


@pytest.fixture(scope="module")
def sizes() -> Callable[..., Sizes]:
    known: dict[tuple[str, str], Sizes] = {}

    def of(first: str, law: str = LAWS[0]) -> Sizes:
        if (first, law) not in known:
            known[first, law] = Sizes(first, law)
        return known[first, law]

    return of


@pytest.mark.parametrize("first", FIRST)
@pytest.mark.parametrize("level", LEVELS, ids=lambda i: f"{DEPTHS[i]:g}")
def test_force(sizes: Callable[..., Sizes], first: str, level: int) -> None:
    known = sizes(first)
    CASE.check(Label.INDEPENDENT, f"{first} first: force at depth {DEPTHS[level]:g}, engine at h = 0 over GetFEM",
               known.limit()[level] / known.stored.force[level], 1,
               known.limit_error()[level] + known.stored.error[level],
               "GetFEM 5.4.2, its meshes and slaves; first or second order in h, saw tooth, penalty")


@pytest.mark.skipif(not FULL, reason="two_bodies compares this law each time")
@pytest.mark.parametrize("first", FIRST)
@pytest.mark.parametrize("level", LEVELS, ids=lambda i: f"{DEPTHS[i]:g}")
def test_force_melody(sizes: Callable[..., Sizes], first: str, level: int) -> None:
    known = sizes(first, "melody")
    for solver, other in (("GetFEM", known.stored), ("CalculiX", read_calculix(first))):
        CASE.check(Label.INDEPENDENT, f"{first} first, melody: force at depth {DEPTHS[level]:g}, engine at h = 0 over"
                   f" {solver}", known.limit()[level] / other.force[level], 1,
                   known.limit_error()[level] + other.error[level],
                   f"{solver}, its meshes, slaves, penalty; first or second order in h, saw tooth, penalty")


@pytest.mark.parametrize("first", FIRST)
@pytest.mark.parametrize("level", range(len(DEPTHS)), ids=lambda i: f"{DEPTHS[i]:g}")
def test_calculix(first: str, level: int) -> None:
    getfem, calculix = read_stored(first, "melody"), read_calculix(first)
    CASE.check(Label.INDEPENDENT, f"{first} first, melody: force at depth {DEPTHS[level]:g}, GetFEM over CalculiX",
               getfem.force[level] / calculix.force[level], 1, getfem.error[level] + calculix.error[level],
               "meshes and slaves of both, penalty of CalculiX 2.20")


@pytest.mark.parametrize(("first", "facet"), [("corner", True), ("corner", False), ("face", True)])
def test_engine_and_reference(first: str, facet: bool) -> None:
    press = Press(first, CHOSEN[LAWS[0]][0], facet=facet, pause=LONG_PAUSE)
    engine, reference = by_engine(CASE, press), by_reference(CASE, press)
    ratio, allowed = engine.force / reference.force, engine.unrest() + NEWTON
    worst = int((np.abs(ratio - 1) / allowed).argmax())
    on = "a facet" if facet else "a node"
    CASE.check(Label.INDEPENDENT, f"{first} first on {on}: force, engine over reference, worst", ratio[worst], 1,
               allowed[worst], "the force of what still moves, by Cauchy and Schwarz; Newton's method")


@pytest.mark.parametrize("first", FIRST)
@pytest.mark.parametrize("level", LEVELS, ids=lambda i: f"{DEPTHS[i]:g}")
def test_shape(sizes: Callable[..., Sizes], first: str, level: int) -> None:
    """A force grows at least in proportion to the depth, so an error of it is less of the depth. Bodies are moved back
    to the axis."""
    known = sizes(first)
    lost = np.abs(known.errors()[-1, level]) + known.penalty[level] + largest_from_here(known.scatter)[-1, level]
    polygon = known.spacings[-1] ** 2 / 12  # by which corners stand out of the circle
    for name in NAMES:
        places = known.rests[-1][0].outline(name, level)
        off = distances_from_half(places - [places[:, 0].mean(), 0], read_outlines(first)[name][level])
        CASE.check(Label.INDEPENDENT, f"{first} first: {name} at depth {DEPTHS[level]:g}, nodes from GetFEM's outline,"
                   " rms", np.sqrt((off**2).mean()), 0, polygon + lost * DEPTHS[level],
                   "corners of the polygon of the circle's area; errors of the force times the depth")


@pytest.mark.parametrize("first", FIRST)
def test_symmetry(sizes: Callable[..., Sizes], first: str) -> None:
    """The hexagon's corner stands on some place of a segment of the disc, not always on its middle."""
    known = sizes(first)
    aside = [rests.outline(name, level)[:, 0].mean() for rests in known.rests[-1] for name in NAMES for level in LEVELS]
    apart = np.abs(np.diff(np.reshape(aside, (-1, len(NAMES), len(LEVELS))), axis=1)).max()
    CASE.check(Label.EXACT, f"{first} first: how far bodies move aside from each other, worst", apart, 0,
               known.spacings[-1] / 2, "symmetry, but for half a segment")


@pytest.mark.skipif(not FULL, reason="needs the solver from elsewhere")
@pytest.mark.parametrize("first", FIRST)
@pytest.mark.parametrize("law", LAWS)
def test_getfem_again(first: str, law: str) -> None:
    off = np.abs(by_getfem(first, RINGS[0], law=law).force / read_stored(first, law).by_rings[0] - 1)
    CASE.check(Label.FROZEN, f"{first} first, {law}: GetFEM's forces, live over stored, worst", off.max(), 0,
               GETFEM_STOPS, "Newton's residuals of 1e-9 in some fifty nodes of a support, over the least force")


@pytest.mark.skipif(not FULL, reason="needs the solver from elsewhere")
@pytest.mark.parametrize("first", FIRST)
def test_calculix_again(first: str) -> None:
    stored = read_calculix(first)
    off = [np.abs(by_calculix(first, COARSE, "disc", stiffness, CASE.out) / stored.of(0, COARSE, stiffness) - 1).max()
           for stiffness in (SOFT, STIFF)]
    CASE.check(Label.FROZEN, f"{first} first, melody: CalculiX's forces, live over stored, worst", max(off), 0,
               CALCULIX_STOPS, "where its Newton's method stops: what load steps half as long change")


def draw_forces(axes: Axes, sizes: Callable[..., Sizes]) -> None:
    for first, colour in zip(FIRST, COLOURS):
        known = sizes(first)
        axes.plot(DEPTHS, known.stored.force, "s-", color=colour, fillstyle="none", label=f"GetFEM, {first} first")
        axes.plot(DEPTHS, known.limit(), "x", color=colour, label="engine, h = 0")
    axes.set_xlabel("depth over R")
    axes.set_ylabel("force over mu R")
    legend(axes)


def draw_errors(axes: Axes, sizes: Callable[..., Sizes]) -> None:
    for first, colour, marker in zip(FIRST, COLOURS, MARKERS):
        known = sizes(first)
        order = observed_order(list(known.spacings), list(known.rms()))
        axes.loglog(known.spacings, known.rms(), marker=marker, color=colour, label=f"{first} first: {order:.2f}")
        axes.set_xticks(known.spacings, [f"{h:.3f}" for h in known.spacings])
    axes.set_xticks([], minor=True)
    axes.set_xlabel("spacing of the disc's outline over R")
    axes.set_ylabel("|force over GetFEM - 1|, rms of depths")
    legend(axes)


def draw_outlines(axes: Axes, sizes: Callable[..., Sizes], first: str) -> None:
    rests, stored = sizes(first).rests[-1][0], read_outlines(first)
    for name, colour in zip(NAMES, COLOURS):
        places, half = rests.outline(name, -1), stored[name][-1]
        for side in (1, -1):
            axes.plot(side * half[:, 0], half[:, 1], "-", color=colour, linewidth=1.0,
                      label=f"GetFEM, {name}" if side == 1 else "")
        axes.plot(places[:, 0], places[:, 1], ".", color=colour, markersize=3, label=f"engine, {name}")
    axes.set_aspect("equal")
    legend(axes)


def test_picture(sizes: Callable[..., Sizes]) -> None:
    figure, axes = panels(4, "A hexagon, twice as stiff, pressed into a disc", across=True)
    draw_forces(axes[0], sizes)
    draw_errors(axes[1], sizes)
    for panel, first in zip(axes[2:], FIRST):
        draw_outlines(panel, sizes, first)
    save(CASE, figure, "polygon_on_disc")
