"""Writes a result folder as a run would, with made-up mechanics: a sheared packing between two bumpy walls.

    /usr/bin/python3 tests/scripts/synthetic_run.py FOLDER [COLUMNS ROWS RINGS]
"""

import sys
from pathlib import Path

import h5py
import numpy as np
from matplotlib.tri import Triangulation

DIAMETER, PITCH, ROW_PITCH, END = 1e-6, 0.87e-6, 1.002e-6, 18.5e-6


def disc(rings: int) -> tuple[np.ndarray, np.ndarray]:
    """Points and triangles of a disc about the origin: rings of 6, 12, ... points; the last ring is the outline."""
    angle = [2 * np.pi * np.arange(6 * r) / (6 * r) for r in range(1, rings + 1)]
    radius = [np.full(6 * r, 0.5 * DIAMETER * r / rings) for r in range(1, rings + 1)]
    rho, phi = np.concatenate([[0.0], *radius]), np.concatenate([[0.0], *angle])
    points = np.column_stack([rho * np.cos(phi), rho * np.sin(phi)])
    return points, Triangulation(points[:, 0], points[:, 1]).triangles


def wall(columns: int, y: float, sign: float) -> np.ndarray:
    """[points x 2] of an open line of bumps over one period."""
    x = np.linspace(0, columns * PITCH, 12 * columns, endpoint=False)
    return np.column_stack([x, y + sign * 0.3e-6 * np.abs(np.sin(np.pi * x / PITCH))])


def line_cells(count: int, start: int, closed: bool) -> np.ndarray:
    return start + np.column_stack([np.arange(count), (np.arange(count) + 1) % count])[: count - (not closed)]


class Packing:
    """Grains, kinds and topology of the made-up scene."""

    def __init__(self, columns: int, rows: int, rings: int) -> None:
        self.points, self.triangles = disc(rings)
        self.ring = np.arange(len(self.points) - 6 * rings, len(self.points))
        lattice = [((i + 0.5) * PITCH, (j + 0.5 * (i % 2)) * ROW_PITCH) for j in range(rows) for i in range(columns)]
        self.centres, self.height = np.array(lattice), rows * ROW_PITCH
        self.kind = np.random.default_rng(1).integers(0, 2, len(self.centres))
        self.walls = [wall(columns, -ROW_PITCH, 1.0), wall(columns, self.height + 0.5e-6, -1.0)]

    def write_topology(self, file: h5py.File) -> None:
        grains, ring = len(self.centres), len(self.ring)
        cells = self.triangles[None] + (np.arange(grains) * len(self.points))[:, None, None]
        starts = grains * ring + np.cumsum([0, len(self.walls[0])])
        lines = [line_cells(ring, g * ring, True) for g in range(grains)]
        lines += [line_cells(len(w), s, False) for w, s in zip(self.walls, starts)]
        self._write_grid(file, "bodies", cells.reshape(-1, 3), np.full(grains, len(self.triangles)))
        self._write_grid(file, "outlines", np.concatenate(lines), np.array([len(line) for line in lines]))

    def _write_grid(self, file: h5py.File, name: str, cells: np.ndarray, per_body: np.ndarray) -> None:
        kinds = np.concatenate([self.kind, [2, 2]])[: len(per_body)]
        file[f"{name}/cells"] = cells.astype("i4")
        file[f"{name}/kind"] = np.repeat(kinds, per_body).astype("f4")
        file[f"{name}/body"] = np.repeat(np.arange(len(per_body)), per_body).astype("f4")

    def write_frame(self, file: h5py.File, index: int, time: float) -> None:
        random = np.random.default_rng(index)
        shear, share = 10.0 * max(time - 1e-6, 0.0), self.centres[:, 1] / self.height
        centres = self.centres + np.column_stack([shear * share, np.zeros(len(share))])
        squeeze = 1 - 0.06 * (self.kind == 0)
        grains = centres[:, None] + self.points[None] * squeeze[:, None, None]
        velocity = np.zeros((*grains.shape[:2], 3))
        velocity[:, :, 0] = (10.0 * share * (time > 1e-6) + random.normal(0, 0.3, len(share)))[:, None]
        radius = np.linalg.norm(self.points[self.triangles].mean(axis=1), axis=1)
        level = 4e8 * random.uniform(0.3, 1, len(share)) * (self.kind == 0)
        stress = level[:, None] * (1 - 3 * (radius / DIAMETER) ** 2)
        outlines = [grains[:, self.ring].reshape(-1, 2), self.walls[0], self.walls[1] + np.array([shear, 0.0])]
        file[f"bodies/{index:06}/position"] = grains.reshape(-1, 2).astype("f4")
        file[f"bodies/{index:06}/velocity"] = velocity.reshape(-1, 3).astype("f4")
        file[f"bodies/{index:06}/von_mises"] = stress.ravel().astype("f4")
        file[f"outlines/{index:06}/position"] = np.concatenate(outlines).astype("f4")


def write_frames(folder: Path, columns: int, rows: int, rings: int, frames: int) -> None:
    packing = Packing(columns, rows, rings)
    with h5py.File(folder / "frames.h5", "w") as file:
        file["times"] = np.linspace(0, END, frames)
        packing.write_topology(file)
        for index, time in enumerate(np.linspace(0, END, frames)):
            packing.write_frame(file, index, time)


def write_probes(folder: Path, columns: int) -> None:
    """Friction factor: peak 0.5 at 1.4 us, plateau 0.25; sampled half as often as the forces."""
    random, time = np.random.default_rng(2), np.linspace(0, END, 3701)
    load = np.minimum(time / 1e-6, 1)
    normal = -1e9 * columns * PITCH * load
    friction = np.where(time > 1e-6, 0.25 + 0.25 * np.exp(-(((time - 1.4e-6) / 3e-7) ** 2)), 0)
    energies = [1e-3 * load * k for k in (0.2, 3, 1)] + [2e3 * time, 4.2e-3 + 2e3 * time]
    errors = [1e-4 * (1 - np.cos(1e7 * time)), 1e-14 * random.uniform(0, 1, len(time))]
    names = ["time [s]", "force.force_x [N/m]", "force.force_y [N/m]", "friction.friction_factor [-]"]
    names += [f"energy.{n} [J/m]" for n in ("kinetic", "strain", "contact", "dissipated", "external_work")]
    names += ["energy.balance_error [-]", "energy.momentum_error [-]", "place.position_x [m]", "place.position_y [m]"]
    place = [10.0 * np.maximum(time - 1e-6, 0.0), 0.0 * time]
    rows = np.column_stack([time, -friction * normal, normal, friction, *energies, *errors, *place])
    rows[1::2, 3] = np.nan
    lines = [",".join("" if np.isnan(v) else repr(float(v)) for v in row) for row in rows]
    (folder / "probes.csv").write_text("\n".join([",".join(names), *lines]) + "\n")


def write_steps(folder: Path, count: int = 50000) -> None:
    random, time, step = np.random.default_rng(3), np.linspace(1e-12, END, count), np.arange(count)
    dt = 2e-12 * (1 + 0.8 * np.exp(-time / 2e-6)) * random.uniform(0.5, 1.1, count)
    error, contacts = 1e-4 * random.lognormal(0, 0.4, count), 6000 + random.integers(0, 50, count)
    table = np.column_stack([time, dt, error, step // 11, 2 * step, contacts])
    header = "time [s],dt [s],error [-],rejections,evaluations,contacts"
    np.savetxt(folder / "steps.csv", table, fmt="%.17g", delimiter=",", header=header, comments="")


def write_run(folder: Path, columns: int = 10, rows: int = 6, rings: int = 3, frames: int = 6) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    write_frames(folder, columns, rows, rings, frames)
    write_probes(folder, columns)
    write_steps(folder)
    probes = '[[probes]]\nname = "force"\nof = "lower"\n[[probes]]\nname = "friction"\nof = "lower"\n'
    probes += '[[probes]]\nname = "place"\nof = "upper"\n'
    domain = f'[domain]\nperiod = "{columns * PITCH * 1e6:.10g} um"\n'
    (folder / "scene.toml").write_text(f'title = "Synthetic"\n{domain}[time]\ntolerance = 1e-3\n{probes}')
    (folder / "summary.json").write_text("{}\n")


if __name__ == "__main__":
    write_run(Path(sys.argv[1]), *(int(a) for a in sys.argv[2:]))
