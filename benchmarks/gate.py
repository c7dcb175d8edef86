"""Whether the engine got slower, by counting: kernels one by one, and small scenes.

    ./pliant bench gate               compares with instructions.json: warns over 0.5 % more, fails over 2 %
    ./pliant bench gate --update      writes what was counted

What is slower on purpose passes with a line `perf-accept: reason` in the message of a commit since the one that last
changed instructions.json. Counts are those of one compiler and one set of instructions: another build is not judged.

Exit codes: 0 no slower, 1 slower, 2 not judged: another compiler, a list that does not fit, bad input.
"""

from __future__ import annotations

import argparse
import difflib
import json
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass, field
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import marginal_cost
from callgrind import Count, count
from marginal_cost import PLAIN, ROOT, appended, both, law, replaced

QUIET, SLOWER, NOT_JUDGED = 0, 1, 2
WARNING, FAILURE = 0.005, 0.02  # of the committed count
VALUES = ROOT / "benchmarks/instructions.json"
PRESET = "counting"

FRICTION = 'law = "mohr-coulomb"\nfriction = 0.3'
SHORT = replaced('end = "0.04 us"', 'end = "0.01 us"')
SHEARED = replaced('level = "7.979 um"', 'level = "7.979 um"\nx = { velocity = "400 m/s" }')
KERNEL_SCENE = law(FRICTION)(PLAIN)
KERNELS = {"internal_forces": "internal_forces", "internal_forces_es_t3": "internal_forces", "outlines": "outlines",
           "carried_forces": "carried_forces", "contact_forces": "contact_forces", "find_candidates": "find_candidates",
           "renew_candidates": "renew_candidates", "contact_bound": "contact_bound", "internal_bound": "internal_bound",
           "step": "step"}
SCENES: dict[str, Callable[[str], str]] = {
    "scene_plain": SHORT,
    "scene_friction_cohesion": both(SHORT, law(FRICTION + '\ncohesion = "20 MPa"\ntension = "20 MPa"')),
    "scene_sheared": both(both(SHORT, law(FRICTION)), SHEARED)}
NAMES = [*KERNELS, *SCENES]


@dataclass
class Build:
    """What counts depend on beside the code."""

    compiler: str
    options: str
    architecture: str

    def __str__(self) -> str:
        return f"{self.compiler}, {' '.join(self.options.split())}, {self.architecture}"


@dataclass
class Values:
    """What instructions.json says."""

    build: Build
    counts: dict[str, Count] = field(default_factory=dict)

    @classmethod
    def read(cls, file: Path) -> Values:
        try:
            content = json.loads(file.read_text())
            return cls(Build(**content["build"]), {name: Count(**c) for name, c in content["counts"].items()})
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise SystemExit(refusal(f"{file}: cannot be read: {error}")) from error

    def write(self, file: Path) -> None:
        content = {"preset": PRESET, "build": asdict(self.build),
                   "counts": {name: {key: n for key, n in asdict(c).items() if n or key != "evaluations"}
                              for name, c in self.counts.items()}}
        file.write_text(json.dumps(content, indent=2) + "\n")


@dataclass
class Verdict:
    lines: list[str]
    code: int


def refusal(message: str) -> int:
    """Says why nothing is judged; the exit code for it."""
    print(f"gate: {message}", file=sys.stderr)
    return NOT_JUDGED


def judge(before: dict[str, Count], now: dict[str, Count], reasons: list[str]) -> Verdict:
    """Compares counts. `reasons`: of commits that accept a slower engine."""
    wrong = [f"{name} has no value: ./pliant bench gate --update" for name in now if name not in before]
    wrong += [f"{name} has a value but is not counted any more: ./pliant bench gate --update"
              for name in before if name not in now]
    if wrong:
        return Verdict([f"error: {line}" for line in wrong], NOT_JUDGED)
    lines, code = [], QUIET
    for name, counted in now.items():
        change = counted.instructions / before[name].instructions - 1
        told = f"{name}: {100 * change:+.2f} %{where(before[name], counted)}"
        if change > FAILURE and not reasons:
            lines.append(f"FAILED {told}, more than {100 * FAILURE:g} % slower")
            code = SLOWER
        elif change > FAILURE:
            lines.append(f"accepted {told}")
        elif change > WARNING:
            lines.append(f"warning: {told}")
        elif change < -FAILURE:
            lines.append(f"warning: {told}, faster: keep it by ./pliant bench gate --update")
    if any(line.startswith("accepted") for line in lines):
        lines += [f"perf-accept: {reason}" for reason in reasons]
        lines.append("warning: until ./pliant bench gate --update more of it goes unseen")
    return Verdict(lines, code)


def where(before: Count, now: Count) -> str:
    """Named when a run took other steps, or when most of a change is not in the program's own code."""
    change, outside = now.instructions - before.instructions, now.libraries - before.libraries
    return ((f", with {now.evaluations} evaluations instead of {before.evaluations}"
             if now.evaluations != before.evaluations else "")
            + (", most of it in libraries" if change != 0 and outside / change > 0.5 else ""))


def table(before: dict[str, Count], now: dict[str, Count]) -> str:
    lines = ["| counted | instructions | in libraries | before | change |", "|---|--:|--:|--:|--:|"]
    for name, c in now.items():
        old = before.get(name)
        change = f"{old.instructions:,} | {100 * (c.instructions / old.instructions - 1):+.3f} %" if old else "| new"
        lines.append(f"| {name} | {c.instructions:,} | {100 * c.libraries / c.instructions:.1f} % | {change} |")
    return "\n".join(lines)


def git(repository: Path, *arguments: str) -> str:
    return subprocess.run(["git", "-C", repository, *arguments], capture_output=True, text=True).stdout


def accepted_reasons(repository: Path, values: Path) -> list[str]:
    """Of the commits since the one that last changed the values."""
    base = git(repository, "log", "-1", "--format=%H", "--", str(values)).strip()
    messages = git(repository, "log", "--format=%B", f"{base}..HEAD") if base else ""
    return re.findall(r"^perf-accept: *(\S.*?) *$", messages, re.MULTILINE)


def build_of(program: Path) -> Build:
    return Build(**json.loads(subprocess.run([program, "--build"], capture_output=True, text=True, check=True).stdout))


def count_all(programs: Path, names: list[str], scratch: Path) -> dict[str, Count]:
    """Several at once: a count does not depend on what else a machine does."""

    def one(name: str) -> Count:
        folder = scratch / re.sub(r"\W+", "_", name)
        if name in SCENES:
            counted = marginal_cost.count(programs / "pliant_engine", SCENES[name](PLAIN), folder)
            return Count(counted.instructions, counted.libraries, counted.evaluations)
        folder.mkdir()
        edit = appended('\n[discretisation]\nmethod = "es-t3"\n') if name.endswith("es_t3") else str
        (folder / "scene.toml").write_text(edit(KERNEL_SCENE))
        command = [str(programs / "pliant_counted_kernels"), str(folder / "scene.toml"), KERNELS[name]]
        return count(command, "pliant_counted", folder)

    longest_first = sorted(names, key=lambda name: name not in SCENES)
    with ThreadPoolExecutor(max_workers=os.cpu_count()) as pool:
        jobs = {name: pool.submit(one, name) for name in longest_first}
        return {name: jobs[name].result() for name in names}


def parse_arguments(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="./pliant bench gate", description=__doc__.splitlines()[0])
    parser.add_argument("--update", action="store_true", help="writes what was counted to instructions.json")
    parser.add_argument("--only", nargs="+", metavar="NAME", default=[], help="these alone")
    parser.add_argument("--json", type=Path, metavar="FILE", help="writes what was counted there as well")
    parser.add_argument("--values", type=Path, default=VALUES, metavar="FILE",
                        help="instead of benchmarks/instructions.json")
    parser.add_argument("--programs", type=Path, default=ROOT / "build" / PRESET, metavar="DIR",
                        help="of pliant_engine and pliant_counted_kernels")
    options = parser.parse_args(arguments)
    for name in options.only:
        if name not in NAMES:
            near = difflib.get_close_matches(name, NAMES, 1)
            parser.error(f"nothing is called '{name}'" + (f"; did you mean '{near[0]}'?" if near else "")
                         + f"; there are: {', '.join(NAMES)}")
    if options.update and options.only:
        parser.error("--update writes all values: leave --only out")
    return options


def main(arguments: list[str]) -> int:
    options = parse_arguments(arguments)
    try:
        build = build_of(options.programs / "pliant_counted_kernels")
        before = None if options.update and not options.values.exists() else Values.read(options.values)
        if before and before.build != build and not options.update:
            return refusal(f"not judged: {options.values.name} is of {before.build}; this is {build}. Counts of "
                           "different builds do not compare: build with that compiler, or ./pliant bench gate --update")
        with tempfile.TemporaryDirectory() as scratch:
            now = count_all(options.programs, options.only or NAMES, Path(scratch))
        if options.json:
            Values(build, now).write(options.json)
    except (OSError, RuntimeError, subprocess.CalledProcessError) as error:
        return refusal(str(error))
    known = before.counts if before else {}
    print(table(known, now))
    if options.update:
        Values(build, now).write(options.values)
        return QUIET
    wanted = {name: c for name, c in known.items() if not options.only or name in options.only}
    verdict = judge(wanted, now, accepted_reasons(options.values.parent, options.values))
    if verdict.code == SLOWER and git(options.values.parent, "rev-parse", "--is-shallow-repository").strip() == "true":
        verdict.lines.append("this clone is shallow: perf-accept lines of commits that it lacks are not seen")
    word = ("no slower", "slower", "not judged")[verdict.code]
    print("\n".join([*verdict.lines, f"gate: {len(now)} counted, {word}"]))
    return verdict.code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
