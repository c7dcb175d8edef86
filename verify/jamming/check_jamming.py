"""400 frictionless compliant discs between four walls: solid fraction and coordination at jamming and above."""

from __future__ import annotations

import math

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection

from contact_network import Outlines
from histories import speeds
from jamming_packing import BOTTOM, DISCS, FORCES, LEFT, RIGHT, TOP, Packing, Stage, read_packing
from pictures import COLOURS, MARKERS, describe, legend, panels, save
from pliant.frames import Frames
from verification import FULL, Case, Label

CASE = Case(__file__, long=True, cost=6)

LARGE = 1.4  # diameter; the small one is 1
AREA = DISCS / 2 * math.pi / 4 * (1 + LARGE**2)
START = 0.78  # solid fraction between the walls; lower than in the middle because of gaps at the walls
CLOSING = [0.81, 0.825, 0.84, 0.86, 0.88]
OPENING = [0.87, 0.86, 0.85, 0.845, 0.84, 0.835, 0.83, 0.825, 0.82]
PAUSE = 300.0  # between fractions, in units of diameter over the speed sqrt(E/density)
RAMP = 150.0  # wall motion within it
CLEARANCE = 0.02  # between a wall's end and the next wall
STIFFNESS = 10.0
CORE = 8.0  # half width of a fixed box, within the region at all times
SEEDS = [1, 2, 3] if FULL else [1]
OUTLINE_NODES = 48
OBLIQUE = math.pi / OUTLINE_NODES / math.sqrt(3)  # rms angle between a segment's normal and that of the circle
DAMPING = 0.1  # of the mass
NODES = {16: 24, 24: 40, 32: 60, 48: 100}  # field nodes by outline nodes
COUNTS = [16, 24, 32]  # coarser ones
ISOSTATIC = 4 * (1 - 1 / DISCS)
ROUGHEST = 3.0  # the same for discs that cannot slide
POSITION = 1e-6  # rounding of frames' positions, in single precision: two halves of the last bit, 9.5e-7 from 8 to 16
ONSET = 1e-4  # pressure over E below which a packing is unjammed: a tenth of that at an excess of 0.01
QUASI_STATIC = 0.01  # kinetic over stored energy, of the order of the kinetic share of the pressure
FITTED = (0.005, 0.06)  # excess solid fractions: overlaps exceed the height of corners, and strains are below 10 %
BANDS = {"below 0.02": (0.005, 0.02), "above 0.02": (0.02, 0.06)}
ROOT, ROOT_ERROR = 3.6, 0.5  # Z - Z0 over the root of the excess in two dimensions: O'Hern et al. 2003
SQUARES, SAMPLES = 4, 400  # of the bootstrap; squares across the region, with some 15 discs in each


def half_width(fraction: float) -> float:
    """Half width of the square between the walls."""
    return 0.5 * math.sqrt(AREA / fraction)


def scene(seed: int, outline_nodes: int) -> str:
    half = half_width(START)
    closing = speeds([-half_width(fraction) for fraction in (START, *CLOSING, *OPENING)], PAUSE, RAMP)
    length = 2 * half + 2
    middle = half - CLEARANCE - length / 2  # of a wall that ends just before the next one's face
    return CASE.scene(
        end=PAUSE * len(CLOSING + OPENING), pause=PAUSE, seed=seed, nodes=NODES[outline_nodes], damping=DAMPING,
        count=DISCS, poisson=0.4, law='"frictionless"',
        outline_nodes=outline_nodes, stiffness=STIFFNESS, length=length, low=-half, high=half,
        bottom=[middle, -half - 0.5], right=[half + 0.5, middle], top=[-middle, half + 0.5],
        left=[-half - 0.5, -middle], core=[[-CORE, -CORE], [CORE, CORE]], closing=closing,
        opening=[[time, -speed] for time, speed in closing])


def compact(seed: int, outline_nodes: int) -> Packing:
    run = CASE.engine(f"seed_{seed}_outline_{outline_nodes}", scene(seed, outline_nodes))
    frames = Frames(run.folder / "frames.h5", None)
    grid = frames.grids["outlines"]
    outlines = [Outlines.of(frames.positions("outlines", i), grid.cells, grid.body) for i in range(len(frames.times))]
    return read_packing(run, outlines, STIFFNESS, 2 * LARGE, len(CLOSING))


@pytest.fixture(scope="module")
def packings() -> list[Packing]:
    return [compact(seed, OUTLINE_NODES) for seed in SEEDS]


def walls_of(stage: Stage) -> np.ndarray:
    """[4] outward forces on the walls, in the order of FORCES."""
    sums = stage.network.resultants()
    return np.array([-sums[BOTTOM, 1], sums[RIGHT, 0], sums[TOP, 1], -sums[LEFT, 0]])


def test_outlines_alone_give_the_same_forces(packings: list[Packing]) -> None:
    """A second contact search with the law of the scene."""
    in_touch = 2 * 2 * half_width(START)  # length of a wall, from either side
    for seed, packing in zip(SEEDS, packings):
        found = np.array([walls_of(stage) for stage in packing.stages])
        engine = np.abs(np.stack([packing.run.probe(name)[1:] for name in FORCES], axis=1))
        CASE.check(Label.EXACT, f"packing {seed}: forces on walls, by outlines less engine",
                   np.abs(found - engine).max() / engine.max(), 0, 0.5 * STIFFNESS * in_touch * POSITION / engine.max(),
                   "penalty law; rounding of all outline positions at a wall")


def test_clipping_anew_gives_the_same_solid_fraction(packings: list[Packing]) -> None:
    box = (-CORE, CORE, -CORE, CORE)
    for seed, packing in zip(SEEDS, packings):
        areas = np.array([stage.shares(box) @ stage.outlines.areas()[:DISCS] for stage in packing.stages])
        error = areas / (2 * CORE) ** 2 - packing.run.probe("core.solid_fraction")[1:]
        CASE.check(Label.EXACT, f"packing {seed}: solid fraction of a box, own less probe", np.abs(error).max(), 0,
                   4 * POSITION / (2 * CORE), "rounding of the outlines along the four sides of the box")


def test_at_rest(packings: list[Packing]) -> None:
    for seed, packing in zip(SEEDS, packings):
        opened = packing.opened(ONSET)
        at = slice(len(CLOSING), len(CLOSING) + len(opened))  # of probes, whose first row is the start
        kinetic, strain, contact = (packing.run.probe(f"energy.{of}")[at] for of in ("kinetic", "strain", "contact"))
        CASE.check(Label.EXACT, f"packing {seed}: kinetic over stored energy", (kinetic / (strain + contact)).max(), 0,
                   QUASI_STATIC, "kinetic pressure over pressure is of this order: 2 kinetic / area against dU/dA")


def test_pressure_of_contacts_is_that_of_walls(packings: list[Packing]) -> None:
    """At each stage, sums of forces f times positions x over discs and walls leave -f depth, as overlaps count twice.
    Love-Weber's sum over discs, with arms from their centres c, is thus that over the walls, plus 2 x contact energy,
    plus the sum of resultants x c, which is zero at rest."""
    for seed, packing in zip(SEEDS, packings):
        opened = packing.opened(ONSET)
        at = slice(len(CLOSING), len(CLOSING) + len(opened))
        love_weber = 2 * packing.run.probe("all.pressure")[at] * packing.run.probe("area.area")[at]
        walls, unbalanced = np.array([(stage.moment_of_walls, stage.unbalanced) for stage in opened]).T
        found = (love_weber - 2 * packing.run.probe("energy.contact")[at] - unbalanced) / walls
        allowed = np.array([rounded_moments(stage) for stage in opened]) / walls
        worst = (np.abs(found - 1) / allowed).argmax()
        CASE.check(Label.EXACT, f"packing {seed}: pressure by contacts over that by walls - 1, worst of {len(opened)}",
                   found[worst] - 1, 0, allowed[worst],
                   "virial less overlaps and resultants; rounding of the outlines: three standard errors of all "
                   "depths, plus the sum of those at the walls, whose faces are straight")
        changed = np.abs(np.diff([packing.stages[packing.closing - 2].moment_of_walls, *walls]))
        CASE.check(Label.EXACT, f"packing {seed}: resultants of discs x centres over what the step before changed of the "
                   "moment of the walls, largest", np.abs(unbalanced / changed).max(), 0, QUASI_STATIC,
                   "damping and inertia balance the resultants: residues of that step's motion, however close a "
                   "packing is to unjamming")


def rounded_moments(stage: Stage) -> float:
    """Effect of rounding of the outlines on the sum of force x arm; arms are one or two large diameters."""
    force = 0.5 * STIFFNESS * math.pi * LARGE / OUTLINE_NODES * POSITION
    inside = len(stage.touching.own)
    return force * LARGE * (3 * math.sqrt(inside / 3) + stage.nodes_at_walls / 2)


def test_no_friction_from_corners(packings: list[Packing]) -> None:
    for seed, packing in zip(SEEDS, packings):
        CASE.check(Label.EXACT, f"packing {seed}: forces across over along the line of centres, rms",
                   packing.opened(ONSET)[-1].obliquity, 0, OBLIQUE,
                   "normals of polygons deviate by pi / n at most, uniformly")


def test_jams_where_others_do(packings: list[Packing]) -> None:
    for seed, packing in zip(SEEDS, packings):
        CASE.check(Label.INDEPENDENT, f"packing {seed}: solid fraction at jamming", packing.jamming_fraction(ONSET),
                   0.84, 0.015, "O'Hern et al. 2003, Majmudar et al. 2007: 0.842; three times the scatter of 400 discs")


def fitted(packing: Packing, band: tuple[float, float]) -> tuple[list[Stage], np.ndarray]:
    """Stages in a band of excess solid fractions, and these fractions."""
    jammed = packing.jamming_fraction(ONSET)
    stages = [s for s in packing.opened(ONSET) if band[0] < s.solid_fraction - jammed < band[1]]
    return stages, np.array([s.solid_fraction - jammed for s in stages])


def excess(packing: Packing) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Excess solid fractions of the fitted stages, and coordination there with its standard error."""
    stages, over = fitted(packing, FITTED)
    errors = [s.counts.std() / math.sqrt(len(s.counts)) for s in stages]
    return over, np.array([s.coordination for s in stages]), np.array(errors)


def drawn_anew(stages: list[Stage]) -> np.ndarray:
    """[stages x (1 + SAMPLES)] coordination: first the original, then bootstrap samples of squares of the region.

    Samples are the same in all stages, which form one network. Squares are drawn because neighbours share contacts.
    """
    sums, discs = (np.array(part) for part in zip(*(s.by_square(SQUARES) for s in stages)))
    drawn = np.random.default_rng(1).multinomial(SQUARES**2, np.full(SQUARES**2, SQUARES**-2), SAMPLES).T
    weights = np.column_stack([np.ones(SQUARES**2), drawn])
    return (sums @ weights) / (discs @ weights)


def at_jamming(packing: Packing) -> tuple[float, float]:
    """Coordination at zero excess, by a straight line over the root of the excess, and its bootstrap standard error."""
    stages, over = fitted(packing, FITTED)
    values = np.polyfit(np.sqrt(over), drawn_anew(stages), 1)[-1]
    return float(values[0]), float(values[1:].std())


def over_root(packing: Packing, band: tuple[float, float]) -> tuple[float, float]:
    """Z - Z0 over the root of the excess by least squares in a band of excesses, and its bootstrap standard error."""
    stages, over = fitted(packing, band)
    root, above = np.sqrt(over), drawn_anew(stages) - ISOSTATIC
    values = root @ above / (root @ root)
    return float(values[0]), float(values[1:].std())


def test_coordination(packings: list[Packing]) -> None:
    for seed, packing in zip(SEEDS, packings):
        value, error = at_jamming(packing)
        last = packing.stages[-1]
        CASE.check(Label.INDEPENDENT, f"packing {seed}: coordination when opened below jamming", last.coordination,
                   0, 0, "O'Hern et al. 2003: contacts drop discontinuously from isostatic to none")
        middle, half = (ISOSTATIC + ROUGHEST) / 2, (ISOSTATIC - ROUGHEST) / 2
        CASE.check(Label.INDEPENDENT, f"packing {seed}: coordination at jamming", value, middle, half + 3 * error,
                   "isostatic: 4 (1 - 1/N) for smooth discs, 3 for rough ones, polygons between them; three standard "
                   "errors of the line, by bootstrap")


@pytest.mark.parametrize("band", BANDS)
def test_coordination_grows_with_the_root_of_the_excess(packings: list[Packing], band: str) -> None:
    """Mean of all packings, equal in both bands, between which the root grows by 1.8 and the excess by 3.4."""
    values, errors = np.transpose([over_root(packing, BANDS[band]) for packing in packings])
    error = float(np.sqrt((errors**2).sum()) / len(errors))
    CASE.check(Label.INDEPENDENT, f"Z - Z0 over the root of the excess, {band}", values.mean(), ROOT,
               ROOT_ERROR + 2 * error, "O'Hern et al. 2003, 3.6 +- 0.5 in two dimensions; two standard errors of the "
               "packings, by bootstrap")


@pytest.mark.skipif(not FULL, reason="three packings more")
def test_corners_vanish(packings: list[Packing]) -> None:
    """Forces across the line of centres vanish with the number of sides, at the last stage that bears load."""
    compared = [*(compact(1, count) for count in COUNTS), packings[0]]
    across = [packing.opened(ONSET)[-1].obliquity for packing in compared]
    CASE.check_rate("forces across over along the line of centres, by outline spacing",
                    [1 / n for n in [*COUNTS, OUTLINE_NODES]], across, 1, 0.3,
                    "angles of normals scale with 1 / n; several nodes in contact, fewer at lower pressure")


def test_pictures(packings: list[Packing]) -> None:
    figure, axes = panels(2, "400 frictionless discs: pressure and contact forces", across=True)
    figure.set_size_inches(13, 6.4)
    opened = packings[0].opened(ONSET)
    for panel, stage in zip(axes, (opened[-1], opened[0])):
        draw_packing(panel, packings[0], stage)
    save(CASE, figure, "packing")
    title = f"400 frictionless discs of {NODES[OUTLINE_NODES]} nodes, {OUTLINE_NODES} on the outline"
    figure, axes = panels(3, title, across=True)
    draw_histories(axes[:2], packings)
    draw_excess(axes[2], packings)
    save(CASE, figure, "jamming")


def draw_packing(axes: Axes, packing: Packing, stage: Stage) -> None:
    """Mean pressure of each disc, and forces as lines between centres, with widths proportional to forces."""
    frames = Frames(packing.run.folder / "frames.h5", None)
    index = packing.stages.index(stage) + 1
    cells = frames.grids["bodies"]
    sums, counts = np.bincount(cells.body, frames.field("bodies", index, "pressure")), np.bincount(cells.body)
    discs = PolyCollection([stage.outlines.of_body(disc) for disc in range(DISCS)], array=(sums / counts)[:DISCS],
                           cmap="YlOrRd", edgecolors="#8a8a8a", linewidths=0.3)
    discs.set_clim(0, np.quantile((sums / counts)[:DISCS], 0.98))
    axes.figure.colorbar(axes.add_collection(discs), ax=axes, label="mean pressure over E", shrink=0.8, extend="max")
    centres = stage.outlines.centres()
    between = (stage.network.pairs < DISCS).all(axis=1)
    force = stage.network.magnitudes()
    axes.add_collection(LineCollection(centres[stage.network.pairs[between]], colors="#2b2b2b", capstyle="round",
                                       linewidths=1.2 * (force / force.mean())[between]))
    reach = stage.half - stage.margin
    for half, style in ((stage.half, "-"), (reach, ":")):
        axes.add_patch(plt.Rectangle((-half, -half), 2 * half, 2 * half, fill=False, linestyle=style, color=COLOURS[0]))
    values = f"{stage.solid_fraction:.3f}, P = {stage.pressure:.2g} E, Z = {stage.coordination:.2f}"
    axes.set_title(f"{values}; dotted: evaluated region", fontsize=10, loc="left")
    axes.set_xlim(-1.03 * stage.half, 1.03 * stage.half)
    axes.set_ylim(-1.03 * stage.half, 1.03 * stage.half)
    describe(axes, x="x over the small diameter", y="y over the small diameter")
    axes.set_aspect("equal")
    axes.grid(False)


def draw_histories(axes: list[Axes], packings: list[Packing]) -> None:
    labels = {"pressure": "pressure on the walls over E", "coordination": "contacts a disc, Z"}
    for panel, (name, label) in zip(axes, labels.items()):
        for packing, seed, colour in zip(packings, SEEDS, COLOURS):
            values = [(s.solid_fraction, getattr(s, name)) for s in packing.stages]
            parts = ((values[: len(CLOSING)], "o:", "closing"), (values[len(CLOSING) - 1 :], "s-", "opening"))
            for part, style, what in parts:
                panel.plot(*np.transpose(part), style, color=colour, markersize=4, linewidth=1.1,
                           label=f"{what}, packing {seed}")
        panel.axvspan(0.825, 0.855, color=COLOURS[6], alpha=0.2, label="jamming: 0.84 +- 0.015")
        describe(panel, x="solid fraction of the region", y=label)
    axes[1].axhline(ISOSTATIC, color=COLOURS[6], linewidth=1.0, linestyle="--", label="isostatic")
    axes[1].set_ylim(3.4, 5.1)
    axes[1].set_title("below jamming the opened packing has no contacts", fontsize=9, loc="left")
    axes[0].legend(fontsize=9, frameon=False, loc="upper left")
    legend(axes[1])


def draw_excess(axes: Axes, packings: list[Packing]) -> None:
    for packing, seed, colour, marker in zip(packings, SEEDS, COLOURS, MARKERS):
        over, coordination, errors = excess(packing)
        axes.errorbar(over, coordination - ISOSTATIC, errors, fmt=marker, color=colour, markersize=4, capsize=2,
                      label=f"packing {seed}")
    line = np.array([0.003, 0.1])
    axes.loglog(line, 3.6 * np.sqrt(line), "--", color=COLOURS[6], linewidth=1, label="3.6 x root: O'Hern et al. 2003")
    axes.set_yticks([0.2, 0.4, 0.6, 0.8, 1.0], ["0.2", "0.4", "0.6", "0.8", "1"])
    axes.set_yticks([], minor=True)
    describe(axes, x="solid fraction above jamming", y="Z - isostatic")
    legend(axes)
