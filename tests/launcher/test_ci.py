"""What continuous integration runs, in all its turns. EXACT."""

from __future__ import annotations

import shutil
import subprocess

import pytest
from conftest import ROOT, Launcher, write_script

SCENES = {"gcc": "test --preset gcc --scenes"}
UNITS = [{"gcc": f"PLIANT_TEST_PART={half}/2 test --preset gcc --units"} for half in (0, 1)]
IN_TURN = {0: SCENES | {"fuzz": "fuzz --seconds 30", "memory": "test --preset fuzz --scenes",
                        "races": "test --preset tsan --scenes"},
           1: UNITS[0], 3: UNITS[1],
           6: SCENES | {"memory": "PLIANT_TEST_PART=1/4 test --preset fuzz --units"}}  # by the number of commits


@pytest.mark.parametrize("commits", IN_TURN)
def test_ci_counts_all_tests_and_fails_with_one(launcher: Launcher, commits: int) -> None:
    (launcher.root / ".ci").mkdir()
    shutil.copy(ROOT / ".ci/run", launcher.root / ".ci/run")
    write_script(launcher.root / "pliant", 'echo "${PLIANT_TEST_PART:+PLIANT_TEST_PART=$PLIANT_TEST_PART }${PLIANT_BUILDS:+PLIANT_BUILDS=$PLIANT_BUILDS }$*" >>"$LOG"; case $* in lint) echo "3 passed";; "test -LE "*) echo "9 passed"; '
                 'echo "5 passed, 1 failed, 2 skipped"; exit 8;; "test --preset gcc --"*) echo "4 passed, 0 failed, 0 skipped";; '
                 'verify) echo "== 7 passed, 2 xfailed in 3 s ==";; esac')
    write_script(launcher.root / "bin/git", f"echo {commits}")
    environment = launcher.environment | {"PATH": f"{launcher.root / 'bin'}:{launcher.environment['PATH']}"}
    result = subprocess.run([launcher.root / ".ci/run"], env=environment, capture_output=True, text=True)
    assert result.returncode == 1
    assert launcher.log.read_text().splitlines() == [
        "lint", "test -LE ^case$", "bench gate", "bench planted", *IN_TURN[commits].values(), "test --preset debug --scenes",
        r"PLIANT_BUILDS=debug counting gcc test -R ^cli\.determinism$ -V", "verify"]
    lines = result.stdout.splitlines()
    assert lines[-1] == "16 passed, 1 failed, 2 skipped, 2 known to fail"
    stages = ["lint", "test", "gate", "planted", *IN_TURN[commits], "debug", "determinism", "verify", "all"]
    told = lines[-1 - len(stages):-1]
    assert [line.split()[1] for line in told] == stages
    assert [line.rsplit(" ", 1)[1] for line in told[:-1]] == ["green", "red", *["green"] * (len(stages) - 3)]
