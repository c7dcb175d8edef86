"""The launcher, on a copy beside a stub engine. All EXACT."""

from __future__ import annotations

import os
import shutil
import signal
import time
from pathlib import Path

import pytest
from conftest import ROOT, Launcher, write_script


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


@pytest.mark.parametrize("quiet", [[], ["--quiet"]], ids=["loud", "quiet"])
def test_a_picture_that_fails_is_told_apart_from_the_run(launcher: Launcher, quiet: list[str]) -> None:
    (launcher.root / "scripts/plot.py").write_text("import no_such_module\n")
    result = launcher("run", "a.toml", *quiet)
    assert result.returncode == 5
    assert "the run is complete and its results are whole: its folder" in result.stderr and "no_such_module" in result.stderr
    assert launcher("run", "a.toml", ENGINE_EXIT="3").returncode == 3, "the engine's own code"
    assert launcher("plot", "its folder").returncode == 1, "no run"


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


@pytest.mark.parametrize("command", ["info", "compare", "view", "movie", "docs"])
def test_scripts_get_their_arguments_and_build_nothing(launcher: Launcher, command: str) -> None:
    (launcher.root / f"scripts/{command}.py").write_text("import sys\nprint(*sys.argv[1:])\nsys.exit(1)\n")
    result = launcher(command, "my results", "--tolerance", "1e-6")
    assert result.returncode == 1 and result.stdout == "my results --tolerance 1e-6\n"
    assert not launcher.calls("ninja")


@pytest.mark.parametrize("word, built", [("error", 2), ("gate", 2), ("faults", 2), ("ab", 0), ("page", 0),
                                         ("partition", 0), ("machines", 0)])
def test_benchmarks_get_their_arguments(launcher: Launcher, word: str, built: int) -> None:
    (launcher.root / "benchmarks").mkdir()
    file = {"faults": "injected_faults", "machines": "many_machines"}.get(word, word)
    (launcher.root / f"benchmarks/{file}.py").write_text("import sys\nprint(*sys.argv[1:])\nsys.exit(1)\n")
    result = launcher("bench", word, "one two", "--three")
    assert result.returncode == 1 and result.stdout == "one two --three\n"
    assert len(launcher.calls("ninja start")) == built


def test_unknown_benchmark(launcher: Launcher) -> None:
    result = launcher("bench", "gat")
    assert result.returncode == 2 and "nothing is called 'gat'; there are: kernels, scenes, scaling, partition, machines, error, gate, faults, ab, page" in result.stderr
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


def test_some_folders_of_the_unit_tests(launcher: Launcher) -> None:
    launcher("test", "--units", "--preset", "gcc")
    launcher.environment["PLIANT_TEST_FOLDERS"] = "contact|files"
    launcher("test", "--units", "--preset", "gcc")
    assert [call.endswith("-DPLIANT_TEST_FOLDERS=contact|files") for call in launcher.calls("cmake")] == [False, True]


@pytest.mark.parametrize("command", [file.stem for file in (ROOT / "launcher/help").iterdir() if file.stem != "pliant"])
def test_every_command_has_help_with_an_example(launcher: Launcher, command: str) -> None:
    result = launcher(command, "--help")
    assert result.returncode == 0
    assert f"Example: ./pliant {command}" in result.stdout
    assert not launcher.log.exists(), "help must not build"


@pytest.mark.parametrize(("options", "cases"), [([], "fast plain"), (["--fast"], "fast"), (["--slow"], "plain"),
                                                (["--full"], "fast long plain"), (["--full", "--slow"], "long plain"),
                                                (["long"], "long")])
def test_verify_runs_cases_by_their_length(launcher: Launcher, options: list[str], cases: str) -> None:
    for name, says in {"fast": ", fast=True", "plain": ", cost=2", "long": ", long=True, cost=9 if 1 else 3"}.items():
        folder = launcher.root / "verify" / name
        folder.mkdir(parents=True)
        (folder / f"check_{name}.py").write_text(
            f"import os\ndef Case(*_, **__): pass\nCASE = Case(__file__{says})\n"
            f"def test_it():\n    open(os.environ['LOG'] + '.{name}.ran', 'w')\n")
    (launcher.root / "verify/pytest.ini").write_text("[pytest]\npython_files = check_*.py\n")
    assert launcher("verify", *options).returncode == 0
    assert " ".join(sorted(file.name.split(".")[-2] for file in launcher.log.parent.glob("*.ran"))) == cases


@pytest.mark.parametrize("arguments", [["no_such_case"], ["--ful"], ["../verify/orders_free"], [""], ["*"], ["fem"],
                                       ["--full", "--mutate"], ["--units"], ["--scenes"], ["--preset", "lint"]])
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
