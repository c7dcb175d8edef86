"""Runs the fuzzers on what they found before and on new inputs, and says how far they came.

    ./pliant fuzz                        all targets, half a minute each
    ./pliant fuzz scene --seconds 600

What they learn stays in results/fuzz/TARGET/corpus, what they found in results/fuzz/TARGET/findings. Exit codes: 0
nothing found, 1 a finding, 2 bad input.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TARGETS = sorted(file.stem.removesuffix("_fuzz") for file in Path(__file__).parent.glob("*_fuzz.cpp"))
SYMBOLIZER = Path("/usr/lib/llvm-19/bin/llvm-symbolizer")  # names source lines, where it is installed
LIMITS = ["-timeout=20", "-rss_limit_mb=3000", "-malloc_limit_mb=2000"]
WORDS = 200  # bytes: longer quotations are no key
COLUMNS = "x [mm], y [mm]\n0, 0\n1, 0\n0.5, 1\n"
GMSH_2 = """$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
4
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
$EndNodes
$Elements
2
1 2 2 0 1 1 2 3
2 2 2 0 1 1 3 4
$EndElements
"""
GMSH_4 = """$MeshFormat
4.1 0 8
$EndMeshFormat
$Nodes
1 3 1 3
2 1 0 3
1
2
3
0 0 0
1 0 0
0 1 0
$EndNodes
$Elements
1 1 1 1
2 1 2 1
1 1 2 3
$EndElements
"""


@dataclass(frozen=True)
class Outcome:
    target: str
    runs: int
    coverage: int  # edges
    findings: list[Path]


def words_of_scenes() -> list[str]:
    """Keys and choices that docs/scene.md names."""
    text = (ROOT / "docs/scene.md").read_text()
    found = set(re.findall(r"`([a-z_]+)`", text)) | set(re.findall(r'("[^"\n|]+")', text))
    return sorted(word for word in found if len(word) < WORDS)


def dictionary(words: list[str]) -> str:
    return "".join(f'"{word}"\n' for word in (word.replace("\\", "\\\\").replace('"', '\\"') for word in words))


def seeds(target: str, folder: Path) -> None:
    """Files to begin with."""
    folder.mkdir(parents=True, exist_ok=True)
    if target == "scene":
        for file in [*(ROOT / "cases").glob("*.toml"), *(ROOT / "verify/hard_cases").glob("*.toml")]:
            (folder / f"{file.parent.name}_{file.name}").write_bytes(file.read_bytes())
    elif target == "outline":
        for name, first, text in (("columns", 0, COLUMNS), ("gmsh_2", 1, GMSH_2), ("gmsh_4", 1, GMSH_4)):
            (folder / name).write_bytes(bytes([first]) + text.encode())
    elif target in ("triangulation", "projection"):
        for size in (8, 40, 120):
            (folder / f"even_{size}").write_bytes(bytes(37 * i % 256 for i in range(size)))


def run(program: Path, target: str, seconds: int, out: Path) -> Outcome:
    corpus, start, findings = (out / target / name for name in ("corpus", "seeds", "findings"))
    for folder in (corpus, findings):
        folder.mkdir(parents=True, exist_ok=True)
    seeds(target, start)
    words = out / target / "words.dict"
    words.write_text(dictionary(words_of_scenes()))
    command = [program, f"-max_total_time={seconds}", *LIMITS, f"-artifact_prefix={findings}/", f"-dict={words}",
               "-print_final_stats=1", corpus, start]
    environment = {**os.environ, "PLIANT_FUZZ_SEEDS": str(start), "OMP_NUM_THREADS": "1",
                   "LSAN_OPTIONS": f"print_suppressions=0:suppressions={Path(__file__).with_name('leaks_of_others.txt')}"}
    if SYMBOLIZER.exists():
        environment["ASAN_SYMBOLIZER_PATH"] = str(SYMBOLIZER)
    before = set(findings.iterdir())
    result = subprocess.run([*map(str, command)], capture_output=True, text=True, errors="replace", env=environment,
                            stdin=subprocess.DEVNULL)
    (out / target / "log.txt").write_text(result.stderr)
    found = sorted(set(findings.iterdir()) - before)
    if result.returncode != 0 and not found:
        raise RuntimeError(f"{program}: exit code {result.returncode}; see {out / target / 'log.txt'}")
    return Outcome(target, int(last(r"stat::number_of_executed_units: (\d+)", result.stderr)),
                   int(last(r" cov: (\d+) ", result.stderr)), found)


def last(pattern: str, text: str) -> str:
    """Group of the last match, "0" without one."""
    found = re.findall(pattern, text)
    return found[-1] if found else "0"


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="./pliant fuzz", description=__doc__.splitlines()[0])
    parser.add_argument("targets", nargs="*", default=TARGETS, metavar="TARGET", help=", ".join(TARGETS))
    parser.add_argument("--seconds", type=int, default=30, help="of each target")
    parser.add_argument("--programs", type=Path, default=ROOT / "build/fuzz/fuzz")
    parser.add_argument("--out", type=Path, default=ROOT / "results/fuzz")
    options = parser.parse_args(arguments)
    unknown = [target for target in options.targets if target not in TARGETS]
    if unknown or options.seconds < 1:
        parser.error(f"no target '{unknown[0]}'; there are: {', '.join(TARGETS)}" if unknown else "--seconds: at least 1")
    findings = 0

    def outcome_of(target: str) -> Outcome:
        return run(options.programs / f"{target}_fuzz", target, options.seconds, options.out)

    with ThreadPoolExecutor(os.cpu_count()) as pool:  # one target a core; each waits for its own process
        try:
            for outcome in pool.map(outcome_of, options.targets):
                findings += len(outcome.findings)
                print(f"{outcome.target:14} {outcome.runs:>10} runs, {outcome.coverage:>6} edges, "
                      f"{', '.join(map(str, outcome.findings)) or 'nothing found'}", flush=True)
        except (OSError, RuntimeError) as error:
            print(f"error: {error}", file=sys.stderr)
            return 2
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
