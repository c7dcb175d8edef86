"""Speed against error: what each choice of discretisation, scheme, step and stiffness costs for the error that it leaves.

    ./pliant bench error                         all scenes: an hour, most of it the paper's scheme in the third body; results/bench/error.html, .json and .png
    ./pliant bench error --only oscillation impact
    ./pliant bench error --resume                adds to the results of the same engine and processor in the folder
    ./pliant bench error --sizes 168 340         fewer nodes
    ./pliant bench error --keep                  writes what ./pliant check foretells too, and prints what it changes

Exit codes: 0 written, 2 bad input or broken off (what was measured is written), 4 the report cannot be written.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "benchmarks"), str(ROOT / "scripts"), str(ROOT / "python")]

from error_study import keep, report
from error_study.choices import Choice, of_longer_steps, of_paper, of_reference, of_space, of_stiffness, of_time
from error_study.measure import Measured, Programs, Runner
from error_study.scenes import SCENES, Scene
from history import machine

WRITTEN, BAD_INPUT, NOT_WRITTEN = 0, 2, 4
MIDDLE = 340  # nodes, of the study of steps


def choices_of(scene: Scene, sizes: list[int]) -> Iterator[Choice]:
    """All that are compared on a scene, each once."""
    middle = min(sizes, key=lambda n: abs(n - MIDDLE))
    found = [*of_space(sizes), *of_longer_steps(sizes), *of_paper(sizes), *of_time(middle)]
    if scene.free_stiffness:
        found += of_stiffness(sizes)
    found += of_reference([n for n in scene.reference_sizes if n in sizes])
    return iter(dict.fromkeys(found))


def parse_arguments(arguments: list[str] | None) -> argparse.Namespace:
    names = [scene.name for scene in SCENES]
    parser = argparse.ArgumentParser(prog="./pliant bench error", description=__doc__.splitlines()[0])
    parser.add_argument("--only", nargs="+", choices=names, default=names, metavar="SCENE", help=", ".join(names))
    parser.add_argument("--sizes", nargs="+", type=int, help="nodes of a body instead of each scene's own")
    parser.add_argument("--keep", action="store_true", help="write lib/cli/measured_errors.hpp")
    parser.add_argument("--resume", action="store_true", help="keep what the folder has of the same engine and processor")
    parser.add_argument("--repetitions", type=int, default=2, help="the fastest counts")
    parser.add_argument("--engine", type=Path, default=ROOT / "build/release/pliant_engine")
    parser.add_argument("--reference", type=Path, default=ROOT / "build/release/pliant_reference_solver")
    parser.add_argument("--out", type=Path, default=ROOT / "results/bench")
    options = parser.parse_args(arguments)
    if options.repetitions < 1 or any(size < 12 for size in options.sizes or []):
        parser.error("at least one repetition, and 12 nodes a body")
    return options


def measure(runner: Runner, scenes: list[Scene], sizes: list[int] | None, rows: list[Measured], folder: Path, about: dict) -> None:
    """Adds what is missing to the rows; says and stores each as it comes."""
    known = {(row.scene, row.choice) for row in rows}
    for scene in scenes:
        for choice in choices_of(scene, sizes or scene.sizes):
            if (scene.name, choice) in known:
                continue
            row = runner.measure(scene, choice)
            what = row.message or f"error {row.error:.2e}, {row.evaluations} evaluations, {row.seconds:.3f} s"
            print(f"{scene.name}: {choice.family}, {choice.nodes} nodes: {what}", flush=True)
            rows.append(row)
            report.write_data(folder, rows, about)


def main(arguments: list[str] | None = None) -> int:
    options = parse_arguments(arguments)
    os.environ.setdefault("OMP_WAIT_POLICY", "passive")
    code = WRITTEN
    rows: list[Measured] = []
    try:
        version = subprocess.run([options.engine, "--version"], capture_output=True, text=True, check=True).stdout
        about = {"commit": version.strip(), "processor": machine()["cpu"], "repetitions": options.repetitions}
        if options.resume:
            rows = report.read(options.out, about)
        with tempfile.TemporaryDirectory() as scratch:
            runner = Runner(Programs(options.engine, options.reference), Path(scratch), options.repetitions)
            measure(runner, [scene for scene in SCENES if scene.name in options.only], options.sizes, rows, options.out, about)
    except (OSError, ValueError, subprocess.CalledProcessError, KeyboardInterrupt) as error:
        print(f"error: {error or 'interrupted'}", file=sys.stderr)
        code = BAD_INPUT
    if not rows:
        return code
    try:
        files = report.write(options.out, [scene for scene in SCENES if any(row.scene == scene.name for row in rows)], rows, about)
        if options.keep and code == WRITTEN:
            keep.keep(rows)
    except OSError as error:
        print(f"error: {options.out}: cannot be written: {error}", file=sys.stderr)
        return NOT_WRITTEN
    except ValueError as error:
        print(f"error: --keep: {error}", file=sys.stderr)
        return BAD_INPUT
    print("written:", *files)
    return code


if __name__ == "__main__":
    sys.exit(main())
