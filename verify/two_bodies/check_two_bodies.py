"""Two deformable bodies in contact at large strain: engine and reference solver against GetFEM and CalculiX.

Discs between plates, a hexagon on a disc with a corner or a face first, and a disc pushed along a block with friction.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import two_bodies_discs as discs
import two_bodies_pictures as pictures
import two_bodies_polygon as polygon
import two_bodies_push as push
from foreign.stored import distances
from squeeze import NEWTON
from two_bodies_discs import Discs, Squeeze
from two_bodies_polygon import CornerFirst, FaceFirst, Polygon, Press
from two_bodies_push import SLIPS, Across, Along, Push, Sliding
from two_bodies_study import LAWS, Rests, RestStudy, Setup, Study, read
from verification import FULL, Case, Label

CASE = Case(__file__, long=True, cost=12)
KINDS = (Discs, CornerFirst, FaceFirst, Along, Across)
FROZEN = [*discs.AGAIN, *polygon.AGAIN, *push.AGAIN]
SAME_NODES = {"discs": Squeeze(size=discs.SAME_NODES, pause=40.0),
              "corner first on a facet": Press(first="corner", size=10, pause=60.0),
              "corner first on a node": Press(first="corner", size=10, way=2, pause=60.0),
              "face first on a facet": Press(first="face", size=10, pause=60.0)}
LIVE = pytest.mark.skipif(not FULL, reason="needs the third-party solvers")


@cache
def study(kind: type[Study], law: str = "neo-hookean") -> Study:
    return kind(CASE, law)


def params(*values: object, kind: type[Study], law: str = "neo-hookean") -> object:
    """Parameters with a readable name, skipped where runs are long."""
    marks = [pytest.mark.skipif(not FULL, reason=kind.long[law])] if law in kind.long else []
    return pytest.param(kind, *values, marks=marks, id="-".join(map(str, (kind.name, *values))))


@pytest.mark.parametrize("kind, law, solver, i", [
    params(law, solver, i, kind=kind, law=law) for kind in KINDS for law in LAWS
    for solver in ("GetFEM", "CalculiX")[:1 + (law == "melody")] for i in kind.compared
    if solver == "GetFEM" or i in kind.between])
def test_force(kind: type[Study], law: str, solver: str, i: int) -> None:
    known = study(kind, law)
    other = known.getfem if solver == "GetFEM" else kind.read_calculix()
    # Of discs this tolerance has GetFEM's error as well, 3e-4 beside 6e-3.
    also = known.getfem.error[i] if (kind, solver) == (Discs, "CalculiX") else 0
    CASE.check(Label.INDEPENDENT, f"{kind.name}, {law}: force {kind.places[i]}, engine at h = 0 over {solver}",
               known.limit()[i] / other.force[i], 1, known.limit_error()[i] + other.error[i] + also,
               f"{kind.others[solver]}; {kind.own}")


@pytest.mark.parametrize("kind, i", [pytest.param(kind, i, id=f"{kind.name}-{i}")
                                     for kind in KINDS for i in kind.between])
def test_getfem_over_calculix(kind: type[Study], i: int) -> None:
    getfem, calculix = kind.read_getfem("melody"), kind.read_calculix()
    CASE.check(Label.INDEPENDENT, f"{kind.name}, melody: force {kind.places[i]}, GetFEM over CalculiX",
               getfem.force[i] / calculix.force[i], 1, getfem.error[i] + calculix.error[i], kind.both)


@pytest.mark.parametrize("rings", push.CALCULIX_RINGS)
def test_lag(rings: int) -> None:
    """CalculiX in full slip; it pairs points of both surfaces only at the start of an increment."""
    order, error = push.order_of_lag(rings)
    CASE.check(Label.RATE, f"pushed, tangential, melody: force in slip, CalculiX with {rings} rings by three"
               " increments", order, 1, error, "pairs of points at an increment's start; next term, the square of"
               " the lag, at the longest increment")


@pytest.mark.parametrize("kind", [params(kind=kind) for kind in KINDS if kind.order])
def test_order(kind: type[Study]) -> None:
    known, (what, errors) = study(kind), kind.order
    CASE.check_rate(f"{kind.name}: {what}", list(known.spacings), list(known.rms()), 2, known.slope_error(), errors)


@pytest.mark.parametrize("name", SAME_NODES)
def test_engine_and_reference(name: str) -> None:
    setup: Setup = SAME_NODES[name]
    engine, reference = Rests(setup, setup.by_engine(CASE)), Rests(setup, setup.by_reference(CASE))
    ratio, allowed = engine.force / reference.force, engine.unrest() + NEWTON
    worst = int((np.abs(ratio - 1) / allowed).argmax())
    CASE.check(Label.INDEPENDENT, f"{name}: force, engine over reference, worst", ratio[worst], 1, allowed[worst],
               "force of residual motion, from its kinetic energy by Cauchy and Schwarz; Newton's method")


@pytest.mark.parametrize("state", ["sticks", "slips"])
@pytest.mark.parametrize("kind", [Along, Across])
def test_pushed_engine_and_reference(kind: type[Sliding], state: str) -> None:
    ratio, allowed = push.engine_and_reference(CASE)[kind.kind]
    there = [i for i in kind.compared if SLIPS[i] == (state == "slips")]
    i = max(there, key=lambda i: abs(ratio[i] - 1) / allowed[i])
    CASE.check(Label.INDEPENDENT, f"{kind.name}: force that {state}, engine over reference, worst", ratio[i], 1,
               allowed[i], "order in the rate; change by half as many load steps of statics, or between samples")


@pytest.mark.parametrize("kind, body, i", [params(body, i, kind=kind) for kind in KINDS if issubclass(kind, RestStudy)
                                           for body in kind.outlines() for i in kind.compared])
def test_shape(kind: type[RestStudy], body: str, i: int) -> None:
    known, number = study(kind), list(kind.outlines()).index(body)
    CASE.check(Label.INDEPENDENT, f"{kind.name}: {body} {kind.places[i]}, nodes from GetFEM's outline, rms",
               known.off(number, i, kind.outlines()[body][i]), 0, known.shape_error(number, i), kind.shape)


@pytest.mark.parametrize("kind", [CornerFirst, FaceFirst])
def test_symmetry(kind: type[Polygon]) -> None:
    """The hexagon's corner touches a segment of the disc at an arbitrary position, not always its middle."""
    known = study(kind)
    CASE.check(Label.EXACT, f"{kind.name}: how far bodies move aside from each other, worst", known.apart(), 0,
               known.spacings[-1] / 2, "symmetry, up to half a segment")


@pytest.mark.skipif(not FULL, reason=push.COARSE)
@pytest.mark.parametrize("at", push.DRAWN)
def test_surface(at: float) -> None:
    """A force grows at least in proportion to the depth, so its relative error bounds that of the depth. Sticking
    points of the surface have moved along by at most the push at full slip."""
    finest = Push(size=push.CHOSEN["neo-hookean"][-1])
    found, place = push.by_engine(CASE, finest), push.STUCK.index(at) if at in push.STUCK else -1
    across, along = (np.abs(known.errors()[-1, place]) + known.scatter[-1, place]
                     for known in (study(Across), study(Along)))
    tops = read("push_surfaces").outlines()
    overlap = found.samples[:, push.COLUMN["across"]].max() / 1.5 / finest.stiffness
    off = distances(found.surface(finest.time_of(at)), tops[push.DRAWN.index(at)])
    CASE.check(Label.INDEPENDENT, f"pushed: block's top at push {at:g}, nodes from GetFEM's, rms",
               np.sqrt((off**2).mean()), 0, across * push.DEPTH + along * min(at, push.SLIDING[0]) + overlap,
               "error of the normal force times depth, of the tangential one times the push in stick, overlap")


@LIVE
@pytest.mark.parametrize("solver, change, tolerance, source", FROZEN, ids=[row[0] for row in FROZEN])
def test_again(solver: str, change: Callable[[Path], np.ndarray], tolerance: float, source: str) -> None:
    CASE.check(Label.FROZEN, f"{solver}'s forces, live over stored, worst", np.abs(change(CASE.out)).max(), 0,
               tolerance, source)


@LIVE
@pytest.mark.parametrize("law", LAWS)
def test_live(law: str) -> None:
    known, live = study(Discs, law), discs.opinion_of(discs.live(law))
    ratio, allowed = known.limit() / live.force, known.limit_error() + live.error
    worst = int((np.abs(ratio - 1) / allowed).argmax())
    CASE.check(Label.INDEPENDENT, f"discs, {law}: engine at h = 0 over GetFEM live, worst", ratio[worst], 1,
               allowed[worst], "GetFEM's difference of two meshes; saw tooth between corners and facets, penalty")


@pytest.mark.parametrize("draw, kinds", [
    pytest.param(pictures.draw_discs, [Discs], id="discs"),
    pytest.param(pictures.draw_polygon, [CornerFirst, FaceFirst], id="polygon"),
    pytest.param(pictures.draw_push, [Along, Across], id="push",
                 marks=pytest.mark.skipif(not FULL, reason=push.COARSE))])
def test_picture(draw: Callable[..., None], kinds: list[type[Study]]) -> None:
    draw(CASE, *map(study, kinds))
