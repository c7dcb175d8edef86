"""./pliant study: checks a study and all of its scenes, lays its folder out and has Snakemake run it."""

from __future__ import annotations

import argparse
import fcntl
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from pliant.engine import BadScene, Estimate, check
from pliant.scene import Scene
from pliant.study import slurm
from pliant.study.folder import Folder, state_beside
from pliant.study.gather import CannotGather, function_of
from pliant.study.points import Point, points_of
from pliant.study.reading import BadStudy
from pliant.study.rehearsal import check_windows, rehearse
from pliant.study.spec import Study
from pliant.study.study_file import read_study

HERE = Path(__file__).resolve().parent
PACKAGE = HERE.parents[1]
FAILED, BAD_INPUT = 1, 2


def with_equals_sign(words: list[str], name: str) -> list[str]:
    """What begins with a dash is a value to argparse behind an equals sign alone."""
    result: list[str] = []
    for word in words:
        if result and result[-1] == name:
            result[-1] += f"={word}"
        else:
            result.append(word)
    return result


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="pliant study", add_help=False)
    parser.add_argument("study", type=Path)
    parser.add_argument("--out", type=Path)
    parser.add_argument("--cores", type=int)
    parser.add_argument("--dry-run", action="store_true")
    parser.add_argument("--retry", action="store_true")
    parser.add_argument("--slurm", action="store_true")
    parser.add_argument("--jobs", type=int, default=100)
    parser.add_argument("--sbatch", action="append", default=[])
    options = parser.parse_args(with_equals_sign(sys.argv[1:], "--sbatch"))
    if options.cores is None:
        options.cores = 1 if options.slurm else os.cpu_count()
    return options


def scene_of(base: Scene, point: Point) -> Scene:
    scene = base.copy()
    for path, value in point.sets.items():
        try:
            scene[path] = value
        except KeyError as error:
            raise BadStudy(f"{base.file_name}: {error.args[0]}") from error
    return scene


def check_paths(study: Study, base: Scene) -> None:
    """No key is set twice."""
    taken: dict[str, str] = {base.canonical(path): "[set]" for path in study.fixed}
    for p in [*study.parameters, *([study.replicas] if study.replicas else [])]:
        for path in p.paths:
            key = base.canonical(path)
            for other, name in taken.items():
                if f"{key}.".startswith(f"{other}.") or f"{other}.".startswith(f"{key}."):
                    raise BadStudy(f"{study.file}: '{p.name}' sets {path}, which '{name}' sets too")
            taken[key] = p.name


def check_all(study: Study, points: list[Point]) -> tuple[list[Estimate], dict[str, Path]]:
    """Each scene as the engine reads it: nothing runs if one is wrong. Estimates, and files that go along, by what they
    are called beside the scene."""
    unique_names = {point.name: point for point in points}
    if len(unique_names) < len(points):
        raise BadStudy(f"{study.file}: two runs would have the same values")
    for where in study.functions:
        function_of(where)
    base = Scene.read(study.scene)
    scenes, estimates = [scene_of(base, point) for point in points], []
    check_paths(study, base)
    files = {name: study.scene.parent / name for scene in scenes for name in scene.files()}
    files |= {state_beside(scene["start.from"]): state for scene in scenes if (state := scene.state())}
    with tempfile.TemporaryDirectory() as scratch:
        for point, scene in zip(points, scenes):
            file = scene.write_whole(Path(scratch))
            try:
                estimates.append(check(file, study.threads))
            except BadScene as error:
                said = str(error).replace(str(file), str(study.scene))
                raise BadStudy(f"{study.file}: the run {point.name}: {said}") from error
            check_windows(study, scene, point.name)
            if point is points[0]:
                rehearse(study, file, Path(scratch))
    return estimates, files


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
def alone(folder: Folder) -> Iterator[int]:
    """One call at a time in a folder; a killed one leaves no lock. Gives its descriptor, for those who
    work on."""
    folder.path.mkdir(parents=True, exist_ok=True)
    with (folder.path / ".lock").open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise BadStudy(f"{folder.path}: another call works in this folder") from None
        yield lock.fileno()


def snakemake(folder: Folder, study: Study, options: argparse.Namespace, lock: int) -> int:
    command = ["/usr/bin/snakemake", "--snakefile", HERE / "Snakefile", "--directory", folder.path / "workflow",
               "--config", f"out={folder.path}", f"package={PACKAGE}", f"threads={study.threads}",
               f"python={sys.executable}", "--keep-going", "--nolock", "--rerun-incomplete", "--rerun-triggers",
               "mtime", "--quiet", "all"]
    if options.slurm:
        command += ["--cluster", slurm.submit_command(folder.path, options.sbatch),
                    "--cluster-status", slurm.status_command(folder.path), "--max-status-checks-per-second", "2",
                    "--jobs", str(options.jobs), "--local-cores", str(options.cores), "--latency-wait", "60"]
    else:
        command += ["--cores", str(options.cores)]
    (folder.path / "workflow").mkdir(exist_ok=True)
    stopped = False
    with subprocess.Popen(command, stdin=subprocess.DEVNULL, pass_fds=[lock]) as process:
        while True:
            try:
                code = process.wait()
                break
            except KeyboardInterrupt:
                stopped = True
                print("pliant study: stopping; runs write their checkpoints", file=sys.stderr)
    if options.slurm and stopped:
        slurm.cancel(folder.path)
    return code


def run(study: Study, options: argparse.Namespace) -> int:
    points = points_of(study)
    if options.slurm:
        slurm.check_options(options.sbatch, study.threads)
    estimates, files = check_all(study, points)
    if options.dry_run:
        describe(points, estimates)
        return 0
    folder = Folder((options.out or Path("results/studies") / study.name).absolute())
    if set("{}") & set(str(folder.path)):
        raise BadStudy(f"{folder.path}: Snakemake reads braces as names; give another folder by --out")
    with alone(folder) as lock:
        folder.lay_out(study, points, files)
        for point in points:
            if options.retry and folder.outcome(point.name)["status"] == "failed":
                folder.outcome_file(point.name).unlink()
                shutil.rmtree(folder.results(point.name), ignore_errors=True)
            if not folder.results(point.name).is_dir():  # someone took the data away
                folder.outcome_file(point.name).unlink(missing_ok=True)
        code = snakemake(folder, study, options, lock)
        if code != 0:
            print("pliant study: not ended; the same command goes on from here", file=sys.stderr)
            return FAILED
        return tell(folder)


def tell(folder: Folder) -> int:
    table = folder.read("table.json")
    bad = [row for row in table["rows"] if row["status"] != "finished" or row["problems"]]
    for row in bad:
        print(f"{row['run']}: {row['status']}: {'; '.join(filter(None, [row['message'], *row['problems']]))}",
              file=sys.stderr)
    for row in table["rows"]:
        for text in row["warnings"]:
            print(f"{row['run']}: warning: {text}", file=sys.stderr)
    changed = [r for r in table.get("regression", []) if not r["good"]]
    for r in changed:
        if r["quantity"] == "-":
            print(f"{r['run']}: is in the baseline alone", file=sys.stderr)
            continue
        print(f"{r['run']}: {r['quantity']} was {r['then']}, is {r['now']}; {r['tolerance']:g} allowed",
              file=sys.stderr)
    for order in table.get("orders", []):
        of = "".join(f", {name} = {value}" for name, value in order["of"].items())
        print(f"{order['quantity']}{of}: {order['words']}")
    print(f"{len(table['rows']) - len(bad)} of {len(table['rows'])} runs are whole; {folder.path / 'table.csv'}, "
          f"{folder.path / 'report.html'}")
    return FAILED if bad or changed else 0


def words_of(options: str) -> list[str]:
    try:
        return shlex.split(options)
    except ValueError as error:
        raise BadStudy(f"--sbatch: {options}: {error}") from error


def main() -> int:
    options = arguments()
    try:
        if options.cores < 1 or options.jobs < 1:
            raise BadStudy("--cores and --jobs must be at least 1")
        if options.sbatch and not options.slurm:
            raise BadStudy("--sbatch has no meaning without --slurm")
        options.sbatch = words_of(" ".join(options.sbatch))
        return run(read_study(options.study), options)
    except slurm.NoAnswer as error:
        print(f"pliant study: --slurm: {error}", file=sys.stderr)
        return BAD_INPUT
    except (BadStudy, BadScene, CannotGather, UnicodeDecodeError, OSError) as error:
        print(f"pliant study: {error}", file=sys.stderr)
        return BAD_INPUT


if __name__ == "__main__":
    sys.exit(main())
