"""Which of two commits is faster, by wall time: their engines run one scene in turn.

    ./pliant bench ab HEAD~3 HEAD
    ./pliant bench ab build/release/pliant_engine my/pliant_engine     # programs that are built already

Each round runs A, A again (A') and B, every other round the other way about, so that what drifts meets both. Seconds
are those of the steps, without preparation and output. Nothing is said of B unless A and A', the same program, agree.
Worktrees and builds stay in build/ab for the next time.

Exit codes: 0 B is no slower, 1 B is slower, 2 not judged: A and A' differ, a build or a run failed, bad input;
130 stopped.
"""

from __future__ import annotations

import argparse
import difflib
import json
import os
import statistics
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from scipy.stats import mannwhitneyu

sys.path.insert(0, str(Path(__file__).resolve().parent))

import history
from history import ROOT, git

NO_SLOWER, SLOWER, NOT_JUDGED, STOPPED = 0, 1, 2, 130
SCENE = ROOT / "benchmarks/ab.toml"
LEAST_PAIRS = 9
SAME = 0.02  # how far A and A' may be apart, and B from A without being called slower
UNLIKELY = 0.01  # largest p of what is called a difference


@dataclass
class Side:
    name: str
    commit: str | None  # None: a program
    engine: Path


@dataclass
class Comparison:
    a: list[float]
    again: list[float]
    b: list[float]

    @property
    def ratio(self) -> float:
        return statistics.median(self.b) / statistics.median(self.a)

    @property
    def unrest(self) -> float:
        """How far the same program is from itself."""
        return abs(statistics.median(self.again) / statistics.median(self.a) - 1)

    @property
    def p(self) -> float:
        """Of so large a difference between equals (Mann and Whitney, two-sided)."""
        ties = len({*self.a, *self.b}) < len(self.a) + len(self.b)
        method = "asymptotic" if ties else "exact"
        return float(mannwhitneyu(self.a, self.b, alternative="two-sided", method=method).pvalue)

    def code(self) -> int:
        if self.unrest > SAME:
            return NOT_JUDGED
        return SLOWER if self.ratio > 1 + SAME and self.p < UNLIKELY else NO_SLOWER

    def verdict(self) -> str:
        if self.code() == NOT_JUDGED:
            return (f"not judged: A and A', the same program, differ by {100 * self.unrest:.1f} %, more than "
                    f"{100 * SAME:g} %: something else runs on this machine")
        if self.p >= UNLIKELY:
            return f"no difference seen: B/A {self.ratio:.3f}, p = {self.p:.2g}"
        word = "slower" if self.ratio > 1 else "faster"
        small = f", by less than {100 * SAME:g} %" if abs(self.ratio - 1) <= SAME else ""
        return f"B is {word}{small}: B/A {self.ratio:.3f}, p = {self.p:.2g}"

    def figures(self) -> dict:
        return {"ratio_of_medians": self.ratio, "ratio_of_minima": min(self.b) / min(self.a), "p": self.p,
                "same_program_apart": self.unrest, "verdict": self.verdict()}


def is_program(name: str) -> bool:
    return Path(name).is_file() and os.access(name, os.X_OK)


def checked_out(repository: Path, scratch: Path, name: str) -> Side:
    """A commit in a worktree of its own, built; or a program as it is."""
    if is_program(name):
        return Side(name, None, Path(name).resolve())
    try:
        commit = git(repository, "rev-parse", "--verify", "--quiet", "--end-of-options", f"{name}^{{commit}}").strip()
    except ValueError:
        known = git(repository, "for-each-ref", "--format=%(refname:short)").split()
        near = difflib.get_close_matches(name, known, 1)
        hint = f"; did you mean '{near[0]}'?" if near else ""
        raise ValueError(f"no commit and no program '{name}'{hint}") from None
    folder = scratch / commit[:12]
    if not (folder / ".git").exists():
        git(repository, "worktree", "prune")
        git(repository, "worktree", "add", "--detach", str(folder), commit)
    build(repository, folder)
    return Side(name, commit, folder / "build/release/pliant_engine")


def build(repository: Path, folder: Path) -> None:
    log = folder / "build/ab.log"
    log.parent.mkdir(exist_ok=True)
    print(f"pliant: building {folder.name} (log: {log})", file=sys.stderr)
    openmp = f"-DPLIANT_OPENMP={repository / 'build/openmp'}"  # if it is unpacked there, see cmake/compiler.cmake
    ninja = ["ninja", "-C", "build/release", "-j", str(os.cpu_count()), "pliant_engine"]
    with log.open("w") as file:
        for command in (["cmake", "--preset", "release", openmp], ninja):
            result = subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=file, stderr=file)
            if result.returncode != 0:
                raise RuntimeError(f"{folder.name} does not build: {log}")


def seconds_of_steps(engine: Path, scene: Path, threads: int) -> float:
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out"
        command = [engine, "run", scene, "--out", out, "--threads", str(threads), "--quiet"]
        result = subprocess.run(command, capture_output=True, text=True)
        if result.returncode != 0:
            raise RuntimeError(f"{engine}: exit code {result.returncode}: {result.stderr.strip()[-1000:]}")
        try:
            summary = json.loads((out / "summary.json").read_text())
            return summary["wall_seconds"] - summary["phase_seconds"]["output"]
        except (OSError, ValueError, KeyError) as error:
            raise RuntimeError(f"{engine}: its summary.json tells no time of steps: {error}") from error


def run_in_turn(a: Side, b: Side, scene: Path, pairs: int, threads: int) -> Comparison:
    seconds: dict[str, list[float]] = {"A": [], "A'": [], "B": []}
    engines = {"A": a.engine, "A'": a.engine, "B": b.engine}
    for pair in range(pairs):
        for name in list(engines)[::1 if pair % 2 == 0 else -1]:
            seconds[name].append(seconds_of_steps(engines[name], scene, threads))
        told = ", ".join(f"{name} {runs[-1]:.3f} s" for name, runs in seconds.items())
        print(f"pliant: {pair + 1} of {pairs}: {told}", file=sys.stderr)
    return Comparison(*seconds.values())


def table(a: Side, b: Side, comparison: Comparison) -> str:
    rows = [("A", a, comparison.a), ("A'", a, comparison.again), ("B", b, comparison.b)]
    lines = ["| engine | of | minimum, s | median, s | median/A |", "|---|---|--:|--:|--:|"]
    for name, side, seconds in rows:
        median, least = statistics.median(seconds), min(seconds)
        of = f"{side.name} ({side.commit[:12]})" if side.commit else side.name
        ratio = median / statistics.median(comparison.a)
        lines.append(f"| {name} | {of} | {least:.3f} | {median:.3f} | {ratio:.3f} |")
    return "\n".join([*lines, f"ab: {comparison.verdict()}"])


def parse_arguments(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="./pliant bench ab", description=__doc__.splitlines()[0])
    parser.add_argument("base", metavar="BASE", help="A: a commit, or a program")
    parser.add_argument("head", metavar="HEAD", help="B: a commit, or a program")
    parser.add_argument("--scene", type=Path, default=SCENE, metavar="FILE", help="of about 10 s by default")
    parser.add_argument("--pairs", type=int, default=LEAST_PAIRS, metavar="N", help=f"rounds, at least {LEAST_PAIRS}")
    parser.add_argument("--threads", type=int, default=os.cpu_count(), metavar="N", help="of a run; default: all cores")
    parser.add_argument("--json", type=Path, metavar="FILE", help="writes all seconds and figures there as well")
    parser.add_argument("--record", action="store_true", help="adds a line for each commit to the history")
    parser.add_argument("--history", type=Path, default=history.HISTORY, metavar="FILE",
                        help="default: benchmarks/results/history.jsonl")
    parser.add_argument("--repository", type=Path, default=ROOT, metavar="DIR", help="whose commits these are")
    options = parser.parse_args(arguments)
    if options.pairs < LEAST_PAIRS:
        parser.error(f"--pairs {options.pairs}: at least {LEAST_PAIRS}, else chance decides")
    if options.threads < 1:
        parser.error(f"--threads {options.threads}: at least 1")
    if not options.scene.is_file():
        parser.error(f"--scene {options.scene}: no such file")
    for name in (options.base, options.head):
        if options.record and is_program(name):
            parser.error(f"--record is of commits: the program {name} does not tell its own")
    return options


def main(arguments: list[str]) -> int:
    options = parse_arguments(arguments)
    worktrees = options.repository / "build/ab"
    try:
        a, b = (checked_out(options.repository, worktrees, name) for name in (options.base, options.head))
        comparison = run_in_turn(a, b, options.scene, options.pairs, options.threads)
    except (ValueError, RuntimeError, OSError) as error:
        print(f"ab: {error}", file=sys.stderr)
        return NOT_JUDGED
    except KeyboardInterrupt:
        return STOPPED
    print(table(a, b, comparison))
    if options.json:
        sides = {"A": a.commit or a.name, "B": b.commit or b.name}
        seconds = {"A": comparison.a, "A'": comparison.again, "B": comparison.b}
        content = {"of": sides, "scene": str(options.scene), "threads": options.threads, "machine": history.machine(),
                   "seconds": seconds, **comparison.figures()}
        options.json.write_text(json.dumps(content, indent=2) + "\n")
    if options.record and comparison.code() != NOT_JUDGED:
        scene = options.scene.stem
        for side, seconds in {a.commit: (a, comparison.a + comparison.again), b.commit: (b, comparison.b)}.values():
            history.record(options.history, options.repository, side.commit, scene, seconds)
    return comparison.code()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
