#!/usr/bin/python3
"""Whole runs: time and memory a grain and step of the third body, and of packings like it of 200 to 200,000 grains.

    ./pliant bench scenes
    ./pliant bench scenes --largest                 # 200,000 grains too, if there is memory for them
    ./pliant bench scenes --compress                # first squeezes the third bodies until 1 us: minutes to an hour

Grains are those of cases/third_body.toml, discs of 1 um, half of them compliant with 168 nodes. In the series candidates for contact are found anew every
100 steps, so that its figures have their part of it, broad phase included. Third bodies start where --compress has left them, or else at the start of their
case. Also writes results/bench/scenes.json.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
from dataclasses import asdict, dataclass, replace
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
MISSING = 2
FINISHED = "finished"

PITCH, ROW_PITCH = 0.87, 1.002  # um, of the lattice
REFRESH = 100  # steps
MOST_OUTPUT = 0.03  # of all time
COMPRESSED_AT = "1 us"


@dataclass(frozen=True)
class Size:
    """Of a packing, and the steps that take some seconds."""
    columns: int
    rows: int
    steps: int

    @property
    def grains(self) -> int:
        return self.columns * self.rows


SERIES = [Size(10, 20, 4000), Size(100, 20, 800), Size(200, 100, 200)]
LARGEST = Size(1000, 200, 100)
LARGEST_MEMORY = 8e9  # bytes, with room to spare
THIRD_BODIES = {"third_body_mini": 10000, "third_body": 1000}  # steps


@dataclass
class Figures:
    """Of one run, or of the fastest of some."""
    scene: str
    grains: int
    threads: int
    steps: int
    evaluations: int
    seconds: float  # of the steps
    preparation: float  # s
    memory: float  # peak, bytes
    output: float  # share of the seconds
    cpu: float = 0.0  # of all threads and of the preparation too, s: on a busy machine it tells more than the clock

    @property
    def time_a_grain(self) -> float:
        """And step, s."""
        return self.seconds / (self.grains * max(1, self.steps))

    @property
    def memory_a_grain(self) -> float:
        return self.memory / self.grains


def replaced(text: str, pattern: str, new: str) -> str:
    """Each line that matches, at least one."""
    result, count = re.subn(pattern, new, text, flags=re.MULTILINE)
    if count == 0:
        raise ValueError(f"no line '{pattern}'")
    return result


def with_end(text: str, end: float) -> str:
    """Seconds."""
    return replaced(text, r"^end = .*$", f'end = "{end:.6g} s"')


def packing(case: str, size: Size) -> str:
    """The third body's scene on another number of columns and rows, searched for contacts at fixed times."""
    text = replaced(case, r"^columns = .*$", f"columns = {size.columns}")
    text = replaced(text, r"^rows = .*$", f"rows = {size.rows}")
    text = replaced(text, r"^period = .*um\"$", f'period = "{size.columns * PITCH:.9g} um"')
    text = replaced(text, r"^count = .*$", f"count = {size.columns}")
    upper = text.index('name = "upper"')
    text = text[:upper] + replaced(text[upper:], r"^level = .*$", f'level = "{(size.rows + 0.5) * ROW_PITCH:.9g} um"')
    return text + f"\n[contact]\nrefresh = {REFRESH}\n"


def figures_of(scene: str, grains: int, summary: dict, before: dict | None = None) -> Figures:
    """From a run's summary; `before`: that of the run that it goes on from."""
    before = before or {"steps": 0, "evaluations": 0}
    phases = summary["phase_seconds"]  # of this process
    seconds = sum(phases.values())
    return Figures(scene, grains, summary["threads"], summary["steps"] - before["steps"],
                   summary["evaluations"] - before["evaluations"], seconds, summary["preparation_seconds"],
                   summary["peak_memory_bytes"], phases["output"] / seconds if seconds > 0 else 0.0)


def last_step(folder: Path) -> float:
    """Length of the last of a run, s."""
    header, *rows = (folder / "steps.csv").read_text().splitlines()
    return float(rows[-1].split(",")[header.split(",").index("dt [s]")])


def available_memory(meminfo: str) -> float:
    """Bytes, from the text of /proc/meminfo."""
    found = re.search(r"^MemAvailable:\s+(\d+) kB", meminfo, re.MULTILINE)
    return float(found[1]) * 1024 if found else 0.0


def has_memory_for_largest() -> bool:
    """Says so if not."""
    available = available_memory(Path("/proc/meminfo").read_text())
    if available < LARGEST_MEMORY:
        print(f"error: 200,000 grains need {LARGEST_MEMORY / 1e9:.0f} GB, {available / 1e9:.1f} GB are free", file=sys.stderr)
    return available >= LARGEST_MEMORY


def table(rows: list[Figures]) -> str:
    lines = [f"{'scene':<22} {'grains':>7} {'threads':>7} {'steps':>7} {'evaluations':>11} {'a grain and step':>16} "
             f"{'a grain':>10} {'all memory':>10} {'prepared in':>11} {'output':>7} {'CPU':>8}"]
    lines += [f"{f.scene:<22} {f.grains:>7} {f.threads:>7} {f.steps:>7} {f.evaluations:>11} {f.time_a_grain * 1e9:>13.0f} ns "
              f"{f.memory_a_grain / 1e3:>7.1f} kB {f.memory / 1e6:>7.0f} MB {f.preparation:>9.2f} s {f.output:>7.1%} {f.cpu:>6.1f} s" for f in rows]
    return "\n".join(lines)


def verdict(rows: list[Figures]) -> list[str]:
    """What should be flat, and is it."""
    lines = []
    for threads in sorted({f.threads for f in rows}):
        times = [f.time_a_grain for f in rows if f.threads == threads and f.scene == "packing"]
        if len(times) > 1:
            lines.append(f"{threads} threads: time a grain and step from {min(times) * 1e9:.0f} to {max(times) * 1e9:.0f} ns, "
                         f"{max(times) / min(times):.2f} times")
    lines += [f"{f.scene}, {f.threads} threads: {f.output:.1%} of the time is output, more than {MOST_OUTPUT:.0%}"
              for f in rows if f.scene == "third_body_mini" and f.output > MOST_OUTPUT]
    return lines


def processor_time() -> float:
    """Of the programs that have ended, s."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


class Runner:
    def __init__(self, engine: Path, scratch: Path) -> None:
        self.engine, self.scratch = engine, scratch

    def run(self, *arguments: object) -> float:
        """Returns the processor's time, s."""
        before = processor_time()
        environment = {"OMP_WAIT_POLICY": "active", **os.environ}
        result = subprocess.run([self.engine, "run", *map(str, arguments), "--quiet"], capture_output=True, text=True,
                                env=environment)
        if result.returncode != 0:
            raise RuntimeError(result.stderr.strip())
        return processor_time() - before

    def fresh(self, name: str, grains: int, text: str, threads: int) -> Figures:
        scene, out = self.scratch / f"{name}.toml", self.scratch / "out"
        scene.write_text(text)
        cpu = self.run(scene, "--out", out, "--threads", threads, "--force")
        return replace(figures_of(name, grains, json.loads((out / "summary.json").read_text())), cpu=cpu)

    def resumed(self, name: str, grains: int, folder: Path, steps: int, threads: int) -> Figures:
        out = self.scratch / "resumed"
        shutil.rmtree(out, ignore_errors=True)
        shutil.copytree(folder, out)
        before = json.loads((out / "summary.json").read_text())
        until = before["time"] + steps * last_step(out)
        cpu = self.run(out / "scene.toml", "--resume", "--out", out, "--threads", threads, "--until", f"{until:.9g} s")
        return replace(figures_of(name, grains, json.loads((out / "summary.json").read_text()), before), cpu=cpu)


def usual_step(runner: Runner, case: str) -> float:
    """Of these grains, s: soon after the start it hardly changes."""
    runner.fresh("pilot", SERIES[0].grains, with_end(packing(case, SERIES[0]), 3e-9), 1)
    return last_step(runner.scratch / "out")


def compress(runner: Runner, folder: Path) -> None:
    for name in THIRD_BODIES:
        scene, out = ROOT / f"cases/{name}.toml", folder / name
        print(f"squeezing {name} until {COMPRESSED_AT}", flush=True)
        runner.run(scene, "--out", out, "--until", COMPRESSED_AT, *(["--resume"] if out.exists() else []))


def is_compressed(folder: Path) -> bool:
    summary = folder / "summary.json"
    return summary.exists() and (folder / "checkpoint.bin").exists() and json.loads(summary.read_text())["status"] == FINISHED


def third_body(runner: Runner, name: str, grains: int, steps: int, dt: float, threads: int, compressed: Path) -> Figures:
    if is_compressed(compressed / name):
        return runner.resumed(name, grains, compressed / name, steps, threads)
    text = (ROOT / f"cases/{name}.toml").read_text()
    return runner.fresh(name, grains, with_end(text, steps * dt), threads)


def parse_arguments(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="./pliant bench scenes", description=__doc__.splitlines()[0])
    parser.add_argument("--engine", type=Path, default=ROOT / "build/release/pliant_engine")
    parser.add_argument("--threads", type=int, nargs="+", default=sorted({1, min(2, os.cpu_count() or 1)}))
    parser.add_argument("--largest", action="store_true", help=f"200,000 grains too; needs {LARGEST_MEMORY / 1e9:.0f} GB")
    parser.add_argument("--compress", action="store_true", help=f"third bodies squeezed until {COMPRESSED_AT} first, once")
    parser.add_argument("--only", nargs="+", help="scenes whose names begin so: packing, third_body_mini, third_body")
    parser.add_argument("--repetitions", type=int, default=1, help="the fastest counts")
    parser.add_argument("--json", type=Path, default=ROOT / "results/bench/scenes.json")
    return parser.parse_args(arguments)


def main(arguments: list[str] | None = None) -> int:
    options = parse_arguments(arguments)
    if options.largest and not has_memory_for_largest():
        return MISSING
    case, compressed = (ROOT / "cases/third_body.toml").read_text(), options.json.parent / "compressed"
    wanted = lambda name: not options.only or any(name.startswith(begin) for begin in options.only)
    rows: list[Figures] = []
    with tempfile.TemporaryDirectory() as scratch:
        runner = Runner(options.engine, Path(scratch))
        try:
            if options.compress:
                compress(runner, compressed)
            dt = usual_step(runner, case)
            jobs = [(lambda threads, name=name, grains=grains: third_body(runner, name, grains, THIRD_BODIES[name], dt, threads, compressed))
                    for name, grains in [("third_body_mini", 200), ("third_body", 2000)] if wanted(name)]
            jobs += [(lambda threads, size=size: runner.fresh("packing", size.grains, with_end(packing(case, size), size.steps * dt), threads))
                     for size in SERIES + [LARGEST] * options.largest if wanted("packing")]
            for job in jobs:
                for threads in options.threads:
                    rows.append(min((job(threads) for _ in range(options.repetitions)), key=lambda f: f.time_a_grain))
                    print(table(rows).splitlines()[-1] if len(rows) > 1 else table(rows), flush=True)
        except (RuntimeError, OSError) as error:
            print(f"error: {error}", file=sys.stderr)
            return MISSING
    print("\n".join(verdict(rows)))
    options.json.parent.mkdir(parents=True, exist_ok=True)
    options.json.write_text(json.dumps([{**asdict(f), "time_a_grain": f.time_a_grain, "memory_a_grain": f.memory_a_grain}
                                        for f in rows], indent=2) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
