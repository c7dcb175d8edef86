"""Contact patch test: uniform pressure through a face whose nodes do not match."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fields import Stresses, along_outline, stresses_of
from half_planes import pressures
from pictures import COLOURS, MARKERS, draw_cells, legend, panels, save
from verification import FULL, Case, Label, Run, observed_order

CASE = Case(__file__)

PRESSURE = 1e-5
YOUNG, POISSON = 2.8, 0.4
END = 40.0
# Segments of the faces, lower and upper, from coarse to fine: matching, and three ratios of spacings.
FACES = {"1:1": [(16, 16), (32, 32), (64, 64)], "5:4": [(20, 16), (40, 32), (80, 64)],
         "3:2": [(18, 12), (36, 24), (72, 48)], "2:1": [(24, 12), (32, 16), (64, 32)]}
if FULL:
    FACES = {ratio: [*faces, (2 * faces[-1][0], 2 * faces[-1][1])] for ratio, faces in FACES.items()}
STIFFER = [4.0, 16.0, 64.0]  # times the automatic stiffness
NARROWER = 1e-5  # the upper block on either side
SMALL = PRESSURE  # of Cauchy stresses against those of linear elasticity: strains of p/E, 3.6e-6, and as much again
RESIDUE = 5e-5
# Newton stops at 1e-10 of the forces, which glide a block on springs of 1e-6 by 1e-10 p/1e-6 = 1e-9: 1e-8 of a
# spacing. Times 0.1 p of error a node, and over p/kn = 1e-8 to 1e-7 of penetration where faces are rough: 1e-5 at most.
GLIDING = 1e-5
SPRINGS = ("statics glide on springs of 1e-6 by what Newton's method leaves, the engine's motion does not; "
           "single precision")
DEPTH = 0.25
EXACT = np.array([0, -PRESSURE, 0])


def spacing(face: tuple[int, int]) -> float:
    """Of the coarser side."""
    return 2 / min(face)


def scene(face: tuple[int, int], stiffer: float = 1) -> str:
    """The automatic stiffness 8 E/h of the finer side, or more."""
    stiffness = stiffer * 8 * YOUNG * max(face) / 2
    return CASE.scene(recipe="mls", lower=2 / face[0], upper=2 / face[1], stiffness=float(stiffness), end=END)


def run_name(ratio: str, face: tuple[int, int], stiffer: float) -> str:
    return f"reference_{ratio.replace(':', '_')}_{face[0]}_{stiffer:g}"


def solve(ratio: str, face: tuple[int, int], stiffer: float = 1) -> Run:
    return CASE.reference(run_name(ratio, face, stiffer), scene(face, stiffer), "--static", "--dt", repr(END))


@pytest.fixture(scope="module")
def statics() -> dict[str, list[Stresses]]:
    return {ratio: [stresses_of(solve(ratio, face)) for face in faces] for ratio, faces in FACES.items()}


@pytest.fixture(scope="module")
def stiffer() -> list[Stresses]:
    return [stresses_of(solve("2:1", FACES["2:1"][1], factor)) for factor in STIFFER]


def error(stresses: Stresses, where: np.ndarray) -> float:
    return stresses.rms(stresses.values - EXACT, where) / PRESSURE


def middle_error(stresses: Stresses, reach: float) -> float:
    """Up to a distance from the face, rms weighted by cos^2(pi x) over |x| < 1/2: it takes no part of the sides, and
    the same of each period of nodes that divides 1/2, wherever cells lie."""
    x, y = stresses.centres.T
    return error(stresses, np.where((np.abs(x) < 0.5) & (np.abs(y) < reach), np.cos(np.pi * x)**2, 0))


def everywhere(stresses: Stresses) -> np.ndarray:
    return np.full(len(stresses.areas), True)


def inside(stresses: Stresses) -> np.ndarray:
    """Away from the sides and from the common face."""
    x, y = np.abs(stresses.centres.T)
    return (x < 0.5) & (y > DEPTH)


def errors(statics: dict[str, list[Stresses]], ratio: str, where: str) -> list[float]:
    if where == "inside":
        return [error(s, inside(s)) for s in statics[ratio]]
    return [middle_error(s, spacing(face) if where == "face" else 1) for s, face in zip(statics[ratio], FACES[ratio])]


def order_of_next_term(steps: list[float]) -> float:
    """What order 1 + h shows between the steps, h over the width of the weights, 1."""
    return float(np.log((1 + steps[0]) / (1 + steps[-1])) / np.log(steps[0] / steps[-1]))


@pytest.mark.parametrize("ratio", [ratio for ratio in FACES if ratio != "1:1"])
def test_error_of_the_face(statics: dict[str, list[Stresses]], ratio: str) -> None:
    steps = [spacing(face) for face in FACES[ratio]]
    CASE.check_rate(f"{ratio}: rms stress error in the layer of one spacing", steps, errors(statics, ratio, "face"), 0,
                    order_of_next_term(steps),
                    "each spacing has the same error: kn h/E is kept, and nodes lie alike; the next term, 1 + h")
    CASE.check_rate(f"{ratio}: rms stress error at all depths", steps, errors(statics, ratio, "all depths"), 0.5,
                    order_of_next_term(steps), "an error of O(1) in a layer of height h; the next term, 1 + h")
    CASE.check(Label.EXACT, f"{ratio}: rms stress error a quarter of the width away", errors(statics, ratio,
                                                                                             "inside")[-1], 0,
               errors(statics, ratio, "face")[-1] * decay(FACES[ratio][-1], ratio) + RESIDUE
               + error_of_corners(statics, steps[-1]),
               "tractions that balance over a period of l of both spacings decay by exp(-2 pi y/l) (1 + 2 pi y/l); "
               "what corners make of matching faces goes with h^2")


def decay(face: tuple[int, int], ratio: str) -> float:
    """Of the largest stress of a half-plane under tractions of wave length l, from the face to DEPTH."""
    period = 2 / face[0] * int(ratio[0])
    return (1 + 2 * np.pi * DEPTH / period) * np.exp(-2 * np.pi * DEPTH / period)


def error_of_corners(statics: dict[str, list[Stresses]], step: float) -> float:
    """A quarter of the width away, from matching faces of the coarsest spacing."""
    return error(statics["1:1"][0], inside(statics["1:1"][0])) * (step / spacing(FACES["1:1"][0]))**2


def test_matching_faces_pass_but_for_corners(statics: dict[str, list[Stresses]]) -> None:
    """Of two corners on each other the inner one is in touch, with its half in one pass; what the outer one lacks is its
    neighbour's: p h/4 at a distance h. So the error is of O(1) in an area of h^2 at either end, and far from there that of
    a moment of p h^2/4."""
    steps, faces = [spacing(face) for face in FACES["1:1"]], statics["1:1"]
    next_term = order_of_next_term(steps)
    CASE.check_rate("1:1: rms stress error everywhere", steps, [error(s, everywhere(s)) for s in faces], 1, next_term,
                    "O(1) in an area of h^2 at the corners; the next term, 1 + h")
    CASE.check_rate("1:1: rms stress error a quarter of the width away", steps, [error(s, inside(s)) for s in faces], 2,
                    next_term + residual_order(error(faces[-1], inside(faces[-1])), steps),
                    "a moment of p h^2/4; the next term, 1 + h; strains of 1e-5 change stresses by as much")


def residual_order(last: float, steps: list[float]) -> float:
    """By how much SMALL of the last error may change the order over the steps."""
    return float(np.log(1 + SMALL / last) / np.log(steps[0] / steps[-1]))


def order_over_penalty(factor: float) -> float:
    """Of 1 / (1 + ratio s) over the factors s of STIFFER. The error is a pressure from node to node of the finer face,
    of wave length 2 h, which bends two half-planes by 2 p 2 h / (pi E'), E' = E / (1 - nu^2), and springs by p / kn,
    kn = 8 s E/h: so they share it as 1 to ratio s."""
    ratio = factor * 32 * (1 - POISSON**2) / np.pi
    return observed_order([1 / s for s in STIFFER], [1 / (1 + ratio * s) for s in STIFFER])


def test_error_falls_with_the_penalty(stiffer: list[Stresses]) -> None:
    """In its limit all nodes of both faces lie on one line, which only linear displacements do: tractions of
    equilibrium."""
    values = [middle_error(stresses, 1) for stresses in stiffer]
    order = order_over_penalty(1)
    CASE.check_rate("2:1: rms stress error over 1/kn", [1 / s for s in STIFFER], values, order,
                    abs(order - order_over_penalty(2 / np.pi)),
                    "half-planes and springs share the error as in series; a wave of two nodes is linear between them, "
                    "2/pi of a sine's load")


def nodal_errors(ratio: str, stiffer: float = 1) -> np.ndarray:
    """Of the pressures on the finer face's nodes within a quarter of the width from the middle, over the load."""
    run = Run(CASE.out / run_name(ratio, FACES[ratio][1], stiffer))
    places, pressure = along_outline(run, 0, "contact_pressure")
    face = (np.abs(places[:, 1]) < 0.01) & (np.abs(places[:, 0]) < 0.25)
    return pressure[face] / PRESSURE - 1


def test_what_two_passes_make_of_uniform_pressure(statics: dict, stiffer: list[Stresses]) -> None:
    """At 2:1 each node of the finer face that has one opposite gets 3/2 of its share, the others 1/2, as long as gaps are
    equal. They are not, as faces give way, by some d over the stiffness: the error is 1 / (2 + d s), whatever d is."""
    one, four = (np.abs(nodal_errors("2:1", s)) for s in (1, STIFFER[0]))
    without_stiffness = (STIFFER[0] - 1) / (STIFFER[0] / one - 1 / four)
    CASE.check(Label.EXACT, "2:1: error of nodal pressures to no stiffness", without_stiffness.mean(), 0.5,
               np.ptp(without_stiffness), "the trapezoidal rule on the wrong nodes; from stiffness 1 and 4, straight in the "
               "inverse; the sides, by which the middle's nodes differ")


@pytest.mark.parametrize("ratio", ["3:2", "5:4"])
def test_nodal_pressures(statics: dict, ratio: str) -> None:
    """Waves longer than two nodes: half-planes give way to them as to sines."""
    fine, coarse = map(int, ratio.split(":"))
    modulus = YOUNG / (1 - POISSON**2)
    sine, linear = (np.abs(pressures(fine, coarse, 8 * YOUNG, share * modulus) - 1).max() for share in (1, np.pi / 2))
    CASE.check(Label.INDEPENDENT, f"{ratio}: largest error of nodal pressures", np.abs(nodal_errors(ratio)).max(), sine,
               linear - sine, "two half-planes under two passes; waves of few nodes are linear between them, at worst "
               "2/pi of a sine's load")


def test_balance_and_both_solvers(statics: dict[str, list[Stresses]]) -> None:
    face = FACES["2:1"][1]
    runs = {"engine": CASE.engine("engine_2_1", scene(face)), "reference": Run(CASE.out / run_name("2:1", face, 1))}
    for name, run in runs.items():
        force = float(run.probe("force.force_y")[-1])
        CASE.check(Label.EXACT, f"2:1, {name}: force through the face over the load",
                   force / (2 * PRESSURE * (1 - NARROWER)), 1, 1e-6,
                   "balance on the upper block's width; of statics, springs of 1e-6 carry as much of 1/E")
    a, b = (stresses_of(run).values for run in runs.values())
    CASE.check(Label.INDEPENDENT, "2:1: stresses, engine against reference", np.abs(a - b).max() / PRESSURE, 0, GLIDING,
               SPRINGS)
    p, q = (along_outline(run, 1, "contact_pressure")[1] for run in runs.values())
    CASE.check(Label.INDEPENDENT, "2:1: contact pressures, engine against reference", np.abs(p - q).max() / PRESSURE, 0,
               GLIDING, SPRINGS)


def draw_pressures(axes: Axes) -> None:
    for colour, marker, ratio in zip(COLOURS, MARKERS, ("1:1", "5:4", "2:1")):
        for body, style in ((0, "-"), (1, ":")):
            run = Run(CASE.out / run_name(ratio, FACES[ratio][1], 1))
            places, pressure = along_outline(run, body, "contact_pressure")
            face = np.flatnonzero((np.abs(places[:, 1]) < 0.01) & (np.abs(places[:, 0]) < 0.98))
            face = face[np.argsort(places[face, 0])]
            axes.plot(places[face, 0], pressure[face] / PRESSURE, style, marker=marker, markersize=3, color=colour,
                      linewidth=0.9,
                      label=f"{ratio}, {'lower' if body == 0 else 'upper'}")
    axes.set_xlim(-0.55, 0.55)
    axes.set_title("nodal pressure along the face", fontsize=10, loc="left")
    axes.set_xlabel("x")
    axes.set_ylabel("contact pressure / load")
    axes.legend(fontsize=8, frameon=False, ncols=3, loc="upper center", bbox_to_anchor=(0.5, -0.13))


def draw_map(figure: Figure, axes: Axes, stresses: Stresses) -> None:
    draw_cells(figure, axes, stresses.triangles, stresses.values[:, 1] / PRESSURE, "RdBu_r", (-1.1, -0.9),
               "stress yy / load, 2:1 (32 on 16)")


def draw_rates(axes: Axes, statics: dict[str, list[Stresses]]) -> None:
    for colour, marker, ratio in zip(COLOURS, MARKERS, FACES):
        steps = [spacing(face) for face in FACES[ratio]]
        values = errors(statics, ratio, "all depths")
        axes.loglog(steps, values, marker=marker, markersize=4, color=colour, linewidth=1.1,
                    label=f"{ratio}: {observed_order(steps, values):.2f}")
    h = np.array([2 / 64, 2 / 8])
    axes.loglog(h, 0.03 * np.sqrt(h / h[1]), "--", color=COLOURS[6], linewidth=1.0, label="slope 1/2")
    axes.set_ylim(3e-6, 0.1)
    axes.set_xticks([1 / 4, 1 / 8, 1 / 16, 1 / 32], ["1/4", "1/8", "1/16", "1/32"])
    axes.set_xticks([], minor=True)
    axes.set_title("rms stress error in the middle, all depths", fontsize=10, loc="left")
    axes.set_xlabel("spacing of the coarser face")
    axes.set_ylabel("over the load")
    legend(axes)


def test_picture(statics: dict[str, list[Stresses]]) -> None:
    figure, axes = panels(3, "Uniform pressure through a face of nodes that do not match (8 E/h)", across=True)
    draw_pressures(axes[0])
    draw_map(figure, axes[1], statics["2:1"][1])
    draw_rates(axes[2], statics)
    save(CASE, figure, "contact_patch")
