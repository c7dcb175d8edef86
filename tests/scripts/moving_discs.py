"""Two discs in a period of 10 um as a run would write them, and films decoded: pixels, and where things are in them."""

import json
import re
import subprocess
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np

from synthetic_run import disc

PERIOD, RADIUS, FRAMES, END = 10e-6, 0.5e-6, 6, 5e-6
Colour = tuple[float, float, float]
COMPLIANT, RIGID, NEUTRAL, WHITE = (0xF2, 0xC0, 0x79), (0x4A, 0x4A, 0x4A), (0xC9, 0xC9, 0xC9), (0xFF, 0xFF, 0xFF)


def times() -> np.ndarray:
    return np.linspace(0, END, FRAMES)


def centres(time: float) -> np.ndarray:
    """Body 0, compliant, goes over the edge of the period, from 8 um to 13 um; body 1, rigid, stands."""
    return np.array([[8e-6 + 1.0 * time, 0.0], [5e-6, 2e-6]])


def write_run(folder: Path, together: bool = False) -> Path:
    """`together`: body 1 moves as body 0 does."""
    folder.mkdir(parents=True, exist_ok=True)
    points, triangles = disc(6)
    ring = np.arange(len(points) - 36, len(points))
    with h5py.File(folder / "frames.h5", "w") as file:
        file["times"] = times()
        segments = np.column_stack([np.arange(36), np.roll(np.arange(36), -1)])
        for grid, cells in (("bodies", triangles), ("outlines", segments)):
            size = len(points) if grid == "bodies" else len(ring)
            file[f"{grid}/cells"] = np.concatenate([cells, cells + size]).astype("i4")
            file[f"{grid}/body"] = file[f"{grid}/kind"] = np.repeat([0.0, 1.0], len(cells)).astype("f4")
        for index, time in enumerate(times()):
            place = centres(time) + np.array([[0.0, 0.0], [1.0 * time * together, 0.0]])
            file[f"bodies/{index:06}/position"] = (place[:, None] + points).reshape(-1, 2)
            file[f"bodies/{index:06}/velocity"] = np.tile([3.0, -4.0, 0.0], (2 * len(points), 1)) * index
            file[f"bodies/{index:06}/von_mises"] = np.repeat([2e7 * index, 0.0], len(triangles))
            file[f"outlines/{index:06}/position"] = (place[:, None] + points[ring]).reshape(-1, 2)
            file[f"outlines/{index:06}/contact_shear"] = np.where(np.arange(72) % 36 < 18, 1e6, -1e6) * (index > 0)
    rows = [f"{t:.9g},{t:.9g},0.3" for t in np.linspace(0, END, 101)]
    header = "time [s],way.position_x [m],drag.friction_factor [-]"
    (folder / "probes.csv").write_text("\n".join([header, *rows]) + "\n")
    (folder / "scene.toml").write_text('title = "Discs"\n[domain]\nperiod = "10 um"\n')
    return folder


def described(film: Path) -> dict:
    """What ffprobe says of its only stream, with the frames counted."""
    command = ["ffprobe", "-v", "error", "-count_frames", "-show_streams", "-of", "json", str(film)]
    streams = json.loads(subprocess.run(command, capture_output=True, check=True).stdout)["streams"]
    assert len(streams) == 1
    return streams[0]


def decoded(film: Path) -> np.ndarray:
    """[frames x rows x columns x 3]"""
    command = ["ffmpeg", "-v", "error", "-i", film, "-vsync", "passthrough", "-f", "image2pipe", "-c:v", "ppm", "-"]
    raw = subprocess.run(command, capture_output=True, check=True).stdout
    header = re.match(rb"P6\n(\d+) (\d+)\n255\n", raw)
    width, height = int(header[1]), int(header[2])
    frames = np.frombuffer(raw, np.uint8).reshape(-1, len(header[0]) + 3 * width * height)
    return frames[:, len(header[0]) :].reshape(-1, height, width, 3).astype(int)


@dataclass
class Panel:
    """Where a panel is in a picture, by its frame of dark lines: pixels."""

    left: int
    right: int
    top: int
    bottom: int

    @property
    def inside(self) -> tuple[slice, slice]:
        return slice(self.top + 2, self.bottom - 1), slice(self.left + 2, self.right - 1)

    def pixel(self, x: float, y: float, box: tuple[float, float, float, float]) -> tuple[int, int]:
        """Row and column of a place in the panel's limits."""
        column = self.left + (x - box[0]) / (box[1] - box[0]) * (self.right - self.left)
        row = self.bottom + (y - box[2]) / (box[3] - box[2]) * (self.top - self.bottom)
        return round(row), round(column)


def panels(picture: np.ndarray) -> list[Panel]:
    """From top to bottom: between two rows that are dark over much of their width. Not in a film's first and last
    frame, where the mark stands on the edge of a panel."""
    dark = picture.sum(axis=2) < 250
    rows = np.flatnonzero(dark.mean(axis=1) > 0.3)
    rows = rows[np.concatenate([[True], np.diff(rows) > 3])]
    found = []
    for top, bottom in zip(rows[::2], rows[1::2]):
        columns = np.flatnonzero(dark[top : bottom + 1].mean(axis=0) > 0.95)
        right = columns[columns > columns[0] + 3][0]  # and then the bar of colours
        found.append(Panel(*(int(n) for n in (columns[0], right, top, bottom))))
    return found


def near(picture: np.ndarray, colour: Colour, tolerance: int = 24) -> np.ndarray:
    """[rows x columns] where the picture has the colour."""
    return np.abs(picture - np.array(colour)).max(axis=-1) <= tolerance


def has(picture: np.ndarray, place: tuple[int, int], colour: Colour) -> bool:
    """In the mean of some pixels about the place: H.264 keeps no single one exactly."""
    patch = picture[place[0] - 2 : place[0] + 3, place[1] - 2 : place[1] + 3]
    return bool(near(patch.mean(axis=(0, 1)), colour, 10))
