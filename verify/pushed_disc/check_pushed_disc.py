"""A stiff disc pushed along a soft block with Coulomb friction, stick and slip: engine and reference against GetFEM and
CalculiX."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from matplotlib.axes import Axes
from scipy.stats import t as students_t

from foreign.stored import distances
from make_pushed_disc_oracles import (CALCULIX_MESHES, DEPTH, DRAWN, FRICTION, LAWS, LONG, LONGEST, MESHES, SHORT,
                                      SLIDING, SOFT, STEPS, STUCK, by_calculix, by_getfem)
from pictures import COLOURS, MARKERS, legend, panels, save
from pushed_disc_runs import WINDOWS, Push, Result, by_engine, by_reference, hann
from pushed_disc_stored import by_group, read_calculix, read_stored, read_surfaces
from verification import FULL, Case, Label, observed_order, weights_of_limit

CASE = Case(__file__, cost=8)
SIZES = [10, 14, 20, 28]
CHOSEN = {"neo-hookean": SIZES, "melody": SIZES[:3]}  # by law
STIFF, SLOW = 2.0, 2.0  # times the contact stiffness; the pause
GETFEM_STOPS = 3e-7  # Newton's residuals of 1e-9 in the fifty nodes of the disc's support, over the least force, 0.177
KINDS = {"along": "tangential", "across": "normal"}
PLACES = [*(f"at push {push:g}" for push in STUCK), *(f"in slip, push {low:g} to {high:g}" for low, high in WINDOWS)]
QUANTITIES = [(name, i) for name in KINDS for i in range(len(PLACES)) if (name, i) != ("along", 0)]
SLIPS = np.arange(len(PLACES)) >= len(STUCK)
# Of the change by half the rate, that to none. At rests: of first order or higher. In slip: drag is of first order,
# but what snaps after each tooth sets in late by rate^(2/3), as whatever passes a fold slowly.
FACTOR, FACTOR_ERROR = np.where(SLIPS, 2.35, 1.5), np.where(SLIPS, 0.35, 0.5)
CONFIDENCE = 0.95
COARSE = "two sizes tell 1 % of N and 3 to 8 % of T that sticks, for 16 runs: only three and more are worth it"


def error_of_mean(values: np.ndarray, freedoms: int) -> np.ndarray:
    """[places] by Student's factor, of a mean over meshes, [meshes x places]; their spread has so many freedoms."""
    factor = students_t.ppf((1 + CONFIDENCE) / 2, freedoms)
    return factor * values.std(axis=0, ddof=1) / np.sqrt(len(values))


class Study:
    """One component of the force on the block at all places by mesh size, corrected for penalty and rate."""

    def __init__(self, name: str, law: str = LAWS[0]) -> None:
        self.name, self.law, self.first = name, law, 1 if name == "along" else 0
        stored = read_stored(law)
        self.stored, self.stored_error = getattr(stored.forces, name), getattr(stored.errors(), name)
        self.spacings = np.array([Push(size).spacing for size in CHOSEN[law]])
        lost = self._penalty()
        self.penalty = lost.mean(axis=0)
        found = [self._size(size) for size in CHOSEN[law]]
        self.force = np.array([force for force, _ in found]) * (1 + self.penalty)  # [sizes x places]
        self.scatter = np.array([scatter for _, scatter in found]) / self.stored
        self.penalty_error = by_group(np.abs(lost[0] - lost[1]) / 2, self.first)

    def _of(self, push: Push) -> np.ndarray:
        return getattr(result_of(push).forces, self.name)

    def _penalty(self) -> np.ndarray:
        """[2 x places] lost by it, of order 1 / stiffness."""
        ways = Push(SIZES[0], law=self.law).ways(2)
        pairs = [(push, replace(push, stiffness=push.stiffness * STIFF)) for push in ways]
        return STIFF / (STIFF - 1) * np.array([self._of(harder) / self._of(usual) - 1 for usual, harder in pairs])

    def _size(self, size: int) -> tuple[np.ndarray, np.ndarray]:
        """[places] forces, those of the same meshes at half the rate drawn to no rate at all, and their error: that of
        a mean over meshes, of which the spread is the largest of all places, and of the order in the rate."""
        ways = Push(size, law=self.law).ways(2)
        usual, slower = (np.array([self._of(replace(push, pause=push.pause * slow)) for push in ways])
                         for slow in (1.0, SLOW))
        late = (slower - usual).mean(axis=0)
        more = [result_of(replace(push, slides=False)) for push in Push(size, law=self.law).ways()[2:]]
        stuck = np.concatenate([usual[:, ~SLIPS], [getattr(result.forces, self.name) for result in more]])
        force = np.concatenate([stuck.mean(axis=0), usual[:, SLIPS].mean(axis=0)]) + FACTOR * late
        still = usual + FACTOR * (slower - usual)
        means = np.concatenate([error_of_mean(stuck, len(stuck) - 1),
                                error_of_mean(still[:, SLIPS], (len(still) - 1) * len(WINDOWS))])
        return force, by_group(means, self.first) + by_group(FACTOR_ERROR * np.abs(late), self.first)

    def errors(self) -> np.ndarray:
        """[sizes x places] relative."""
        return self.force / self.stored - 1

    def rms(self) -> np.ndarray:
        """[sizes] of errors in slip, where the saw tooth is gone from the means."""
        return np.sqrt((self.errors()[:, SLIPS] ** 2).mean(axis=1))

    def weights(self) -> np.ndarray:
        """[sizes]"""
        return weights_of_limit(self.spacings, 2)

    def limit(self) -> np.ndarray:
        """[places] at h = 0."""
        return self.weights() @ self.force

    def own_error(self) -> np.ndarray:
        """[places] of the limit, relative: saw tooth and rate, penalty."""
        return np.abs(self.weights()) @ self.scatter + self.penalty_error

    def limit_error(self) -> np.ndarray:
        """[places] relative, with that of what is stored."""
        return self.own_error() + self.stored_error


KNOWN: dict[Push, Result] = {}


def result_of(push: Push) -> Result:
    if push not in KNOWN:
        KNOWN[push] = by_engine(CASE, push)
    return KNOWN[push]


@pytest.fixture(scope="module")
def studies() -> dict[str, Study]:
    return {name: Study(name) for name in KINDS}


@pytest.fixture(scope="module")
def melody() -> Callable[[str], Study]:
    return cache(lambda name: Study(name, "melody"))


@pytest.mark.skipif(not FULL, reason=COARSE)
@pytest.mark.parametrize("name, i", QUANTITIES, ids=[f"{name}-{i}" for name, i in QUANTITIES])
def test_force(studies: dict[str, Study], name: str, i: int) -> None:
    known = studies[name]
    CASE.check(Label.INDEPENDENT, f"{KINDS[name]} force {PLACES[i]}, engine at h = 0 over GetFEM",
               known.limit()[i] / known.stored[i], 1, known.limit_error()[i],
               "GetFEM 5.4.2, its meshes and load steps; saw tooth between meshes of one size, penalty, rate")


@pytest.mark.parametrize("name, i", QUANTITIES, ids=[f"{name}-{i}" for name, i in QUANTITIES])
def test_calculix(name: str, i: int) -> None:
    getfem, calculix = read_stored("melody"), read_calculix()
    k = list(KINDS).index(name)
    CASE.check(Label.INDEPENDENT, f"melody: {KINDS[name]} force {PLACES[i]}, GetFEM over CalculiX",
               getattr(getfem.forces, name)[i] / calculix.force[k, i], 1,
               getattr(getfem.errors(), name)[i] + calculix.error[k, i],
               "meshes and load steps of both, penalty, slaves and lag of CalculiX 2.20")


@pytest.mark.parametrize("mesh", CALCULIX_MESHES, ids=str)
def test_lag(mesh: tuple[int, int]) -> None:
    """Where CalculiX pairs points of both surfaces at the start of an increment only, and all slips."""
    calculix = read_calculix()
    along = np.array([calculix.of(mesh, SOFT, increment)[0, SLIPS] for increment in (LONGEST, LONG, SHORT)])
    changes = np.sqrt((np.diff(along, axis=0) ** 2).mean(axis=1))
    lag = (along[0] / (2 * along[2] - along[1]) - 1).max()
    CASE.check(Label.RATE, f"melody: tangential force in slip, CalculiX with {mesh[0]} rings by three increments",
               np.log2(changes[0] / changes[1]), 1, np.log2((1 + 1.5 * lag) / (1 + 0.75 * lag)),
               "pairs of points at an increment's start; a next term of the lag's square, with the longest one's lag")


@pytest.mark.skipif(not FULL, reason=COARSE)
@pytest.mark.parametrize("name, i", QUANTITIES, ids=[f"{name}-{i}" for name, i in QUANTITIES])
def test_force_melody(melody: Callable[[str], Study], name: str, i: int) -> None:
    known, calculix, k = melody(name), read_calculix(), list(KINDS).index(name)
    for solver, force, error in (("GetFEM", known.stored, known.stored_error),
                                 ("CalculiX", calculix.force[k], calculix.error[k])):
        CASE.check(Label.INDEPENDENT, f"melody: {KINDS[name]} force {PLACES[i]}, engine at h = 0 over {solver}",
                   known.limit()[i] / force[i], 1, known.own_error()[i] + error[i],
                   f"{solver}, its meshes and load steps; saw tooth between meshes of one size, penalty, rate")


@pytest.mark.skipif(not FULL, reason=COARSE)
@pytest.mark.parametrize("name", KINDS)
def test_order(studies: dict[str, Study], name: str) -> None:
    known = studies[name]
    errors = known.rms()
    logs = np.log(known.spacings) - np.log(known.spacings).mean()
    own = known.scatter[:, SLIPS].max(axis=1) / errors
    common = (known.stored_error + known.penalty_error)[SLIPS].max() / errors
    CASE.check_rate(f"{KINDS[name]} force in slip over GetFEM, rms of windows", list(known.spacings), list(errors), 2,
                    float((np.sqrt(((logs * own) ** 2).sum()) + np.abs((logs * common).sum())) / (logs**2).sum()),
                    "linear consistency and a polygon for a circle; errors of rate and saw tooth by size, common ones")


@pytest.fixture(scope="module")
def same_nodes() -> list[Result]:
    """Reference, and with half as many load steps, of what sticks alone."""
    push = Push(SIZES[0])
    return [by_reference(CASE, push), by_reference(CASE, replace(push, points=push.points // 2, slides=False))]


def within_steps(push: np.ndarray, force: np.ndarray) -> np.ndarray:
    """[windows] how far means may be off since a force that changes between samples is known at these alone: at each
    tooth it snaps."""
    change = np.abs(np.diff(force, prepend=force[0]))
    return np.array([hann(push, *window) @ change / 2 for window in WINDOWS])


@pytest.mark.parametrize("name", KINDS)
def test_engine_and_reference(same_nodes: list[Result], name: str) -> None:
    """The engine's rate is taken out as in Study."""
    moving = [result_of(replace(Push(SIZES[0]), pause=Push(SIZES[0]).pause * slow)) for slow in (1.0, SLOW)]
    usual, slower = (getattr(result.forces, name) for result in moving)
    static, long_steps = (getattr(result.forces, name) for result in same_nodes)
    first = 1 if name == "along" else 0
    still = usual + FACTOR * (slower - usual)
    allowed = by_group(FACTOR_ERROR * np.abs(slower - usual), first)
    allowed[~SLIPS] += np.abs(long_steps - static[~SLIPS])[first:].max()
    allowed[SLIPS] += sum(within_steps(result.push, getattr(result, name)) for result in (moving[0], same_nodes[0]))
    off = np.abs(still - static) / allowed
    for kind, there in (("sticks", ~SLIPS), ("slips", SLIPS)):
        i = np.flatnonzero(there)[first * (kind == "sticks") + off[there][first * (kind == "sticks"):].argmax()]
        CASE.check(Label.INDEPENDENT, f"{KINDS[name]} force that {kind}, engine over reference, worst",
                   still[i] / static[i], 1, allowed[i] / static[i],
                   "the order in the rate; what half as many load steps of statics change, or what changes between"
                   " samples")


@pytest.mark.skipif(not FULL, reason=COARSE)
@pytest.mark.parametrize("push", DRAWN)
def test_surface(studies: dict[str, Study], push: float) -> None:
    """A force grows at least in proportion to the depth, so an error of it is less of the depth; along, what sticks at
    the surface has gone no further than the push at which all slips."""
    finest = Push(SIZES[-1])
    result = result_of(finest)
    place = STUCK.index(push) if push in STUCK else len(PLACES) - 1
    across, along = (np.abs(studies[name].errors()[-1, place]) + studies[name].scatter[-1, place]
                     for name in ("across", "along"))
    overlap = result.forces.across.max() / 1.5 / finest.stiffness
    off = distances(result.surface(finest.rests[-1] if push in STUCK else finest.end), read_surfaces()[push])
    CASE.check(Label.INDEPENDENT, f"block's top at push {push:g}: nodes from GetFEM's, rms",
               np.sqrt((off**2).mean()), 0, across * DEPTH + along * min(push, SLIDING[0]) + overlap,
               "error of the normal force times depth, of the tangential one times the way that sticks, overlap")


@pytest.mark.skipif(not FULL, reason="needs the solver from elsewhere")
def test_getfem_again() -> None:
    key = (*MESHES[0], STEPS[-1])
    live = by_getfem(*key, [*STUCK, *(float(push) for push in SLIDING)]).forces
    off = np.abs(live[:, 1:] / read_stored().samples[key][:, 1:] - 1)[1:]
    CASE.check(Label.FROZEN, "GetFEM's forces, live over stored, worst", off.max(), 0, GETFEM_STOPS,
               "Newton's residuals of 1e-9 in some fifty nodes of a support, over the least force")


@pytest.mark.skipif(not FULL, reason="needs the solver from elsewhere")
def test_calculix_again() -> None:
    calculix, mesh = read_calculix(), CALCULIX_MESHES[0]
    off = np.abs(by_calculix(*mesh, SOFT, CASE.out, LONG) / calculix.samples(mesh, SOFT, LONG) - 1)[1:, 1:]
    CASE.check(Label.FROZEN, "melody: CalculiX's forces, live over stored, worst", off.max(), 0,
               np.abs(calculix.down()[:, 1:]).max(), "what increments half as long on the way down change")


def draw_forces(axes: Axes, name: str) -> None:
    column = 1 if name == "along" else 2
    stored = read_stored().finest
    axes.plot(stored[:, 0], stored[:, column], "ks", markersize=3, label="GetFEM")
    for size, colour in zip((SIZES[0], SIZES[-1]), COLOURS):
        result = result_of(Push(size))
        axes.plot(result.push, getattr(result, name), "-", color=colour, linewidth=1.0,
                  label=f"engine, h = {Push(size).spacing:.3f} R")
    axes.set_xlabel("push over R")
    axes.set_ylabel(f"{KINDS[name]} force over mu R")
    legend(axes)


def draw_errors(axes: Axes, studies: dict[str, Study]) -> None:
    for (name, known), colour, marker in zip(studies.items(), COLOURS, MARKERS):
        order = observed_order(list(known.spacings), list(known.rms()))
        axes.loglog(known.spacings, known.rms(), marker=marker, color=colour, linewidth=1.2,
                    label=f"{KINDS[name]}: {order:.2f}")
        off = np.abs(known.limit() / known.stored - 1)[SLIPS]
        axes.axhline(np.sqrt((off**2).mean()), linestyle=":", color=colour, linewidth=1.0, label="at h = 0")
    spacings = studies["along"].spacings
    axes.set_xticks(spacings, [f"{h:.3f}" for h in spacings])
    axes.set_xticks([], minor=True)
    axes.set_xlabel("spacing of the block's outline over R")
    axes.set_ylabel("|force in slip over GetFEM - 1|")
    legend(axes)


def draw_surfaces(axes: Axes) -> None:
    finest = Push(SIZES[-1])
    for push, colour in zip(DRAWN, COLOURS):
        stored = read_surfaces()[push]
        places = result_of(finest).surface(finest.rests[-1] if push in STUCK else finest.end)
        axes.plot(stored[:, 0], stored[:, 1], "-", color=colour, linewidth=1.0, label=f"GetFEM, push {push:g}")
        axes.plot(places[:, 0], places[:, 1], ".", color=colour, markersize=4, label=f"engine, push {push:g}")
    axes.set_aspect("equal")
    axes.set_ylim(-1.2, 1.4)
    axes.set_xlabel("x over R")
    legend(axes)


@pytest.mark.skipif(not FULL, reason=COARSE)
def test_picture(studies: dict[str, Study]) -> None:
    figure, axes = panels(4, f"A stiff disc pushed along a soft block, friction {FRICTION:g}", across=True)
    for panel, name in zip(axes, KINDS):
        draw_forces(panel, name)
    draw_errors(axes[2], studies)
    draw_surfaces(axes[3])
    save(CASE, figure, "pushed_disc")
