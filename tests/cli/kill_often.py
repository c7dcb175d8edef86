"""Kills runs again and again, mends each by --resume and compares bits and summary with those of a run that nothing
disturbed: at random times, and before every single change of a file. Not a part of `./pliant test`, which kills a few.

    /usr/bin/python3 -B tests/cli/kill_often.py --kills 500
    /usr/bin/python3 -B tests/cli/kill_often.py --changes

Exit code 1 when anything differs.
"""

from __future__ import annotations

import argparse
import collections
import itertools
import random
import shutil
import sys
import tempfile
import time
from pathlib import Path

from conftest import Desk
from kills import EACH_STEP, assert_same, build_preload, changes_of, killed, mend, start, start_preloaded
from scenes import LAYER, SHORT_LAYER

LATE = 0.01  # s: a third of the random kills come within this time of the run's end


def whole_run(folder: Path, scene: str, integrator: str) -> tuple[Desk, float]:
    """A run in `whole`, and how long it took."""
    folder.mkdir()
    desk = Desk(folder)
    desk.write(scene.replace("[time]", f'[time]\nintegrator = "{integrator}"'))
    began = time.monotonic()
    result = desk.run("--out", "whole", "--threads", "1", "--quiet")
    assert result.returncode == 0, result.stderr
    return desk, time.monotonic() - began


def where(desk: Desk, out: str) -> str:
    """What a kill found."""
    folder = desk.folder / out
    if not folder.exists():
        return "before the folder"
    if not (folder / "run.lock").exists():
        return "after the end"
    if not (folder / "checkpoint.bin").exists():
        return "before the first checkpoint"
    time_done = desk.summary(out)["time"] if (folder / "summary.json").exists() else 0
    whole = (folder / "steps.csv").read_bytes() == (desk.folder / "whole/steps.csv").read_bytes()
    if whole:
        summary = "summary written" if time_done == desk.summary("whole")["end"] else "no summary"
        return f"after the last step, {summary}"
    return "amid the run"


def is_late(desk: Desk, out: str) -> bool:
    """Whether the last frame but one is there: an eighth of the run is left."""
    file = desk.folder / out / "frames.xdmf"
    return file.exists() and file.stat().st_size > 0.85 * (desk.folder / "whole/frames.xdmf").stat().st_size


def kill_at_random(desk: Desk, out: str, number: int, duration: float, late: bool) -> None:
    period = f"{random.choice([1, 5, 20])} ms"
    process = start(desk, out, "--threads", str(1 + number % 2), "--checkpoint-every", period)
    if late:
        while not is_late(desk, out) and process.poll() is None:
            time.sleep(0.0002)
    time.sleep(random.uniform(0, LATE if late else duration))
    process.kill()
    killed(process)


def random_kills(folder: Path, count: int) -> collections.Counter:
    desks = [whole_run(folder / integrator, LAYER, integrator) for integrator in ["verlet", "step-doubling"]]
    seen: collections.Counter = collections.Counter()
    for number in range(count):
        desk, duration = desks[number // 2 % 2]
        out = f"out{number}"
        kill_at_random(desk, out, number, duration, number % 3 == 0)
        seen[where(desk, out)] += 1
        check(desk, out, 1 + number // 4 % 2)
    return seen


def kills_at_changes(folder: Path, preload: Path) -> collections.Counter:
    seen: collections.Counter = collections.Counter()
    for integrator, threads in itertools.product(["verlet", "step-doubling"], [1, 2]):
        desk, _ = whole_run(folder / f"{integrator}{threads}", SHORT_LAYER, integrator)
        options = [*EACH_STEP, "--threads", str(threads)]
        for number in range(changes_of(preload, desk, "counted", *options)):
            out = f"out{number}"
            assert killed(start_preloaded(preload, desk, out, *options, KILL_BEFORE=number))
            seen[where(desk, out)] += 1
            check(desk, out, 3 - threads)
    return seen


def check(desk: Desk, out: str, threads: int) -> None:
    mend(desk, out, threads)
    assert_same(desk, out)
    shutil.rmtree(desk.folder / out)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kills", type=int, default=500, help="at random times")
    parser.add_argument("--changes", action="store_true", help="before every change of a file instead")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    random.seed(arguments.seed)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if arguments.changes:
            seen = kills_at_changes(folder, build_preload(folder))
        else:
            seen = random_kills(folder, arguments.kills)
    for moment, count in sorted(seen.items()):
        print(f"{count:5d}  {moment}")
    print(f"{sum(seen.values()):5d}  kills, all mended: the same bits and summary")


if __name__ == "__main__":
    try:
        main()
    except AssertionError as error:
        print(f"not mended: {error}", file=sys.stderr)
        raise
