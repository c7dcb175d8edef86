"""Two discs between plates, the upper one twice as stiff: runs, other solvers, stored forces, and the study."""

from __future__ import annotations

from functools import cache, partial
from pathlib import Path

import numpy as np

from foreign.calculix_deck import Deck
from foreign.meshes import Mesh, half_disc
from foreign.stored import Opinion, largest
from histories import speeds
from squeeze import to_rigid_contact
from two_bodies_study import LAWS, RAMP, Again, RestStudy, Setup, read
from verification import FULL, Case, Run

APPROACHES = [0.1, 0.2, 0.3, 0.4]  # over the sum of both diameters, 4
MODULI = {"soft": 1.0, "stiff": 2.0}  # mu; lambda = 4 mu
GAP = 0.001  # of either plate at the start, as in discs.toml
HOLD = 20.0  # mu: of the springs at each pole, for any length
SIZES = {96: (36, 126, 42), 168: (48, 220, 56), 340: (68, 450, 80), 700: (100, 900, 116)}  # by nodes of the soft disc
CHOSEN = {"neo-hookean": [168, 340, 700], "melody": [168, 340, *([700] if FULL else [])]}
SAME_NODES = 168 if FULL else 96  # of engine and reference
STEPS = 2  # of GetFEM's load, per approach
# Rings of the soft disc; the stiff one has a quarter more, so that nodes do not match.
RINGS = {"neo-hookean": [8, 16, 32, 64], "melody": [8, 16]}
OUTLINE_RINGS = 24
CALCULIX_REACHES = 3  # approaches: beyond 33 % its Newton's method failed with all tested steps and penalties
SOFT, STIFF = 300.0, 3000.0  # mu / R: penalties of CalculiX
CALCULIX_RINGS = [4, 6, 8]
CALCULIX = [(rings, stiffness) for rings in CALCULIX_RINGS for stiffness in (SOFT, STIFF)]
OVERLAP = 0.005  # R


def meshes(rings: int, overlap: float = 0.0) -> dict[str, Mesh]:
    return {"soft": half_disc(rings, overlap - 1), "stiff": half_disc(rings + rings // 4, 1 - overlap)}


def by_getfem(law: str, rings: int) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """[approaches] forces of a plate on whole discs, and half outlines."""
    from foreign.getfem_bodies import Bodies  # GetFEM is installed only with --full

    bodies = Bodies(law, meshes(rings), MODULI, {"low": -2.0, "high": 2.0})
    bodies.press("soft", "low", -1)
    bodies.press("stiff", "high", 1)
    bodies.touch("stiff", "soft")
    loads = [{"low": -2 * (1 - approach), "high": 2 * (1 - approach)} for approach in APPROACHES]
    return bodies.go(loads, [STEPS] * len(loads), lambda: bodies.plate_force("soft", "low", -1) +
                     bodies.plate_force("stiff", "high", 1))


def by_calculix(rings: int, stiffness: float, folder: Path) -> np.ndarray:
    """[approaches reached] forces on a plate, with the law `melody` and a penalty in mu / R.

    Discs and plates overlap at the start, so that nothing is loose; the first step removes the overlap.
    """
    deck = Deck(stiffness, meshes(rings, OVERLAP), MODULI)
    deck.add_plate("LOW", -3, -2 + 2 * OVERLAP, "up")
    deck.add_plate("HIGH", 2 - 2 * OVERLAP, 3, "down")
    for slave, master in (("SOFTDOWN", "LOWFACE"), ("STIFFUP", "HIGHFACE"), ("STIFFDOWN", "SOFTUP")):
        deck.touch(slave, master)
    for approach in APPROACHES[:CALCULIX_REACHES]:
        deck.step({"LOW": 0.0, "HIGH": 4 * (OVERLAP - approach)}, 0.1)
    forces = deck.forces(folder / f"discs_{rings}_{stiffness:g}")
    return forces["LOW"] - forces["HIGH"]  # of two halves


def opinion_of(by_rings: np.ndarray) -> Opinion:
    """Opinion from [meshes x approaches]. The error is the largest change from a mesh half as fine, as at one approach
    it may be accidentally small."""
    return Opinion(by_rings[-1], largest(np.abs(by_rings[-2] / by_rings[-1] - 1)))


def calculix_by_rings() -> np.ndarray:
    """[meshes x approaches] forces of rigid contact: the penalty's error is of order 1 / K."""
    soft, stiff = (read("discs_calculix_melody").of(stiffness=stiffness) for stiffness in (SOFT, STIFF))
    return to_rigid_contact(soft, stiff, STIFF / SOFT)


class Squeeze(Setup):
    """Setup by the nodes of the soft disc, with facets (way 0) or corners at all poles."""

    WAYS, LEVELS, AXIS, STORED = 2, APPROACHES, 3.0, 8.0

    @property
    def outlines(self) -> tuple[int, int]:
        return SIZES[self.size][::2]

    @property
    def spacing(self) -> float:
        """Mean spacing of both outlines, R."""
        return 2 * np.pi * np.mean(1 / np.array(self.outlines))

    def scene(self, case: Case) -> str:
        up = speeds([-GAP, *(2 * approach for approach in APPROACHES)], self.pause, RAMP)
        soft, stiff_nodes, stiff = SIZES[self.size]
        turns = [np.pi / count if self.way == 0 else 0.0 for count in self.outlines]
        return case.scene("discs.toml", levels=APPROACHES, end=float(self.rests[-1]), rest=self.pause, law=self.law,
                          soft_nodes=self.size, stiff_nodes=stiff_nodes, soft_outline=soft, stiff_outline=stiff,
                          soft_angle=turns[0], stiff_angle=turns[1], stiffness=self.stiffness,
                          bearings=self.bearings(), up=up, down=[[t, -v] for t, v in up])

    def bearings(self) -> str:
        """Springs on the segment at each pole, or on the two that meet in a corner there."""
        return "\n".join(f"""[[boundary]]
of = "{name}"
part = {{ angles = [{pole - 1.2 * np.pi / count!r}, {pole + 1.2 * np.pi / count!r}] }}
x = "fixed"
stiffness = {HOLD * count / (2 * np.pi * (self.way + 1))!r}
""" for name, count in zip(MODULI, self.outlines) for pole in (np.pi / 2, -np.pi / 2))

    def forces(self, run: Run) -> tuple[np.ndarray, np.ndarray]:
        """[approaches] force of a plate, and gap between the plates."""
        upper, lower = (run.at(f"{name}.force_y", self.rests) for name in ("upper", "lower"))
        return (upper - lower) / 2, 2 * run.at("plate.position_y", self.rests)


class Discs(RestStudy):
    """Study of Squeezes."""

    name, places = "discs", [f"at {100 * approach:g} %" for approach in APPROACHES]
    compared, between = range(len(APPROACHES)), range(CALCULIX_REACHES)
    bodies, table = tuple(MODULI), "discs_outlines"
    group = largest
    own = "saw tooth between corners and facets, penalty"
    others = {"GetFEM": "GetFEM 5.4.2 and its difference of two meshes",
              "CalculiX": "CalculiX 2.20, its mesh and penalty"}
    both = "mesh of both, penalty"
    order = ("force over GetFEM, rms of approaches",
             "linear consistency and a polygon for a circle; scatter of the saw tooth")
    shape = "corners of the polygon of the circle's area; overlap of the penalty; mesh as for the force"

    def __init__(self, case: Case, law: str) -> None:
        super().__init__(case, law, [Squeeze(size=size, law=law) for size in CHOSEN[law]])

    @classmethod
    def read_getfem(cls, law: str) -> Opinion:
        return opinion_of(read(f"discs_getfem_{law}").of())

    @classmethod
    def read_calculix(cls) -> Opinion:
        """Error: the largest change by halving the rings plus the product of both losses, second order of the penalty.
        """
        by_rings = calculix_by_rings()
        losses = 1 - read("discs_calculix_melody").of(rings=CALCULIX_RINGS[-1]) / by_rings[-1]
        return Opinion(by_rings[-1], np.abs(by_rings[0] / by_rings[-1] - 1).max() + losses.prod(axis=0))

    def slope_error(self) -> float:
        """Error of the slope from independent saw teeth of all sizes."""
        return self.slope_error_of(np.sqrt((self.saw**2).mean(axis=1)), 0.0)

    def shape_error(self, body: int, level: int) -> float:
        """R. The plate's approach that changes the force by its error. Corners protrude by x^2/12, and the contact's
        overlap is the penalty's part of the approach."""
        approach_by_force = 4 / np.gradient(np.log(self.getfem.force), APPROACHES)[level]
        corners = self.setups[-1].outlines[body]
        return float((2 * np.pi / corners) ** 2 / 12 + self.lost(level) * approach_by_force / 2)


@cache
def live(law: str) -> np.ndarray:
    """[meshes x approaches] live forces by GetFEM on the two coarsest meshes."""
    return np.array([by_getfem(law, rings)[0] for rings in RINGS[law][:2]])


def getfem_again(law: str, _: Path) -> np.ndarray:
    return live(law) / read(f"discs_getfem_{law}").of()[:2] - 1


def calculix_again(folder: Path) -> np.ndarray:
    return np.array([by_calculix(*run, folder) for run in CALCULIX]) / read("discs_calculix_melody").of() - 1


AGAIN: list[Again] = [
    *((f"discs, {law}: GetFEM", partial(getfem_again, law), 1.5e-7,
       "Newton's residuals of 1e-9 in some fifty nodes on a plate, over the smallest force") for law in LAWS),
    ("discs, melody: CalculiX", calculix_again, 3e-5,
     "termination of its Newton's method: change by steps four times shorter")]
