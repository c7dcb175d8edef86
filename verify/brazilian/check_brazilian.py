"""Disc under two opposite pressures: stresses against the exact field of linear elasticity."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fields import Stresses, stresses_of
from pictures import COLOURS, MARKERS, describe, draw_cells, draw_rate, legend, panels, save, set_ticks
from verification import FULL, Case, Label, Run

CASE = Case(__file__)

HALF_ANGLE = np.radians(15)
PRESSURE = 1e-6  # of mu: Cauchy stress and that of linear elasticity differ by the order of the strains
POISSON = 0.4
END = 25.0  # s; motion decays as exp(-1.5 t) after the end of loading at 5 s: to 1e-13
# Outline nodes by nodes; the arcs are whole segments.
SIZES = {378: 72, 672: 96, 1512: 144, 2688: 192} | ({6048: 288, 10752: 384} if FULL else {})
METHODS = ["mls", "t3", "es-t3", "mls-gauss"]
LOG_SPACINGS = np.log([1 / count for count in SIZES.values()])
WIDTH = float(np.sqrt(((LOG_SPACINGS - LOG_SPACINGS.mean())**2).sum()))  # slope scatter = scatter of errors over it
# Orders of stresses inside, where nodes lie on a hexagonal lattice. For gradients averaged over neighbours, the lattice
# contributes h^2. So do the arcs' ends, wrong by O(1) in an area of h^2. The band along the outline contributes
# h^(5/2): its 1/h cells have independent errors O(h) in areas of h^2. These reach the middle as some ten waves around
# the disc. The sum of ten squares scatters by sqrt(2/10), and errors by half of that.
SCATTER = np.sqrt(2 / 10) / 2 / WIDTH  # of a slope
AVERAGED = ((2 + 2.5) / 2, (2.5 - 2) / 2 + SCATTER)
# A method that fails the patch test adds an error of order 3/2 in the middle of a disc (verify/patch). The lattice has
# order 2.
INCONSISTENT = ((1.5 + 2) / 2, (2 - 1.5) / 2 + SCATTER)
# Linear triangles: order 1. The h^2 term of the lattice, as in the averaged methods, is 8 % on the coarsest mesh.
LINEAR = (1, float(np.log(1.08) / (LOG_SPACINGS[0] - LOG_SPACINGS[-1])))
ORDERS = {"mls": AVERAGED, "t3": LINEAR, "es-t3": AVERAGED, "mls-gauss": INCONSISTENT}
# Whole disc: the squared error at each of the four arc ends scatters by half with the mesh.
ENDS = 2 * 0.5 / 2 / np.sqrt(4) / WIDTH
CENTRE = 2 * PRESSURE / np.pi * np.array([np.sin(2 * HALF_ANGLE) - HALF_ANGLE, -np.sin(2 * HALF_ANGLE) - HALF_ANGLE])


def exact(places: np.ndarray) -> np.ndarray:
    """[places x 3] xx, yy, xy by the summed Fourier series. With t from the y axis, the load is 2 a/pi plus
    a_n cos(n t) for even n, a_n = 4 sin(n a)/(n pi). Airy functions r^n cos(n t) and r^(n+2) cos(n t) without shear at
    r = 1 give the radial stress -a_n/2 (n r^(n-2) - (n-2) r^n) cos(n t), the hoop stress
    a_n/2 (n r^(n-2) - (n+2) r^n) cos(n t) and the shear stress a_n/2 n (r^(n-2) - r^n) sin(n t)."""
    r, t = np.hypot(*places.T), np.arctan2(places[:, 0], places[:, 1])
    ahead, behind = ((r * np.exp(1j * (t + angle))) ** 2 for angle in (HALF_ANGLE, -HALF_ANGLE))
    even = ahead / (1 - ahead) - behind / (1 - behind)  # sum of r^n sin(n a) e^(i n t), times 2 i
    logarithm = 0.25 * np.imag(np.log(1 - behind) - np.log(1 - ahead))  # the same sum with terms divided by n
    mean = -2 * HALF_ANGLE / np.pi - 4 / np.pi * logarithm
    difference = 2 / np.pi * (1 / r**2 - 1) * 0.5 * np.imag(even)
    shear = -2 / np.pi * (1 / r**2 - 1) * 0.5 * np.real(even)
    s, c = np.sin(t), np.cos(t)
    radial, hoop = mean - difference, mean + difference
    return PRESSURE * np.stack([radial * s**2 + hoop * c**2 + 2 * shear * s * c,
                                radial * c**2 + hoop * s**2 - 2 * shear * s * c,
                                (radial - hoop) * s * c + shear * (c**2 - s**2)], axis=1)


def hondros(r: np.ndarray) -> np.ndarray:
    """[r x 2] hoop (xx) and radial (yy) stress on the loaded diameter: Hondros 1959, Austral. J. Appl. Sci. 10, 243."""
    a = HALF_ANGLE
    first = (1 - r**2) * np.sin(2 * a) / (1 - 2 * r**2 * np.cos(2 * a) + r**4)
    second = np.arctan((1 + r**2) / (1 - r**2) * np.tan(a))
    return 2 * PRESSURE / np.pi * np.stack([first - second, -first - second], axis=1)


def scene(method: str, nodes: int) -> str:
    return CASE.scene(method=method, nodes=nodes, outline=SIZES[nodes], end=END)


@pytest.fixture(scope="module")
def engine() -> dict[str, dict[int, Stresses]]:
    return {method: {nodes: stresses_of(CASE.engine(f"engine_{method}_{nodes}",
                                                    scene(method, nodes))) for nodes in SIZES}
            for method in METHODS}


def error(stresses: Stresses, reach: float) -> float:
    """Rms error within a share of the radius, over the magnitude of the exact stress at the centre."""
    inside = np.hypot(*stresses.centres.T) < reach
    return stresses.rms(stresses.values - exact(stresses.centres), inside) / np.linalg.norm(CENTRE)


def spacings() -> list[float]:
    return [2 * np.pi / count for count in SIZES.values()]


def test_exact_solution() -> None:
    """The summed series, Hondros' closed form along the loaded diameter and the value at the centre agree."""
    r = np.linspace(0.01, 0.99, 99)
    series = exact(np.stack([np.zeros_like(r), r], axis=1))
    CASE.check(Label.EXACT, "summed series against Hondros", np.abs(series[:, :2] - hondros(r)).max() / PRESSURE, 0,
               1e-12,
               "two solutions of one problem; rounding")
    CASE.check(Label.EXACT, "Hondros at the centre", np.abs(hondros(np.zeros(1))[0] - CENTRE).max() / PRESSURE, 0,
               1e-12,
               "(2 p/pi) (+-sin 2a - a), rounding")


def spacings_inside(engine: dict[str, dict[int, Stresses]]) -> list[float]:
    """Root of the mean triangle area within half the radius; in coarse meshes it exceeds that along the outline."""
    def mean_area(stresses: Stresses) -> float:
        return float(stresses.areas[np.hypot(*stresses.centres.T) < 0.5].mean())

    return [np.sqrt(mean_area(stresses)) for stresses in engine["t3"].values()]


@pytest.mark.parametrize("method", METHODS)
def test_stresses_converge_inside(engine: dict[str, dict[int, Stresses]], method: str) -> None:
    errors = [error(engine[method][nodes], 0.5) for nodes in SIZES]
    order, tolerance = ORDERS[method]
    CASE.check_rate(f"{method}: stress within half the radius", spacings_inside(engine), errors, order, tolerance,
                    "linear triangles: first order plus 8 % of second; averaged gradients: 2 from the lattice (3/2 if "
                    "the patch test fails), 5/2 from the band along the outline, scatter of ten waves")
    whole = [error(engine[method][nodes], 2) for nodes in SIZES]
    CASE.check_rate(f"{method}: stress in the whole disc", spacings(), whole, 1, ENDS,
                    "stresses wrong by O(1) in an area of h^2 at the arc ends; first order of linear triangles; "
                    "twice the scatter of four arc ends")


@pytest.mark.parametrize("method", METHODS)
def test_stress_at_the_centre(engine: dict[str, dict[int, Stresses]], method: str) -> None:
    """Mean over a tenth of the radius, in which the exact stress varies by its square."""
    nodes = list(SIZES)[-1]
    stresses = engine[method][nodes]
    core = np.hypot(*stresses.centres.T) < 0.1
    mean = np.average(stresses.values[core], axis=0, weights=stresses.areas[core])
    expected = np.average(exact(stresses.centres[core]), axis=0, weights=stresses.areas[core])
    off = np.linalg.norm((mean - expected)[:2]) / np.linalg.norm(CENTRE)
    scatter = error(stresses, 0.5) / np.sqrt(core.sum())
    CASE.check(Label.EXACT, f"{method}: stress at the centre, error", off, 0, (2 * np.pi / SIZES[nodes]) ** 2 + scatter,
               "Hondros, mean over a tenth of the radius; h^2 of the outline plus the cells' scatter over the root of "
               "their number")
    ratio = stresses.across / (POISSON * stresses.values[:, :2].sum(axis=1))
    CASE.check(Label.EXACT, f"{method}: zz over nu (xx + yy)", np.abs(ratio[core] - 1).max(), 0, 1e-6,
               "plane strain; fields in single precision")


@pytest.mark.parametrize("method", METHODS)
def test_both_solvers(engine: dict[str, dict[int, Stresses]], method: str) -> None:
    run = CASE.reference(f"reference_{method}", scene(method, 672), "--static", "--dt", repr(END))
    energies = [float(r.probe("energy.strain")[-1]) for r in (Run(CASE.out / f"engine_{method}_672"), run)]
    CASE.check(Label.INDEPENDENT, f"{method}: strain energy, engine over reference", energies[0] / energies[1], 1, 1e-8,
               "motion decays to 1e-13; displacements of 1e-6 are differences of positions near 1, rounded to 1e-16: "
               "1e-10")


def draw_diameter(axes: Axes, stresses: Stresses) -> None:
    r = np.linspace(-0.99, 0.99, 199)
    near = np.abs(stresses.centres[:, 0]) < 0.05
    for i, (name, colour) in enumerate((("across the load (xx)", COLOURS[0]), ("along the load (yy)", COLOURS[1]))):
        axes.plot(r, hondros(np.abs(r))[:, i] / PRESSURE, color=colour, linewidth=1.1, label=f"{name}, Hondros")
        axes.plot(stresses.centres[near, 1], stresses.values[near, i] / PRESSURE, ".", color=colour, markersize=3.5)
    describe(axes, "loaded diameter; dots: engine, mls", "place y / R", "stress / pressure")
    legend(axes)


def draw_map(figure: Figure, axes: Axes, stresses: Stresses) -> None:
    difference = (stresses.values - exact(stresses.centres)) / np.linalg.norm(CENTRE)
    size = np.sqrt(difference[:, 0] ** 2 + difference[:, 1] ** 2 + 2 * difference[:, 2] ** 2)
    draw_cells(figure, axes, stresses.triangles, np.log10(np.maximum(size, 1e-4)), "viridis", (-4, 0),
               "log10 of the stress error, mls, 2688 nodes")


def test_picture(engine: dict[str, dict[int, Stresses]]) -> None:
    figure, axes = panels(3, "Disc under two opposite pressures on arcs of 30 degrees", across=True)
    draw_diameter(axes[0], engine["mls"][2688])
    draw_map(figure, axes[1], engine["mls"][2688])
    inside = spacings_inside(engine)
    for method, colour, marker in zip(METHODS, COLOURS, MARKERS):
        errors = [error(engine[method][nodes], 0.5) for nodes in SIZES]
        draw_rate(axes[2], inside, errors, method, colour, marker)
    for order, style in ((1, "--"), (2, ":")):
        axes[2].loglog(inside, 1e-3 * (np.array(inside) / inside[-1]) ** order, style, color=COLOURS[6],
                       linewidth=1.0,
                       label=f"slope {order}")
    set_ticks(axes[2], inside, [f"{h:.3f}" for h in inside])
    axes[2].set_ylim(top=1)
    describe(axes[2], "within half the radius", "root of the mean triangle there / R",
             "rms stress error / stress at the centre")
    legend(axes[2])
    save(CASE, figure, "brazilian")
