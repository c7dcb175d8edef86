"""Natural frequencies of a free disc: the engine's own stiffness and masses against exact ones and finite elements."""

from __future__ import annotations

import csv
import json
import subprocess
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes
from scipy.io import mmread
from scipy.linalg import eigh

from disc_spectrum import count_in_the_plane, disc_modes, frequencies, frequency_functions, roots
from motion import SINGLE, read_motion
from pictures import COLOURS, MARKERS, describe, legend, panels, save, set_ticks
from verification import ENGINE, FULL, LONGEST_RUN, REFERENCE, ROOT, Case, Label, observed_order

CASE = Case(__file__)
COUNT = 10  # frequencies compared
NODES = [168, 340, 700, 1400] if FULL else [168, 340, 700]
H = [float(np.sqrt(np.pi / n)) for n in NODES]  # mean distance of nodes
POISSON = [0.3, 0.4, 0.49]
METHODS = {"mls": "", "mls-gauss 1": "gauss_points = 1", "mls-gauss 3": "gauss_points = 3",
           "mls-gauss 6": "gauss_points = 6", "t3": "", "es-t3": ""}
MASSES = ["lumped", "corrected"]
LAST = 8.0  # of the stored roots, w R / c_s
# Tolerance for frequencies of triangles with rounded nodes. Gradients turn by SINGLE / h, which adds this share of
# |grad u| to a dilation d: lambda d |grad u| is at most sqrt(lambda / 2 mu) of the energy (lambda d^2 / 2 +
# mu |grad u|^2).
SAME_NODES = SINGLE / H[0] * np.sqrt(49 / 2)

# rms errors of the first ten at nu = 0.4 in %, 168, 340 and 700 nodes, as in README.md: lumped, corrected.
FIGURES = {"mls": ("4.10 2.03 0.96", "0.161 0.111 0.082"), "mls-gauss 1": ("4.19 2.02 0.95", "0.329 0.211 0.129"),
           "mls-gauss 3": ("4.70 2.33 1.11", "0.582 0.216 0.077"),
           "mls-gauss 6": ("4.55 2.24 1.07", "0.441 0.120 0.029"), "t3": ("1.15 0.50 0.23", "3.07 1.44 0.68"),
           "es-t3": ("2.85 1.35 0.64", "0.086 0.014 0.004")}
LAST_DIGIT = "our own earlier figure, +- half of its last digit: the same meshes, up to rounding of nodes"


def scene(method: str, mass: str, poisson: float, nodes: int, extra: str = "") -> str:
    return CASE.scene(method=method.split()[0], mass=mass, points=METHODS[method] + extra, nodes=nodes, poisson=poisson,
                      young=2 * (1 + poisson))


def ask(name: str, text: str, *options: str) -> dict:
    """Output of `pliant modes` for the only body."""
    file, answer = CASE.out / f"{name}.toml", CASE.out / f"{name}.json"
    return answer_of([ENGINE, "modes", file, "--count", COUNT, "--json", answer, *options], text, file, answer)


def ask_the_reference(name: str, text: str) -> dict:
    file, answer = CASE.out / f"{name}_reference.toml", CASE.out / f"{name}_reference.json"
    return answer_of([REFERENCE, file, "--modes", answer], text, file, answer)


def answer_of(words: list, text: str, file: Path, answer: Path) -> dict:
    file.write_text(text)
    command = [str(word) for word in words]
    result = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=LONGEST_RUN)
    if result.returncode != 0:
        raise RuntimeError(f"{' '.join(command)}\nexit code {result.returncode}\n{result.stderr}")
    return json.loads(answer.read_text())["bodies"][0]


@cache
def errors(method: str, mass: str, poisson: float, nodes: int) -> np.ndarray:
    """[COUNT] relative, sorted by frequency."""
    name = named(method, mass, poisson, nodes)
    exported = poisson == 0.4 or nodes == NODES[0]  # see matrices() and residual_of_translations()
    export = ["--matrices", str(CASE.out / name)] if exported else []
    answer = ask(name, scene(method, mass, poisson, nodes), *export)
    CASE.check(Label.EXACT, f"{method}, {mass}, nu = {poisson}, {nodes} nodes: motions without stiffness",
               answer["motions_at_rest"], 3, 0, "two translations and a rotation; any more would be mechanisms")
    return np.array(answer["frequencies"]) / frequencies(poisson, COUNT) - 1


def named(method: str, mass: str, poisson: float, nodes: int) -> str:
    return f"{method.replace(' ', '_')}_{mass}_{poisson:g}_{nodes}"


@cache
def errors_of_the_reference(method: str, mass: str, poisson: float) -> np.ndarray:
    """[COUNT] as errors(), on the coarsest mesh."""
    answer = ask_the_reference(named(method, mass, poisson, NODES[0]), scene(method, mass, poisson, NODES[0]))
    return np.array(answer["frequencies"][:COUNT]) / frequencies(poisson, COUNT) - 1


@cache
def finite_elements(poisson: float) -> tuple[list[int], list[int], list[np.ndarray]]:
    """Rings of elements, nodes and frequencies of three meshes."""
    from fem.eigen import natural_frequencies
    from fem.meshes import disc
    from fem.solid import Material, Solid

    rings = [16, 24, 32] if poisson == 0.49 else [6, 9, 12]
    solids = [Solid(disc(n), Material.of_poisson(poisson)) for n in rings]
    nodes = [solid.space.dofmap.index_map.size_global for solid in solids]
    return rings, nodes, [natural_frequencies(solid, COUNT) for solid in solids]


def rms(values: np.ndarray) -> float:
    return float(np.sqrt((values**2).mean()))


def test_roots_are_those_stored() -> None:
    with (ROOT / "verify/oracles/disc_eigenfrequencies.csv").open() as stream:
        stored = list(csv.DictReader(stream))
    found = disc_modes(0.4, LAST)
    CASE.check(Label.EXACT, "roots below 8: number", len(found), len(stored), 0,
               "own roots of Bessel functions, stored")
    same = [(int(row["circumferential_order"]), row["kind"], int(row["multiplicity"])) for row in stored]
    CASE.check(Label.EXACT, "roots: orders, kinds, multiplicities that differ",
               sum(a != b for a, b in zip(same, [(m.order, m.kind, m.multiplicity) for m in found])), 0, 0, "as stored")
    off = [m.frequency / float(row["omega_R_over_cs"]) - 1 for m, row in zip(found, stored)]
    CASE.check(Label.EXACT, "roots: largest difference", np.abs(off).max(), 0, 1e-13, "rounding of Bessel functions")


@pytest.mark.parametrize("poisson", POISSON)
def test_no_root_is_missed(poisson: float) -> None:
    """The argument principle counts zeros of the entire function in a rectangle, including any missed by a grid."""
    highest = max(mode.order for mode in disc_modes(poisson, LAST)) + 3
    lines = {(n, kind): f for n in range(highest + 1) for kind, f in frequency_functions(n, poisson).items()}
    missed = sum(abs(count_in_the_plane(f, 0.3, LAST) - len(roots(f, 0.3, LAST))) for f in lines.values())
    CASE.check(Label.EXACT, f"nu = {poisson}: roots that a grid missed", missed, 0, 0, "turns of the determinant")


@pytest.mark.parametrize("poisson", POISSON)
def test_finite_elements_agree_with_the_roots(poisson: float) -> None:
    rings, _, found = finite_elements(poisson)
    error = [rms(f / frequencies(poisson, COUNT) - 1) for f in found]
    CASE.check_rate(f"finite elements, nu = {poisson}: rms error", [1 / n for n in rings], error, 4, 0.5,
                    "quadratic elements: twice the second order of their strains; on finer meshes if nearly "
                    "incompressible")
    limit = found[-1] + (found[-1] - found[-2]) / ((rings[-1] / rings[-2])**4 - 1)
    CASE.check(Label.INDEPENDENT, f"finite elements, nu = {poisson}: extrapolated over exact",
               rms(limit / frequencies(poisson,
                                       COUNT) - 1), 0, error[-1] / 4, "dolfinx and SLEPc, live; a quarter remains")


@pytest.mark.parametrize("poisson", POISSON)
@pytest.mark.parametrize("method", METHODS)
def test_lumped_mass_is_of_second_order(method: str, poisson: float) -> None:
    if method == "t3" and poisson == 0.49:
        pytest.skip("locks: see test_locking")
    error = [rms(errors(method, "lumped", poisson, nodes)) for nodes in NODES]
    CASE.check_rate(f"{method}, lumped, nu = {poisson}: rms of the first ten", H, error, 2, 0.3,
                    "row sums and linear functions: second order; 0.3 for the fourth order in h^2 <= 0.14^2 x 4.8^2")


@pytest.mark.parametrize("method", FIGURES)
def test_figures_stay(method: str) -> None:
    """Bounds on both sides: errors of corrected mass are sums of two of opposite sign, either of which may change."""
    for mass, figures in zip(MASSES, FIGURES[method]):
        for nodes, figure in zip(NODES, figures.split()):
            CASE.check(Label.FROZEN, f"{method}, {mass}, {nodes} nodes: rms of the first ten [%]",
                       100 * rms(errors(method, mass, 0.4, nodes)), float(figure), half_a_digit(figure), LAST_DIGIT)


def half_a_digit(figure: str) -> float:
    return 0.5 * 10.0**-len(figure.partition(".")[2])


def test_support_of_nine_nodes() -> None:
    answer = ask("support_9", scene("mls", "corrected", 0.4, 700, "\nsupport = 9"))
    error = 100 * rms(np.array(answer["frequencies"]) / frequencies(0.4, COUNT) - 1)
    CASE.check(Label.FROZEN, "mls with support 9, corrected, 700 nodes: rms of the first ten [%]", error, 0.027,
               half_a_digit("0.027"), LAST_DIGIT)


def matrices(method: str, nodes: int) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness and consistent mass, both [2 nodes x 2 nodes]: M = 2 D - D W D of the exported inverse masses D^-1
    and W."""
    folder = {mass: CASE.out / named(method, mass, 0.4, nodes) for mass in MASSES}
    for mass in MASSES:
        errors(method, mass, 0.4, nodes)
    lumped = 1 / mmread(folder["lumped"] / "disc_inverse_mass.mtx").diagonal()
    inverse = mmread(folder["corrected"] / "disc_inverse_mass.mtx").toarray()
    mass = 2 * np.diag(lumped) - lumped[:, None] * inverse * lumped
    return mmread(folder["corrected"] / "disc_stiffness.mtx").toarray(), np.kron(mass, np.eye(2))


@cache
def parts(method: str) -> tuple[list[float], list[float]]:
    """rms over NODES of the stiffness error (with the consistent mass), and of the additional error of the corrected
    mass."""
    of_stiffness, of_mass = [], []
    for nodes in NODES:
        consistent = np.sqrt(eigh(*matrices(method, nodes), eigvals_only=True, subset_by_index=(3, 2 + COUNT),
                                  driver="gvx"))
        exact = frequencies(0.4, COUNT)
        of_stiffness.append(rms(consistent / exact - 1))
        of_mass.append(rms((errors(method, "corrected", 0.4, nodes) + 1) * exact / consistent - 1))
    return of_stiffness, of_mass


@pytest.mark.parametrize("method", ["mls", "mls-gauss 3", "t3", "es-t3"])
def test_corrected_mass_errs_in_fourth_order(method: str) -> None:
    CASE.check_rate(f"{method}: corrected over consistent mass", H, parts(method)[1], 4, 0.5,
                    "W - M^-1 = -D^-1 (1 - M D^-1)^2 ..., M D^-1 - 1 of the order h^2; half an order for the next term")


@pytest.mark.parametrize("method", ["mls", "t3"])
def test_stiffness_is_of_second_order(method: str) -> None:
    CASE.check_rate(f"{method}: stiffness with consistent mass", H, parts(method)[0], 2, 0.5,
                    "linear functions; half an order for the remaining h^4")


@pytest.mark.parametrize("method", [method for method in METHODS if method != "t3"])
def test_does_not_lock(method: str) -> None:
    """Additional error of each frequency by near incompressibility; corrected mass isolates the stiffness."""
    added = [rms(errors(method, "corrected", 0.49, nodes) - errors(method, "corrected", 0.3, nodes)) for nodes in NODES]
    CASE.check_rate(f"{method}, corrected: error at nu = 0.49 less that at 0.3, rms of the first ten", H, added, 3, 1,
                    "from 2, as all errors of linear functions, to 4: an unavoidable dilation of order h^2 costs "
                    "lambda h^4; with locking, one of order h costs lambda h^2 and suppresses the motion: below 2")


def frequencies_of_linear_triangles(poisson: float, nodes: int) -> dict[str, np.ndarray]:
    """By mass, [COUNT] from stiffness and mass matrices of dolfinx on the engine's own nodes."""
    from fem.eigen import matrix
    from fem.meshes import create
    from fem.solid import Material, Solid

    frames = '\n[frames]\nperiod = 1\nfields = ["displacement"]\n'
    motion = read_motion(CASE.engine(f"t3_{nodes}_mesh", scene("t3", "lumped", poisson, nodes) + frames))
    solid = Solid(create(motion.positions[0], motion.triangles, 1), Material.of_poisson(poisson), 1)
    stiffness, consistent = (dense(matrix(form)) for form in (solid.stiffness(), solid.mass()))
    lumped = consistent.sum(axis=1)
    inverse = {"lumped": np.diag(1 / lumped)}
    inverse["corrected"] = 2 * inverse["lumped"] - consistent / np.outer(lumped, lumped)
    return {mass: np.sqrt(eigh(stiffness, np.linalg.inv(inverse[mass]), eigvals_only=True,
                               subset_by_index=(3, 2 + COUNT))) for mass in MASSES}


def dense(matrix) -> np.ndarray:
    rows, columns = map(range, matrix.getSize())
    return matrix.getValues(rows, columns)


def test_linear_triangles_of_dolfinx_lock_alike() -> None:
    """On the coarsest mesh, where locking is worst: 12 % with the corrected mass."""
    for mass, expected in frequencies_of_linear_triangles(0.49, NODES[0]).items():
        found = (errors("t3", mass, 0.49, NODES[0]) + 1) * frequencies(0.49, COUNT)
        CASE.check(Label.INDEPENDENT, f"t3, {mass}, nu = 0.49: largest of ten over dolfinx's linear triangles on these "
                   "nodes - 1", np.abs(found / expected - 1).max(), 0, SAME_NODES,
                   "rounding of nodes in frames changes gradients by 4e-7, energies by that x root of lambda/(2 mu)")


@pytest.mark.parametrize("poisson", [0.4, 0.49])
@pytest.mark.parametrize("method", METHODS)
def test_engine_against_reference(method: str, poisson: float) -> None:
    off, allowed = [], []
    for mass in MASSES:
        engine, reference = (1 + of(method, mass, poisson) for of in (coarsest_errors, errors_of_the_reference))
        off.append(engine / reference - 1)
        allowed.append(residual_of_translations(method, mass, poisson) / (2 * frequencies(poisson, COUNT)**2))
    worst = np.unravel_index((np.abs(off) / np.array(allowed)).argmax(), np.shape(off))
    CASE.check(Label.INDEPENDENT, f"{method}, nu = {poisson}: engine over reference - 1, the worst of both masses",
               off[worst[0]][worst[1]], 0, allowed[worst[0]][worst[1]],
               "differences of forces leave a residual on translations, exactly 0; it bounds the error of w^2")


def coarsest_errors(method: str, mass: str, poisson: float) -> np.ndarray:
    return errors(method, mass, poisson, NODES[0])


def residual_of_translations(method: str, mass: str, poisson: float) -> float:
    """|A x| / |x| of the symmetric A = L^T K L, W = L L^T the inverse mass, for translations; the larger of the two. It
    bounds the error of w^2 by the differences of forces for any frequency w (Weyl)."""
    coarsest_errors(method, mass, poisson)
    folder = CASE.out / named(method, mass, poisson, NODES[0])
    stiffness = mmread(folder / "disc_stiffness.mtx").toarray()
    read = mmread(folder / "disc_inverse_mass.mtx")
    inverse = np.kron(read.toarray() if mass == "corrected" else np.diag(read.diagonal()), np.eye(2))
    found = []
    for direction in np.eye(2):
        translation = np.tile(direction, len(inverse) // 2)
        force = stiffness @ translation
        found.append(force @ inverse @ force / (translation @ np.linalg.solve(inverse, translation)))
    return float(np.sqrt(max(found)))


def test_picture() -> None:
    figure, axes = panels(3, "First ten natural frequencies of a free disc", across=True)
    for panel, mass, poisson, orders in zip(axes, ["lumped", "corrected", "corrected"], [0.4, 0.4, 0.49],
                                            [[2], [2, 4], [2, 4]]):
        draw_errors(panel, mass, poisson, orders)
    save(CASE, figure, "modes")


def draw_errors(axes: Axes, mass: str, poisson: float, orders: list[int]) -> None:
    for method, colour, marker in zip(METHODS, COLOURS, MARKERS):
        values = [100 * rms(errors(method, mass, poisson, nodes)) for nodes in NODES]
        axes.loglog(NODES, values, marker=marker, markersize=4, linewidth=1.1, color=colour,
                    label=f"engine, {method}: {observed_order(H, values):.1f}")
    of_reference = [100 * rms(errors_of_the_reference(method, mass, poisson)) for method in METHODS]
    axes.plot([NODES[0]] * len(METHODS), of_reference, "kx", markersize=7, label="reference, each of them")
    rings, nodes, found = finite_elements(poisson)
    values = [100 * rms(f / frequencies(poisson, COUNT) - 1) for f in found]
    order_of_elements = observed_order([1 / n for n in rings], values)
    axes.plot(nodes, values, "k:", marker="*", label=f"finite elements: {order_of_elements:.1f}")
    for order, style in zip(orders, ("--", "-.")):
        axes.loglog(NODES, 0.05 * (np.array(H) / H[0])**order, style, color=COLOURS[6], linewidth=1.0,
                    label=f"order {order}")
    ticks = sorted({*NODES, nodes[-1]})
    set_ticks(axes, ticks, [str(n) for n in ticks])
    axes.set_ylim(1e-4, 1e4)  # room for the legend
    describe(axes, f"{mass} mass, nu = {poisson}", "nodes", "rms error [%]")
    legend(axes)
