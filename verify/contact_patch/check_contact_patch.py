"""Contact patch test: uniform pressure through a face with nonmatching nodes, over segments and at nodes."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fields import Stresses, along_outline, stresses_of
from half_planes import pressures
from pictures import COLOURS, MARKERS, describe, draw_cells, panels, save, set_ticks
from verification import FULL, Case, Label, Run, observed_order

CASE = Case(__file__)

Face = tuple[int, int]  # segments of the common face, lower and upper
Statics = dict[str, list[Run]]  # of each ratio of spacings, from coarse to fine

SEGMENTS, NODES = "auto", "nodes"  # quadratures; the default is the integral, as blocks have corners
PRESSURE = 1e-5
YOUNG, POISSON = 2.8, 0.4
END = 40.0
FACES: dict[str, list[Face]] = {"1:1": [(16, 16), (32, 32), (64, 64)], "5:4": [(20, 16), (40, 32), (80, 64)],
                                "3:2": [(18, 12), (36, 24), (72, 48)], "2:1": [(24, 12), (32, 16), (64, 32)]}
NOT_MATCHING = [ratio for ratio in FACES if ratio != "1:1"]
FINER = {ratio: (2 * FACES[ratio][-1][0], 2 * FACES[ratio][-1][1]) for ratio in NOT_MATCHING} if FULL else {}
STIFFER = [4.0, 16.0, 64.0]  # times the automatic stiffness
SUPPORT = 1e-6  # stiffness along x of springs that keep blocks from gliding
NEWTON = 64 * np.finfo(float).eps * 10 * YOUNG  # residual at a node: 64 roundings of positions of 1, stiffness 10 E
GLIDING = 2 * NEWTON / (6 * SUPPORT)  # relative, of the blocks, by that residual at a node; outline length 6 each
NARROWER = 1e-6  # upper block on either side, with contact at nodes: exceeds gliding and depth
# Stress along x of these springs under the strain nu (1 + nu) p/E, over the load. On half a block, the side pulls as
# much as top and bottom together.
SUPPORTS = 2 * SUPPORT * POISSON * (1 + POISSON) / YOUNG
DEPTH = 0.25
EXACT = np.array([0, -PRESSURE, 0])


def spacing(face: Face) -> float:
    """Spacing of the coarser side."""
    return 2 / min(face)


def blur(face: Face) -> float:
    """Bound of an exact solver's deviation from uniform stress, over the load.

    Strains are p/E at most; by them Cauchy stress differs from that of small strains, and corner directions from the
    initial ones. At corners, each pass meets the other block's side where it is nearer than the face. A corner thus
    lacks d = p/kn of its half spacing, 2 d/h = p/(4 E) at 8 E/h. The other terms are springs along x, single precision
    of frames and the residual of Newton's method.
    """
    return PRESSURE / YOUNG + PRESSURE / (4 * YOUNG) + SUPPORTS + 2**-24 + rounding(face)


def rounding(face: Face) -> float:
    """Newton residual over nodal loads p h."""
    return NEWTON / (PRESSURE * 2 / max(face))


ROUNDING = "Newton residual 4e-13 per node"
BLUR = f"strains p/E, depth over half a spacing p/(4 E), springs along x 4e-7, single precision; {ROUNDING}"
GLIDES = "the residual lets blocks glide by 1.3e-7 on springs of 1e-6"


def half_width(quadrature: str) -> float:
    """Half width of the upper block."""
    return 1 - NARROWER if quadrature == NODES else 1.0


def scene(face: Face, quadrature: str, stiffer: float = 1) -> str:
    """Scene with the automatic stiffness 8 E/h of the finer side, times `stiffer`."""
    stiffness = stiffer * 8 * YOUNG * max(face) / 2
    return CASE.scene(quadrature=quadrature, half=half_width(quadrature), lower=2 / face[0], upper=2 / face[1],
                      stiffness=float(stiffness), end=END)


def solve(face: Face, quadrature: str, stiffer: float = 1) -> Run:
    return CASE.reference(f"reference_{quadrature}_{face[0]}_{face[1]}_{stiffer:g}", scene(face, quadrature, stiffer),
                          "--static", "--dt", repr(END))


@pytest.fixture(scope="module")
def segments() -> Statics:
    return {ratio: [solve(face, SEGMENTS) for face in faces] for ratio, faces in FACES.items()}


@pytest.fixture(scope="module")
def nodes() -> Statics:
    return {ratio: [solve(face, NODES) for face in all_faces(ratio)] for ratio in FACES}


@pytest.fixture(scope="module")
def stiffer() -> list[Run]:
    return [solve(FACES["2:1"][1], NODES, factor) for factor in STIFFER]


def all_faces(ratio: str) -> list[Face]:
    return [*FACES[ratio], *([FINER[ratio]] if ratio in FINER else [])]


def on_face(run: Run, body: int) -> tuple[np.ndarray, np.ndarray]:
    """x and the pressure over the load of a body's nodes on the common face, from left to right."""
    places, pressure = along_outline(run, body, "contact_pressure")
    face = np.flatnonzero(np.abs(places[:, 1]) < 0.01)
    face = face[np.argsort(places[face, 0])]
    values = pressure[face] / PRESSURE
    # A corner's length includes half a spacing of the side; its normal lies at 45 degrees.
    values[[0, -1]] *= 2 * np.sqrt(2)
    return places[face, 0], values


def error(stresses: Stresses, where: np.ndarray) -> float:
    return stresses.rms(stresses.values - EXACT, where) / PRESSURE


def middle_error(run: Run, reach: float = 1) -> float:
    """Rms up to a distance from the face, weighted by cos^2(pi x) over |x| < 1/2. The weight excludes the sides and is
    the same for each period of nodes that divides 1/2, for any position of cells."""
    stresses = stresses_of(run)
    x, y = stresses.centres.T
    return error(stresses, np.where((np.abs(x) < 0.5) & (np.abs(y) < reach), np.cos(np.pi * x)**2, 0))


def check_patch(what: str, runs: list[Run], tolerance: float, source: str) -> None:
    """Uniform stress in all cells of both blocks, and uniform pressure on all nodes of the face, corners included."""
    stress = max(np.abs(stresses_of(run).values - EXACT).max() for run in runs) / PRESSURE
    CASE.check(Label.EXACT, f"{what}: largest stress error of all cells", stress, 0, tolerance, source)
    pressure = max(np.abs(on_face(run, body)[1] - 1).max() for run in runs for body in (0, 1))
    CASE.check(Label.EXACT, f"{what}: largest error of nodal pressures", pressure, 0, tolerance, source)


@pytest.mark.parametrize("ratio", FACES)
def test_segments_pass(segments: Statics, ratio: str) -> None:
    """Two Gauss points integrate the constant pressure times hat functions exactly, for any opposite nodes."""
    check_patch(f"segments, {ratio}, reference", segments[ratio], blur(FACES[ratio][-1]), BLUR)
    engine = CASE.engine(f"engine_{SEGMENTS}_{ratio.replace(':', '_')}", scene(FACES[ratio][1], SEGMENTS))
    check_patch(f"segments, {ratio}, engine", [engine], blur(FACES[ratio][1]), BLUR)


def test_matching_nodes_pass(nodes: Statics) -> None:
    """Of two coinciding corners, the inner one touches in one pass, with half of both its sides. This equals the sum of
    both passes. The outer corner touches nothing and receives that force."""
    face = FACES["1:1"][-1]
    check_patch("nodes, 1:1, reference", nodes["1:1"], blur(face) + (NARROWER + GLIDING) * max(face),
                f"{BLUR}; 1e-6 of the outer corner's half spacing h/2 is not loaded; {GLIDES}")


def order_of_next_term(steps: list[float], length: float = 1) -> float:
    """Apparent order of 1 + h/length over the steps; the weight function in the middle has the width 1."""
    return float(np.log((1 + steps[0] / length) / (1 + steps[-1] / length)) / np.log(steps[0] / steps[-1]))


@pytest.mark.parametrize("ratio", NOT_MATCHING)
def test_error_of_nodes(nodes: Statics, ratio: str) -> None:
    steps = [spacing(face) for face in all_faces(ratio)]
    at_face = [middle_error(run, step) for run, step in zip(nodes[ratio], steps)]
    CASE.check_rate(f"nodes, {ratio}: rms stress error in the layer of one spacing", steps, at_face, 0,
                    order_of_next_term(steps),
                    "the error is the same at each spacing, as kn h/E and relative node positions are; next term 1 + h")
    CASE.check_rate(f"nodes, {ratio}: rms stress error at all depths", steps, [middle_error(r) for r in nodes[ratio]],
                    0.5, order_of_next_term(steps), "an error of O(1) in a layer of height h; next term 1 + h")


def far_error(run: Run) -> float:
    """Rms away from the sides and from the common face."""
    stresses = stresses_of(run)
    x, y = np.abs(stresses.centres.T)
    return error(stresses, (x < 0.5) & (y > DEPTH))


def test_corners_far_away(nodes: Statics) -> None:
    """At 2:1 the coarse corner, of spacing H, transfers p H/2 to the fine one, whose length is h/2. The surplus is
    missing close by, so a moment of O(p h^2) acts far away. The face's own error decays within a period, here H."""
    steps, values = [spacing(face) for face in all_faces("2:1")], [far_error(run) for run in nodes["2:1"]]
    others = np.log(1 + (SUPPORTS + NARROWER) / values[-1]) / np.log(steps[0] / steps[-1])
    CASE.check_rate("nodes, 2:1: rms stress error a quarter of the width away", steps, values, 2,
                    order_of_next_term(steps, np.hypot(0.5, DEPTH)) + others,
                    "a moment of O(p h^2) at corners; next term 1 + h over the distance from them, 0.56; springs "
                    "along x, 4e-7, and the narrower block, 1e-6, over the last error")


def order_over_penalty(factor: float) -> float:
    """Order of 1 / (1 + ratio s) over the factors s of STIFFER. The error is a pressure alternating between nodes of
    the finer face, of wavelength 2 h. It displaces two half-planes by 2 p 2 h / (pi E'), E' = E / (1 - nu^2), and
    springs by p / kn, kn = 8 s E/h. The ratio of the two is ratio s."""
    ratio = factor * 32 * (1 - POISSON**2) / np.pi
    return observed_order([1 / s for s in STIFFER], [1 / (1 + ratio * s) for s in STIFFER])


def test_error_of_nodes_falls_with_the_penalty(stiffer: list[Run]) -> None:
    """In the limit all nodes of both faces lie on one line. Only linear displacements satisfy this, so tractions are
    those of equilibrium."""
    order = order_over_penalty(1)
    values = [middle_error(run) for run in stiffer]
    CASE.check_rate("nodes, 2:1: rms stress error over 1/kn", [1 / s for s in STIFFER], values, order,
                    abs(order - order_over_penalty(2 / np.pi)),
                    "half-planes and springs act in series; a wave of two nodes is linear between them, with 2/pi of "
                    "a sine's load")


def nodal_errors(run: Run) -> np.ndarray:
    """Errors of pressures on the finer face's nodes within a quarter of the width from the middle, over the load."""
    x, pressure = on_face(run, 0)
    return np.abs(pressure[np.abs(x) < 0.25] - 1)


def test_what_two_passes_make_of_uniform_pressure(nodes: Statics, stiffer: list[Run]) -> None:
    """At 2:1 with equal gaps, a node of the finer face opposite another node gets 3/2 of its share, the others 1/2.
    Gaps differ, as faces deform by some d over the stiffness: the error is 1 / (2 + d s), for any d."""
    one, four = nodal_errors(nodes["2:1"][1]), nodal_errors(stiffer[0])
    without_stiffness = (STIFFER[0] - 1) / (STIFFER[0] / one - 1 / four)
    CASE.check(Label.EXACT, "nodes, 2:1: error of nodal pressures to no stiffness", without_stiffness.mean(), 0.5,
               np.ptp(without_stiffness), "trapezoidal rule on the wrong nodes; inverse errors at stiffness 1 and 4 "
               "extrapolated linearly; spread over the middle's nodes, by the sides")


@pytest.mark.parametrize("ratio", ["3:2", "5:4"])
def test_nodal_pressures(nodes: Statics, ratio: str) -> None:
    """Half-planes deform under waves longer than two nodes as under sines."""
    fine, coarse = map(int, ratio.split(":"))
    modulus = YOUNG / (1 - POISSON**2)
    sine, linear = (np.abs(pressures(fine, coarse, 8 * YOUNG, share * modulus) - 1).max() for share in (1, np.pi / 2))
    largest = nodal_errors(nodes[ratio][1]).max()
    CASE.check(Label.INDEPENDENT, f"nodes, {ratio}: largest error of nodal pressures", largest, sine, linear - sine,
               "two half-planes under two passes; waves of few nodes are linear between them, at least 2/pi of a "
               "sine's load")


@pytest.mark.parametrize("quadrature", [SEGMENTS, NODES])
def test_balance_and_both_solvers(segments: Statics, nodes: Statics, quadrature: str) -> None:
    face, what = FACES["2:1"][1], "nodes, 2:1" if quadrature == NODES else "segments, 2:1"
    runs = {"engine": CASE.engine(f"engine_{quadrature}_both", scene(face, quadrature)),
            "reference": (nodes if quadrature == NODES else segments)["2:1"][1]}
    for name, run in runs.items():
        force = float(run.probe("force.force_y")[-1])
        CASE.check(Label.EXACT, f"{what}, {name}: force through the face over the load",
                   force / (2 * PRESSURE * half_width(quadrature)), 1, rounding(face), f"balance; {ROUNDING}")
    # With contact at nodes, gliding of the blocks affects corners.
    tolerance, source = blur(face), BLUR
    if quadrature == NODES:
        tolerance, source = tolerance + GLIDING * max(face), f"{BLUR}; {GLIDES}"
    a, b = (stresses_of(run).values for run in runs.values())
    CASE.check(Label.INDEPENDENT, f"{what}: stresses, engine against reference", np.abs(a - b).max() / PRESSURE, 0,
               tolerance, source)
    differences = [np.abs(np.subtract(*(on_face(run, body)[1] for run in runs.values()))).max() for body in (0, 1)]
    CASE.check(Label.INDEPENDENT, f"{what}: nodal pressures, engine against reference", max(differences), 0, tolerance,
               source)


def draw_pressures(axes: Axes, segments: Statics, nodes: Statics) -> None:
    for colour, name, run in zip(COLOURS, ("segments", "nodes"), (segments["2:1"][1], nodes["2:1"][1])):
        for body, style, marker in ((0, "-", "o"), (1, ":", "s")):
            x, pressure = on_face(run, body)
            axes.plot(x, pressure, style, marker=marker, markersize=3, color=colour, linewidth=0.9,
                      label=f"{name}, {'finer' if body == 0 else 'coarser'}")
    axes.set_ylim(0.9, 1.12)
    describe(axes, "nodal pressure along the face, 2:1 (32 on 16)", "x", "contact pressure / load")
    axes.legend(fontsize=8, frameon=False, ncols=2, loc="upper center")


def draw_map(figure: Figure, axes: Axes, name: str, run: Run) -> None:
    stresses = stresses_of(run)
    draw_cells(figure, axes, stresses.triangles, stresses.values[:, 1] / PRESSURE, "RdBu_r", (-1.1, -0.9),
               f"stress yy / load, 2:1, {name}")


def draw_rates(axes: Axes, segments: Statics, nodes: Statics) -> None:
    for name, runs, style in (("nodes", nodes, "-"), ("segments", segments, ":")):
        for colour, marker, ratio in zip(COLOURS, MARKERS, FACES):
            steps = [spacing(face) for face in all_faces(ratio)][:len(runs[ratio])]
            values = [middle_error(run) for run in runs[ratio]]
            order = f": {observed_order(steps, values):.2f}" if runs is nodes and ratio != "1:1" else ""
            axes.loglog(steps, values, style, marker=marker, markersize=4, color=colour, linewidth=1.1,
                        label=f"{name}, {ratio}{order}")
    h = np.array([2 / 64, 2 / 8])
    axes.loglog(h, 0.03 * np.sqrt(h / h[1]), "--", color=COLOURS[6], linewidth=1.0, label="slope 1/2")
    axes.axhline(PRESSURE / YOUNG, color="0.5", linewidth=0.8)
    axes.text(h[0], 1.15 * PRESSURE / YOUNG, "strain p/E", fontsize=8, color="0.4")
    axes.set_ylim(1e-7, 0.1)
    set_ticks(axes, [1 / 4, 1 / 8, 1 / 16, 1 / 32], ["1/4", "1/8", "1/16", "1/32"])
    describe(axes, "rms stress error in the middle, all depths", "spacing of the coarser face", "over the load")
    axes.legend(fontsize=8, frameon=False, ncols=2, loc="center", bbox_to_anchor=(0.5, 0.48))


def test_picture(segments: Statics, nodes: Statics) -> None:
    figure, axes = panels(4, "Uniform pressure through a face of nodes that do not match (8 E/h)", across=True)
    draw_pressures(axes[0], segments, nodes)
    draw_rates(axes[1], segments, nodes)
    draw_map(figure, axes[2], "segments", segments["2:1"][1])
    draw_map(figure, axes[3], "nodes", nodes["2:1"][1])
    save(CASE, figure, "contact_patch")
