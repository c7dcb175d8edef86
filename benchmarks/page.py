"""Writes what was measured as a page: instructions and seconds over commits, and a roofline of kernels.

    ./pliant bench page               results/bench/index.html, to be opened in any browser, also without a network

Instructions are those that commits carry in benchmarks/instructions.json, seconds those of
benchmarks/results/history.jsonl (./pliant bench ab --record), the roofline that of results/bench/kernels.json (./pliant
bench kernels --json); what is missing is left out, and the page says so.

Exit codes: 0 written, 2 an input cannot be read, 4 the page cannot be written.
"""

from __future__ import annotations

import argparse
import json
import re
import statistics
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import history
from history import ROOT

WRITTEN, BAD_INPUT, NOT_WRITTEN = 0, 2, 4
TEMPLATE = Path(__file__).with_name("page")
CHARTS = Path("/usr/share/javascript/chart.js/chart.min.js")  # of the package libjs-chart.js
UNITS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}
MACHINE = "machine/"


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


def measured(file: Path) -> dict[str, dict[str, float]]:
    """Seconds, bytes and flops of an iteration by benchmark: the median where one ran several times."""
    runs: dict[str, list[dict]] = {}
    for entry in read_json(file).get("benchmarks", []):
        if entry.get("aggregate_name", "median") == "median" and not entry.get("error_occurred"):
            runs.setdefault(entry.get("run_name", entry["name"]), []).append(entry)
    result = {}
    for name, entries in runs.items():
        medians = [entry for entry in entries if "aggregate_name" in entry] or entries
        seconds = statistics.median(entry["real_time"] * UNITS[entry["time_unit"]] for entry in medians)
        result[name] = {"seconds": seconds, "bytes": medians[0].get("bytes", 0), "flops": medians[0].get("flops", 0)}
    return result


def roofline(file: Path) -> dict | None:
    """Peaks of the machine and places of kernels; None without the file."""
    if not file.exists():
        return None
    try:
        entries = measured(file)
        machine = {name.removeprefix(MACHINE): entry for name, entry in entries.items() if name.startswith(MACHINE)}
        # Google's benchmark adds its options to names, as in machine/fma_peak/real_time.
        peaks = [e["flops"] / e["seconds"] for name, e in machine.items() if name.startswith("fma_peak")]
        bandwidths = {name.removeprefix("read_bandwidth_").split("/")[0]: e["bytes"] / e["seconds"]
                      for name, e in machine.items() if name.startswith("read_bandwidth_")}
        kernels = [{"name": name, "intensity": e["flops"] / e["bytes"], "rate": e["flops"] / e["seconds"]}
                   for name, e in entries.items()
                   if not name.startswith(MACHINE) and e["bytes"] > 0 and e["flops"] > 0]
    except (KeyError, TypeError, AttributeError, ZeroDivisionError) as error:
        raise BadInput(f"{file}: is no output of ./pliant bench kernels --json: {error!r}") from error
    if not peaks or not bandwidths:
        raise BadInput(f"{file}: has no {MACHINE}fma_peak or no {MACHINE}read_bandwidth_*: a roofline needs both")
    return {"peak": max(peaks), "bandwidths": bandwidths, "kernels": kernels}


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
    parser.add_argument("--repository", type=Path, default=ROOT, metavar="DIR", help="whose commits carry counts")
    options = parser.parse_args(arguments)
    if options.kernels and not options.kernels.exists():
        parser.error(f"--kernels {options.kernels}: no such file")
    options.kernels = options.kernels or ROOT / "results/bench/kernels.json"
    return options


def main(arguments: list[str]) -> int:
    options = parse_arguments(arguments)
    try:
        lines = history.read(options.history)
        data = {"counts": counts_over_commits(options.repository, options.repository / history.COUNTS, lines),
                "seconds": seconds_over_commits(lines), "roofline": roofline(options.kernels)}
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
