"""Bodies at large strain in contact, by CalculiX (ccx 2.20): quadratic triangles in plane strain, surface contact by
penalty, optional Coulomb friction.

*HYPERELASTIC, NEO HOOKE is psi = C10 (J^(-2/3) I1 - 3) + (J - 1)^2 / D1, which is the law `melody` with C10 = mu/2,
D1 = 2/K (docs/method.md, section 3).
"""

from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path

import numpy as np

from foreign.meshes import PLAIN, Mesh, Where

PLATE_CELLS, PLATE_FROM, PLATE_TO = 6, -0.5, 3.0  # along x
STEEL = 1e3  # mu: of plates, all of whose nodes are prescribed
SHORTEST, STEPS = 1e-5, 1000  # shortest increment over its step, most increments
SIMPSON = np.array([1, 1, 4]) / 6  # of both ends and the middle of a side


class Failed(RuntimeError):
    """ccx did not reach the end."""


class Deck:
    """An input file, built in this order: bodies, plates and springs, then contacts, then steps."""

    def __init__(self, stiffness: float, meshes: dict[str, Mesh], moduli: dict[str, float],
                 friction: float = 0.0) -> None:
        """Tangential and normal penalty are equal; lambda = 4 mu."""
        self._nodes, self._cells = 0, 0
        self._axis: list[int] = []
        self._bodies: dict[str, tuple[int, Mesh]] = {}  # with its first node
        self._plates: list[str] = []
        self._springs: dict[str, dict[int, float]] = {}  # by node
        self._model = ["*SURFACE INTERACTION,NAME=TOUCH", "*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR",
                       f"{stiffness:.15g}"]
        if friction > 0:
            self._model += ["*FRICTION", f"{friction:.15g},{stiffness:.15g}"]
        self._steps: list[str] = []
        self._places: list[dict[str, np.ndarray]] = []  # by step
        for name, mesh in meshes.items():
            self._add(name.upper(), mesh, moduli[name])

    def _add(self, name: str, mesh: Mesh, mu: float) -> None:
        """A body, with the surfaces <name>UP and <name>DOWN of its outline beyond 0.2 above and below its middle. A
        half body has u_x = 0 on x = 0."""
        first = self._place(mesh.points)
        self._bodies[name] = first, mesh
        if mesh.half:
            self._axis += list(first + np.flatnonzero(np.abs(mesh.points[:, 0]) < PLAIN))
        before = self._connect(name, "CPE6", first + mesh.cells)
        middle = (mesh.points[:, 1].max() + mesh.points[:, 1].min()) / 2
        heights = mesh.side_middles()[:, 1] - middle
        for surface, there in (("UP", heights > 0.2), ("DOWN", heights < -0.2)):
            self._surface(name + surface, [(before + cell, side) for cell, side in mesh.outline[there]])
        bulk = 4 * mu + 2 * mu / 3
        self._material(name, ["*HYPERELASTIC,NEO HOOKE", f"{mu / 2:.15g},{2 / bulk:.15g}"])

    def add_plate(self, name: str, low: float, high: float, faces: str) -> None:
        """From y = low to y = high; its surface <name>FACE is up or down."""
        x = np.linspace(PLATE_FROM, PLATE_TO, PLATE_CELLS + 1)
        first = self._place(np.array([[at, y] for y in (low, high) for at in x]))
        i = np.arange(PLATE_CELLS)
        row = PLATE_CELLS + 1
        before = self._connect(name, "CPE4", first + np.stack([i, i + 1, row + i + 1, row + i], axis=1))
        self._surface(name + "FACE", [(before + cell, 2 if faces == "up" else 0) for cell in i])
        self._material(name, ["*ELASTIC", f"{STEEL:g},0.3"])
        self._model += [f"*NSET,NSET=ALL{name}", *(str(first + k) for k in range(2 * row))]
        self._plates.append(name)

    def hold(self, body: str, where: Where, stiffness: float, name: str) -> None:
        """Springs of this stiffness per length along x and y on the selected outline, by Simpson's rule on each side.
        Loads move their other ends like a plate: ccx 2.20 fails with springs between two nodes (SPRING2)."""
        first, mesh = self._bodies[body]
        springs = self._springs[name] = {}
        for cell, side in mesh.outline[where(mesh.side_middles())]:
            nodes = mesh.side_nodes(cell, side)
            a, b, middle = mesh.points[nodes]
            ways = np.array([4 * middle - 3 * a - b, 3 * b + a - 4 * middle, b - a])  # by a parameter from 0 to 1
            for node, share in zip(nodes, SIMPSON * np.linalg.norm(ways, axis=1)):
                springs[first + node] = springs.get(first + node, 0.0) + stiffness * share
        self._model += [f"*NSET,NSET=ALL{name}", *map(str, springs)]
        for node, stiff in springs.items():
            for axis in (1, 2):
                self._cells += 1
                own = f"S{self._cells}"
                self._model += [f"*ELEMENT,TYPE=SPRING1,ELSET={own}", f"{self._cells},{node}", f"*SPRING,ELSET={own}",
                                str(axis), f"{stiff:.15g}"]

    def touch(self, slave: str, master: str) -> None:
        self._model += ["*CONTACT PAIR,INTERACTION=TOUCH,TYPE=SURFACE TO SURFACE", f"{slave},{master}"]

    def step(self, heights: dict[str, float], increment: float, asides: dict[str, float] | None = None) -> None:
        """A step that moves plates and ends of springs up, and these ends aside, to these distances from the start.
        `increment` is its share of the step."""
        places = {name: np.array([(asides or {}).get(name, 0.0), height]) for name, height in heights.items()}
        self._places.append(places)
        self._steps += [f"*STEP,NLGEOM,INC={STEPS}", "*STATIC", f"{increment:g},1.,{SHORTEST:g},{increment:g}"]
        for name in self._plates:
            self._steps += ["*BOUNDARY", f"ALL{name},2,2,{heights[name]:.15g}"]
        for name, springs in self._springs.items():
            self._steps += ["*CLOAD", *(f"{node},{axis + 1},{stiff * places[name][axis]:.15g}" for axis in (0, 1)
                                        if axis == 1 or asides for node, stiff in springs.items())]
        for name in self._plates:
            self._steps += [f"*NODE PRINT,NSET=ALL{name},TOTALS=ONLY", "RF"]
        for name in self._springs:
            self._steps += [f"*NODE PRINT,NSET=ALL{name}", "U"]
        self._steps += ["*END STEP"]

    def forces(self, job: Path, all_steps: bool = True) -> dict[str, np.ndarray]:
        """Runs ccx. Returns by plate [steps] its holding force along y, and by support of springs [steps x 2] that
        along x and y, at the end of each step that ccx reaches."""
        axis = ["*NSET,NSET=AXIS", *map(str, self._axis), "*BOUNDARY", "AXIS,1,1"] if self._axis else []
        held = [*axis, *(f"ALL{name},1,1" for name in self._plates)]
        job.with_suffix(".inp").write_text("\n".join([*self._model, *held, *self._steps]) + "\n")
        result = subprocess.run(["ccx", job.name], cwd=job.parent, capture_output=True, text=True,
                                stdin=subprocess.DEVNULL, env=os.environ | {"OMP_NUM_THREADS": "1"})
        if all_steps and result.returncode != 0:
            raise Failed(f"{job}: exit code {result.returncode}\n{result.stdout[-2000:]}")
        text = job.with_suffix(".dat").read_text()
        forces = {}
        for name in self._plates:
            rows = re.findall(rf"for set ALL{name} and time\s+(\S+)\s+\S+\s+(\S+)", text)
            forces[name] = np.array([float(force) for time, force in rows if ends_step(time)])
        for name, springs in self._springs.items():
            tables = re.findall(rf"for set ALL{name} and time\s+(\S+)\n\s+([^a-z]+)", text)
            moved = [{int(node): np.array([float(x), float(y)]) for node, x, y, _ in np.reshape(table.split(), (-1, 4))}
                     for time, table in tables if ends_step(time)]
            forces[name] = np.array([sum(stiff * (places[name] - u[node]) for node, stiff in springs.items())
                                     for places, u in zip(self._places, moved)]).reshape(-1, 2)
        return forces

    def _place(self, points: np.ndarray) -> int:
        """Number of the first of these nodes."""
        first = self._nodes + 1
        self._model += ["*NODE", *(f"{first + i},{x:.15g},{y:.15g},0." for i, (x, y) in enumerate(points))]
        self._nodes += len(points)
        return first

    def _connect(self, name: str, kind: str, cells: np.ndarray) -> int:
        """Number of the first of these elements."""
        first = self._cells + 1
        self._model += [f"*ELEMENT,TYPE={kind},ELSET=E{name}",
                        *(",".join(map(str, [first + i, *cell])) for i, cell in enumerate(cells))]
        self._cells += len(cells)
        return first

    def _surface(self, name: str, sides: list[tuple[int, int]]) -> None:
        self._model += [f"*SURFACE,NAME={name},TYPE=ELEMENT", *(f"{cell},S{side + 1}" for cell, side in sides)]

    def _material(self, name: str, lines: list[str]) -> None:
        self._model += [f"*MATERIAL,NAME=M{name}", *lines, f"*SOLID SECTION,ELSET=E{name},MATERIAL=M{name}", "1."]


def ends_step(time: str) -> bool:
    return abs(float(time) - round(float(time))) < 1e-6
