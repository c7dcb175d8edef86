"""A hexagon pressed into a disc, a corner or a face first: runs, other solvers, stored forces, and the study."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from foreign.calculix_deck import Deck
from foreign.meshes import Mesh, above, below, fan, half_disc
from foreign.stored import Opinion, largest_from_here
from histories import smooth_rises
from squeeze import to_rigid_contact
from two_bodies_study import LAWS, RAMP, Again, RestStudy, Setup, read
from verification import FULL, Case, Run

DEPTHS = [0.1, 0.2, 0.4, 0.6]  # R
MODULI = {"disc": 1.0, "hexagon": 2.0}  # mu; lambda = 4 mu
HOLD = 100.0  # mu / R: of the springs
FIRST = ("corner", "face")  # part in first contact
HEIGHT = {"corner": 1.0, "face": float(np.sqrt(0.75))}  # of the hexagon's centre above its lowest point
HELD = {"corner": [np.pi / 6, 5 * np.pi / 6], "face": [0.0, np.pi]}  # directions of the hexagon's upper sides
UPPER = {"corner": above(1.5), "face": above(HEIGHT["face"])}  # these sides
# Outlines of discs with a corner and with a facet at the top, nodes of either; outlines of hexagons whose sides have an
# even and an odd number of segments, nodes of either.
SIZES = {10: ((48, 50), 168, (48, 54), 140), 14: ((68, 70), 340, (72, 66), 290), 20: ((100, 102), 700, (96, 102), 590),
         28: ((140, 142), 1400, (144, 138), 1180)}
CHOSEN = {"neo-hookean": [size for size in SIZES if FULL or size < 28],
          "melody": [size for size in SIZES if size < (28 if FULL else 20)]}
RINGS = [8, 16, 32]  # of the disc; the hexagon has a quarter more
# Rings with the hexagon as slave; with 16 rings and `melody` a corner stops at 0.549 R.
SWAPPED = {(first, law): [8, 12 if (first, law) == ("corner", "melody") else 16] for first in FIRST for law in LAWS}
LONGEST = 0.05  # R, of a load step
INCREMENT = 0.02  # R, of CalculiX
SOFT, BETWEEN, STIFF = 300.0, 1000.0, 3000.0  # mu / R: penalties of CalculiX
COARSE, FINE = 6, 12  # CalculiX's rings of the disc; COARSE with either slave and all penalties
# Slave, rings, penalty.
CALCULIX = [*(("disc", rings, stiffness) for rings in (COARSE, 8, FINE) for stiffness in (SOFT, STIFF)),
            ("disc", COARSE, BETWEEN), ("hexagon", COARSE, SOFT), ("hexagon", COARSE, STIFF)]


def corners(first: str) -> np.ndarray:
    """[6 x 2] corners of the hexagon, counter-clockwise from the lowest on the right."""
    angles = np.pi / 3 * np.arange(6) - np.pi / (2 if first == "corner" else 3)
    return np.stack([np.cos(angles), np.sin(angles)], axis=1)


def half_hexagon(first: str, t: np.ndarray) -> np.ndarray:
    """[n x 2] points of the half outline x >= 0 about the origin, from the bottom, at shares of its length."""
    places = corners(first)[:4]
    if first == "face":
        places = np.concatenate([[[0, -HEIGHT[first]]], corners(first)[:3], [[0, HEIGHT[first]]]])
    lengths = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(places, axis=0), axis=1))])
    x, y = (np.interp(t, lengths / lengths[-1], places[:, axis]) for axis in range(2))
    return np.stack([np.where(np.abs(t - 0.5) < 0.5, x, 0.0), y], axis=1)


def meshes(first: str, rings: int) -> dict[str, Mesh]:
    hexagon = fan(partial(half_hexagon, first), (0.0, HEIGHT[first]), rings + rings // 4, 6)
    return {"disc": half_disc(rings, -1), "hexagon": hexagon}


def by_getfem(first: str, law: str, rings: int, slave: str = "disc") -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """[depths] forces of the hexagon on the disc, and half outlines."""
    from foreign.getfem_bodies import Bodies  # GetFEM is installed only with --full

    bodies = Bodies(law, meshes(first, rings), MODULI, {"down": 0.0})
    bodies.hold("disc", below(-1), HOLD, "0", "0")
    bodies.hold("hexagon", UPPER[first], HOLD, "0", "down")
    bodies.touch(slave, "hexagon" if slave == "disc" else "disc")
    steps = [round(step / LONGEST) for step in np.diff(DEPTHS, prepend=0)]
    return bodies.go([{"down": -depth} for depth in DEPTHS], steps, lambda: 2 * bodies.holding_force("disc")[1])


def by_calculix(first: str, slave: str, rings: int, stiffness: float, folder: Path) -> np.ndarray:
    """[depths, nan beyond those reached] forces of the hexagon on the disc, with the law `melody` and a penalty in
    mu / R."""
    deck = Deck(stiffness, meshes(first, rings), MODULI)
    deck.hold("DISC", below(-1), HOLD, "GROUND")
    deck.hold("HEXAGON", UPPER[first], HOLD, "RAM")
    deck.touch(*(("DISCUP", "HEXAGONDOWN") if slave == "disc" else ("HEXAGONDOWN", "DISCUP")))
    for depth, step in zip(DEPTHS, np.diff(DEPTHS, prepend=0)):
        deck.step({"GROUND": 0.0, "RAM": -depth}, INCREMENT / step)
    found = deck.forces(folder / f"{first}_{rings}_{slave}_{stiffness:g}", all_steps=False)["GROUND"][:, 1]
    return 2 * np.pad(found, (0, len(DEPTHS) - len(found)), constant_values=np.nan)  # of two halves


def stored(solver: str, first: str, rings: int, slave: int = 0, **key: float) -> np.ndarray:
    """[depths] stored forces of getfem_<law> or calculix_melody."""
    return read(f"polygon_{solver}").of(first=FIRST.index(first), slave=slave, rings=rings, **key)[0]


@dataclass(frozen=True, kw_only=True)
class Press(Setup):
    """Setup of a size of SIZES. Ways: a facet of the disc at the top, the hexagon even and odd; likewise a corner."""

    first: str

    WAYS, LEVELS, STORED = 4, DEPTHS, 2.0

    @property
    def spacing(self) -> float:
        """Spacing of the disc's outline, R."""
        return 2 * np.pi / float(np.mean(SIZES[self.size][0]))

    def scene(self, case: Case) -> str:
        discs, disc_nodes, hexagons, hexagon_nodes = SIZES[self.size]
        down = smooth_rises([-depth for depth in DEPTHS], self.pause, RAMP, 12)
        return case.scene("polygon.toml", levels=DEPTHS, end=float(self.rests[-1]), rest=self.pause, law=self.law,
                          stiffness=self.stiffness, disc_nodes=disc_nodes, disc_outline=discs[self.way < 2],
                          hexagon_nodes=hexagon_nodes, hexagon_outline=hexagons[self.way % 2],
                          corners=corners(self.first).tolist(), height=HEIGHT[self.first],
                          held=[float(angle) for angle in HELD[self.first]], down=down)

    def forces(self, run: Run) -> tuple[np.ndarray, np.ndarray]:
        """[depths] force on the disc, and distance of the ends up to a constant."""
        return -run.at("disc.force_y", self.rests), -np.array(DEPTHS)


class Polygon(RestStudy):
    """Study of Presses."""

    first: str
    bodies = tuple(MODULI)
    places = [f"at depth {depth:g}" for depth in DEPTHS]
    compared, between = range(1, len(DEPTHS)), range(len(DEPTHS))  # at 0.1 R a corner's contact is two segments wide
    long = {"melody": "discs compare this law each time"}
    orders = (1, 2)  # beside corners errors are of first order, elsewhere of second
    counted = np.array(compared)
    scatters = 2.0
    group = largest_from_here
    own = "first or second order in h, saw tooth, penalty"
    others = {"GetFEM": "GetFEM 5.4.2, its meshes and slaves", "CalculiX": "CalculiX, its meshes, slaves, penalty"}
    both = "meshes and slaves of both, penalty of CalculiX 2.20"
    shape = "corners of the polygon of the circle's area; errors of the force times the depth"

    def __init__(self, case: Case, law: str) -> None:
        super().__init__(case, law, [Press(first=self.first, size=size, law=law) for size in CHOSEN[law]])

    @classmethod
    def read_getfem(cls, law: str) -> Opinion:
        """Error: the largest change from a mesh half as fine at this depth and deeper ones, as at one it may be
        accidentally small (small contacts are resolved worst). For at least first order, half of the change with the
        other body as slave is added, on the finest mesh that has both."""
        of, swapped = partial(stored, f"getfem_{law}", cls.first), SWAPPED[cls.first, law][-1]
        half, finest = (of(rings) for rings in RINGS[-2:])
        swap = of(swapped, 1) / of(swapped) - 1
        return Opinion(finest, largest_from_here(np.abs(half / finest - 1) + np.abs(swap) / 2))

    @classmethod
    def read_calculix(cls) -> Opinion:
        """Force of rigid contact by the finest mesh. The error has three parts, the largest of this depth and deeper
        ones: the change by halving the rings, half of the change with the other body as slave, and the penalty. Beside
        sharp corners the pressure is singular and the order below one, so the last part is the change of rigid contact
        with an intermediate penalty in place of the stiff one."""
        def rigid(rings: int, slave: int = 0, stiff: float = STIFF) -> np.ndarray:
            """[depths] force from two penalties, as the error is of order 1 / K."""
            soft, hard = (stored("calculix_melody", cls.first, rings, slave, stiffness=k) for k in (SOFT, stiff))
            return to_rigid_contact(soft, hard, stiff / SOFT)

        force, coarse = rigid(FINE), rigid(COARSE)
        mesh, swap, penalty = (np.abs(change - 1) for change in (coarse / force, rigid(COARSE, 1) / coarse,
                                                                 rigid(COARSE, stiff=BETWEEN) / coarse))
        return Opinion(force, largest_from_here(mesh + swap / 2 + penalty))

    def shape_error(self, body: int, level: int) -> float:
        """R. Corners of the disc's polygon protrude from the circle. A force grows at least in proportion to the depth,
        so its relative error bounds that of the depth."""
        return self.spacings[-1] ** 2 / 12 + self.lost(level) * DEPTHS[level]

    def nodes(self, body: int, level: int) -> np.ndarray:
        """Nodes, shifted back to the axis."""
        found = super().nodes(body, level)
        return found - [found[:, 0].mean(), 0]

    def apart(self) -> float:
        """R. Largest relative sideways displacement of bodies of the finest size."""
        aside = [[[rests.outline(body, level)[:, 0].mean() for level in self.compared] for body in range(len(MODULI))]
                 for rests in self.rests[-1]]
        return float(np.abs(np.diff(aside, axis=1)).max())


class CornerFirst(Polygon):
    name, first, table = "corner first", "corner", "corner_outlines"


class FaceFirst(Polygon):
    name, first, table = "face first", "face", "face_outlines"


def getfem_again(first: str, law: str, _: Path) -> np.ndarray:
    return by_getfem(first, law, RINGS[0])[0] / stored(f"getfem_{law}", first, RINGS[0]) - 1


def calculix_again(first: str, folder: Path) -> np.ndarray:
    return np.array([by_calculix(first, "disc", COARSE, stiffness, folder) /
                     stored("calculix_melody", first, COARSE, stiffness=stiffness) - 1 for stiffness in (SOFT, STIFF)])


AGAIN: list[Again] = [
    *((f"{first} first, {law}: GetFEM", partial(getfem_again, first, law), 1e-6,
       "Newton's residuals of 1e-9 in some fifty nodes of a support, over the smallest force")
      for law in LAWS for first in FIRST),
    *((f"{first} first, melody: CalculiX", partial(calculix_again, first), 3e-4,
       "termination of its Newton's method: change by load steps half as long, at most for a corner at 0.1 R, K = 300")
      for first in FIRST)]
