"""Writes a result folder as a run would, with made-up mechanics: a sheared packing between two bumpy walls.

    /usr/bin/python3 tests/scripts/synthetic_run.py FOLDER [COLUMNS ROWS RINGS]
"""

import sys
from pathlib import Path

import h5py
import numpy as np

DIAMETER, PITCH, ROW_PITCH, END = 1e-6, 0.87e-6, 1.002e-6, 18.5e-6


def disc(rings: int) -> tuple[np.ndarray, np.ndarray]:
    """Points and triangles of a disc about the origin: rings of 6, 12, ... points; the last ring is the outline."""
    angle = [2 * np.pi * np.arange(6 * r) / (6 * r) for r in range(1, rings + 1)]
    radius = [np.full(6 * r, 0.5 * DIAMETER * r / rings) for r in range(1, rings + 1)]
    rho, phi = np.concatenate([[0.0], *radius]), np.concatenate([[0.0], *angle])
    points = np.column_stack([rho * np.cos(phi), rho * np.sin(phi)])
    from matplotlib.tri import Triangulation

    return points, Triangulation(points[:, 0], points[:, 1]).triangles


def wall(columns: int, y: float, sign: float) -> np.ndarray:
    """[points x 2] of an open line of bumps over one period."""
    x = np.linspace(0, columns * PITCH, 12 * columns, endpoint=False)
    return np.column_stack([x, y + sign * 0.3e-6 * np.abs(np.sin(np.pi * x / PITCH))])


def line_cells(count: int, start: int) -> np.ndarray:
    return start + np.column_stack([np.arange(count), (np.arange(count) + 1) % count])


def write_frames(folder: Path, columns: int, rows: int, rings: int, frames: int) -> None:
    random = np.random.default_rng(1)
    points, triangles = disc(rings)
    ring = np.arange(len(points) - 6 * rings, len(points))
    centres = np.array([((i + 0.5) * PITCH, (j + 0.5 * (i % 2)) * ROW_PITCH) for j in range(rows) for i in range(columns)])
    grains, height = len(centres), rows * ROW_PITCH
    kind = random.integers(0, 2, grains)
    walls = [wall(columns, -ROW_PITCH, 1.0), wall(columns, height + 0.5e-6, -1.0)]
    cells = (triangles[None] + (np.arange(grains) * len(points))[:, None, None]).reshape(-1, 3)
    starts = grains * len(ring) + np.cumsum([0, len(walls[0])])
    segments = np.concatenate([line_cells(len(ring), g * len(ring)) for g in range(grains)]
                              + [line_cells(len(w), s) for w, s in zip(walls, starts)])  # fmt: skip
    segment_kind = np.concatenate([np.repeat(kind, len(ring)), np.full(sum(map(len, walls)), 2)])
    segment_body = np.concatenate([np.repeat(np.arange(grains), len(ring)),
                                   np.repeat([grains, grains + 1], [len(w) for w in walls])])  # fmt: skip
    with h5py.File(folder / "frames.h5", "w") as file:
        file["times"] = np.linspace(0, END, frames)
        file["bodies/cells"], file["outlines/cells"] = cells.astype("i4"), segments.astype("i4")
        file["bodies/kind"] = np.repeat(kind, len(triangles)).astype("f4")
        file["bodies/body"] = np.repeat(np.arange(grains), len(triangles)).astype("f4")
        file["outlines/kind"], file["outlines/body"] = segment_kind.astype("f4"), segment_body.astype("f4")
        for f, time in enumerate(file["times"][()]):
            shear = 10.0 * max(time - 1e-6, 0.0)
            speed = 10.0 * centres[:, 1] / height * (time > 1e-6) + random.normal(0, 0.3, grains)
            moved = centres + np.column_stack([shear * centres[:, 1] / height, np.zeros(grains)])
            body = moved[:, None] + points[None] * (1 - 0.06 * (kind == 0))[:, None, None]
            bodies = file.create_group(f"bodies/{f:06}")
            bodies["position"] = body.reshape(-1, 2).astype("f4")
            velocity = np.zeros((grains, len(points), 3))
            velocity[:, :, 0] = speed[:, None]
            bodies["velocity"] = velocity.reshape(-1, 3).astype("f4")
            centroid = points[triangles].mean(axis=1)
            stress = 4e8 * (1 - 3 * (centroid**2).sum(axis=1) / DIAMETER**2) + random.normal(0, 2e7, len(triangles))
            bodies["von_mises"] = ((random.uniform(0.3, 1, grains) * (kind == 0))[:, None] * stress).ravel().astype("f4")
            outlines = file.create_group(f"outlines/{f:06}")
            upper = walls[1] + np.array([shear, 0.0])
            outlines["position"] = np.concatenate([body[:, ring].reshape(-1, 2), walls[0], upper]).astype("f4")


def write_tables(folder: Path, columns: int) -> None:
    random = np.random.default_rng(2)
    time = np.linspace(0, END, 3701)
    normal = -1e9 * columns * PITCH * np.minimum(time / 1e-6, 1) * (1 + random.normal(0, 0.01, len(time)))
    friction = np.where(time > 1e-6, 0.25 + 0.25 * np.exp(-(((time - 1.4e-6) / 3e-7) ** 2)), 0) + random.normal(0, 0.02, len(time))
    names = "time [s],lower.force_x [N/m],lower.force_y [N/m],friction.friction_factor [-],energy.kinetic [J/m],"
    names += "energy.strain [J/m],energy.contact [J/m],energy.dissipated [J/m],energy.work [J/m],energy.balance [J/m]"
    energies = [1e-3 * np.minimum(time / 1e-6, 1) * k for k in (0.2, 3, 1)] + [2e3 * time, 4.2e-3 + 2e3 * time, 1e-6 * np.sin(1e7 * time)]
    rows = np.column_stack([time, -friction * normal, normal, friction, *energies])
    text = [",".join("" if i % 2 and c == 3 else repr(float(v)) for c, v in enumerate(row)) for i, row in enumerate(rows)]
    (folder / "probes.csv").write_text("\n".join([names, *text]) + "\n")
    count = 50000
    step_time = np.linspace(1e-12, END, count)
    dt = 2e-12 * (1 + 0.8 * np.exp(-step_time / 2e-6)) * random.uniform(0.5, 1.1, count)
    table = np.column_stack([step_time, dt, 1e-4 * random.lognormal(0, 0.4, count), np.arange(count) // 11,
                             2 * np.arange(count), 6000 + random.integers(0, 50, count)])  # fmt: skip
    header = "time [s],dt [s],error [-],rejections,evaluations,contacts"
    np.savetxt(folder / "steps.csv", table, fmt="%.17g", delimiter=",", header=header, comments="")


def write_run(folder: Path, columns: int = 10, rows: int = 6, rings: int = 3, frames: int = 6) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    write_frames(folder, columns, rows, rings, frames)
    write_tables(folder, columns)
    probes = '[[probes]]\nname = "lower"\nof = "lower"\n[[probes]]\nname = "friction"\nof = "lower"\n'
    (folder / "scene.toml").write_text(f'title = "Synthetic"\n[domain]\nperiod = "{columns * PITCH * 1e6:.10g} um"\n{probes}')
    (folder / "summary.json").write_text("{}\n")


if __name__ == "__main__":
    write_run(Path(sys.argv[1]), *(int(a) for a in sys.argv[2:]))
