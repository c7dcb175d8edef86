"""Unit tests that detect a mutation."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import time
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

LONGEST = 1200  # s, of all tests


def red_tests(program: Path, folder: Path, longest: float = LONGEST, usual: float = LONGEST) -> list[str]:
    """Names of the tests that fail, crash or do not end within this number of seconds, as a mutant may hang. Once some
    are red, waiting ends after `usual` seconds. Tests run in one process per core, each with its share; a crash ends
    only its own share."""
    folder.mkdir(parents=True, exist_ok=True)
    shards = os.cpu_count() or 1
    running = {shard: start(program, folder, shard, shards) for shard in range(shards)}
    begin = time.monotonic()
    while running and time.monotonic() - begin < longest:
        for shard in [shard for shard, process in running.items() if process.poll() is not None]:
            end(running.pop(shard))
        if time.monotonic() - begin > usual and red_so_far(folder, shards, running):
            break
        time.sleep(0.2)
    red = red_so_far(folder, shards, running)
    for process in running.values():
        end(process)
    said = [text_of(folder, shard) for shard in range(shards)]
    if not any(begun(text) for text in said):
        raise RuntimeError(f"no unit test ran:\n{said[0][-4000:]}")
    # Those at work when others were red already are not to blame.
    return red or [name for text in said for name in unfinished(text)]


def red_so_far(folder: Path, shards: int, running: Iterable[int]) -> list[str]:
    """Without those still running."""
    red = []
    for shard in range(shards):
        said = text_of(folder, shard)
        at_work = begun(said)[-1:] if shard in running else []
        red += [name for name in unfinished(said) if name not in at_work]
    return red


def end(process: subprocess.Popen) -> None:
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def text_of(folder: Path, shard: int) -> str:
    return output(folder, shard).read_text(errors="replace")


def output(folder: Path, shard: int) -> Path:
    return folder / f"unit_tests_{shard}.txt"


def start(program: Path, folder: Path, shard: int, shards: int) -> subprocess.Popen:
    environment = {**os.environ, "GTEST_TOTAL_SHARDS": str(shards), "GTEST_SHARD_INDEX": str(shard),
                   "OMP_WAIT_POLICY": "passive"}
    with output(folder, shard).open("w") as file:
        return subprocess.Popen([str(program), "--gtest_color=no"], cwd=folder, env=environment, stdout=file,
                                stderr=subprocess.STDOUT, start_new_session=True)


def begun(said: str) -> list[str]:
    return re.findall(r"^\[ RUN      \] (\S+)", said, re.MULTILINE)


def unfinished(said: str) -> list[str]:
    """Tests that began and did not end successfully, from a test program's output."""
    well = set(re.findall(r"\[       OK \] (\S+)", said)) | set(re.findall(r"\[  SKIPPED \] (\S+)", said))
    return [name for name in begun(said) if name not in well]


def in_short(names: list[str]) -> str:
    shown = ", ".join(names[:4])
    return f"{shown} and {len(names) - 4} more" if len(names) > 4 else shown
