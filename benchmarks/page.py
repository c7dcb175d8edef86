"""Writes what was measured as a page: instructions and seconds over commits, and a roofline of kernels.

    ./pliant bench page               results/bench/index.html, to be opened in any browser, also without a network

Instructions are those that commits carry in benchmarks/instructions.json, seconds those of
benchmarks/results/history.jsonl (./pliant bench ab --record), the roofline that of results/bench/kernels.json (./pliant
bench kernels --json), and times with more threads those of results/bench/scaling.json (./pliant bench scaling); what is
missing is left out, and the page says so.

Exit codes: 0 written, 2 an input cannot be read, 4 the page cannot be written.
"""

from __future__ import annotations

import argparse
import json
import re
import statistics
import sys
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import history
from history import ROOT

WRITTEN, BAD_INPUT, NOT_WRITTEN = 0, 2, 4
TEMPLATE = Path(__file__).with_name("page")
CHARTS = Path("/usr/share/javascript/chart.js/chart.min.js")  # of the package libjs-chart.js
UNITS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}
MACHINE = "machine/"
NO_KERNELS = (MACHINE, "baseline/")  # what the machine does, and plain loops for comparison


class BadInput(Exception):
    """A file cannot be used; the message names it."""


def read_json(file: Path) -> dict:
    try:
        content = json.loads(file.read_text())
    except (OSError, ValueError) as error:
        raise BadInput(f"{file}: cannot be read: {error}") from error
    if not isinstance(content, dict):
        raise BadInput(f"{file}: is no JSON object")
    return content


def counts_over_commits(repository: Path, values: Path, lines: list[dict]) -> list[dict]:
    """Instructions by name, the oldest first; last what stands in the file now, where no commit has it yet."""
    found = history.committed_counts(repository)
    known = {line["commit"] for line in found}
    found += [{key: line[key] for key in ("commit", "date", "instructions")}
              for line in lines if line["instructions"] and line["commit"] not in known]
    found.sort(key=lambda line: line["date"])
    if values.exists():
        try:
            now = {name: count["instructions"] for name, count in read_json(values)["counts"].items()}
        except (KeyError, TypeError, AttributeError) as error:
            raise BadInput(f"{values}: holds no counts: {error}") from error
        if not found or found[-1]["instructions"] != now:
            found.append({"commit": "now", "date": "", "instructions": now})
    return found


def seconds_over_commits(lines: list[dict]) -> list[dict]:
    return [{"commit": line["commit"], "date": line["date"], "minimum": min(line["seconds"]),
             "median": statistics.median(line["seconds"]), "runs": len(line["seconds"]),
             "of": f"{line['scene']}, {line['machine']['cores']} cores, {line['machine']['cpu']}"} for line in lines]


@dataclass
class Measured:
    """Of an iteration of a benchmark."""

    name: str
    threads: int
    seconds: float
    bytes: float
    flops: float


def measured(file: Path) -> list[Measured]:
    """The fastest of each benchmark's repetitions; the median where only what they make together is told."""
    found: dict[str, Measured] = {}
    single = [entry for entry in read_json(file).get("benchmarks", []) if not entry.get("error_occurred")]
    repeated = {entry["run_name"] for entry in single if entry.get("run_type") == "iteration"}
    for entry in single:
        if "aggregate_name" in entry and (entry["aggregate_name"] != "median" or entry["run_name"] in repeated):
            continue
        # Google's benchmark writes name/threads:2/real_time.
        name = re.sub(r"/(\w+:\d+|real_time)(?=/|$)", "", entry["run_name"])
        threads = re.search(r"/threads:(\d+)", entry["run_name"])
        run = Measured(name, int(threads[1]) if threads else 1, entry["real_time"] * UNITS[entry["time_unit"]],
                       entry.get("bytes", 0), entry.get("flops", 0))
        if entry["run_name"] not in found or run.seconds < found[entry["run_name"]].seconds:
            found[entry["run_name"]] = run
    return list(found.values())


def rooflines(file: Path) -> list[dict]:
    """By number of threads, peaks of the machine and places of kernels; none without the file."""
    if not file.exists():
        return []
    try:
        runs = measured(file)
        found = [roofline(threads, [run for run in runs if run.threads == threads])
                 for threads in sorted({run.threads for run in runs})]
    except (KeyError, TypeError, AttributeError, ZeroDivisionError) as error:
        raise BadInput(f"{file}: is no output of ./pliant bench kernels --json: {error!r}") from error
    found = [roof for roof in found if roof]
    if not found:
        raise BadInput(f"{file}: has no {MACHINE}fma_peak or no {MACHINE}read_bandwidth_*: a roofline needs both")
    return found


def roofline(threads: int, runs: list[Measured]) -> dict | None:
    peaks = [run.flops / run.seconds for run in runs if run.name.startswith(f"{MACHINE}fma_peak")]
    bandwidth = f"{MACHINE}read_bandwidth_"
    bandwidths = {run.name.removeprefix(bandwidth): run.bytes / run.seconds
                  for run in runs if run.name.startswith(bandwidth)}
    kernels = [{"name": run.name, "intensity": run.flops / run.bytes, "rate": run.flops / run.seconds}
               for run in runs if not run.name.startswith(NO_KERNELS) and run.bytes > 0 and run.flops > 0]
    if not peaks or not bandwidths:
        return None
    return {"threads": threads, "peak": max(peaks), "bandwidths": bandwidths, "kernels": kernels}


def scaling(file: Path) -> list[dict]:
    """Efficiency of each scene by numbers of threads; none without the file."""
    if not file.exists():
        return []
    try:
        return [{"scene": scene, "threads": [p["threads"] for p in found["predictions"]],
                 "efficiency": [p["efficiency"] for p in found["predictions"]],
                 "seconds": [p["seconds"] for p in found["predictions"]]} for scene, found in read_json(file).items()]
    except (KeyError, TypeError) as error:
        raise BadInput(f"{file}: is no output of ./pliant bench scaling: {error!r}") from error


def page(data: dict, charts: str) -> str:
    """Template, style, script and data in one text; data cannot end the element that holds them."""
    parts = {"style": (TEMPLATE / "page.css").read_text(), "script": (TEMPLATE / "page.js").read_text(),
             "charts": charts, "data": json.dumps(data).replace("<", "\\u003c")}
    return re.sub(r"\{\{(\w+)\}\}", lambda match: parts[match[1]], (TEMPLATE / "page.html").read_text())


def parse_arguments(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="./pliant bench page", description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=ROOT / "results/bench", metavar="DIR", help="folder of index.html")
    parser.add_argument("--history", type=Path, default=history.HISTORY, metavar="FILE",
                        help="default: benchmarks/results/history.jsonl")
    parser.add_argument("--kernels", type=Path, metavar="FILE", help="default: results/bench/kernels.json")
    parser.add_argument("--scaling", type=Path, metavar="FILE", help="default: results/bench/scaling.json")
    parser.add_argument("--repository", type=Path, default=ROOT, metavar="DIR", help="whose commits carry counts")
    options = parser.parse_args(arguments)
    for name in ("kernels", "scaling"):
        file = getattr(options, name)
        if file and not file.exists():
            parser.error(f"--{name} {file}: no such file")
        setattr(options, name, file or ROOT / f"results/bench/{name}.json")
    return options


def main(arguments: list[str]) -> int:
    options = parse_arguments(arguments)
    try:
        lines = history.read(options.history)
        data = {"counts": counts_over_commits(options.repository, options.repository / history.COUNTS, lines),
                "seconds": seconds_over_commits(lines), "rooflines": rooflines(options.kernels),
                "scaling": scaling(options.scaling)}
        text = page(data, CHARTS.read_text())
    except (BadInput, ValueError, OSError) as error:
        print(f"page: {error}", file=sys.stderr)
        return BAD_INPUT
    try:
        options.out.mkdir(parents=True, exist_ok=True)
        (options.out / "index.html").write_text(text)
    except OSError as error:
        print(f"page: {error}", file=sys.stderr)
        return NOT_WRITTEN
    print(options.out / "index.html")
    return WRITTEN


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
