"""Instructions that callgrind counts inside one function, the same on every machine.

valgrind shows a program a processor of its own, but with AVX2 only where the machine has it, and the C library chooses
memcpy, exp and pow by that and by the sizes of caches. Here it is told to choose as for a processor of 2008. One
thread: a team's waiting would be counted.
"""

from __future__ import annotations

import os
import re
import subprocess
from dataclasses import dataclass
from pathlib import Path

NOT_USED = ["AVX", "AVX2", "AVX_Fast_Unaligned_Load", "AVX512F", "AVX512VL", "AVX512BW", "BMI1", "BMI2", "ERMS", "FMA",
            "FMA4", "FSRM", "LZCNT", "MOVBE", "RTM", "XSAVE", "XSAVEC"]
FIXED = {"GLIBC_TUNABLES": ":".join([
             "glibc.cpu.hwcaps=" + ",".join(f"-{name}" for name in NOT_USED), "glibc.cpu.x86_data_cache_size=32768",
             "glibc.cpu.x86_shared_cache_size=1048576", "glibc.cpu.x86_non_temporal_threshold=1048576"]),
         "LD_BIND_NOW": "1", "OMP_NUM_THREADS": "1", "LC_ALL": "C"}
NAME = re.compile(r"\((\d+)\)(?: (.*))?")


@dataclass
class Count:
    instructions: int
    libraries: int  # of them, in shared libraries: the C library's, OpenMP's
    evaluations: int = 0  # of forces, of a whole run


def count(command: list[str], function: str, folder: Path) -> Count:
    """Runs a command and counts what happens from each call of a function to its return. Raises RuntimeError with what
    the command said when it fails, or when the function was not met."""
    out = folder / "callgrind.out"
    valgrind = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", f"--toggle-collect={function}"]
    result = subprocess.run([*valgrind, *command], capture_output=True, text=True, env=os.environ | FIXED)
    if result.returncode != 0 or not out.is_file():
        raise RuntimeError(f"{' '.join(command)}: {result.stderr[-2000:]}")
    counts = by_object(out.read_text(errors="replace"))
    total = sum(counts.values())
    if total == 0:
        raise RuntimeError(f"{' '.join(command)} never calls {function}: nothing was counted")
    own = sum(n for name, n in counts.items() if Path(name).name == Path(command[0]).name)
    return Count(total, total - own)


def by_object(text: str) -> dict[str, int]:
    """Instructions by program or library, from callgrind's file: lines of costs below the object that they belong to;
    the line after `calls=` is what a callee took, which stands under the callee too."""
    counts: dict[str, int] = {}
    names: dict[str, str] = {}
    current, of_callee = "", False
    for line in text.splitlines():
        if line.startswith(("ob=", "cob=")):
            key, _, value = line.partition("=")
            if (short := NAME.fullmatch(value)) is not None:
                value = names.setdefault(short[1], short[2] or "")
            current = value if key == "ob" else current
        elif line.startswith("calls="):
            of_callee = True
        elif line[:1].isdigit() or line[:1] in "+-*":
            if not of_callee and len(parts := line.split()) > 1:
                counts[current] = counts.get(current, 0) + int(parts[1])
            of_callee = False
    return counts
