"""A copy of the launcher beside a stub engine, with stubs of apt-get, cmake and ninja that log their calls."""

from __future__ import annotations

import os
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

STUBS = {
    "dpkg-query": 'for p in $INSTALLED; do printf "ii %s " "$p"; done',
    "apt-get": 'echo "apt-get $*" >>"$LOG"; case "$*" in *${APT_FAILS:-nothing-fails}*) exit 100 ;; esac; '
               '[ "$1" != download ] || for p in "${@:2}"; do touch "$p.deb"; done',
    "dpkg": 'echo "dpkg $*" >>"$LOG"; mkdir -p "$3/usr/lib"',
    "sudo": 'exec "$@"',
    "cmake": 'echo "cmake $*" >>"$LOG"; mkdir -p build/release; touch build/release/build.ninja; exit ${CMAKE_EXIT:-0}',
    "ninja": 'echo "ninja start" >>"$LOG"; sleep ${NINJA_SECONDS:-0}; echo "ninja end" >>"$LOG"; exit ${NINJA_EXIT:-0}',
    "ctest": 'echo "ctest $*" >>"$LOG"; printf "%s\\n" "      Start  1: a.b" "1/2 Test  #1: a.b ....   Passed    0.01 sec"'
             ' "2/2 Test  #2: c.d ....***Failed    0.02 sec"; while [ "$1" != --output-junit ]; do shift; done;'
             ' printf "<testsuite name=\\"x\\"\\n\\ttests=\\"2\\"\\n\\tfailures=\\"1\\"\\n\\tdisabled=\\"0\\"\\n\\tskipped=\\"0\\"\\n'
             '\\t>" >"$2"; exit 8',
}
ENGINE = 'echo "${TELLS-its folder}" >"${PLIANT_TELL_FOLDER:-/dev/null}"; printf "[%s]" "$@"; echo " places=${OMP_PLACES-none} wait=${OMP_WAIT_POLICY-none}"; exit ${ENGINE_EXIT:-0}'


@dataclass
class Launcher:
    root: Path
    log: Path
    environment: dict[str, str]

    def start(self, *arguments: str, process_group: int | None = None, **environment: str) -> subprocess.Popen[str]:
        (self.root / "elsewhere").mkdir(exist_ok=True)
        return subprocess.Popen([self.root / "pliant", *arguments], text=True, cwd=self.root / "elsewhere",
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL,
                                process_group=process_group, env=self.environment | environment)

    def __call__(self, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
        process = self.start(*arguments, **environment)
        output, errors = process.communicate(timeout=60)
        return subprocess.CompletedProcess(arguments, process.returncode, output, errors)

    def calls(self, program: str) -> list[str]:
        lines = self.log.read_text().splitlines() if self.log.exists() else []
        return [line for line in lines if line.startswith(program)]


def write_script(file: Path, body: str) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(f"#!/bin/bash\n{body}\n")
    file.chmod(0o755)


def all_packages() -> list[str]:
    lines = (ROOT / "packages.txt").read_text().splitlines()
    return [line.split()[0] for line in lines if line and not line.startswith("#")]


@pytest.fixture
def launcher(tmp_path: Path) -> Launcher:
    for name in ["pliant", "packages.txt", "CMakePresets.json"]:
        shutil.copy(ROOT / name, tmp_path / name)
    shutil.copytree(ROOT / "launcher", tmp_path / "launcher")
    for name, body in STUBS.items():
        write_script(tmp_path / "stubs" / name, body)
    for program in ["pliant_engine", "pliant_reference_solver"]:
        write_script(tmp_path / "build/release" / program, ENGINE)
    (tmp_path / "scripts").mkdir()
    (tmp_path / "scripts/plot.py").write_text("import sys\nprint('plot', *sys.argv[1:])\n")
    kept = {name: value for name, value in os.environ.items() if not name.startswith(("OMP_", "PLIANT_"))}
    environment = kept | {"PATH": f"{tmp_path / 'stubs'}:{os.environ['PATH']}", "LOG": str(tmp_path / "log"),
                          "INSTALLED": " ".join(all_packages())}
    return Launcher(tmp_path, tmp_path / "log", environment)
