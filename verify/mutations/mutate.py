"""Applies mutations, small errors of physics, one at a time to a copy of the code, and reports which unit tests and
which check of verify/ detect each.

    ./pliant verify --mutate                  all mutations of mutations.toml: some hours
    ./pliant verify --mutate NAME NAME        these

The copy and its builds are in build/mutants; results go to results/verify/mutations.json and into the report. A
mutation counts as detected if a unit test or a check is red, or a run ends with an error, that is green without it. All
unit tests and the mutation's own cases are run, and the other fast cases if those detect nothing.
"""

from __future__ import annotations

import argparse
import fcntl
import filecmp
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass
from pathlib import Path

VERIFY = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(VERIFY), str(VERIFY.parent / "scripts"), str(VERIFY.parent / "python")]

from report import report
from unit_tests import in_short, red_tests
from verification import OUT, ROOT, replace_file

MUTATIONS = Path(__file__).with_name("mutations.toml")
SCRATCH = ROOT / "build/mutants"
SOURCE = SCRATCH / "source"
BUILD = SOURCE / "build/release"
PROGRAMS = ["pliant_engine", "pliant_reference_solver", "pliant_agreement", "pliant_tests"]
LONGEST_RUN = 300  # s; a solver that runs longer than this does not come to an end


@dataclass
class Mutation:
    """A text that occurs once in a file, and its replacement. `cases` are tried first, then the fast ones."""

    name: str
    what: str
    file: str
    old: str
    new: str
    cases: list[str]

    def mutated(self, text: str) -> str:
        if text.count(self.old) != 1:
            raise ValueError(f"mutation {self.name}: text occurs {text.count(self.old)} times in {self.file}, not once")
        return text.replace(self.old, self.new)


@dataclass
class Verdict:
    """A row of results/verify/mutations.json."""

    name: str
    what: str
    file: str
    killed: bool
    killer: str
    message: str
    seconds: float


def read_mutations() -> list[Mutation]:
    return [Mutation(**entry) for entry in tomllib.loads(MUTATIONS.read_text())["mutation"]]


def copy_sources() -> None:
    """Unchanged files keep their times, so that little is rebuilt."""
    listed = subprocess.run(["git", "-C", str(ROOT), "ls-files", "-co", "--exclude-standard", "-z"], check=True,
                            capture_output=True, text=True).stdout
    names = {name for name in listed.split("\0") if name and (ROOT / name).is_file()}
    for name in sorted(names):
        source, copy = ROOT / name, SOURCE / name
        if copy.exists() and filecmp.cmp(source, copy, shallow=False):
            continue
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(source, copy)
    for copy in [file for file in SOURCE.rglob("*") if file.is_file()]:
        name = str(copy.relative_to(SOURCE))
        if name not in names and not name.startswith("build/"):
            copy.unlink()


def build() -> None:
    if not (BUILD / "build.ninja").exists():
        openmp = f"-DPLIANT_OPENMP={ROOT / 'build/openmp'}"  # if it is unpacked there, see cmake/compiler.cmake
        subprocess.run(["cmake", "--preset", "release", openmp], cwd=SOURCE, check=True, stdout=subprocess.DEVNULL)
    result = subprocess.run(["ninja", "-C", str(BUILD), *PROGRAMS], capture_output=True, text=True)
    if result.returncode != 0:
        raise RuntimeError(f"the copy does not build:\n{result.stdout[-3000:]}")


def run_cases(cases: list[str], name: str, *options: str) -> list[str]:
    """Red checks in these cases, each a line "case: check" and, after a tab, its message."""
    out = SCRATCH / "results" / name
    shutil.rmtree(out, ignore_errors=True)
    folders = [str(SOURCE / "verify" / case) for case in cases]
    environment = {**os.environ, "PLIANT_VERIFY_OUT": str(out), "PLIANT_VERIFY_LONGEST": str(LONGEST_RUN),
                   "OMP_WAIT_POLICY": "passive"}
    for variable in ("PLIANT_ENGINE", "PLIANT_REFERENCE", "PLIANT_AGREEMENT", "PLIANT_VERIFY_FULL"):
        environment.pop(variable, None)
    command = [sys.executable, "-B", "-m", "pytest", "-c", str(SOURCE / "verify/pytest.ini"), *options, "-n",
               str(os.cpu_count()), "--dist", "loadfile", *folders]
    process = subprocess.Popen(command, cwd=SOURCE, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               text=True, start_new_session=True)
    said, _ = process.communicate()
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)  # runs of a worker that was stopped after another's red check
    if not (out / "checks.json").exists():
        raise RuntimeError(f"no check ran:\n{said[-4000:]}")
    return red_lines(json.loads((out / "checks.json").read_text()))


def red_lines(checks: dict) -> list[str]:
    lines = [f"{row['case']}: {row['name']} ({row['label']})\t{row['value']:.5g}, expected {row['expected']:.5g} "
             f"+- {row['tolerance']:.2g}" for row in checks["checks"] if not row["green"]]
    return lines + [f"{failure['case']}: {failure['test']}\t{last_error(failure['message'])}"
                    for failure in checks["failures"]]


def last_error(message: str) -> str:
    """The line of a failed run that states the reason."""
    lines = [line.removeprefix("E").strip() for line in message.splitlines() if line.strip()]
    errors = [line for line in lines if "error" in line.lower() or "pliant" in line.lower()]
    return (errors or lines or ["ended without a message"])[-1][:300]


def fast_cases() -> list[str]:
    return sorted(file.parent.name for file in (ROOT / "verify").glob("*/check_*.py")
                  if re.search(r"^CASE = Case\(__file__, .*fast=True", file.read_text(), re.MULTILINE))


@dataclass
class Sound:
    """Tests and cases that are green without a mutation: only these can detect one."""

    cases: list[str]
    red_tests: list[str]
    seconds: float  # of the unit tests

    def unit_tests(self, name: str) -> list[str]:
        """Unit tests that detect a mutation."""
        longest = 3 * self.seconds + 60
        usual = longest if self.red_tests else 1.5 * self.seconds + 30  # tests that are red anyway would count
        red = red_tests(BUILD / "pliant_tests", SCRATCH / "results" / name, longest, usual)
        return [test for test in red if test not in self.red_tests]


def judge(mutation: Mutation, sound: Sound) -> Verdict:
    """Builds the mutant and searches for tests and a check that detect it."""
    start = time.monotonic()
    file = SOURCE / mutation.file
    text = file.read_text()
    file.write_text(mutation.mutated(text))
    try:
        build()
        suspects = [case for case in mutation.cases if case in sound.cases]
        red = run_cases(suspects, mutation.name, "-x") if suspects else []
        tests = sound.unit_tests(mutation.name)
        others = [case for case in fast_cases() if case in sound.cases and case not in suspects]
        if others and not (red or tests):
            red = run_cases(others, mutation.name, "-x")
    finally:
        file.write_text(text)
    check, message = (red[0].split("\t") if red else ("", ""))
    killer = "; ".join(([check] if red else []) + ([f"unit tests {in_short(tests)}"] if tests else []))
    return Verdict(mutation.name, mutation.what, mutation.file, bool(killer), killer, message, time.monotonic() - start)


def write_down(verdicts: list[Verdict], names: list[str]) -> None:
    """Updates the results, keeping those of other mutations."""
    OUT.mkdir(parents=True, exist_ok=True)
    file = OUT / "mutations.json"
    known = {row["name"]: row for row in json.loads(file.read_text())["rows"]} if file.exists() else {}
    known.update({verdict.name: {**asdict(verdict), "commit": report.commit()} for verdict in verdicts})
    rows = [known[name] for name in names if name in known]
    replace_file(file, json.dumps({"written": report.now(), "rows": rows}, indent=1) + "\n")
    report.write(OUT)


def look_for_sound(mutations: list[Mutation]) -> Sound:
    cases = sorted({case for mutation in mutations for case in mutation.cases} | set(fast_cases()))
    print(f"the copy without mutations: the unit tests and {len(cases)} cases", flush=True)
    start = time.monotonic()
    tests = red_tests(BUILD / "pliant_tests", SCRATCH / "results/none")
    seconds = time.monotonic() - start
    for test in tests:
        print(f"  unit test {test} is red without a mutation: left out", flush=True)
    red = {line.split(":")[0] for line in run_cases(cases, "none")}
    for case in sorted(red):
        print(f"  {case} is red without a mutation: left out", flush=True)
    return Sound([case for case in cases if case not in red], tests, seconds)


def chosen(mutations: list[Mutation], names: list[str]) -> list[Mutation]:
    unknown = [name for name in names if name not in {mutation.name for mutation in mutations}]
    if unknown:
        print(f"pliant: verify --mutate: no mutation '{unknown[0]}'; there are: "
              f"{' '.join(mutation.name for mutation in mutations)}", file=sys.stderr)
        sys.exit(2)
    return [mutation for mutation in mutations if not names or mutation.name in names]


@contextmanager
def alone() -> Iterator[None]:
    """Lock, as a concurrent call would change the same copy."""
    SCRATCH.mkdir(parents=True, exist_ok=True)
    with (SCRATCH / ".lock").open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise RuntimeError(f"another call makes mutations in {SCRATCH}; wait for its end") from None
        yield


def main() -> int:
    parser = argparse.ArgumentParser(prog="./pliant verify --mutate", description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help="mutations (default: all)")
    every = read_mutations()
    mutations = chosen(every, parser.parse_args().names)
    try:
        for mutation in mutations:
            mutation.mutated((ROOT / mutation.file).read_text())  # before an hour has gone by
        with alone():
            return judge_all(mutations, [mutation.name for mutation in every])
    except (OSError, RuntimeError, ValueError, subprocess.CalledProcessError) as error:
        print(f"pliant: verify --mutate: {error}", file=sys.stderr)
        return 1


def judge_all(mutations: list[Mutation], known: list[str]) -> int:
    """Exit code: 1 if a mutation survives. Results are written immediately."""
    copy_sources()
    build()
    sound = look_for_sound(mutations)
    verdicts = []
    for mutation in mutations:
        verdicts.append(judge(mutation, sound))
        write_down(verdicts, known)
        found = f"found by {verdicts[-1].killer}" if verdicts[-1].killed else "SURVIVED"
        print(f"{mutation.name:28} {verdicts[-1].seconds:5.0f} s  {found}", flush=True)
    survivors = [verdict.name for verdict in verdicts if not verdict.killed]
    print(f"{len(verdicts) - len(survivors)} of {len(verdicts)} mutations found" +
          (f"; survivors: {', '.join(survivors)}" if survivors else "") + f"; report: {OUT / 'report.html'}")
    return 1 if survivors else 0


if __name__ == "__main__":
    sys.exit(main())
