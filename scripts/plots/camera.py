"""Where the picture of each frame is: whole, a window, or along with a body or with the shear."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from plots.scenery import extent, with_margin
from plots.wrapping import Box
from pliant.results import Run

Progress = Callable[[int], None]
_SIZES = 10.0  # of the body that is followed: width of the picture
_SHAPE = 1.6  # width over height


class BadWindow(Exception):
    """The picture would show nothing, or there is no such body; the message says what there is."""


@dataclass
class Camera:
    """The picture, and what moves with it."""

    box: Box  # about the origin of each frame
    origins: np.ndarray  # [frames x 2], m
    names: tuple[str, str] = ("x", "y")  # of the axes
    body: int | None = None  # that is followed


def whole_or_window(run: Run, indices: Sequence[int], window: Box | None, shear: bool, seen: Progress) -> Camera:
    """All of it, or a window; either stands still, or moves in x with the mean of the grains that it shows."""
    corners, places, before = [], [0.0], None
    for number, index in enumerate(indices):
        corners.append(extent(run, index))
        if shear:
            now = _centroids(run, index)
            places += [] if before is None else [places[-1] + _mean_motion(before, now, run.period, window, places[-1])]
            before = now
        seen(number)
    low, high = np.min([c[0] for c in corners], axis=0), np.max([c[1] for c in corners], axis=0)
    if window is not None:
        _refuse_empty(window, low, high, run.period, shear)
    x = np.array(places) if shear else np.zeros(len(indices))
    box = window or with_margin(low, high, run.period)
    return Camera(box, np.column_stack([x, np.zeros(len(x))]), ("x along with the grains" if shear else "x", "y"))


def _refuse_empty(window: Box, low: np.ndarray, high: np.ndarray, period: float | None, moving: bool) -> None:
    beside = period is None and not moving and (window[1] <= low[0] or window[0] >= high[0])
    if beside or window[3] <= low[1] or window[2] >= high[1]:
        place = f"x {low[0]:.4g} to {high[0]:.4g}, " if period is None else ""
        raise BadWindow(f"the window shows nothing; grains and walls are in {place}y {low[1]:.4g} to {high[1]:.4g} m")


def _centroids(run: Run, index: int) -> np.ndarray:
    """[grains x 2] means of their points."""
    grid, points = run.frames.grids["bodies"], run.frames.positions("bodies", index)
    owner = grid.point_body
    count = np.bincount(owner)
    sums = [np.bincount(owner, points[: len(owner), axis]) for axis in (0, 1)]
    return (np.column_stack(sums)[count > 0].T / count[count > 0]).T


def _mean_motion(before: np.ndarray, now: np.ndarray, period: float | None, window: Box | None, origin: float) -> float:
    """In x, of the grains with their centroid in the window; of all where it has none."""
    there = np.ones(len(before), dtype=bool)
    if window is not None:
        beside = before[:, 0] - origin - window[0]
        beside = beside if period is None else np.mod(beside, period)
        there = (beside >= 0) & (beside < window[1] - window[0])
        there &= (before[:, 1] >= window[2]) & (before[:, 1] < window[3])
    moved = now[:, 0] - before[:, 0]
    return float((moved[there] if there.any() else moved).mean())


def follow(run: Run, indices: Sequence[int], body: int, seen: Progress) -> Camera:
    """A body stays in the middle, with some of its size around it."""
    grid, points = _points_of(run, body)
    origins, size = [], 0.0
    for number, index in enumerate(indices):
        place = run.frames.positions(grid, index)[points]
        origins.append(place.mean(axis=0))
        size = max(size, *np.ptp(place, axis=0))
        seen(number)
    room = with_margin(*extent(run, indices[0]), run.period)
    most = run.period or max(room[1] - room[0], _SHAPE * (room[3] - room[2]))  # neither images of it nor a void
    width = max(min(_SIZES * size, most), 2.5 * size)
    half = 0.5 * width, 0.5 * width / _SHAPE
    names = tuple(f"{axis} from body {body}" for axis in "xy")
    return Camera((-half[0], half[0], -half[1], half[1]), np.array(origins), names, body)


def _points_of(run: Run, body: int) -> tuple[str, np.ndarray]:
    """The grid that has the body, and its points there."""
    known = {}
    for name, grid in run.frames.grids.items():
        known[name] = np.unique(grid.body)
        if body in known[name]:
            return name, np.unique(grid.cells[grid.body == body])
    last = max(int(bodies.max(initial=-1)) for bodies in known.values())
    raise BadWindow(f"no body {body}; there are 0 to {last}")
