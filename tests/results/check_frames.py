"""Reads the frames of the pressed discs of run_test.cpp: every field is there, finite, and says what it must.

    /usr/bin/python3 tests/results/check_frames.py RESULT_FOLDER FRAMES      exit 0: sound, else the first fault
"""

import sys
from pathlib import Path

import h5py
import numpy as np

COMPLIANT, RIGID, WALL = 0, 1, 2
FIELDS = {"bodies": {"position", "velocity", "von_mises", "jacobian", "pressure"},
          "outlines": {"position", "contact_pressure"}}


def frames_of(grid: h5py.Group) -> list[h5py.Group]:
    return [grid[name] for name in sorted(grid) if isinstance(grid[name], h5py.Group)]


def check_grid(grid: h5py.Group, times: np.ndarray, fields: set[str]) -> None:
    frames = frames_of(grid)
    assert [frame.attrs["time"] for frame in frames] == list(times), f"{grid.name}: times differ"
    for frame in frames:
        assert set(frame) == fields, f"{frame.name}: has {set(frame)}, not {fields}"
        for name in fields:
            assert np.isfinite(frame[name][()]).all(), f"{frame.name}/{name}: not finite"


def check_bodies(grid: h5py.Group) -> None:
    kind = grid["kind"][()]
    assert set(kind) == {COMPLIANT, RIGID}, f"kinds of grains: {set(kind)}"
    first, last = frames_of(grid)[0], frames_of(grid)[-1]
    assert np.abs(first["jacobian"][()] - 1).max() < 1e-6, "J is 1 at the start"
    soft = kind == COMPLIANT
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
