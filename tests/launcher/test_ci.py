"""What continuous integration runs: the same each time, in a bare system. EXACT."""

from __future__ import annotations

import re
import shutil
import subprocess

from conftest import ROOT, Launcher, write_script

STAGES = {"system": "make_system", "newcomer": "tests/fresh/newcomer", "test": "pliant test -LE ^case$", "lint": "pliant lint",
          "gate": "pliant bench gate", "gcc": "pliant test --preset gcc --scenes",
          "gcc_cases": "pliant verify --fast",
          "fuzz": "pliant fuzz --seconds 10", "memory": "pliant test --preset fuzz --scenes", "units": "core|files: pliant test --preset fuzz --units",
          "determinism": r"counting gcc: pliant test -R ^cli\.determinism$ -V", "verify": "pliant verify --slow"}


def run_ci(launcher: Launcher) -> subprocess.CompletedProcess[str]:
    """With a system that is none, and programs that only say what was asked of them."""
    (launcher.root / ".ci").mkdir(exist_ok=True)
    shutil.copy(ROOT / ".ci/run", launcher.root / ".ci/run")
    (launcher.root / "tests/fresh").mkdir(parents=True, exist_ok=True)
    (launcher.root / "tests/fresh/system.sh").write_text(
        'make_system() { echo make_system >>"$LOG"; }\ninside() { shift 3; echo "in the system" >>"$LOG"; "$@"; }\n')
    write_script(launcher.root / "tests/fresh/newcomer", 'echo tests/fresh/newcomer >>"$LOG"')
    write_script(launcher.root / "bin/mmdebstrap", "true")
    write_script(launcher.root / "pliant",
                 'echo "${PLIANT_BUILDS:+$PLIANT_BUILDS: }${PLIANT_TEST_FOLDERS:+$PLIANT_TEST_FOLDERS: }pliant $*" >>"$LOG"; case $* in lint) echo "3 passed";; '
                 '"test -LE "*) echo "9 passed"; [ -z "${FAILED-}" ] || echo "  71 - scripts.movie (Timeout)"; echo "5 passed, ${FAILED:-0} failed, 2 skipped"; [ -z "${FAILED-}" ] || exit 8;; '
                 '"test --preset "*) echo "4 passed, 0 failed, 0 skipped";; '
                 'verify*) echo "== 7 passed, 2 xfailed in 3 s ==";; esac')
    path = f"{launcher.root / 'bin'}:{launcher.environment['PATH']}"
    return subprocess.run([launcher.root / ".ci/run"], env=launcher.environment | {"PATH": path}, capture_output=True, text=True)


def test_ci_runs_every_stage_in_a_bare_system_and_counts_all_tests(launcher: Launcher) -> None:
    result = run_ci(launcher)
    assert result.returncode == 0
    calls = launcher.log.read_text().splitlines()
    assert calls[0] == "make_system" and calls[1::2] == ["in the system"] * (len(STAGES) - 1)
    assert calls[2::2] == list(STAGES.values())[1:]
    lines = result.stdout.splitlines()
    assert lines[-1] == "31 passed, 0 failed, 2 skipped, 4 known to fail"
    told = lines[-2 - len(STAGES):-1]
    assert [line.split()[1] for line in told] == [*STAGES, "all"]
    assert all(line.endswith("green") for line in told[:-1])


def test_ci_fails_with_one_stage_and_runs_the_others(launcher: Launcher) -> None:
    launcher.environment["FAILED"] = "1"
    result = run_ci(launcher)
    assert result.returncode == 1
    lines = result.stdout.splitlines()
    assert lines[-1] == "31 passed, 1 failed, 2 skipped, 4 known to fail"
    assert [line.split()[1] for line in lines if re.fullmatch(r"ci: \w+ \d+ s, red", line)] == ["test", "test"]
    assert [line.split()[1] for line in lines[-2 - len(STAGES):-1]] == [*STAGES, "all"]
    assert lines[-3 - len(STAGES)] == "ci: test: 71 - scripts.movie (Timeout)"  # of them all, shortly before the end


def test_no_stage_depends_on_a_count_or_a_date() -> None:
    assert not re.search(r"\bdate\b|rev-list|RANDOM|git log", (ROOT / ".ci/run").read_text())
