"""What a run is and how far it is, from its result folder, finished or not.

    ./pliant info results/third_body_mini

Exit codes: 0 done, 2: no such result folder.
"""

from __future__ import annotations

import argparse
import fcntl
import sys
import tomllib
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "python"))

from pliant.units import readable
from pliant.frames import BadFolder, Frames
from pliant.results import checkpoint_header, read_json

BAD_INPUT = 2
LONGEST_ROW = 4096  # bytes


def read_title(folder: Path) -> str:
    try:
        return tomllib.loads((folder / "scene.toml").read_text()).get("title", "")
    except (OSError, ValueError):
        return ""


def last_row(file: Path) -> dict[str, float]:
    """The last whole row of a table that may be growing, by column name without unit."""
    try:
        with file.open("rb") as table:
            names = [name.split(" [")[0].strip('"') for name in table.readline().decode().strip().split(",")]
            start = table.tell()
            table.seek(max(start, file.stat().st_size - LONGEST_ROW))
            rows = table.read().decode(errors="replace").rpartition("\n")[0].split("\n")
        values = [float(cell) if cell else float("nan") for cell in rows[-1].split(",")]
    except (OSError, ValueError):
        return {}
    return dict(zip(names, values)) if len(values) == len(names) else {}


def is_held(folder: Path) -> bool:
    """Whether a living run holds the folder."""
    try:
        with (folder / "run.lock").open() as lock:
            fcntl.flock(lock, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:
        pass
    return False


def frame_times(folder: Path) -> list[float]:
    try:
        return [float(time) for time in Frames(folder / "frames.h5", period=None).times]
    except BadFolder:
        return []


def status_of(summary: dict, held: bool) -> str:
    status = summary.get("status", "running")
    if held:
        return "running"
    return "killed: it neither ended nor stopped in order" if status == "running" else status


def duration(seconds: float) -> str:
    for size, unit in ((86400, "d"), (3600, "h"), (60, "min")):
        if seconds >= size:
            return f"{seconds / size:.1f} {unit}"
    return f"{seconds:.1f} s"


def size_text(size: int) -> str:
    return readable(float(size), "B") if size else "0 B"


def is_reference(summary: dict) -> bool:
    """Of the reference solver, which counts other things than the engine and writes no checkpoints."""
    return "solver" in summary


def speed_text(summary: dict) -> str:
    wall = duration(summary["wall_seconds"])
    if is_reference(summary):
        return f"{wall} on one thread, {summary['solver']}"
    resumed = f", resumed {summary['resumed']} times" if summary.get("resumed") else ""
    return f"{summary['evaluations_per_second']:.0f} evaluations/s, {wall} on {summary['threads']} threads{resumed}"


def progress_lines(summary: dict, steps: dict[str, float], end: float | None) -> list[tuple[str, str]]:
    time = max(steps.get("time", 0.0), summary.get("time", 0.0))
    share = f" of {readable(end, 's')} ({100 * time / end:.1f} %)" if end else ""
    lines = [("time", readable(time, "s") + share)]
    if not summary:
        return lines
    evaluations = int(max(steps.get("evaluations", 0), summary["evaluations"]))
    at = readable(summary["time"], "s")
    counted = "Newton iterations" if is_reference(summary) else "evaluations"
    lines.append(("steps", f"{summary['steps']}, {summary['rejections']} rejected (at {at}), {evaluations} {counted}"))
    lines.append(("speed", speed_text(summary)))
    if time > 0 and end and time < end and summary["time"] > 0:
        lines.append(("left", f"about {duration(summary['wall_seconds'] / summary['time'] * (end - time))}"))
    return lines


def book_lines(summary: dict) -> list[tuple[str, str]]:
    if not summary:
        return []
    at = readable(summary["time"], "s")
    energy = f"balance error {summary['energy']['balance_error']:.2e}"
    build = ("build", f"{summary['commit']}, {summary['compiler']}")
    if is_reference(summary):
        return [("energy", f"{energy} (at {at})"),
                ("scene", f"{summary['bodies']} bodies, {summary['dofs']} DOFs"), build]
    return [("energy", f"{energy}, momentum error {summary['momentum_error']:.1e} (at {at})"),
            ("hash", f"{summary['state_hash']} (at {at})"),
            ("scene", f"{summary['bodies']} bodies, {summary['nodes']} nodes, {summary['dofs']} DOFs"), build]


def file_lines(folder: Path) -> list[tuple[str, str]]:
    files = sorted(file for file in folder.iterdir() if file.is_file())
    return [("files", ", ".join(f"{file.name} {size_text(file.stat().st_size)}" for file in files))]


def next_step(folder: Path, status: str, checkpoint: dict, reference: bool) -> str:
    if reference and status == "finished":
        return f"./pliant plot {folder}, or ./pliant compare with a folder of the engine"
    if reference and status == "running":
        return "wait, or stop it with SIGINT or SIGTERM: results are whole up to there"
    if reference:
        return f"start anew with ./pliant reference SCENE --force --out {folder}: this solver writes no checkpoints"
    if status == "finished":
        return f"./pliant plot {folder}, or go on to a later end: ./pliant run --resume --out {folder} --until TIME"
    if status == "running":
        return "wait, or stop it with SIGINT or SIGTERM: it then writes a checkpoint"
    if not checkpoint and status.startswith("killed"):
        return f"./pliant run SCENE --resume --out {folder}, which starts anew: there is no checkpoint"
    if not checkpoint:
        return "start anew with --force: there is no checkpoint"
    if status.startswith("failed"):
        return (f"see the reason above; after mending what is outside of the scene (a full disk): ./pliant run "
                f"--resume --out {folder}; after changing the scene: ./pliant run SCENE --force --out {folder}")
    return f"./pliant run --resume --out {folder}"


def report(folder: Path) -> list[tuple[str, str]]:
    if not folder.is_dir():
        raise BadFolder(f"{folder}: no such folder; give the folder that `pliant run` wrote")
    summary, checkpoint = read_json(folder / "summary.json"), checkpoint_header(folder)
    if not summary and not checkpoint and not (folder / "steps.csv").exists():
        raise BadFolder(f"{folder}: holds neither summary.json nor checkpoint.bin nor steps.csv; give the folder that "
                        "`pliant run` wrote")
    status = status_of(summary, is_held(folder))
    end = summary.get("end", checkpoint.get("end"))
    lines = [("run", f"{folder}: {read_title(folder) or summary.get('scene', '')}"), ("status", status)]
    lines += progress_lines(summary, last_row(folder / "steps.csv"), end) + book_lines(summary)
    lines.append(("checkpoint", f"t = {readable(checkpoint['time'], 's')}, step {checkpoint['steps']}, written "
                                f"{checkpoint['written']} UTC" if checkpoint else "none"))
    times = frame_times(folder)
    lines.append(("frames", f"{len(times)}, the last at {readable(times[-1], 's')}" if times else "none"))
    return [*lines, *file_lines(folder), ("next", next_step(folder, status, checkpoint, is_reference(summary)))]


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="pliant info", description="What a run is and how far it is.",
                                     epilog="example: ./pliant info results/third_body_mini")
    parser.add_argument("folder", type=Path, help="result folder of `pliant run`")
    try:
        for name, text in report(parser.parse_args(arguments).folder):
            print(f"{name:<11}{text}")
    except BadFolder as error:
        print(f"error: {error}", file=sys.stderr)
        return BAD_INPUT
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
