"""Whether what guards speed finds injected faults: 3 % more instructions in a kernel, an allocation in a step.

    ./pliant bench faults

Each goes into a copy of one file, which is compiled as its build was and linked before the library that has the sound
one.

Exit codes: 0 all are found; 1 one is not; 2 could not be asked, or something is found without them.
"""

from __future__ import annotations

import argparse
import json
import shlex
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import gate
from gate import QUIET, SLOWER, Values
from marginal_cost import ROOT

FOUND, NOT_FOUND, NOT_ASKED = 0, 1, 2
SHARE = 0.03  # of a kernel's instructions


@dataclass
class Place:
    """Where a statement is inserted: behind a text that stands once in a file."""

    file: str
    behind: str

    def with_fault(self, statement: str) -> str:
        text = (ROOT / self.file).read_text()
        if text.count(self.behind) != 1:
            raise RuntimeError(f"'{self.behind}' stands {text.count(self.behind)} times in {self.file}, not once")
        return text.replace(self.behind, f"{self.behind}\n  {statement}")


CONTACT = Place("lib/contact/contact.cpp", "OutlineField& force, const StepStart* step) {")
STEP = Place("lib/dynamics/verlet.cpp",
             "void Verlet::attempt(State& state, const Proposal& proposal, StepReport& report) {")


def run(command: list[str], folder: Path) -> str:
    result = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    if result.returncode != 0:
        raise RuntimeError(f"{' '.join(command)[:200]} ...: {(result.stderr or result.stdout)[-2000:]}")
    return result.stdout


def including(entry: dict[str, str], file: Path) -> str | None:
    """The text of a compiled file if it includes the other: where several files are compiled at once."""
    unit = Path(entry["file"])
    if not unit.name.startswith("unity_"):
        return None
    text = unit.read_text()
    return text if f'#include "{file}"' in text else None


def compiled(build: Path, place: Place, statement: str, scratch: Path) -> Path:
    """The file with the statement, and what is compiled together with it, as an object."""
    source, faulty = scratch / Path(place.file).name, scratch / "faulty.o"
    source.write_text(place.with_fault(statement))
    entries = json.loads((build / "compile_commands.json").read_text())
    sound = next((entry for entry in entries if Path(entry["file"]) == ROOT / place.file), None)
    if sound is None:
        sound, text = next(((entry, text) for entry in entries if (text := including(entry, ROOT / place.file))), (None, ""))
        if sound is None:
            raise RuntimeError(f"{build} does not compile {place.file}")
        unit = scratch / "unit.cpp"
        unit.write_text(text.replace(f'#include "{ROOT / place.file}"', f'#include "{source}"'))
        source = unit
    words = [str(source) if word == sound["file"] else word for word in shlex.split(sound["command"])]
    words[words.index("-o") + 1] = str(faulty)
    run(words, Path(sound["directory"]))
    return faulty


def link_command(line: str, program: str, faulty: Path, to: Path) -> list[str]:
    """Of ninja's line that links a program, the same with one more object, before the libraries: what these have of it
    is not looked at."""
    for part in line.split(" && "):
        words = shlex.split(part)
        if "-o" in words and words[words.index("-o") + 1:][:1] == [program]:
            at = words.index("-o")
            return [*words[:at], str(faulty), "-o", str(to), *words[at + 2:]]
    raise RuntimeError(f"no command that links {program}: {line[:200]}")


def linked(build: Path, program: str, faulty: Path, scratch: Path) -> Path:
    line = run(["ninja", "-t", "commands", program], build).splitlines()[-1]
    run(link_command(line, program, faulty, scratch / program), build)
    return scratch / program


def slower_kernel_is_found(scratch: Path) -> bool:
    kernel, build = "contact_forces", ROOT / "build" / gate.PRESET
    sound = gate.count_all(build, [kernel], scratch)
    more = round(SHARE * sound[kernel].instructions)
    statement = f'asm volatile(".rept {more}\\n\\tnop\\n\\t.endr");'
    linked(build, "pliant_counted_kernels", compiled(build, CONTACT, statement, scratch), scratch)
    values = scratch / "instructions.json"
    Values(gate.build_of(build / "pliant_counted_kernels"), sound).write(values)
    asked = ["--only", kernel, "--values", str(values), "--programs"]
    if gate.main([*asked, str(build)]) != QUIET:
        raise RuntimeError(f"{kernel} is slower than itself")
    print("faults: this must fail:", flush=True)
    code = gate.main([*asked, str(scratch)])
    if code not in (QUIET, SLOWER):
        raise RuntimeError("the gate does not judge")
    return code == SLOWER


def allocation_is_found(scratch: Path) -> bool:
    build = ROOT / "build/release"
    faulty = linked(build, "pliant_tests", compiled(build, STEP, "::operator delete(::operator new(64));", scratch),
                     scratch)

    def is_red(program: Path) -> bool:
        test = subprocess.run([program, "--gtest_filter=Allocation.there_is_none_in_a_step"], cwd=build,
                              capture_output=True, text=True)
        print(test.stdout, end="", flush=True)
        if test.returncode not in (0, 1) or "1 test from" not in test.stdout:
            raise RuntimeError(f"{program.name} did not run its test, exit code {test.returncode}: {test.stderr[-1000:]}")
        return test.returncode == 1

    if is_red(build / "pliant_tests"):
        raise RuntimeError("the test fails without it")
    print("faults: this must fail:", flush=True)
    return is_red(faulty)


FAULTS = {"3 % more instructions in the contact forces": slower_kernel_is_found,
          "an allocation in each step": allocation_is_found}


def main(arguments: list[str]) -> int:
    argparse.ArgumentParser(prog="./pliant bench faults", description=__doc__.splitlines()[0]).parse_args(arguments)
    found = []
    for what, is_found in FAULTS.items():
        try:
            with tempfile.TemporaryDirectory() as scratch:
                found.append(is_found(Path(scratch)))
        except (OSError, RuntimeError, LookupError, ValueError, subprocess.CalledProcessError) as error:
            print(f"faults: {what}: could not be asked: {error}", file=sys.stderr)
            return NOT_ASKED
        print(f"faults: {what}: {'found' if found[-1] else 'NOT FOUND'}", flush=True)
    return FOUND if all(found) else NOT_FOUND


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
