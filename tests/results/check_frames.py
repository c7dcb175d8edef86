"""Reads the frames of the pressed discs of run_test.cpp: every field is there, finite, and says what it must.

    /usr/bin/python3 tests/results/check_frames.py RESULT_FOLDER FRAMES      exit 0: sound, else the first fault
"""

import sys
from pathlib import Path

import h5py
import numpy as np

COMPLIANT, RIGID, WALL = 0, 1, 2
STRESSES = {f"stress_{component}" for component in ("xx", "yy", "xy", "zz")}
STRAINS = {f"strain_{component}" for component in ("xx", "yy", "xy")}
FIELDS = {"bodies": {"position", "displacement", "velocity", "acceleration", "von_mises", "tresca", "jacobian",
                     "pressure", "strain_energy_density", "principal_stress_1", "principal_stress_2", "contact_count"}
          | STRESSES | STRAINS,
          "outlines": {"position", "contact_pressure", "contact_shear", "contact_gap", "contact_slip"}}
CONSTANT = {"bodies": {"cells", "kind", "body", "material", "scale"}, "outlines": {"cells", "kind", "body"}}
ROUNDING = 3e-6  # of single precision: some units of 6e-8 in sums of squares


def frames_of(grid: h5py.Group) -> list[h5py.Group]:
    return [grid[name] for name in sorted(grid) if isinstance(grid[name], h5py.Group)]


def check_grid(grid: h5py.Group, times: np.ndarray, fields: set[str]) -> None:
    frames = frames_of(grid)
    constant = {name for name in grid if isinstance(grid[name], h5py.Dataset)}
    assert constant == CONSTANT[grid.name.strip("/")], f"{grid.name}: {constant} written once"
    assert [frame.attrs["time"] for frame in frames] == list(times), f"{grid.name}: times differ"
    for frame in frames:
        assert set(frame) == fields, f"{frame.name}: has {set(frame)}, not {fields}"
        for name in fields:
            data = frame[name]
            assert data.dtype == np.float32, f"{data.name}: {data.dtype}"
            assert data.compression == "gzip" or data.size < 100, f"{data.name}: not compressed"
            assert name == "contact_gap" or np.isfinite(data[()]).all(), f"{data.name}: not finite"


def check_invariants(frame: h5py.Group, soft: np.ndarray) -> None:
    """EXACT but for single precision: one integration point a cell, so invariants belong to the cell's tensor."""
    xx, yy, xy, zz = (frame[f"stress_{c}"][()][soft].astype(float) for c in ("xx", "yy", "xy", "zz"))
    scale = np.abs([xx, yy, zz]).max()
    centre, radius = (xx + yy) / 2, np.hypot((xx - yy) / 2, xy)
    deviator = np.array([xx, yy, zz]) - (xx + yy + zz) / 3
    expected = {
        "von_mises": np.sqrt(1.5 * (deviator**2).sum(axis=0) + 3 * xy**2),
        "principal_stress_1": centre + radius,
        "principal_stress_2": centre - radius,
        "tresca": np.maximum(centre + radius, zz) - np.minimum(centre - radius, zz),
        "pressure": -(xx + yy + zz) / 3,
    }
    for name, values in expected.items():
        assert np.abs(frame[name][()][soft] - values).max() < ROUNDING * scale, f"{name} is not that of the stress"


def check_deformation(first: h5py.Group, last: h5py.Group, cells: np.ndarray, soft: np.ndarray) -> None:
    """INDEPENDENT: J and strain of linear triangles through the stored positions. They differ from the smooth fields at
    the rim (correlations 0.84 to 0.98), but a component that is swapped or turned correlates with 0 or less."""
    X, x = (frame["position"][()][cells[soft]].astype(float) for frame in (first, last))
    D, d = (np.stack([p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]], axis=2) for p in (X, x))
    F = d @ np.linalg.inv(D)
    E = (F.transpose(0, 2, 1) @ F - np.eye(2)) / 2
    assert abs(np.linalg.det(F).mean() - last["jacobian"][()][soft].mean()) < 1e-4, "mean J"
    for name, values in {"xx": E[:, 0, 0], "yy": E[:, 1, 1], "xy": E[:, 0, 1]}.items():
        field = last[f"strain_{name}"][()][soft]
        assert np.corrcoef(field, values)[0, 1] > 0.7, f"strain_{name} does not follow the mesh"
        assert abs(field.mean() - values.mean()) < 0.05 * np.abs(values).max(), f"mean strain_{name}"


def check_motion(first: h5py.Group, last: h5py.Group) -> None:
    moved = last["position"][()] - first["position"][()]
    assert np.abs(last["displacement"][()][:, :2] - moved).max() < 1e-6, "EXACT: displacement from frame to frame"
    assert np.abs(last["displacement"][()]).max() > 0.1, "the rigid disc spins by 1 rad"


def check_bodies(grid: h5py.Group) -> None:
    kind = grid["kind"][()]
    assert set(kind) == {COMPLIANT, RIGID}, f"kinds of grains: {set(kind)}"
    first, last = frames_of(grid)[0], frames_of(grid)[-1]
    assert np.abs(first["jacobian"][()] - 1).max() < 1e-6, "J is 1 at the start"
    soft = kind == COMPLIANT
    check_invariants(last, soft)
    check_deformation(first, last, grid["cells"][()], soft)
    check_motion(first, last)
    assert set(grid["material"][()][soft]) == {0} and set(grid["material"][()][~soft]) == {1}, "materials by number"
    assert set(grid["scale"][()]) == {1.0}
    assert set(last["contact_count"][()]) == {2}, "each disc touches floor and plate"
    assert last["von_mises"][()][soft].max() > 1e-3, "the compliant disc is pressed, but without stress"
    assert last["von_mises"][()][~soft].max() == 0, "rigid bodies carry no stress field"
    assert last["jacobian"][()][soft].mean() < 1, "the compliant disc is pressed, but not compressed"
    assert last["pressure"][()][soft].mean() > 0, "compression has positive pressure"
    assert np.abs(first["velocity"][()]).max() > 0.49, "the rigid disc spins with 0.5 rad/s at radius 1"


def check_outlines(grid: h5py.Group) -> None:
    assert set(grid["kind"][()]) == {COMPLIANT, RIGID, WALL}
    pressure = frames_of(grid)[-1]["contact_pressure"][()]
    assert pressure.max() > 0.01, "the discs touch, but without contact pressure"
    assert pressure.min() > -0.5 * pressure.max(), "contact pressure is positive in compression"
    last = frames_of(grid)[-1]
    gap, slip, shear = (last[f"contact_{name}"][()] for name in ("gap", "slip", "shear"))
    touching = np.isfinite(gap)
    assert touching.any() and not touching.all() and (gap[touching] < 0).all(), "gaps where nodes touch"
    assert (slip[~touching] == 0).all() and np.abs(slip).max() > 0, "slip where nodes touch: the rigid disc is turned"
    assert np.abs(shear).max() > 0 and np.abs(shear).max() < 0.6 * pressure.max(), "shear of friction 0.3"


def main(folder: Path, frames: int) -> None:
    with h5py.File(folder / "frames.h5", "r") as file:
        times = file["times"][()]
        assert len(times) == frames, f"{len(times)} frames, not {frames}"
        for name, fields in FIELDS.items():
            check_grid(file[name], times, fields)
        check_bodies(file["bodies"])
        check_outlines(file["outlines"])


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]))
