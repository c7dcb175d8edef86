"""Writes oracles/: /usr/bin/python3 verify/polygon_on_disc/make_polygon_on_disc_oracles.py. Or those of neo-hookean,
melody, calculix, as named. Half an hour.

A hexagon pressed into a disc without friction, a corner or a face first, by GetFEM and CalculiX: forces on meshes
of several sizes, and outlines.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from datetime import date
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from foreign.calculix_deck import Deck
from foreign.meshes import Mesh, fan, half_disc

FOLDER = Path(__file__).parent / "oracles"
DEPTHS = [0.1, 0.2, 0.4, 0.6]  # R
MODULI = {"disc": 1.0, "hexagon": 2.0}  # mu; lambda = 4 mu
HOLD = 100.0  # mu / R: of the springs
FIRST = ("corner", "face")  # what touches first
RINGS = [8, 16, 32]  # of the disc; the hexagon has a quarter more
SWAPPED = [8, 16]  # with the hexagon as slave
SWAPPED_MELODY = {"corner": [8, 12], "face": [8, 16]}  # with 16 rings a corner stops at 0.549 R
LONGEST = 0.05  # R, of a load step
INCREMENT = 0.02  # R, of CalculiX
SOFT, BETWEEN, STIFF = 300.0, 1000.0, 3000.0  # mu / R: penalties of CalculiX
COARSE, FINE = 6, 12  # its rings of the disc; COARSE with either slave and all penalties
CALCULIX = [*((rings, "disc", stiffness) for rings in (COARSE, 8, FINE) for stiffness in (SOFT, STIFF)),
            (COARSE, "disc", BETWEEN), (COARSE, "hexagon", SOFT), (COARSE, "hexagon", STIFF)]
MELODY = "_melody"  # in names of files
GETFEM = "GetFEM 5.4.2, quadratic triangles, augmented Lagrangian, large sliding by ray tracing."
CALCULIX_SAYS = "CalculiX 2.20, CPE6, contact of surfaces by a linear penalty of `stiffness` mu / R."
COLUMNS = "first,slave,rings,force_" + ",force_".join(f"{depth:g}" for depth in DEPTHS)


def corners(first: str) -> np.ndarray:
    """[6 x 2] of the hexagon, counter-clockwise from the lowest on the right."""
    angles = np.pi / 3 * np.arange(6) - np.pi / (2 if first == "corner" else 3)
    return np.stack([np.cos(angles), np.sin(angles)], axis=1)


def height(first: str) -> float:
    """Of the centre above what is lowest."""
    return 1.0 if first == "corner" else float(np.sqrt(0.75))


def half_hexagon(first: str, t: np.ndarray) -> np.ndarray:
    """[n x 2] of the half x >= 0 about the origin, from below, at shares of its length."""
    places = corners(first)[:4]
    if first == "face":
        places = np.concatenate([[[0, -height(first)]], corners(first)[:3], [[0, height(first)]]])
    lengths = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(places, axis=0), axis=1))])
    x, y = (np.interp(t, lengths / lengths[-1], places[:, axis]) for axis in range(2))
    return np.stack([np.where(np.abs(t - 0.5) < 0.5, x, 0.0), y], axis=1)


def hexagon_mesh(first: str, rings: int) -> Mesh:
    """To a disc of so many rings."""
    return fan(lambda t: half_hexagon(first, t), (0.0, height(first)), rings + rings // 4, 6)


def held_above(first: str) -> float:
    """Where the hexagon's upper sides begin."""
    return height(first) + (0.5 if first == "corner" else 0.0)


@dataclass
class Pressed:
    """By GetFEM on one mesh, at all depths."""

    force: np.ndarray  # [depths] of the hexagon on the disc
    outlines: dict[str, np.ndarray]  # [depths x nodes x 2] of the halves x >= 0, from the lowest point up


def by_getfem(first: str, rings: int, slave: str = "disc", law: str = "neo-hookean") -> Pressed:
    from foreign.getfem_bodies import Bodies  # GetFEM is there with --full alone

    bodies = Bodies(law, {"down": 0.0})
    bodies.add("disc", half_disc(rings, -1), MODULI["disc"], 4 * MODULI["disc"])
    bodies.add("hexagon", hexagon_mesh(first, rings), MODULI["hexagon"], 4 * MODULI["hexagon"])
    for name in MODULI:
        bodies.hold_axis(name)
    bodies.hold("disc", lambda middles: middles[:, 1] < -1, HOLD, "0", "0")
    bodies.hold("hexagon", lambda middles: middles[:, 1] > held_above(first), HOLD, "0", "down")
    bodies.touch(slave, "hexagon" if slave == "disc" else "disc")
    force, outlines, before = [], {name: [] for name in MODULI}, 0.0
    for depth in DEPTHS:
        bodies.load({"down": -depth}, round((depth - before) / LONGEST))
        before = depth
        force.append(2 * bodies.holding_force("disc")[1])
        for name, places in outlines.items():
            places.append(bodies.outline(name))
    return Pressed(np.array(force), {name: np.array(places) for name, places in outlines.items()})


def by_calculix(first: str, rings: int, slave: str, stiffness: float, folder: Path) -> np.ndarray:
    """[depths, nan beyond what it gets to] forces of the hexagon on the disc, by the law `melody` and a penalty of so
    many mu / R."""
    deck = Deck(stiffness)
    for name, mesh in (("disc", half_disc(rings, -1)), ("hexagon", hexagon_mesh(first, rings))):
        deck.add(name.upper(), mesh, MODULI[name], 4 * MODULI[name])
    deck.hold("DISC", lambda middles: middles[:, 1] < -1, HOLD, "GROUND")
    deck.hold("HEXAGON", lambda middles: middles[:, 1] > held_above(first), HOLD, "RAM")
    deck.touch(*(("DISCUP", "HEXAGONDOWN") if slave == "disc" else ("HEXAGONDOWN", "DISCUP")))
    before = 0.0
    for depth in DEPTHS:
        deck.step({"GROUND": 0.0, "RAM": -depth}, INCREMENT / (depth - before))
        before = depth
    found = deck.forces(folder / f"{first}_{rings}_{slave}_{stiffness:g}", all_steps=False)["GROUND"][:, 1]
    return 2 * np.pad(found, (0, len(DEPTHS) - len(found)), constant_values=np.nan)  # of two halves


def calculix_row(first: str, rings: int, slave: str, stiffness: float, folder: Path) -> list[float]:
    """As in polygon_on_disc_calculix_melody.csv."""
    force = by_calculix(first, rings, slave, stiffness, folder)
    return [FIRST.index(first), list(MODULI).index(slave), rings, stiffness, *force]


def write(name: str, columns: str, rows: list[list[float]], what: str, solver: str = GETFEM) -> None:
    header = [f"# {what}", f"# {solver}",
              f"# {date.today()}, make_polygon_on_disc_oracles.py, one thread. Units mu = R = 1 of the disc.", columns]
    np.savetxt(FOLDER / f"{name}.csv", np.array(rows), "%.9g", ",", header="\n".join(header), comments="")


def main(made: list[str]) -> None:
    FOLDER.mkdir(exist_ok=True)
    for name in made:
        MAKERS[name]()


def write_getfem(law: str) -> None:
    rows = []
    for i, first in enumerate(FIRST):
        swapped = SWAPPED_MELODY[first] if law == "melody" else SWAPPED
        for k, rings in [*((0, rings) for rings in sorted({*RINGS, *swapped})), *((1, rings) for rings in swapped)]:
            found = by_getfem(first, rings, tuple(MODULI)[k], law)
            rows.append([i, k, rings, *found.force])
            print(first, k, rings, found.force, flush=True)
            write("polygon_on_disc_getfem" + MELODY * (law == "melody"), COLUMNS, rows,
                  "Force by depth. first 0: a corner, 1: a face. slave 0: the disc, 1: the hexagon.")
            if (law, k, rings) == ("neo-hookean", 0, RINGS[1]):
                write_outlines(first, found)


def write_calculix() -> None:
    rows = []
    for first in FIRST:
        for rings, slave, stiffness in CALCULIX:
            with TemporaryDirectory() as folder:
                rows.append(calculix_row(first, rings, slave, stiffness, Path(folder)))
            print(first, rings, slave, stiffness, rows[-1], flush=True)
            write("polygon_on_disc_calculix_melody", COLUMNS.replace("rings", "rings,stiffness"), rows,
                  "Force by depth, law melody. first 0: a corner, 1: a face. slave 0: the disc, 1: the hexagon.",
                  CALCULIX_SAYS)


def write_outlines(first: str, found: Pressed) -> None:
    outlines = [[k, *places.ravel()] for k, name in enumerate(MODULI)
                for places in found.outlines[name].transpose(1, 0, 2)]
    write(f"polygon_on_disc_{first}_outlines", ",".join(["body", *(f"{axis}_{depth:g}" for depth in DEPTHS
                                                                  for axis in "xy")]), outlines,
          f"Half outlines from the lowest point up, {RINGS[1]} rings; body 0: disc, 1: hexagon.")


MAKERS = {"neo-hookean": lambda: write_getfem("neo-hookean"), "melody": lambda: write_getfem("melody"),
          "calculix": write_calculix}

if __name__ == "__main__":
    main(sys.argv[1:] or list(MAKERS))
