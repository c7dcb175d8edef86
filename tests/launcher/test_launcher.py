"""The launcher, on a copy beside a stub engine, with stubs of apt-get, cmake and ninja that log their calls. All EXACT."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import time
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


def test_missing_packages_are_installed_once(launcher: Launcher) -> None:
    present = " ".join(name for name in all_packages() if name not in {"cmake", "libeigen3-dev", "clang-tidy-19"})
    result = launcher("check", "a.toml", INSTALLED=present)
    update, install = launcher.calls("apt-get")
    assert " update" in update
    assert install.endswith(" cmake libeigen3-dev") and "--no-install-recommends" in install
    assert "installing 2 Debian packages" in result.stderr
    launcher("check", "a.toml", INSTALLED="")
    assert len(launcher.calls("apt-get")) == 2, "the second call must not look again"


def test_packages_are_looked_for_again_when_the_list_changes(launcher: Launcher) -> None:
    launcher("check", "a.toml")
    with (launcher.root / "packages.txt").open("a") as file:
        file.write("libnew-dev required something new\n")
    launcher("check", "a.toml")
    assert launcher.calls("apt-get")[-1].endswith(" libnew-dev")


def test_openmp_is_unpacked_where_it_would_remove_another(launcher: Launcher) -> None:
    present = " ".join(name for name in all_packages() if name not in {"clang-19", "libomp-19-dev", "libomp5-19"})
    result = launcher("check", "a.toml", INSTALLED=present, APT_FAILS="install*libomp-19-dev")
    assert result.returncode == 0
    install, refused, download = launcher.calls("apt-get")[1:]
    assert install.endswith(" clang-19") and "--no-remove" in install and "--no-remove" in refused
    assert download == "apt-get download libomp-19-dev libomp5-19" and len(launcher.calls("dpkg")) == 2
    assert (launcher.root / "build/openmp/usr/lib").is_dir() and not (launcher.root / "build/openmp.part").exists()
    assert "not installed: libomp-19-dev" in result.stderr and "unpacking them in build/openmp" in result.stderr
    assert "g++" not in result.stderr


@pytest.mark.parametrize("missing, fails", [("libomp-19-dev", "libomp-19-dev"), ("clang-19", "clang-19")])
def test_without_the_fast_compiler_its_cost_is_told(launcher: Launcher, missing: str, fails: str) -> None:
    present = " ".join(name for name in all_packages() if name != missing)
    result = launcher("check", "a.toml", INSTALLED=present, APT_FAILS=fails)
    assert result.returncode == 0
    assert f"not installed: {missing}" in result.stderr
    assert "g++ builds instead of clang-19: forces take 1.9 times as long" in result.stderr
    assert not (launcher.root / "build/openmp").exists()


def test_what_others_need_does_not_stop_a_run(launcher: Launcher) -> None:
    """Packages of tests and benchmarks, which are not even asked for."""
    of_others = {"test": "libgtest-dev", "verify": "python3-pytest", "bench": "libbenchmark-dev", "movie": "ffmpeg"}
    present = " ".join(name for name in all_packages() if name not in of_others.values())
    assert launcher("run", "a.toml", INSTALLED=present, APT_FAILS="lib").returncode == 0
    assert not launcher.calls("apt-get")
    for command, package in of_others.items():
        result = launcher(command, INSTALLED=present, APT_FAILS=package)
        assert result.returncode == 1 and re.search(f"could not install: .*{package}", result.stderr)
    assert not launcher.calls("ctest")


def test_solvers_from_elsewhere_are_installed_with_full_alone(launcher: Launcher) -> None:
    present = " ".join(name for name in all_packages() if name not in {"python3-getfem", "calculix-ccx"})
    launcher("verify", INSTALLED=present)
    assert not launcher.calls("apt-get")
    launcher("verify", "--full", INSTALLED=present)
    assert launcher.calls("apt-get")[-1].endswith(" python3-getfem calculix-ccx")


def test_a_target_that_was_left_out_is_looked_for_again(launcher: Launcher) -> None:
    ninja = launcher.root / "build/release/build.ninja"
    launcher("run", "a.toml")
    configured = len(launcher.calls("cmake"))
    launcher("run", "a.toml")
    assert len(launcher.calls("cmake")) == configured
    launcher("test")
    assert len(launcher.calls("cmake")) == configured + 1, "configured without packages of the tests"
    ninja.write_text("build pliant_tests: x\n")
    launcher("test")
    assert len(launcher.calls("cmake")) == configured + 1


def test_failed_installation_stops(launcher: Launcher) -> None:
    present = " ".join(name for name in all_packages() if name != "cmake")
    result = launcher("check", "a.toml", INSTALLED=present, APT_FAILS="cmake")
    assert result.returncode == 1
    assert "could not install: cmake" in result.stderr
    assert not launcher.calls("ninja")


def test_failed_build_stops_and_looks_for_packages_again(launcher: Launcher) -> None:
    result = launcher("check", "a.toml", NINJA_EXIT="1")
    assert result.returncode == 1
    assert "building failed" in result.stderr and "[check]" not in result.stdout
    assert not (launcher.root / "build/packages.stamp").exists()


@pytest.mark.parametrize("code", [0, 2, 3, 4, 130, 143])
@pytest.mark.parametrize("command", ["run", "check", "modes"])
def test_exit_codes_pass_through(launcher: Launcher, command: str, code: int) -> None:
    result = launcher(command, "a.toml", ENGINE_EXIT=str(code))
    assert result.returncode == code
    assert ("plot" in result.stdout) == (command == "run" and code == 0)


@pytest.mark.parametrize("command, program", [("run", ["run"]), ("reference", [])])
@pytest.mark.parametrize("arguments", [["a.toml"], ["--until", "1 us", "a.toml", "--quiet"], ["--resume", "--out=o o"]], ids=" ".join)
def test_pictures_go_where_the_program_says(launcher: Launcher, command: str, program: list[str],
                                            arguments: list[str]) -> None:
    result = launcher(command, *arguments)
    said = "".join(f"[{argument}]" for argument in [*program, *arguments])
    assert result.stdout.startswith(said), "options are the program's"
    assert "--quiet" in arguments or result.stdout.splitlines()[-1] == "plot its folder"
    assert "plot" not in launcher(command, *arguments, TELLS="").stdout, "nothing was written"


def test_no_plot_is_the_launchers_own(launcher: Launcher) -> None:
    result = launcher("run", "a.toml", "--no-plot")
    assert result.stdout.startswith("[run][a.toml] ")
    assert "plot" not in result.stdout


def test_threads_wait_actively_and_are_not_bound(launcher: Launcher) -> None:
    assert "places=none wait=active" in launcher("run", "a.toml").stdout
    assert "wait=active" in launcher("check", "a.toml").stdout, "check measures what a run does"
    chosen = launcher("run", "a.toml", OMP_PLACES="sockets", OMP_WAIT_POLICY="passive").stdout
    assert "places=sockets wait=passive" in chosen


def test_a_build_is_announced_until_it_succeeded(launcher: Launcher) -> None:
    assert "building in build/release" in launcher("check", "a.toml", NINJA_EXIT="1").stderr
    assert "building in build/release" in launcher("check", "a.toml").stderr
    assert launcher("check", "a.toml").stderr == ""


def test_builds_in_one_folder_wait_for_each_other(launcher: Launcher) -> None:
    both = [launcher.start("check", "a.toml", NINJA_SECONDS="0.5") for _ in range(2)]
    errors = [process.communicate(timeout=60)[1] for process in both]
    assert launcher.calls("ninja") == ["ninja start", "ninja end"] * 2
    assert any("waiting for another" in text for text in errors)


def test_a_run_does_not_hold_the_lock(launcher: Launcher) -> None:
    write_script(launcher.root / "build/release/pliant_engine", 'sleep "${ENGINE_SECONDS:-0}"')
    long_run = launcher.start("run", "a.toml", ENGINE_SECONDS="5")
    while len(launcher.calls("ninja")) < 2:
        time.sleep(0.02)
    assert launcher("check", "a.toml").returncode == 0
    assert long_run.poll() is None, "the second call waited for the first one's run"
    long_run.communicate()


@pytest.mark.parametrize("stop", [signal.SIGINT, signal.SIGTERM])
def test_signals_reach_a_run_once(launcher: Launcher, stop: signal.Signals) -> None:
    """Also when the terminal sends SIGINT to the launcher's whole process group."""
    write_script(launcher.root / "build/release/pliant_engine",
                 'for s in INT TERM; do trap "echo $s >>$LOG.signals; stop=yes" $s; done; echo ready >"$LOG.ready"; '
                 'for ((i = 0; i < 100; ++i)); do sleep 0.05; [ -z "$stop" ] || { sleep 0.2; exit 130; }; done')
    run = launcher.start("run", "a.toml", process_group=0)
    while not Path(f"{launcher.log}.ready").exists():
        time.sleep(0.02)
    os.killpg(run.pid, stop) if stop == signal.SIGINT else run.send_signal(stop)
    output, _ = run.communicate(timeout=30)
    assert run.returncode == 130 and "plot" not in output
    assert Path(f"{launcher.log}.signals").read_text() == f"{stop.name[3:]}\n"


@pytest.mark.parametrize(("body", "code"), [("open(os.environ['LOG'] + '.ready', 'w'); time.sleep(60)", 130),
                                            ("assert False", 1), ("pass", 0)])
def test_exit_codes_of_verify(launcher: Launcher, body: str, code: int) -> None:
    """Interrupted from the terminal, red, green."""
    folder = launcher.root / "verify/a"
    folder.mkdir(parents=True)
    (folder.parent / "pytest.ini").write_text("[pytest]\npython_files = check_*.py\n")
    (folder / "check_a.py").write_text(f"import os, time\ndef test_a():\n    {body}\n")
    run = launcher.start("verify", "a", process_group=0)
    while run.poll() is None and not Path(f"{launcher.log}.ready").exists():
        time.sleep(0.02)
    if code == 130:
        os.killpg(run.pid, signal.SIGINT)
    run.communicate(timeout=60)
    assert run.returncode == code


@pytest.mark.parametrize("command", ["run", "check", "modes", "schema", "reference", "plot"])
def test_a_named_program_is_used_and_nothing_is_installed_or_built(launcher: Launcher, command: str) -> None:
    named = {}
    for variable, program in [("PLIANT_ENGINE", "my engine"), ("PLIANT_REFERENCE", "my solver")]:
        write_script(launcher.root / program, f'echo "{program} $*"; echo "$PLIANT_ENGINE"')
        named[variable] = f"../{program}"  # seen from where the launcher is called
    result = launcher(command, "a.toml", INSTALLED="", **named)
    assert result.returncode == 0 and not launcher.log.exists()
    first = {"reference": "my solver a.toml", "plot": "plot a.toml"}.get(command, f"my engine {command}")
    assert result.stdout.startswith(first)
    assert command == "plot" or result.stdout.splitlines()[1] == str(launcher.root / "my engine"), "from any folder"


def test_a_named_program_must_be_there(launcher: Launcher) -> None:
    for command, there in [("run", "nothing"), ("reference", "build/release/pliant_engine")]:
        (launcher.root / "build/release/pliant_reference_solver").unlink(missing_ok=True)
        result = launcher(command, "a.toml", PLIANT_ENGINE=str(launcher.root / there))
        assert result.returncode == 2 and "no such program" in result.stderr and not launcher.log.exists()


def test_schema_reads_the_scenes_of_docs_and_cases(launcher: Launcher) -> None:
    for name in ["docs/keys/a.toml", "cases/b.toml"]:
        (launcher.root / name).parent.mkdir(parents=True)
        (launcher.root / name).touch()
    files = [f"[{launcher.root}/{name}]" for name in ["docs/keys/a.toml", "cases/b.toml"]]
    assert launcher("schema").stdout.startswith("[schema]" + "".join(files))


@pytest.mark.parametrize("command", ["info", "compare", "view", "movie", "docs"])
def test_scripts_get_their_arguments_and_build_nothing(launcher: Launcher, command: str) -> None:
    (launcher.root / f"scripts/{command}.py").write_text("import sys\nprint(*sys.argv[1:])\nsys.exit(1)\n")
    result = launcher(command, "my results", "--tolerance", "1e-6")
    assert result.returncode == 1 and result.stdout == "my results --tolerance 1e-6\n"
    assert not launcher.calls("ninja")


@pytest.mark.parametrize("word, built", [("error", 2), ("gate", 2), ("ab", 0), ("page", 0)])
def test_benchmarks_get_their_arguments(launcher: Launcher, word: str, built: int) -> None:
    (launcher.root / "benchmarks").mkdir()
    (launcher.root / f"benchmarks/{word}.py").write_text("import sys\nprint(*sys.argv[1:])\nsys.exit(1)\n")
    result = launcher("bench", word, "one two", "--three")
    assert result.returncode == 1 and result.stdout == "one two --three\n"
    assert len(launcher.calls("ninja start")) == built


def test_unknown_benchmark(launcher: Launcher) -> None:
    result = launcher("bench", "gat")
    assert result.returncode == 2 and "nothing is called 'gat'; there are: kernels, scenes, error, gate, ab, page" in result.stderr
    assert not launcher.log.exists()


def test_tests_are_counted_and_their_failure_passes_through(launcher: Launcher) -> None:
    result = launcher("test", "-R", "contact")
    assert result.returncode == 8
    assert launcher.calls("ctest")[0].endswith("-R contact")
    assert "c.d" in result.stdout and "a.b" not in result.stdout
    assert result.stdout.splitlines()[-1] == "1 passed, 1 failed, 0 skipped"


def test_unit_tests_alone(launcher: Launcher) -> None:
    launcher("test", "--units", "--preset", "gcc", "-R", "contact")
    assert launcher.calls("ctest")[0].endswith("-R contact -L ^unit$") and "build/gcc" in launcher.calls("ctest")[0]
    for option in ("--units", "--scenes"):
        result = launcher("build", option)
        assert result.returncode == 1 and f"unknown option {option}" in result.stderr


def test_scenes_alone(launcher: Launcher) -> None:
    launcher("test", "--scenes", "--preset", "gcc")
    assert launcher.calls("ctest")[0].endswith(r"-R ^cli\.cases_run$") and "build/gcc" in launcher.calls("ctest")[0]


def test_a_part_of_the_unit_tests(launcher: Launcher) -> None:
    launcher("test", "--units", "--preset", "gcc")
    launcher.environment["PLIANT_TEST_PART"] = "1/4"
    launcher("test", "--units", "--preset", "gcc")
    assert [call.endswith("-DPLIANT_TEST_PART=1/4") for call in launcher.calls("cmake")] == [False, True]


GCC = {way: {"gcc": f"test --preset gcc --{way}"} for way in ("scenes", "units")}
IN_TURN = {0: GCC["scenes"] | {"fuzz": "fuzz --seconds 30", "memory": "test --preset fuzz --scenes",
                               "races": "test --preset tsan --scenes"},
           1: GCC["units"], 3: GCC["units"],
           6: GCC["scenes"] | {"memory": "PLIANT_TEST_PART=1/4 test --preset fuzz --units"}}  # by the number of commits


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
        "lint", "test -LE ^case$", "bench gate", *IN_TURN[commits].values(), "test --preset debug --scenes",
        r"PLIANT_BUILDS=debug counting gcc test -R ^cli\.determinism$ -V", "verify"]
    lines = result.stdout.splitlines()
    assert lines[-1] == "16 passed, 1 failed, 2 skipped, 2 known to fail"
    stages = ["lint", "test", "gate", *IN_TURN[commits], "debug", "determinism", "verify", "all"]
    told = lines[-1 - len(stages):-1]
    assert [line.split()[1] for line in told] == stages
    assert [line.rsplit(" ", 1)[1] for line in told[:-1]] == ["green", "red", *["green"] * (len(stages) - 3)]


@pytest.mark.parametrize("command", [file.stem for file in (ROOT / "launcher/help").iterdir() if file.stem != "pliant"])
def test_every_command_has_help_with_an_example(launcher: Launcher, command: str) -> None:
    result = launcher(command, "--help")
    assert result.returncode == 0
    assert f"Example: ./pliant {command}" in result.stdout
    assert not launcher.log.exists(), "help must not build"


@pytest.mark.parametrize("arguments", [["no_such_case"], ["--ful"], ["../verify/orders_free"], [""], ["*"], ["fem"],
                                       ["--full", "--mutate"]])
def test_unknown_cases_of_verify_are_refused(launcher: Launcher, arguments: list[str]) -> None:
    shutil.copytree(ROOT / "verify", launcher.root / "verify")
    result = launcher("verify", *arguments)
    assert result.returncode == 2
    assert "orders_free" in result.stderr or "--help" in result.stderr
    assert not launcher.log.exists(), "nothing is built for them"


@pytest.mark.parametrize("preset", ["relase", "base", "", "../x", "-x"])
def test_unknown_preset_leaves_nothing(launcher: Launcher, preset: str) -> None:
    before = {file.name for file in (launcher.root / "build").iterdir()}
    result = launcher("build", f"--preset={preset}")
    assert result.returncode == 2
    assert f"no preset '{preset}'" in result.stderr and "asan-ubsan" in result.stderr
    assert {file.name for file in (launcher.root / "build").iterdir()} == before
    assert not launcher.log.exists()


def test_unknown_command(launcher: Launcher) -> None:
    result = launcher("rnu", "a.toml")
    assert result.returncode == 2
    assert "rnu" in result.stderr and "run" in result.stderr
