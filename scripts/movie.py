#!/usr/bin/python3
"""Makes a film of a run.

    ./pliant movie results/third_body
    ./pliant movie results/third_body --field von_mises --follow 1017 --out grain.gif

Exit codes: 0 done, 1: ffmpeg is not there, 2: no such run, field, body or probe, or a window that shows nothing, 4: the
film cannot be written.
"""

import argparse
import math
import re
import signal
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "python"))

from plots import fields
from plots.camera import BadWindow, Camera, follow, whole_or_window
from plots.encoder import EncoderFailed, write_film
from plots.film import Curve, Film, curve_of
from pliant import units
from pliant.names import nearest
from pliant.frames import BadFolder
from pliant.results import Run, read_run

SETTING_UP_FAILED, BAD_INPUT, OUTPUT_FAILED = 1, 2, 4
WIDTHS, GIF_WIDTH, FILM_WIDTH = (320, 4096), 640, 1280
RATES = {".mp4": 60, ".gif": 50}  # the most frames a second
USUAL_SECONDS = 10  # that a film lasts, where so many frames a second are neither few nor many
SAMPLE = 12  # frames that colours are chosen by


class BadInput(Exception):
    """What was asked for is not there; the message says what is."""


def quantity(of_text: Callable[[str], float], unit: str) -> Callable[[str], float]:
    """Reads a number in SI, or one with a unit as in scene files."""
    def read(text: str) -> float:
        try:
            value = float(text) if re.fullmatch(r"[-+\d.eE\s]+", text) else of_text(text)
        except ValueError as error:
            said = f"'{text.strip()}' is neither a number ({unit}) nor one with a unit"
            raise argparse.ArgumentTypeError(said) from error
        if not math.isfinite(value):
            raise argparse.ArgumentTypeError(f"'{text.strip()}' is not finite")
        return value
    return read


def whole_number(least: int, most: int) -> Callable[[str], int]:
    def read(text: str) -> int:
        if not re.fullmatch(r"\s*-?\d+", text) or not least <= int(text) <= most:
            raise argparse.ArgumentTypeError(f"'{text.strip()}' is no whole number from {least} to {most}")
        return int(text)
    return read


def parse_arguments(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="pliant movie", description="Makes a film of a run.",
                                     epilog="example: ./pliant movie results/third_body --field von_mises")
    length, moment = quantity(units.length, "m"), quantity(units.time, "s")
    parser.add_argument("folder", type=Path, help="result folder of `pliant run`")
    parser.add_argument("--field", default=fields.KINDS, metavar="NAME", help="what colours show (default: kinds)")
    view = parser.add_mutually_exclusive_group()
    view.add_argument("--window", type=length, nargs=4, metavar=("X0", "X1", "Y0", "Y1"), help="the part that is shown")
    view.add_argument("--follow", type=int, metavar="BODY", help="number of a body that stays in the middle")
    parser.add_argument("--follow-shear", action="store_true", help="moves in x with the grains that are shown")
    parser.add_argument("--times", type=moment, nargs=2, metavar=("FROM", "TO"), help="part of the run (default: all)")
    parser.add_argument("--fps", type=whole_number(1, max(RATES.values())), metavar="N", help="frames a second")
    parser.add_argument("--width", type=whole_number(*WIDTHS), metavar="PIXELS", help="default: 1280, of a GIF 640")
    parser.add_argument("--out", type=Path, metavar="FILE", help="film, .mp4 or .gif (default: NAME.mp4 in the folder)")
    parser.add_argument("--curve", metavar="PROBE.COLUMN", help="under the picture, or none (default: friction factor)")
    # A space before keeps -1e-6 and "-1 um" from being taken for options.
    options = parser.parse_args([f" {a}" if re.match(r"-[\d.]", a) else a for a in arguments])
    refuse_contradictions(parser, options)
    return options


def refuse_contradictions(parser: argparse.ArgumentParser, options: argparse.Namespace) -> None:
    if options.follow_shear and options.follow is not None:
        parser.error("argument --follow-shear: not allowed with argument --follow")
    if options.window and not (options.window[0] < options.window[1] and options.window[2] < options.window[3]):
        parser.error("argument --window: X0 must be less than X1, and Y0 less than Y1")
    if options.window and not 1 / 8 <= np.divide(*np.diff(options.window)[::2]) <= 8:
        parser.error("argument --window: one side is more than 8 times as long as the other")
    if options.times and not options.times[0] < options.times[1]:
        parser.error("argument --times: FROM must be less than TO")
    options.out = options.out or options.folder / f"{'grains' if options.field == fields.KINDS else options.field}.mp4"
    if options.out.suffix not in RATES:
        parser.error(f"argument --out: '{options.out}' must end with .mp4 or .gif")
    if options.fps and options.fps > RATES[options.out.suffix]:
        parser.error(f"argument --fps: a GIF has at most {RATES['.gif']} frames a second")


class Progress:
    """A line that is written over and over; nothing where no terminal is."""

    def __init__(self, what: str, count: int) -> None:
        self._what, self._count, self._start, self._told = what, count, time.monotonic(), 0.0

    def __call__(self, number: int) -> None:
        now, done = time.monotonic(), number + 1
        if not sys.stderr.isatty() or (now - self._told < 0.2 and done < self._count):
            return
        self._told = now
        left = math.ceil((now - self._start) / done * (self._count - done))
        print(f"\r{self._what} {done} of {self._count}, {left} s left\033[K", end="", file=sys.stderr, flush=True)

    def clear(self) -> None:
        if sys.stderr.isatty():
            print("\r\033[K", end="", file=sys.stderr, flush=True)


def chosen_frames(run: Run, times: list[float] | None) -> list[int]:
    if not run.has_frames or "bodies" not in run.frames.grids:
        raise BadInput(f"{run.folder}: the run has no frames; its scene asks for them with [frames]")
    all_times = run.frames.times
    start, end = times or (-math.inf, math.inf)
    slack = 1e-9 * (all_times[-1] - all_times[0])
    chosen = np.flatnonzero((all_times >= start - slack) & (all_times <= end + slack))
    if len(chosen) < 2:
        there = f"{len(all_times)} from {all_times[0]:.6g} s to {all_times[-1]:.6g} s" if len(all_times) > 1 else "one"
        raise BadInput(f"{run.folder}: a film needs two frames or more, {len(chosen)} would be in it; the run has "
                       f"{there}")
    return [int(index) for index in chosen]


def chosen_colours(run: Run, name: str, indices: list[int]) -> fields.Kinds | fields.Field | fields.Fragments:
    if name == fields.KINDS:
        return fields.Kinds(run.frames)
    if name == fields.FRAGMENT and name in run.frames.names("bodies"):
        return fields.Fragments(run.frames)
    known = fields.names(run)
    if name not in known:
        raise BadInput(f"{run.folder}: no field '{name}' in the frames{nearest(name, known, listed=True)}")
    sample = np.unique(np.linspace(0, len(indices) - 1, SAMPLE).round().astype(int))
    return fields.Field(run.frames, name, [indices[i] for i in sample])


def chosen_curve(run: Run, name: str | None, indices: list[int]) -> Curve | None:
    columns = run.probes.columns
    start, end = (float(run.frames.times[index]) for index in (indices[0], indices[-1]))
    if name is None:
        curves = (curve_of(run, c, start, end) for c in columns if c.name == "friction_factor")
        return next((curve for curve in curves if curve), None)
    if name == "none":
        return None
    known = {column.full_name: column for column in columns}
    if name not in known:
        raise BadInput(f"{run.folder}: no probe and column '{name}' in probes.csv{nearest(name, known, listed=True)}")
    curve = curve_of(run, known[name], start, end)
    if curve is None:
        raise BadInput(f"{run.folder}: {name} has no value from {start:.6g} s to {end:.6g} s")
    return curve


def camera_of(run: Run, options: argparse.Namespace, indices: list[int]) -> Camera:
    seen, window = Progress("places of frame", len(indices)), tuple(options.window) if options.window else None
    try:
        if options.follow is not None:
            return follow(run, indices, options.follow, seen)
        return whole_or_window(run, indices, window, options.follow_shear, seen)
    finally:
        seen.clear()


def drawn(film: Film, count: int) -> Iterator[bytes]:
    told = Progress("frame", count)
    for number in range(count):
        yield film.frame(number)
        told(number)
    told.clear()


def make(options: argparse.Namespace) -> None:
    run = read_run(options.folder)
    indices = chosen_frames(run, options.times)
    shown, curve = chosen_colours(run, options.field, indices), chosen_curve(run, options.curve, indices)
    if not options.out.parent.is_dir() or options.out.is_dir():
        raise OSError(0, f"{options.out.parent} is no folder" if not options.out.is_dir() else "it is a folder")
    camera = camera_of(run, options, indices)
    width = 2 * ((options.width or (GIF_WIDTH if options.out.suffix == ".gif" else FILM_WIDTH)) // 2)
    film, count = Film(run, indices, camera, shown, curve, width), len(indices)
    rate = options.fps or int(np.clip(round(count / USUAL_SECONDS), 5, 25))
    print(f"{shown.title}: {count} frames of {film.size[0]} x {film.size[1]} pixels, {count / rate:.1f} s", flush=True)
    every = write_film(options.out, drawn(film, count), count, film.size, rate)
    left_out = f", one frame in {every}" if every > 1 else ""
    print(f"{options.out} ({options.out.stat().st_size / 1e6:.2g} MB{left_out})")


def stop(number: int, _: object) -> None:
    sys.exit(128 + number)


def main(arguments: list[str]) -> int:
    options = parse_arguments(arguments)
    try:
        make(options)
    except (BadFolder, BadInput, BadWindow) as error:
        print(f"error: {error}", file=sys.stderr)
        return BAD_INPUT
    except (OSError, EncoderFailed) as error:
        if isinstance(error, FileNotFoundError) and error.filename == "ffmpeg":
            print("error: ffmpeg is not there: install Debian's package ffmpeg", file=sys.stderr)
            return SETTING_UP_FAILED
        reason = error.strerror if isinstance(error, OSError) and error.strerror else error
        print(f"error: {options.out}: the film cannot be written: {reason}; check the permissions and the free disk "
              "space", file=sys.stderr)
        return OUTPUT_FAILED
    return 0


if __name__ == "__main__":
    for stopping in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(stopping, stop)
    sys.exit(main(sys.argv[1:]))
