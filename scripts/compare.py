"""How far two runs differ: largest differences by summary figure, probe column and frame field.

    ./pliant compare results/one results/other --tolerance 1e-6

A relative difference is the largest absolute one over the largest magnitude that the column or field has in either run.
Exit codes: 0 equal within the tolerance (default: every bit), 1 different, 2 not comparable: no result folders, nothing
in common, or other grids.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "python"))

from pliant.frames import BadFolder, Contacts, Frames
from pliant.results import Run, Table, read_json, read_run

EQUAL, DIFFERENT, NOT_COMPARABLE = 0, 1, 2
# Of the machine and the day, not of the run.
NOT_OF_THE_RUN = {"preparation_seconds", "wall_seconds", "phase_seconds", "evaluations_per_second",
                  "peak_memory_bytes", "threads", "resumed", "checkpoint_time", "commit", "compiler", "scene", "title",
                  "warnings"}
SAME_TIME = 1e-9  # relative: outputs of the same instant


@dataclass
class Difference:
    """Of one column, field or figure; `absolute` in its own unit."""

    name: str
    absolute: float
    relative: float
    where: str = ""


def relative_to(scale: float, difference: float, name: str) -> float:
    """Errors of balances are relative already."""
    if name.removesuffix(" [-]").endswith(("balance_error", "momentum_error")):
        return difference
    return difference / scale if scale > 0 else np.inf


class Comparison:
    def __init__(self, tolerance: float) -> None:
        self.tolerance = tolerance
        self.differences: list[Difference] = []
        self.notes: list[str] = []  # what only one of the runs has: never equal
        self.compared = 0

    def add(self, name: str, a: np.ndarray, b: np.ndarray, where: list[str] | None = None) -> None:
        """Compares two arrays [times x ...]; a value that only one of them has (NaN) is an infinite difference."""
        self.compared += 1
        both_missing = np.isnan(a) & np.isnan(b)
        apart = np.where(both_missing | (a == b), 0.0, np.abs(a - b))
        apart = np.where(np.isnan(apart), np.inf, apart)
        largest = float(apart.max(initial=0.0))
        scale = max((float(np.abs(x[np.isfinite(x)]).max(initial=0.0)) for x in (a, b)))
        if largest == 0:
            return
        at = int(np.unravel_index(apart.argmax(), apart.shape)[0]) if apart.ndim else 0
        relative = relative_to(scale, largest, name)
        self.differences.append(Difference(name, largest, relative, where[at] if where else ""))

    def code(self) -> int:
        beyond = [d for d in self.differences if d.relative > self.tolerance]
        return DIFFERENT if beyond or self.notes else EQUAL


def figures(summary: dict, prefix: str = "") -> dict[str, float | str]:
    flat: dict[str, float | str] = {}
    for key, value in summary.items():
        if key in NOT_OF_THE_RUN:
            continue
        flat |= figures(value, f"{prefix}{key}.") if isinstance(value, dict) else {prefix + key: value}
    return flat


def compare_summaries(a: Path, b: Path, result: Comparison) -> None:
    one, other = (figures(read_json(folder / "summary.json")) for folder in (a, b))
    for name in sorted(one.keys() | other.keys()):
        values = [one.get(name), other.get(name)]
        if all(isinstance(value, (int, float)) for value in values):
            result.add(f"summary {name}", np.float64(values[0]), np.float64(values[1]))
        elif values[0] != values[1] and not (name == "state_hash" and result.tolerance > 0):
            result.notes.append(f"summary {name}: {values[0]} and {values[1]}")


def common_times(name: str, a: np.ndarray, b: np.ndarray, result: Comparison) -> tuple[np.ndarray, np.ndarray]:
    """Indices of the times that both have; what one lacks is noted."""
    scale = SAME_TIME * max(np.abs(a).max(initial=0.0), np.abs(b).max(initial=0.0))
    index = np.searchsorted(b - scale, a, side="right") - 1
    found = (index >= 0) & (np.abs(b[np.maximum(index, 0)] - a) <= scale) if len(b) else np.zeros(len(a), dtype=bool)
    if found.sum() < max(len(a), len(b)):
        result.notes.append(f"{name}: {len(a)} and {len(b)} times, {found.sum()} in common")
    return np.flatnonzero(found), index[found]


def columns(table: Table) -> dict[str, np.ndarray]:
    return {f"{column.full_name} [{column.unit}]": column.values for column in table.columns}


def compare_tables(name: str, a: Table | None, b: Table | None, result: Comparison) -> None:
    if a is None or b is None:
        if a is not b:
            result.notes.append(f"{name}: only one of the runs has rows")
        return
    rows = common_times(name, a.time, b.time, result)
    one, other = columns(a), columns(b)
    for column in sorted(one.keys() ^ other.keys()):
        result.notes.append(f"{name} {column}: only in the {'first' if column in one else 'second'} run")
    times = [f"t = {time:.6g} s" for time in a.time[rows[0]]]
    for column in one.keys() & other.keys() if times else ():
        result.add(f"{name} {column}", one[column][rows[0]], other[column][rows[1]], times)


def compare_frames(a: Frames | None, b: Frames | None, result: Comparison) -> None:
    if a is None or b is None:
        if a is not b:
            result.notes.append("frames: only one of the runs has any")
        return
    for grid in sorted(a.grids.keys() | b.grids.keys()):
        if grid not in a.grids or grid not in b.grids or not np.array_equal(a.grids[grid].cells, b.grids[grid].cells):
            raise BadFolder(f"the grids '{grid}' of the two runs have other cells: their frames cannot be compared")
    rows = common_times("frames", a.times, b.times, result)
    if not len(rows[0]):
        return
    for grid in sorted(a.grids):
        compare_grid(grid, a, b, rows, result)
    compare_contacts(a, b, rows, result)


def compare_grid(grid: str, a: Frames, b: Frames, rows: tuple[np.ndarray, np.ndarray], result: Comparison) -> None:
    names = a.stored(grid, rows[0][0]), b.stored(grid, rows[1][0])
    for name in sorted(names[0] ^ names[1]):
        result.notes.append(f"frames {grid}/{name}: only in the {'first' if name in names[0] else 'second'} run")
    for name in sorted(names[0] & names[1]):
        pairs = ((a.field(grid, left, name), b.field(grid, right, name)) for left, right in zip(*rows))
        add_frames(f"frames {grid}/{name}", pairs, a.times[rows[0]], result)


def add_frames(name: str, pairs: Iterable[tuple[np.ndarray, np.ndarray]], times: np.ndarray,
               result: Comparison) -> None:
    """Frame by frame: all at once may not fit into memory."""
    worst, scale = Comparison(0), 0.0
    for time, (one, other) in zip(times, pairs):
        one, other = one.astype(float), other.astype(float)
        scale = max([scale, *(float(np.abs(x[np.isfinite(x)]).max(initial=0.0)) for x in (one, other))])
        worst.add(name, one, other, [f"t = {time:.6g} s"] * len(one))
    result.compared += 1
    if worst.differences:
        largest = max(worst.differences, key=lambda difference: difference.absolute)
        largest.relative = relative_to(scale, largest.absolute, name)
        result.differences.append(largest)


def compare_contacts(a: Frames, b: Frames, rows: tuple[np.ndarray, np.ndarray], result: Comparison) -> None:
    """Pair by pair. One that is in touch in one run alone has neither force nor length in the other; points of common
    pairs are compared."""
    stored = a.contacts(rows[0][0]) is not None, b.contacts(rows[1][0]) is not None
    if stored[0] != stored[1]:
        result.notes.append(f"frames contacts: only in the {'first' if stored[0] else 'second'} run")
    if not all(stored):
        return
    for name in ("point", "force", "length"):
        pairs = (aligned(a.contacts(left), b.contacts(right), name) for left, right in zip(*rows))
        add_frames(f"frames contacts/{name}", pairs, a.times[rows[0]], result)


def aligned(a: Contacts, b: Contacts, name: str) -> tuple[np.ndarray, np.ndarray]:
    """[pairs that either has x ...] of both; points: [pairs that both have x 2]."""
    keys = [list(map(tuple, np.column_stack([contacts.bodies, contacts.images]))) for contacts in (a, b)]
    union = sorted(set(keys[0]) & set(keys[1]) if name == "point" else set(keys[0]) | set(keys[1]))
    values = []
    for contacts, own in zip((a, b), keys):
        of = dict(zip(own, getattr(contacts, name)))
        absent = np.zeros(getattr(contacts, name).shape[1:])
        values.append(np.array([of.get(key, absent) for key in union]))
    return values[0], values[1]


def compare(a: Run, b: Run, tolerance: float) -> Comparison:
    result = Comparison(tolerance)
    compare_summaries(a.folder, b.folder, result)
    compare_tables("probes", a.probes, b.probes, result)
    compare_tables("steps", a.steps, b.steps, result)
    compare_frames(a.frames, b.frames, result)
    if result.compared == 0:
        raise BadFolder(f"{a.folder} and {b.folder} have nothing in common to compare")
    return result


def print_result(result: Comparison) -> None:
    for note in result.notes:
        print(note)
    for d in sorted(result.differences, key=lambda difference: -difference.relative):
        mark = " " if d.relative <= result.tolerance else "*"
        print(f"{mark} {d.name:<44} {d.absolute:10.3e} absolute  {d.relative:10.3e} relative  {d.where}")
    equal = result.compared - len(result.differences)
    verdict = "equal" if result.code() == EQUAL else "different"
    limit = f"within {result.tolerance:g}" if result.tolerance > 0 else "bit by bit"
    print(f"{verdict} {limit}: {result.compared} figures, columns and fields compared, {equal} of them the same")


def tolerance(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0 <= value < float("inf"):
        raise argparse.ArgumentTypeError(f"'{text}' is not a finite number >= 0")
    return value


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="pliant compare", description="Largest differences of two runs.",
                                     epilog="example: ./pliant compare results/one results/other --tolerance 1e-6")
    parser.add_argument("folders", type=Path, nargs=2, metavar="DIR", help="result folders of `pliant run`")
    parser.add_argument("--tolerance", type=tolerance, default=0.0,
                        help="largest relative difference that counts as equal")
    options = parser.parse_args(arguments)
    try:
        result = compare(*(read_run(folder) for folder in options.folders), options.tolerance)
    except BadFolder as error:
        print(f"error: {error}", file=sys.stderr)
        return NOT_COMPARABLE
    print_result(result)
    return result.code()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
