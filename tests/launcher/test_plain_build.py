"""Without the launcher, as docs/install.md has it: CMake's own choices configure, and what they make compiles. EXACT."""

import json
import shlex
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SMALL = "lib/results/contact_network.cpp"


def test_cmake_alone_configures_what_compiles(tmp_path: Path) -> None:
    options = ["-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", "-DPLIANT_UNITY=OFF",  # one small file is compiled below
               "-DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON"]  # which would take most of the time
    configured = subprocess.run(["cmake", "-G", "Ninja", "-B", tmp_path, "-S", ROOT, *options],
                                capture_output=True, text=True)
    assert configured.returncode == 0, configured.stderr
    commands = {Path(entry["file"]).relative_to(ROOT).as_posix(): shlex.split(entry["command"])
                for entry in json.loads((tmp_path / "compile_commands.json").read_text())
                if Path(entry["file"]).is_relative_to(ROOT)}
    assert "-O3" in commands[SMALL] or "-O2" in commands[SMALL], "not optimised"
    programs = ["pliant_engine", "pliant_reference_solver"]
    planned = subprocess.run(["ninja", "-C", tmp_path, "-t", "commands", *programs], capture_output=True, text=True)
    assert planned.returncode == 0 and all(f"-o {name} " in planned.stdout for name in programs)
    compiled = subprocess.run([*commands[SMALL], "-fsyntax-only"], cwd=tmp_path, capture_output=True, text=True)
    assert compiled.returncode == 0, compiled.stderr
