"""Writes oracles/: /usr/bin/python3 verify/two_bodies/make_two_bodies_oracles.py [LAW...]. Half an hour for both laws.

Two discs between plates by GetFEM: forces on meshes of several sizes, and outlines.
"""

from __future__ import annotations

import csv
import sys
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from foreign.calculix_deck import Deck
from foreign.meshes import half_disc

FOLDER = Path(__file__).parent / "oracles"
APPROACHES = [0.1, 0.2, 0.3, 0.4]  # over the sum of both diameters
MODULI = {"soft": 1.0, "stiff": 2.0}  # mu; lambda = 4 mu
STEPS = 2  # of the load, an approach
# Of the soft disc; the stiff one has a quarter more, so that nodes do not match.
RINGS = {"neo-hookean": [8, 16, 32, 64], "melody": [8, 16]}
OUTLINE_RINGS = 24
CALCULIX_REACHES = 3  # approaches: beyond 33 % its Newton's method fails with all steps and penalties that were tried
CALCULIX = [(rings, penalty) for rings in (4, 6, 8) for penalty in (300.0, 3000.0)]
OVERLAP = 0.005  # R


@dataclass
class Squeezed:
    """By one solver on one mesh, at all approaches."""

    force: np.ndarray  # [approaches] of a plate on whole discs
    outlines: dict[str, np.ndarray]  # [approaches x nodes x 2] of the halves x >= 0, from the lowest point up


def by_getfem(law: str, rings: int) -> Squeezed:
    from foreign.getfem_bodies import Bodies  # GetFEM is there with --full alone

    bodies = Bodies(law, {"low": -2.0, "high": 2.0})
    bodies.add("soft", half_disc(rings, -1), MODULI["soft"], 4 * MODULI["soft"])
    bodies.add("stiff", half_disc(rings + rings // 4, 1), MODULI["stiff"], 4 * MODULI["stiff"])
    for name in MODULI:
        bodies.hold_axis(name)
    bodies.press("soft", "low", -1)
    bodies.press("stiff", "high", 1)
    bodies.touch("stiff", "soft")
    force, outlines = [], {name: [] for name in MODULI}
    for approach in APPROACHES:
        bodies.load({"low": -2 * (1 - approach), "high": 2 * (1 - approach)}, STEPS)
        force.append(bodies.plate_force("soft", "low", -1) + bodies.plate_force("stiff", "high", 1))  # of two halves
        for name, places in outlines.items():
            places.append(bodies.outline(name))
    return Squeezed(np.array(force), {name: np.array(places) for name, places in outlines.items()})


def by_calculix(rings: int, stiffness: float, folder: Path) -> np.ndarray:
    """[approaches it gets to] forces on a plate, by the law `melody` and a penalty of so many mu / R.

    Discs and plates overlap at the start, by what the first step takes back: nothing is loose.
    """
    deck = Deck(stiffness)
    for name, side, more in (("SOFT", -1, 0), ("STIFF", 1, rings // 4)):
        mu = MODULI[name.lower()]
        deck.add(name, half_disc(rings + more, side * (1 - OVERLAP)), mu, 4 * mu)
    deck.add_plate("LOW", -3, -2 + 2 * OVERLAP, "up")
    deck.add_plate("HIGH", 2 - 2 * OVERLAP, 3, "down")
    for slave, master in (("SOFTDOWN", "LOWFACE"), ("STIFFUP", "HIGHFACE"), ("STIFFDOWN", "SOFTUP")):
        deck.touch(slave, master)
    for approach in APPROACHES[:CALCULIX_REACHES]:
        deck.step({"LOW": 0.0, "HIGH": 4 * (OVERLAP - approach)}, 0.1)
    forces = deck.forces(folder / f"discs_{rings}_{stiffness:g}")
    return forces["LOW"] - forces["HIGH"]  # of two halves


def write(name: str, header: list[str], rows: list[list[float]]) -> None:
    with (FOLDER / f"{name}.csv").open("w", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(header)
        writer.writerows([[f"{value:.9g}" for value in row] for row in rows])


def write_forces(law: str) -> None:
    write(f"discs_getfem_{law}", ["rings", *(f"force_{100 * approach:g}" for approach in APPROACHES)],
          [[rings, *by_getfem(law, rings).force] for rings in RINGS[law]])


def write_outlines(law: str) -> None:
    """Every second node."""
    found = by_getfem(law, OUTLINE_RINGS).outlines
    rows = [[i, *places.ravel()] for i, name in enumerate(MODULI) for places in found[name].transpose(1, 0, 2)[::2]]
    write(f"discs_outlines_{law}",
          ["body", *(f"{axis}_{100 * approach:g}" for approach in APPROACHES for axis in "xy")], rows)


def calculix_rows(folder: Path) -> list[list[float]]:
    """Rings, penalty and forces."""
    return [[rings, stiffness, *by_calculix(rings, stiffness, folder)] for rings, stiffness in CALCULIX]


def write_calculix() -> None:
    with TemporaryDirectory() as folder:
        rows = calculix_rows(Path(folder))
    names = [f"force_{100 * approach:g}" for approach in APPROACHES[:CALCULIX_REACHES]]
    write("discs_calculix_melody", ["rings", "stiffness", *names], rows)


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    for law in sys.argv[1:] or RINGS:
        write_forces(law)
    write_outlines("neo-hookean")
    write_calculix()
