"""Harms runs in every way that a machine or a user may, and looks at what is left: each ends with a clear message, or
goes on with the bits and figures of a run that nothing disturbed; nothing finished is lost. Mounts small file systems,
so it needs root. Not a part of `./pliant test`.

    /usr/bin/python3 -B tests/cli/faults.py --faults 100

Exit code 1 when anything is lost or not told.
"""

from __future__ import annotations

import argparse
import collections
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from conftest import Desk
from kills import EACH_STEP, assert_same, killed, mend, start
from kill_often import whole_run
from scenes import LAYER

BAD_INPUT, FAILED_FILES = 2, 4  # exit codes


class Bench:
    """A scene whose undisturbed results are known."""

    def __init__(self, folder: Path, integrator: str) -> None:
        self.desk, self.duration = whole_run(folder, LAYER, integrator)
        self.size = sum(file.stat().st_size for file in (folder / "whole").iterdir())

    def path(self, out: str) -> Path:
        return self.desk.folder / out

    def start(self, out: str) -> subprocess.Popen[str]:
        """A run that writes a checkpoint each millisecond."""
        return start(self.desk, out, "--threads", "1", "--checkpoint-every", "1 ms")

    def wait(self) -> None:
        time.sleep(random.uniform(0.2, 0.9) * self.duration)

    def stopped(self, out: str) -> None:
        """Leaves a run in its middle, with a checkpoint."""
        result = self.desk.run("--out", out, "--until", str(random.choice([1, 1.5, 2, 3])), "--quiet", "--threads", "1",
                               *EACH_STEP)
        assert result.returncode == 0, result.stderr

    def told(self, result: subprocess.CompletedProcess[str], code: int, *words: str) -> None:
        """Ended with one message that names what went wrong."""
        assert result.returncode == code, (result.returncode, result.stderr)
        errors = [line for line in result.stderr.splitlines() if line.startswith("error")]
        assert len(errors) == 1 and any(word in errors[0] for word in words), result.stderr


def contents(folder: Path) -> dict[str, bytes]:
    return {file.name: file.read_bytes() for file in sorted(folder.iterdir())}


@contextmanager
def mounted(folder: Path, options: str) -> Iterator[None]:
    folder.mkdir(exist_ok=True)
    subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", folder], check=True)
    try:
        yield
    finally:
        subprocess.run(["umount", folder], check=True)


def finished(process: subprocess.Popen[str]) -> subprocess.CompletedProcess[str]:
    output, errors = process.communicate(timeout=120)
    return subprocess.CompletedProcess(process.args, process.returncode, output, errors)


def kill(bench: Bench, out: str) -> None:
    process = bench.start(out)
    bench.wait()
    process.kill()
    killed(process)
    mend(bench.desk, out)
    assert_same(bench.desk, out)


def terminate(bench: Bench, out: str) -> None:
    process = bench.start(out)
    bench.wait()
    process.send_signal(signal.SIGTERM)
    result = finished(process)
    # A process that has not come to main() yet dies of the signal.
    early = result.returncode == -signal.SIGTERM and not bench.path(out).exists()
    assert early or result.returncode in {0, 143}, (result.returncode, result.stderr)
    assert early or result.returncode == 0 or "--resume" in result.stderr, result.stderr
    mend(bench.desk, out)
    assert_same(bench.desk, out)


def full_disk(bench: Bench, out: str) -> None:
    """Filled at any point; then there is room again."""
    with mounted(bench.path(out), f"size={int(random.uniform(0.3, 1.5) * bench.size / 4096) + 1}p"):
        process = bench.start(out)
        result = finished(process)
        if result.returncode != 0:
            bench.told(result, FAILED_FILES, "space")
            subprocess.run(["mount", "-o", f"remount,size={20 * bench.size}", bench.path(out)], check=True)
            resume = ["--resume"] if (bench.path(out) / "checkpoint.bin").exists() else ["--force"]
            result = bench.desk.run("--out", out, "--quiet", "--threads", "1", *resume)
            assert result.returncode == 0, result.stderr
        assert_same(bench.desk, out)


def read_only(bench: Bench, out: str) -> None:
    with mounted(bench.path(out), "ro"):
        bench.told(bench.desk.run("--out", out, "--quiet"), FAILED_FILES, "ead-only")
    bench.stopped(f"{out}_before")
    with mounted(bench.path(out), "size=20m"):
        for file in bench.path(f"{out}_before").iterdir():
            shutil.copy(file, bench.path(out))
        before = contents(bench.path(out))
        subprocess.run(["mount", "-o", "remount,ro", bench.path(out)], check=True)
        bench.told(bench.desk.run("--out", out, "--resume", "--quiet"), FAILED_FILES, "ead-only")
        assert contents(bench.path(out)) == before
    shutil.rmtree(bench.path(f"{out}_before"))


def harmed_checkpoint(bench: Bench, out: str, harm: Callable[[bytes], bytes]) -> None:
    """The run is refused with the other files as they were; with the checkpoint back it goes on."""
    bench.stopped(out)
    file = bench.path(out) / "checkpoint.bin"
    whole = file.read_bytes()
    file.write_bytes(harm(whole))
    before = contents(bench.path(out))
    result = bench.desk.run("--out", out, "--resume", "--quiet", "--threads", "1")
    bench.told(result, result.returncode if result.returncode in {BAD_INPUT, FAILED_FILES} else BAD_INPUT, "checkpoint")
    assert contents(bench.path(out)) == before
    file.write_bytes(whole)
    mend(bench.desk, out)
    assert_same(bench.desk, out)


def truncated_checkpoint(bench: Bench, out: str) -> None:
    harmed_checkpoint(bench, out, lambda whole: whole[:random.randrange(len(whole))])


def flipped_bit(bench: Bench, out: str) -> None:
    def flip(whole: bytes) -> bytes:
        at = random.randrange(len(whole))
        return whole[:at] + bytes([whole[at] ^ 1 << random.randrange(8)]) + whole[at + 1:]

    harmed_checkpoint(bench, out, flip)


def vanished_folder(bench: Bench, out: str) -> None:
    process = bench.start(out)
    bench.wait()
    while process.poll() is None and bench.path(out).exists():
        shutil.rmtree(bench.path(out), ignore_errors=True)
    result = finished(process)
    if result.returncode != 0:
        bench.told(result, FAILED_FILES, out)
    bench.path(out).mkdir(exist_ok=True)


def two_at_once(bench: Bench, out: str) -> None:
    process = bench.start(out)
    while process.poll() is None and not (bench.path(out) / "run.lock").exists():
        time.sleep(0.001)
    time.sleep(random.uniform(0, 0.3) * bench.duration)
    second = bench.desk.run("--out", out, "--quiet", random.choice(["--force", "--resume"]))
    if process.poll() is None:
        bench.told(second, FAILED_FILES, "another", "running")
    assert finished(process).returncode == 0
    assert_same(bench.desk, out)


FAULTS = [kill, terminate, full_disk, read_only, truncated_checkpoint, flipped_bit, vanished_folder, two_at_once]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--faults", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    random.seed(arguments.seed)
    lost: collections.Counter = collections.Counter()
    done: collections.Counter = collections.Counter()
    with tempfile.TemporaryDirectory() as name:
        benches = [Bench(Path(name) / integrator, integrator) for integrator in ("verlet", "step-doubling")]
        for number in range(arguments.faults):
            fault, bench, out = FAULTS[number % len(FAULTS)], benches[number // len(FAULTS) % 2], f"out{number}"
            done[fault.__name__] += 1
            try:
                fault(bench, out)
            except AssertionError as error:
                lost[fault.__name__] += 1
                print(f"{number} {fault.__name__}: {error}", file=sys.stderr)
            shutil.rmtree(bench.path(out), ignore_errors=True)
    for kind, count in done.items():
        print(f"{count:4d}  {kind.replace('_', ' ')}" + (f", {lost[kind]} lost or not told" if lost[kind] else ""))
    print(f"{sum(done.values()):4d}  faults, {sum(lost.values())} lost or not told")
    sys.exit(1 if lost else 0)


if __name__ == "__main__":
    main()
