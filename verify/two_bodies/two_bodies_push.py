"""A stiff disc pushed along a soft block with Coulomb friction: runs, other solvers, stored forces, and the study."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
from scipy.stats import t as students_t

from foreign.calculix_deck import Deck
from foreign.meshes import Mesh, above, below, block, full_disc
from foreign.stored import Opinion
from histories import smooth_rises
from squeeze import to_rigid_contact
from two_bodies_study import HARDER, LAWS, Again, Setup, Study, lost_by_penalty, outline, read
from verification import Case, Run

COLUMN = {"along": 1, "across": 2}  # of samples by push
FIRST = {"along": 1, "across": 0}  # first compared place: the tangential force nearly vanishes before the push
DEPTH, FRICTION = 0.5, 0.3
START = -0.5  # x of the disc
MODULI = {"disc": 10.0, "block": 1.0}  # mu; lambda = 4 mu
HOLD = 100.0  # mu / R: of the springs
GAP = 0.001  # at the start, as in push.toml
PRESSES = 2  # states of rest during pressing
STUCK = [0.0, 0.1, 0.2, 0.3]  # pushes with full or partial stick
SLIDING = np.linspace(0.4, 1.2, 33)  # pushes with full slip
PUSHES = [*STUCK, *(float(push) for push in SLIDING)]
WINDOWS = [(0.4, 0.8), (0.8, 1.2)]  # of the push, over which forces in slip are averaged
PLACES = [*(f"at push {push:g}" for push in STUCK), *(f"in slip, push {low:g} to {high:g}" for low, high in WINDOWS)]
SLIPS = np.arange(len(PLACES)) >= len(STUCK)
DRAWN = (0.3, 1.2)  # pushes of the stored surfaces, of the finest mesh
# Outlines of the discs with a corner and with a facet at the lowest point, nodes of either; outlines of the blocks,
# with different segment positions below it, nodes of either.
SIZES = {10: ((48, 50), 168, (82, 80), 380), 14: ((68, 70), 340, (114, 112), 740),
         20: ((100, 102), 700, (162, 160), 1450), 28: ((140, 142), 1400, (228, 226), 2900)}
CHOSEN = {"neo-hookean": [10, 14, 20, 28], "melody": [10, 14, 20]}
# Change to zero rate over that by half the rate. At rests: first order or higher. In slip: drag is of first order, but
# the drop after each tooth is delayed by rate^(2/3), as in any slow passage through a fold.
FACTOR, FACTOR_ERROR = np.where(SLIPS, 2.35, 1.5), np.where(SLIPS, 0.35, 0.5)
CONFIDENCE = 0.95
COARSE = "two sizes resolve N to 1 % and T in stick to 3 to 8 %, in 16 runs: three or more sizes are needed"
ROWS = {4: 5, 8: 10, 12: 15, 16: 20, 24: 30}  # of squares in the block, by rings of the disc
# Rings of the disc, load steps per 0.1 R of push.
RINGS = {"neo-hookean": [8, 12, 16, 24], "melody": [8, 12, 16]}
STEPS = [2, 4, 8]
# CalculiX: increments down and then along, R, by which forces lag in first order; penalties, mu / R.
DOWN, LONGEST, LONG, SHORT = 0.025, 0.025, 0.0125, 0.00625
SOFT, STIFF = 300.0, 1000.0
CALCULIX_RINGS = [4, 8]
FINEST = 12  # rings, with SOFT and LONG alone
# Slave, rings, penalty, increments down and along, whether the run continues into slip.
CALCULIX = [*(("disc", rings, stiffness, DOWN, along, True) for rings in CALCULIX_RINGS for stiffness in (SOFT, STIFF)
              for along in (LONG, SHORT)),
            *(("disc", rings, SOFT, DOWN, LONGEST, True) for rings in CALCULIX_RINGS),
            ("disc", FINEST, SOFT, DOWN, LONG, True),
            *(("block", CALCULIX_RINGS[0], STIFF, DOWN, along, True) for along in (LONG, SHORT)),
            ("disc", CALCULIX_RINGS[0], SOFT, DOWN / 2, LONG, False)]


def meshes(rings: int) -> dict[str, Mesh]:
    return {"disc": full_disc(rings, (START, 1.0)), "block": block(3 * ROWS[rings], ROWS[rings], -3.0, 3.0, 2.0)}


def by_getfem(law: str, rings: int, steps: int, slides: bool = True) -> tuple[np.ndarray, np.ndarray]:
    """[pushes x 3] push, tangential and normal force on the block; [pushes x nodes x 2] its top, from right to left."""
    from foreign.getfem_bodies import Bodies  # GetFEM is installed only with --full

    pushes = PUSHES if slides else STUCK
    bodies = Bodies(law, meshes(rings), MODULI, {"along": 0.0, "down": 0.0})
    bodies.hold("disc", above(1), HOLD, "along", "down")
    bodies.hold("block", below(-1), HOLD, "0", "0")
    bodies.touch("disc", "block", FRICTION)
    counts = [round(10 * DEPTH * steps)]
    counts += [round(10 * steps * way) if push <= STUCK[-1] else 1 for push, way in zip(pushes[1:], np.diff(pushes))]
    forces, outlines = bodies.go([{"along": push, "down": -DEPTH} for push in pushes], counts,
                                 lambda: bodies.holding_force("disc") * [1, -1])
    return np.column_stack([pushes, forces]), outlines["block"][:, :6 * ROWS[rings] + 1]


def by_calculix(slave: str, rings: int, stiffness: float, down: float, increment: float, slides: bool,
                folder: Path) -> np.ndarray:
    """[pushes reached x 3] push, tangential and normal force on the block, with the law `melody` and a penalty in
    mu / R. Points of both surfaces are paired at the start of an increment, so forces lag by it."""
    deck = Deck(stiffness, meshes(rings), MODULI, FRICTION)
    deck.hold("DISC", above(1), HOLD, "RAM")
    deck.hold("BLOCK", below(-1), HOLD, "GROUND")
    deck.touch(*(("DISCDOWN", "BLOCKUP") if slave == "disc" else ("BLOCKUP", "DISCDOWN")))
    pushes = PUSHES if slides else STUCK
    for push, part in zip(pushes, [down / DEPTH, *(increment / np.diff(pushes))]):
        deck.step({"GROUND": 0.0, "RAM": -DEPTH}, part, {"RAM": push})
    found = deck.forces(folder / f"{rings}_{stiffness:g}_{slave}", all_steps=False)["RAM"]
    return np.column_stack([pushes[:len(found)], found[:, 0], -found[:, 1]])


def hann(push: np.ndarray, low: float, high: float) -> np.ndarray:
    """[samples] weights of a mean that suppresses oscillations with two or more periods between low and high."""
    share = np.clip((push - low) / (high - low), 0, 1)
    weights = 1 - np.cos(2 * np.pi * share)
    return weights / weights.sum()


def at_places(samples: np.ndarray, kind: str) -> np.ndarray:
    """[places] forces at the pushes of STUCK, then means over WINDOWS if the run slides. Samples [samples x 3] are
    push, tangential and normal force, and include the pushes of STUCK and SLIDING."""
    push, force = samples[:, 0], samples[:, COLUMN[kind]]
    stuck = np.abs(push[:, None] - STUCK).argmin(axis=0)
    means = [hann(push, *window) @ force for window in WINDOWS if push[-1] >= window[1] - 1e-9]
    return np.concatenate([force[stuck], means])


def by_group(values: np.ndarray, kind: str) -> np.ndarray:
    """[places] the largest value in stick, and in slip, as at a single place it may be accidentally small."""
    found = np.array(values, dtype=float)
    found[~SLIPS], found[SLIPS] = found[~SLIPS][FIRST[kind]:].max(), found[SLIPS].max()
    return found


def getfem_samples(law: str, rings: int, steps: int = STEPS[-1]) -> np.ndarray:
    """[pushes x 3] stored push, tangential and normal force. Coarser load steps are stored only for stick."""
    return read(f"push_getfem_{law}").of(rings=rings, steps=steps)


def calculix_samples(rings: int, stiffness: float, increment: float, slave: int = 0, down: float = DOWN) -> np.ndarray:
    """[pushes x 3] stored push, tangential and normal force."""
    key = {"slave": slave, "rings": rings, "stiffness": stiffness, "down": down, "increment": increment}
    return read("push_calculix_melody").of(**key)


def changed_on_the_way_down() -> np.ndarray:
    """[pushes in stick x 2] relative change of tangential and normal force by half the increments down."""
    half, whole = (calculix_samples(CALCULIX_RINGS[0], SOFT, LONG, down=way)[:len(STUCK), 1:]
                   for way in (DOWN / 2, DOWN))
    return half / whole - 1


def order_of_lag(rings: int) -> tuple[float, float]:
    """Order of the tangential force in slip from three increments, and its error by the next term, the lag's square."""
    along = np.array([at_places(calculix_samples(rings, SOFT, increment), "along")[SLIPS]
                      for increment in (LONGEST, LONG, SHORT)])
    changes = np.sqrt((np.diff(along, axis=0) ** 2).mean(axis=1))
    lag = (along[0] / (2 * along[2] - along[1]) - 1).max()
    return float(np.log2(changes[0] / changes[1])), float(np.log2((1 + 1.5 * lag) / (1 + 0.75 * lag)))


@dataclass(frozen=True, kw_only=True)
class Push(Setup):
    """Setup of a size of SIZES. A pause, half of it in motion, advances the push by 0.1 R. Ways are combinations of
    discs and blocks; the first two differ in both."""

    pause: float = 40.0
    points: int = 16  # of a ramp's history
    slides: bool = True
    sample: float = 0.0025  # of the push in slip: of outputs

    WAYS, LEVELS, STEP, FIRST_REST = 4, STUCK, 40.0, PRESSES

    @property
    def speed(self) -> float:
        """Speed of the sliding disc."""
        return 0.1 / self.pause

    @property
    def end(self) -> float:
        return float(self.rests[-1] + (SLIDING[-1] - STUCK[-1]) / self.speed * self.slides)

    @property
    def spacing(self) -> float:
        """Spacing of the block's outline, R."""
        return 16 / float(np.mean(SIZES[self.size][2]))

    def time_of(self, push: float) -> float:
        """Time of the last push of STUCK, or the end."""
        return float(self.rests[-1]) if push in STUCK else self.end

    def scene(self, case: Case) -> str:
        discs, disc_nodes, blocks, block_nodes = SIZES[self.size]
        facet, shifted = [(False, False), (True, True), (True, False), (False, True)][self.way]
        down = [-(DEPTH + GAP) * (i + 1) / PRESSES for i in range(PRESSES)]
        along = smooth_rises([0.0] * PRESSES + STUCK[1:], self.pause, self.pause / 2, self.points)
        along += [[self.end, float(SLIDING[-1])]] * self.slides
        return case.scene("push.toml", end=self.end, output=self.pause * self.sample / 0.1, frame=self.pause,
                          friction=FRICTION, law=self.law, disc_nodes=disc_nodes, disc_outline=discs[facet],
                          block_nodes=block_nodes, block_outline=blocks[shifted], stiffness=self.stiffness, along=along,
                          down=smooth_rises(down, self.pause, self.pause / 2, self.points))


class Pushed:
    """Forces on the block in a run, sampled by push."""

    def __init__(self, push: Push, run: Run) -> None:
        self.run = run
        times = run.times("disc.force_x")
        sliding = times > push.rests[-1] * (1 + 1e-9)
        pushes = np.concatenate([STUCK, STUCK[-1] + (times[sliding] - push.rests[-1]) * push.speed])
        at = np.concatenate([push.rests, times[sliding]])
        self.samples = np.column_stack([pushes, -run.at("disc.force_x", at), run.at("disc.force_y", at)])
        self.forces = {kind: at_places(self.samples, kind) for kind in COLUMN}  # [places]

    def within_steps(self, kind: str) -> np.ndarray:
        """[windows] error of means by sampling: the force is known only at samples and drops abruptly at each tooth."""
        push, force = self.samples[:, 0], self.samples[:, COLUMN[kind]]
        change = np.abs(np.diff(force, prepend=force[0]))
        return np.array([hann(push, *window) @ change / 2 for window in WINDOWS])

    def surface(self, time: float) -> np.ndarray:
        """[nodes x 2] positions of the block's top, without its corners."""
        first = outline(self.run, 1, 0.0)
        return outline(self.run, 1, time)[(first[:, 1] > -1e-6) & (np.abs(first[:, 0]) < 2.99)]


@cache
def by_engine(case: Case, push: Push) -> Pushed:
    return Pushed(push, push.by_engine(case))


def error_of_mean(values: np.ndarray, freedoms: int) -> np.ndarray:
    """[places] error of a mean over meshes, [meshes x places], by Student's factor for these degrees of freedom."""
    factor = students_t.ppf((1 + CONFIDENCE) / 2, freedoms)
    return factor * values.std(axis=0, ddof=1) / np.sqrt(len(values))


class Sliding(Study):
    """One component of the force on the block, corrected for penalty and rate."""

    kind: str
    places = PLACES
    long = dict.fromkeys(LAWS, COARSE)
    counted = SLIPS  # where means are free of the saw tooth
    own = "saw tooth between meshes of one size, penalty, rate"
    others = {"GetFEM": "GetFEM 5.4.2, its meshes and load steps", "CalculiX": "CalculiX, its meshes and load steps"}
    both = "meshes and load steps of both, penalty, slaves and lag of CalculiX 2.20"
    order = ("force in slip over GetFEM, rms of windows",
             "linear consistency and a polygon for a circle; errors of rate and saw tooth by size, common errors")

    def __init__(self, case: Case, law: str) -> None:
        super().__init__(case, law)
        self.spacings = np.array([Push(size=size).spacing for size in CHOSEN[law]])
        ways = Push(size=CHOSEN[law][0], law=law).ways()[:2]
        harder = [replace(way, stiffness=HARDER * way.stiffness) for way in ways]
        self.penalty, error = lost_by_penalty(self._of(ways), self._of(harder))
        self.penalty_error = by_group(error, self.kind)
        found = [self._size(size) for size in CHOSEN[law]]
        self.force = np.array([force for force, _ in found]) * (1 + self.penalty)
        self.scatter = np.array([scatter for _, scatter in found]) / self.getfem.force

    @classmethod
    def read_getfem(cls, law: str) -> Opinion:
        """Error: the largest change from meshes half as fine and finer, in stick and in slip, as from a single mesh or
        at a single push it may be accidentally small. In stick, the first-order change by load steps twice as long is
        added."""
        def of(rings: int, steps: int = STEPS[-1]) -> np.ndarray:
            return at_places(getfem_samples(law, rings, steps), cls.kind)

        *coarser, finest = RINGS[law]
        force = of(finest)
        changes = [np.abs(of(rings) / force - 1) for rings in coarser if 2 * rings >= finest]
        error = by_group(np.max(changes, axis=0), cls.kind)
        long, short = of(RINGS[law][0], STEPS[-2]), of(RINGS[law][0])[~SLIPS]
        error[~SLIPS] += np.abs(long / short - 1)[FIRST[cls.kind]:].max()
        return Opinion(force, error)

    @classmethod
    def read_calculix(cls) -> Opinion:
        """Force of the finest mesh, with the corrections for penalty and lag of a coarser one. Error: the sum of all
        changes, each the largest in stick and in slip."""
        def of(*run: float) -> np.ndarray:
            """[places]"""
            return at_places(calculix_samples(*run), cls.kind)

        def still(rings: int, stiffness: float, slave: int = 0, short: float = SHORT) -> np.ndarray:
            """[places] without the first-order lag, from these increments and ones twice as long."""
            return 2 * of(rings, stiffness, short, slave) - of(rings, stiffness, 2 * short, slave)

        def rigid(rings: int) -> np.ndarray:
            """[places] rigid contact from two penalties, as the error is of order 1 / K."""
            return to_rigid_contact(still(rings, SOFT), still(rings, STIFF), STIFF / SOFT)

        def share(rings: int) -> np.ndarray:
            """[places] rigid contact without lag over forces with SOFT and LONG, the only ones of the finest mesh."""
            return rigid(rings) / of(rings, SOFT, LONG)

        coarse, fine = CALCULIX_RINGS
        soft, stiff = (still(fine, stiffness) / rigid(fine) - 1 for stiffness in (SOFT, STIFF))
        down = np.zeros(len(PLACES))
        down[~SLIPS] = changed_on_the_way_down()[:, COLUMN[cls.kind] - 1]
        changes = [(of(fine, SOFT, LONG) / of(FINEST, SOFT, LONG) - 1) / (FINEST / fine - 1),  # rest, first order
                   share(coarse) / share(fine) - 1,
                   soft * stiff,  # second order of the penalty
                   (still(coarse, STIFF, 1) / still(coarse, STIFF) - 1) / 2,  # the other body as slave
                   down,
                   still(fine, SOFT, short=LONG) / still(fine, SOFT) - 1]  # the lag by longer increments
        error = sum(by_group(np.abs(change), cls.kind) for change in changes)
        return Opinion(of(FINEST, SOFT, LONG) * share(fine), error)

    def _of(self, pushes: list[Push]) -> np.ndarray:
        """[pushes x places]"""
        return np.array([by_engine(self.case, push).forces[self.kind] for push in pushes])

    def _size(self, size: int) -> tuple[np.ndarray, np.ndarray]:
        """[places] forces, extrapolated to zero rate from the same meshes at half the rate, and their error: that of a
        mean over meshes, with the largest spread of all places, plus that of the order in the rate."""
        ways = Push(size=size, law=self.law).ways()
        usual, slower = self._of(ways[:2]), self._of([replace(way, pause=2 * way.pause) for way in ways[:2]])
        late = (slower - usual).mean(axis=0)
        stuck = np.concatenate([usual[:, ~SLIPS], self._of([replace(way, slides=False) for way in ways[2:]])])
        force = np.concatenate([stuck.mean(axis=0), usual[:, SLIPS].mean(axis=0)]) + FACTOR * late
        still = usual + FACTOR * (slower - usual)
        means = np.concatenate([error_of_mean(stuck, len(stuck) - 1),
                                error_of_mean(still[:, SLIPS], (len(still) - 1) * len(WINDOWS))])
        return force, by_group(means, self.kind) + by_group(FACTOR_ERROR * np.abs(late), self.kind)

    def slope_error(self) -> float:
        common = (self.getfem.error + self.penalty_error)[SLIPS].max()
        return self.slope_error_of(self.scatter[:, SLIPS].max(axis=1), common)


class Along(Sliding):
    name, kind = "pushed, tangential", "along"
    compared = between = range(FIRST["along"], len(PLACES))


class Across(Sliding):
    name, kind = "pushed, normal", "across"
    compared = between = range(FIRST["across"], len(PLACES))


@cache
def engine_and_reference(case: Case) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """By kind [places] ratio of both forces on the same nodes, corrected for the engine's rate, and its tolerance. Load
    steps in slip are longer than the engine's outputs."""
    push = Push(size=CHOSEN[LAWS[0]][0])
    moving, slow = by_engine(case, push), by_engine(case, replace(push, pause=2 * push.pause))
    static, long_steps = (Pushed(way, way.by_reference(case)) for way in (
        replace(push, sample=0.00625), replace(push, sample=0.00625, points=push.points // 2, slides=False)))
    found = {}
    for kind, expected in static.forces.items():
        late = slow.forces[kind] - moving.forces[kind]
        allowed = by_group(FACTOR_ERROR * np.abs(late), kind)
        allowed[~SLIPS] += np.abs(long_steps.forces[kind] - expected[~SLIPS])[FIRST[kind]:].max()
        allowed[SLIPS] += moving.within_steps(kind) + static.within_steps(kind)
        found[kind] = (moving.forces[kind] + FACTOR * late) / expected, allowed / expected
    return found


def getfem_again(_: Path) -> np.ndarray:
    live, stored = by_getfem(LAWS[0], RINGS[LAWS[0]][0], STEPS[-1])[0], getfem_samples(LAWS[0], RINGS[LAWS[0]][0])
    return (live[:, 1:] / stored[:, 1:] - 1)[1:]


def calculix_again(folder: Path) -> np.ndarray:
    live, stored = by_calculix(*CALCULIX[0], folder), calculix_samples(CALCULIX_RINGS[0], SOFT, LONG)
    return (live[:, 1:] / stored[:, 1:] - 1)[1:]


AGAIN: list[Again] = [
    ("pushed, neo-hookean: GetFEM", getfem_again, 3e-7,
     "Newton's residuals of 1e-9 in some fifty nodes of a support, over the smallest force, 0.177"),
    ("pushed, melody: CalculiX", calculix_again, float(np.abs(changed_on_the_way_down()[1:]).max()),
     "change by increments half as long during pressing")]
