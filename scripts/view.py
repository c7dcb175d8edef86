#!/usr/bin/python3
"""Writes a run as one HTML page that any browser opens, also without a network.

    ./pliant view results/third_body_mini
    ./pliant view results/third_body --every 10 --fields velocity von_mises --out third_body.html

Bodies through time, coloured by kind or by a field that the frames hold, with the probes' curves below. Exit code 2: no
such folder, frame or field, 4: the page cannot be written.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "python"))

from pliant.frames import BadFolder
from pliant.results import Run, read_run
from pliant.names import nearest
from pliant.units import readable
from viewing import page
from viewing.packing import Field, Packing, fields_of

BAD_INPUT, OUTPUT_FAILED = 2, 4
LARGE = 100e6  # bytes: browsers take their time
_SAME_TIME = 1e-9


class BadInput(Exception):
    """The frames or the fields that were asked for are not there; the message names them."""


def count(text: str) -> int:
    if not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"'{text}' is not a whole number from 1 on")
    return int(text)


def parse_arguments(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="pliant view", description="Writes a run as one HTML page that any browser opens, also without a network.",
        epilog="example: ./pliant view results/third_body_mini",
    )
    parser.add_argument("folder", type=Path, help="result folder of `pliant run`")
    parser.add_argument("--out", type=Path, metavar="FILE.html", help="default: view.html in the result folder")
    parser.add_argument("--every", type=count, default=1, metavar="N", help="every Nth frame alone")
    parser.add_argument("--fields", nargs="+", metavar="NAME", help="default: all that the frames hold")
    parser.add_argument("--times", type=float, nargs=2, metavar=("FROM", "TO"), help="frames between these times, in s")
    options = parser.parse_args(arguments)
    if options.out is not None and options.out.suffix not in (".html", ".htm"):
        parser.error(f"argument --out: '{options.out}' must end with .html")
    return options


def chosen_frames(times: np.ndarray, every: int, span: list[float] | None) -> list[int]:
    low, high = span or (-np.inf, np.inf)
    if not low <= high:
        raise BadInput(f"--times {low:g} {high:g}: the first is to be the earlier one")
    margin = _SAME_TIME * float(np.abs(times).max())
    found = np.flatnonzero((times >= low - margin) & (times <= high + margin))[::every]
    if len(found) == 0:
        raise BadInput(f"no frame between {low:g} and {high:g} s; there are {len(times)}, from {times[0]:g} to "
                       f"{times[-1]:g} s")
    return [int(index) for index in found]


def chosen_fields(held: dict[str, Field], names: list[str] | None) -> list[Field]:
    for name in names or []:
        if name not in held:
            raise BadInput(f"the frames hold no field '{name}'{nearest(name, list(held))}")
    return [field for name, field in held.items() if names is None or name in names]


def pack(run: Run, options: argparse.Namespace) -> Packing:
    if not run.has_frames:
        raise BadInput("the run has no frame yet, or stores none: its scene needs [frames] period")
    chosen = chosen_frames(run.frames.times, options.every, options.times)
    return Packing(run.frames, chosen, chosen_fields(fields_of(run.frames, chosen[0]), options.fields))


def write(run: Run, packing: Packing, file: Path) -> None:
    """The file is whole or absent: written under another name first."""
    temporary = file.with_name(file.name + ".tmp")
    try:
        with temporary.open("w", encoding="utf-8") as out:
            out.writelines(page.parts(run, packing))
        temporary.replace(file)
    finally:
        temporary.unlink(missing_ok=True)


def report(packing: Packing, file: Path) -> None:
    size = file.stat().st_size
    print(file)
    names = ", ".join(["kind", *(field.name for field in packing.fields)])
    print(f"{readable(size, 'B')}, {len(packing.chosen)} frames of {packing.points.bodies} bodies: {names}")
    if size > LARGE:
        print("note: browsers take their time with a page of this size; --every, --times and --fields make it smaller",
              file=sys.stderr)


def main(arguments: list[str]) -> int:
    options = parse_arguments(arguments)
    file = options.out or options.folder / "view.html"
    try:
        run = read_run(options.folder)
        packing = pack(run, options)
        write(run, packing, file)
        report(packing, file)
    except BadFolder as error:
        print(f"error: {error}", file=sys.stderr)
        return BAD_INPUT
    except BadInput as error:
        print(f"error: {options.folder}: {error}", file=sys.stderr)
        return BAD_INPUT
    except OSError as error:
        print(f"error: {file}: cannot be written: {error.strerror or error}", file=sys.stderr)
        return OUTPUT_FAILED
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
