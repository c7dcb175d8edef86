"""./pliant study: checks a study and all of its scenes, lays its folder out and has Snakemake run it."""

from __future__ import annotations

import argparse
import fcntl
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from pliant.engine import BadScene, Estimate, check
from pliant.scene import Scene
from pliant.study.folder import Folder
from pliant.study.points import Point, points_of
from pliant.study.reading import BadStudy
from pliant.study.spec import Study, read_study

HERE = Path(__file__).resolve().parent
PACKAGE = HERE.parents[1]
FAILED, BAD_INPUT = 1, 2


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="pliant study", add_help=False)
    parser.add_argument("study", type=Path)
    parser.add_argument("--out", type=Path)
    parser.add_argument("--cores", type=int, default=os.cpu_count())
    parser.add_argument("--dry-run", action="store_true")
    parser.add_argument("--retry", action="store_true")
    parser.add_argument("--slurm", action="store_true")
    parser.add_argument("--jobs", type=int, default=100)
    return parser.parse_args()


def scene_of(base: Scene, point: Point) -> Scene:
    scene = Scene(base.text(), base.file_name)
    for path, value in point.sets.items():
        try:
            scene[path] = value
        except KeyError as error:
            raise BadStudy(f"{base.file_name}: {error.args[0]}") from error
    return scene


def check_all(study: Study, points: list[Point]) -> list[Estimate]:
    """Each scene as the engine reads it: nothing runs if one is wrong."""
    base, estimates = Scene.read(study.scene), []
    with tempfile.TemporaryDirectory() as scratch:
        for name in base.files(study.scene.parent):
            (Path(scratch) / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(study.scene.parent / name, Path(scratch) / name)
        for point in points:
            file = scene_of(base, point).write(Path(scratch) / study.scene.name)
            try:
                estimates.append(check(file, study.threads))
            except BadScene as error:
                said = str(error).replace(str(file), str(study.scene))
                raise BadStudy(f"{study.file}: the run {point.name}: {said}") from error
    return estimates


def describe(points: list[Point], estimates: list[Estimate]) -> None:
    def figure(value: float | None, unit: float = 1) -> str:
        return "?" if value is None else f"{value / unit:.3g}"

    width = max(len(point.name) for point in points)
    print(f"{'run':{width}}  {'evaluations':>12}  {'time [s]':>9}  {'memory [MB]':>11}  {'output [MB]':>11}")
    for point, e in zip(points, estimates):
        print(f"{point.name:{width}}  {figure(e.evaluations):>12}  {figure(e.seconds):>9}  {figure(e.memory, 1e6):>11}"
              f"  {figure(e.output, 1e6):>11}")
    seconds, output = (sum(getattr(e, of) or 0 for e in estimates) for of in ("seconds", "output"))
    memory = max((e.memory or 0 for e in estimates), default=0)
    print(f"{len(points)} runs: at least {seconds:.3g} s one after the other, {memory / 1e6:.3g} MB of memory each at "
          f"most, {output / 1e6:.3g} MB of output")


@contextmanager
def alone(folder: Folder) -> Iterator[None]:
    """One call at a time in a folder; a killed one leaves no lock."""
    folder.path.mkdir(parents=True, exist_ok=True)
    with (folder.path / ".lock").open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise BadStudy(f"{folder.path}: another call works in this folder") from None
        yield


def snakemake(folder: Folder, study: Study, options: argparse.Namespace) -> int:
    command = ["/usr/bin/snakemake", "--snakefile", HERE / "Snakefile", "--directory", folder.path / "workflow",
               "--config", f"out={folder.path}", f"package={PACKAGE}", f"threads={study.threads}",
               f"python={sys.executable}", "--keep-going", "--nolock", "--rerun-incomplete", "--rerun-triggers",
               "mtime", "--quiet", "all"]
    if options.slurm:
        command += ["--cluster", "sbatch --parsable --cpus-per-task={threads} --job-name=pliant-{rule} "
                    f"--output={folder.path}/workflow/slurm-%j.log", "--jobs", str(options.jobs), "--latency-wait", "60"]
    else:
        command += ["--cores", str(options.cores)]
    (folder.path / "workflow").mkdir(exist_ok=True)
    return subprocess.run(command, stdin=subprocess.DEVNULL, check=False).returncode


def run(study: Study, options: argparse.Namespace) -> int:
    points = points_of(study)
    estimates = check_all(study, points)
    if options.dry_run:
        describe(points, estimates)
        return 0
    folder = Folder((options.out or Path("results/studies") / study.name).absolute())
    with alone(folder):
        folder.lay_out(study, points)
        for point in points:
            if options.retry and folder.outcome(point.name)["status"] == "failed":
                folder.outcome_file(point.name).unlink()
                shutil.rmtree(folder.results(point.name), ignore_errors=True)
        code = snakemake(folder, study, options)
        if code != 0:
            print("pliant study: not ended; the same command goes on from here", file=sys.stderr)
            return FAILED
        return tell(folder)


def tell(folder: Folder) -> int:
    table = folder.read("table.json")
    bad = [row for row in table["rows"] if row["status"] != "finished" or row["problems"]]
    for row in bad:
        print(f"{row['run']}: {row['status']}: {'; '.join([row['message'], *row['problems']])}", file=sys.stderr)
    changed = [r for r in table.get("regression", []) if not r["good"]]
    for r in changed:
        print(f"{r['run']}: {r['quantity']} was {r['then']}, is {r['now']}; {r['tolerance']:g} allowed", file=sys.stderr)
    for order in table.get("orders", []):
        of = "".join(f", {name} = {value}" for name, value in order["of"].items())
        found = (f"order {order['order']:.2f}, limit {order['limit']:.5g}, index {order['index']:.2g}"
                 if order["order"] is not None else "")
        print(f"{order['quantity']}{of}: {'; '.join(text for text in (found, order['note']) if text)}")
    print(f"{len(table['rows']) - len(bad)} of {len(table['rows'])} runs are whole; {folder.path / 'table.csv'}, "
          f"{folder.path / 'report.html'}")
    return FAILED if bad or changed else 0


def main() -> int:
    options = arguments()
    try:
        return run(read_study(options.study), options)
    except (BadStudy, OSError) as error:
        print(f"pliant study: {error}", file=sys.stderr)
        return BAD_INPUT


if __name__ == "__main__":
    sys.exit(main())
