"""The steps of a study, each a process: `python -m pliant.study.steps STEP FOLDER [RUN [THREADS [JOB]]]`."""

from __future__ import annotations

import shutil
import signal
import subprocess
import sys
import time
from dataclasses import asdict
from pathlib import Path

from pliant.engine import start
from pliant.results import checkpoint_header, is_finished, read_json, read_run
from pliant.scene import Scene
from pliant.study import gather as gathering
from pliant.study.folder import Folder, as_text, copy_if_other, replace, state_beside

FILES = 4  # exit code: a full disk, another run in the folder
KILLED = (130, 143, -2, -15, -9)  # by signals: to be gone on with, not a failure


def scene(folder: Folder, name: str) -> None:
    changed = Scene.read(folder.path / "base.toml")
    for path, value in folder.point(name).sets.items():
        changed[path] = value
    for other in folder.files_beside():
        copy_if_other(other, folder.run(name) / other.relative_to(folder.beside))
    if changed.state() is not None:
        changed = changed.starting_from(state_beside(changed["start.from"]))
    replace(folder.scene(name), changed.text())


def run(folder: Folder, name: str, threads: str, job: str = "") -> None:
    """Begins, goes on from a checkpoint of the same scene, or takes what is finished. A run that fails is an outcome like
    others; one that is killed is none. `job`: its number, of Slurm's."""
    scene_file, results = folder.scene(name), folder.results(name)
    begun, fingerprint = folder.run(name) / "begun", folder.fingerprint(name)
    same = begun.exists() and begun.read_text() == fingerprint
    if same and is_finished(results):
        code, message = 0, ""
    else:
        resumes = same and (results / "checkpoint.bin").exists()
        begin, reached = time.monotonic(), steps_of_checkpoint(results) if resumes else -1
        replace(begun, fingerprint)
        way = ["--resume"] if resumes else [scene_file, "--force"]
        code, message, warned = to_its_end("run", *way, "--out", results, "--threads", threads, "--quiet")
        if code in KILLED or code == FILES:
            moved = steps_of_checkpoint(results) > reached
            what = "the same job" if job and warned and moved and is_queued_again(job) else "the next call"
            sys.exit(f"{name}: stopped{': ' * bool(message)}{message}; {what} goes on")
        if folder.fingerprint(name) != fingerprint:
            sys.exit(f"{name}: its scene changed meanwhile; the next call runs it anew")
        what = "finished" if code == 0 else "FAILED"
        print(f"{name}: {what}{' after a checkpoint' if resumes else ''}, {time.monotonic() - begin:.1f} s", flush=True)
    status = "finished" if code == 0 else "failed"
    replace(folder.outcome_file(name), as_text({"status": status, "code": code, "message": message, "job": job}))


def to_its_end(*arguments: str | Path) -> tuple[int, str, bool]:
    """Exit code and errors of the engine; no signal ends this process first. SIGINT and SIGTERM come to both: from a
    terminal, or from Slurm. SIGUSR1 is Slurm's warning of a time limit, to this process alone: whether it came."""
    warnings: list[int] = []

    def warn(*_: object) -> None:
        warnings.append(signal.SIGUSR1)
        process.terminate()

    for ends in (signal.SIGINT, signal.SIGTERM):
        signal.signal(ends, lambda *_: None)
    with start(*arguments) as process:
        signal.signal(signal.SIGUSR1, warn)
        errors = process.communicate()[1]
    return process.returncode, errors.strip(), bool(warnings)


def steps_of_checkpoint(results: Path) -> int:
    return checkpoint_header(results).get("steps", -1)


def is_queued_again(job: str) -> bool:
    """It ends all that belongs to the job, itself too if it is slow."""
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    return subprocess.run(["scontrol", "requeue", job], stdin=subprocess.DEVNULL, check=False).returncode == 0


def gather(folder: Folder, name: str) -> None:
    values: dict[str, dict] = {}
    curves: dict[str, dict] = {}
    problems: list[str] = []
    warned = read_json(folder.results(name) / "summary.json").get("warnings", [])
    if folder.outcome(name)["status"] == "finished":
        results = read_run(folder.results(name))
        for quantity in folder.quantities():
            try:
                values[quantity.name] = asdict(gathering.gather(quantity, results))
            except gathering.CannotGather as error:
                problems.append(f"{quantity.name}: {error}")
        for curve in folder.curves():
            try:
                curves[curve.name] = gathering.gather_curve(curve, results)
            except gathering.CannotGather as error:
                problems.append(f"{curve.name}: {error}")
    replace(folder.run(name) / "quantities.json",
            as_text({"values": values, "curves": curves, "problems": problems, "warnings": warned}))


def table(folder: Folder) -> None:
    from pliant.study.curves import write_curves
    from pliant.study.table import write_table
    write_table(folder)
    write_curves(folder)


def plots(folder: Folder) -> None:
    from pliant.study.figures import draw_all
    shutil.rmtree(folder.path / "figures", ignore_errors=True)
    replace(folder.path / "plots.json", as_text(draw_all(folder)))


def report(folder: Folder) -> None:
    from pliant.study.report import write_report
    write_report(folder)


STEPS = {step.__name__: step for step in (scene, run, gather, table, plots, report)}

if __name__ == "__main__":
    STEPS[sys.argv[1]](Folder(Path(sys.argv[2])), *sys.argv[3:])
