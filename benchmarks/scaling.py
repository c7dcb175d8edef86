#!/usr/bin/python3
"""Predicts how the time of a step falls with the number of threads of one machine.

    ./pliant bench scaling
    ./pliant bench scaling --largest          # 200,000 grains too, if there is memory for them
    ./pliant bench scaling --scene FILE       # another scene, from its start

The times of all chunks of all parallel loops are recorded on one thread, and played back through the engine's schedule
for 1 to 128 threads. A region ends when its slowest thread does, and then costs a barrier, whose time is measured here
with two threads and grows with the logarithm of their number. Work between regions does not speed up. Caches, memory
and clock are those of one thread here: the last column gives the memory bandwidth that the step needs then. A limit is
taken into account with --bandwidth. Predicted times for one thread and for two stand beside measured ones.

Also writes results/bench/scaling.json, which ./pliant bench page shows.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import re
import subprocess
import sys
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from scenes import LARGEST, LARGEST_MEMORY, MISSING, ROOT, Size, has_memory_for_largest, packing

STEPS = 100  # as many as between two searches of packing()
LARGE_BODY = """
[shapes.large]
kind = "disc"
diameter = "40 um"
nodes = 50000

[[grains]]
name = "large"
shape = "large"
species = [{ body = "compliant", material = "soft", share = 1.0 }]

[grains.packing]
kind = "grid"
columns = 1
rows = 1
pitch = "40 um"
origin = ["43.5 um", "-20.5 um"]

"""


@dataclass(frozen=True)
class Machine:
    """To which a prediction applies."""
    barrier: float  # s, of two threads
    single: float  # s, of a region of one thread
    bandwidth: float  # bytes/s, of all threads

    def region(self, threads: int) -> float:
        return self.single if threads == 1 else max(self.single, self.barrier * math.log2(threads))


@dataclass(frozen=True)
class Region:
    """Of a parallel region, s; times are those of a call."""
    name: str
    calls: float  # in a step
    seconds: float
    serial: float  # before it
    worst_chunk: float
    bytes: float
    slowest: dict[int, float]  # by threads, in the engine's schedule
    by_cost: dict[int, float]  # with shares of equal cost

    def time(self, threads: int, machine: Machine, equal: bool = False) -> float:
        """In a step."""
        busy = (self.by_cost if equal else self.slowest)[threads]
        return self.calls * (max(busy, self.bytes / machine.bandwidth) + machine.region(threads))

    def efficiency(self, threads: int, machine: Machine) -> float:
        return self.calls * self.seconds / (threads * self.time(threads, machine))


def function_name(text: str) -> str:
    """Of a compiler's full name of a function: class and name."""
    without_arguments = re.sub(r"<[^<>]*>", "", re.sub(r"\(anonymous namespace\)::", "", text)).split("(")[0]
    return re.sub(r"^.*[ &*]", "", without_arguments).replace("pliant::", "")


def regions_of(recording: dict) -> list[Region]:
    threads = recording["threads"]
    by_threads = lambda values: dict(zip(threads, values))
    return [Region(f"{function_name(r['function'])}, {Path(r['file']).name}:{r['line']}", r["calls"], r["seconds"], r["serial"],
                   r["worst_chunk"], r["bytes"], by_threads(r["shares"]), by_threads(r["by_cost"]))
            for r in recording["regions"]]


@dataclass(frozen=True)
class Prediction:
    """Of a step."""
    threads: int
    seconds: float
    efficiency: float
    equal_cost: float  # efficiency with shares of equal cost
    serial: float  # share of the time
    bandwidth: float  # bytes/s that it needs


class Step:
    def __init__(self, recording: dict, bandwidth: float) -> None:
        self.recording, self.regions = recording, regions_of(recording)
        cost = {int(threads): seconds for threads, seconds in recording["region_cost"].items()}
        self.machine = Machine(cost.get(2, cost[1]), cost[1], bandwidth)
        self.serial = recording["serial_at_end"] + sum(r.calls * r.serial for r in self.regions)

    def seconds(self, threads: int, equal: bool = False) -> float:
        return self.serial + sum(r.time(threads, self.machine, equal) for r in self.regions)

    def measured(self, threads: int) -> float | None:
        found = self.recording["measured"].get(str(threads))
        return min(found) if found else None

    def predictions(self) -> list[Prediction]:
        one = self.seconds(1)
        result = []
        for threads in self.recording["threads"]:
            seconds = self.seconds(threads)
            result.append(Prediction(threads, seconds, one / (threads * seconds), one / (threads * self.seconds(threads, True)),
                                     self.serial / seconds, self.recording["bytes"] / seconds))
        return result

    def check(self) -> list[str]:
        """Predicted times beside measured ones."""
        found = [(threads, self.measured(threads)) for threads in (1, 2)]
        return [f"{threads} thread{'s' * (threads > 1)}: predicted {self.seconds(threads) * 1e3:.3f} ms, measured {time * 1e3:.3f} ms, "
                f"{self.seconds(threads) / time - 1:+.1%}" for threads, time in found if time]


def table_of(step: Step) -> str:
    lines = [f"{'threads':>7} {'ms a step':>10} {'efficiency':>10} {'equal cost':>10} {'serial':>7} {'GB/s':>7}"]
    lines += [f"{p.threads:>7} {p.seconds * 1e3:>10.3f} {p.efficiency:>10.0%} {p.equal_cost:>10.0%} {p.serial:>7.1%} {(f'{p.bandwidth / 1e9:.1f}' if p.bandwidth else '-'):>7}"
              for p in step.predictions()]
    return "\n".join(lines)


def table_of_regions(step: Step, threads: int, least: float = 0.003) -> str:
    """`least`: share of the time of a step on one thread or on all below which regions are left out."""
    one, many = step.seconds(1), step.seconds(threads)
    lines = [f"{'region':<60} {'ms, 1':>9} {'before':>9} {f'us, {threads}':>9} {'efficiency':>10} {'worst chunk, us':>17}"]
    for r in sorted(step.regions, key=lambda r: -r.time(threads, step.machine)):
        time = r.time(threads, step.machine)
        if max(r.calls * r.seconds / one, (time + r.calls * r.serial) / many) >= least:
            lines.append(f"{r.name[:60]:<60} {r.calls * r.seconds * 1e3:>9.4f} {r.calls * r.serial * 1e3:>9.4f} {time * 1e6:>9.1f} {r.efficiency(threads, step.machine):>10.0%} "
                         f"{r.worst_chunk * 1e6:>17.1f}")
    lines.append(f"{'after the last region':<60} {'':>9} {step.recording['serial_at_end'] * 1e3:>9.4f}")
    return "\n".join(lines)


def large_body_among_small(case: str) -> str:
    """2000 grains without walls on a disc of 50,000 nodes."""
    text = packing(case, Size(100, 20, STEPS))
    text = text[:text.index("[[walls]]")] + LARGE_BODY + text[text.index("[[contacts]]"):text.index("[[probes]]")]
    return text + f"\n[contact]\nrefresh = {STEPS}\n"


def run(program: Path, scene: Path, rounds: int) -> dict:
    environment = {"OMP_WAIT_POLICY": "active", "GLIBC_TUNABLES": "glibc.malloc.hugetlb=1", **os.environ}  # as launcher/simulate.sh
    result = subprocess.run([program, scene, str(STEPS), str(rounds)], capture_output=True, text=True, env=environment)
    if result.returncode != 0:
        raise RuntimeError(result.stderr.strip())
    return json.loads(result.stdout)


def with_bytes(recording: dict, pages: dict) -> dict:
    """A recording with what another run of the same scene found in pages of a step: of a region in each of its calls."""
    of = {(r["file"], r["line"]): r["bytes"] for r in pages.get("regions", [])}
    regions = [r | {"bytes": of.get((r["file"], r["line"]), 0) / max(1.0, r["calls"])} for r in recording["regions"]]
    return recording | {"bytes": pages["step"], "regions": regions}


def record(program: Path, scene: Path, rounds: int) -> dict:
    return with_bytes(run(program, scene, rounds), run(program, scene, 0))


def parse_arguments(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="./pliant bench scaling", description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=Path, default=ROOT / "build/release/pliant_record_loops")
    parser.add_argument("--scene", type=Path, help="instead of the packings")
    parser.add_argument("--only", nargs="+", help="of the packings, those whose names begin so")
    parser.add_argument("--largest", action="store_true", help=f"200,000 grains too; needs {LARGEST_MEMORY / 1e9:.0f} GB")
    parser.add_argument("--rounds", type=int, default=3, help=f"at least 1, of {STEPS} steps: recorded, and measured with one thread and with two; the fastest counts")
    parser.add_argument("--threads", type=int, default=64, help="of the table of regions: a power of two up to 128")
    parser.add_argument("--bandwidth", type=float, default=math.inf, metavar="GB/s", help="of the memory of the machine")
    parser.add_argument("--json", type=Path, default=ROOT / "results/bench/scaling.json")
    options = parser.parse_args(arguments)
    if options.threads not in (1, 2, 4, 8, 16, 32, 64, 128):
        parser.error(f"--threads {options.threads}: no power of two up to 128")
    if options.scene and not options.scene.is_file():
        parser.error(f"--scene {options.scene}: no such file")
    if options.rounds < 1:
        parser.error(f"--rounds {options.rounds}: at least 1")
    if not options.bandwidth > 0:
        parser.error(f"--bandwidth {options.bandwidth}: not positive")
    return options


def main(arguments: list[str] | None = None) -> int:
    options = parse_arguments(arguments)
    if options.largest and not has_memory_for_largest():
        return MISSING
    case = (ROOT / "cases/third_body.toml").read_text()
    scenes = {"2,000 grains": packing(case, Size(100, 20, STEPS)), "20,000 grains": packing(case, Size(200, 100, STEPS)),
              "large body": large_body_among_small(case)}
    if options.largest:
        scenes["200,000 grains"] = packing(case, LARGEST)
    if options.only:
        wanted = {name: text for name, text in scenes.items() if any(name.startswith(begin) for begin in options.only)}
        if not wanted:
            print(f"error: --only {' '.join(options.only)}: there are {', '.join(scenes)}", file=sys.stderr)
            return MISSING
        scenes = wanted
    found = {}
    with tempfile.TemporaryDirectory() as scratch:
        files = {name: Path(scratch) / f"{i}.toml" for i, name in enumerate(scenes)}
        for name, file in files.items():
            file.write_text(scenes[name])
        for name, file in ({options.scene.stem: options.scene} if options.scene else files).items():
            try:
                step = Step(record(options.program, file, options.rounds), options.bandwidth * 1e9)
            except (RuntimeError, OSError, ValueError) as error:
                print(f"error: {name}: {error}", file=sys.stderr)
                return MISSING
            print(f"# {name}", table_of(step), *step.check(), table_of_regions(step, options.threads), "", sep="\n", flush=True)
            found[name] = {"predictions": [asdict(p) for p in step.predictions()], "recording": step.recording}
    options.json.parent.mkdir(parents=True, exist_ok=True)
    options.json.write_text(json.dumps(found, indent=1) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
