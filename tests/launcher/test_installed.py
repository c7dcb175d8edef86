"""The installed program runs a scene where there is no checkout: `cmake --install` into a scratch prefix. EXACT."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(os.environ.get("PLIANT_SOURCE_DIR", Path(__file__).resolve().parents[2]))
BUILD = Path(os.environ.get("PLIANT_ENGINE", ROOT / "build/release/pliant_engine")).parent
# In a mount namespace of its own an empty file system lies over the checkout, with its builds.
HIDDEN = ["unshare", "--mount", *(["--map-root-user"] if os.geteuid() else []), "bash", "-c",
          'mount -t tmpfs none "$1" && cd "$2" && shift 2 && exec "$@"', "-", str(ROOT)]
COMMANDS = {"run", "reference", "check", "modes", "plot", "movie", "view", "shape-functions", "export", "info", "study",
            "compare", "schema"}


@pytest.fixture(scope="module")
def prefix(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("prefix")
    result = subprocess.run(["cmake", "--install", BUILD, "--prefix", folder], capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    return folder


@pytest.fixture
def hidden(prefix: Path, tmp_path: Path):
    """Calls the installed launcher with the checkout out of sight."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith(("PLIANT_", "PYTHON"))}

    def call(*command: str | Path) -> subprocess.CompletedProcess[str]:
        result = subprocess.run([*HIDDEN, tmp_path, *command], env=environment, capture_output=True, text=True, timeout=300)
        if "unshare: " in result.stderr and not os.environ.get("CI"):
            pytest.skip(f"no namespace can be made here: {result.stderr.strip()}")
        return result

    return call


def test_the_checkout_is_hidden(hidden) -> None:
    result = hidden("ls", ROOT)
    assert (result.returncode, result.stdout) == (0, ""), result.stderr


def test_a_scene_is_run_and_drawn(prefix: Path, tmp_path: Path, hidden) -> None:
    pliant, scene = prefix / "bin/pliant", prefix / "share/pliant/cases/two_discs.toml"
    result = hidden(pliant, "run", scene, "--until", "2 ns")
    assert result.returncode == 0, result.stderr
    results = tmp_path / "results/two_discs"
    assert {"summary.json", "frames.h5", "grains.png", "energy.png"} <= {file.name for file in results.iterdir()}
    assert hidden(pliant, "reference", scene, "--until", "0.05 ns", "--no-plot").returncode == 0
    assert hidden(pliant, "compare", results, results).returncode == 0
    told = hidden(pliant, "info", results).stdout
    assert "pliant plot" in told and "./pliant" not in told
    assert not list(prefix.rglob("summary.json")), "results go to where the call came from"


def test_python_finds_the_program(prefix: Path, hidden) -> None:
    code = "import pliant, pliant.engine, os; print(pliant.__file__); print(pliant.engine.engine())"
    package, programs = prefix / "lib/python3/dist-packages", prefix / "bin"
    result = hidden("env", f"PYTHONPATH={package}", sys.executable, "-B", "-c", code)
    assert result.stdout.split() == [f"{package}/pliant/__init__.py", f"{programs}/pliant_engine"], result.stderr


def test_openmp_is_the_compilers(prefix: Path, hidden) -> None:
    """Where clang compiled it, a library of that version lies beside it, which another system's must not replace."""
    for program in ["pliant_engine", "pliant_reference_solver"]:
        linked = hidden("ldd", prefix / "bin" / program).stdout
        assert "not found" not in linked
        for found in re.findall(r"libomp\S* => (\S+)", linked):
            assert Path(found).resolve().is_relative_to(prefix) and Path(found).resolve().is_file()


def test_help_and_refusals(prefix: Path, hidden) -> None:
    pliant = prefix / "bin/pliant"
    assert hidden(pliant, "--version").stdout == f"pliant {version()}\n"
    assert {file.stem for file in (prefix / "share/pliant/launcher/help").iterdir()} == COMMANDS | {"pliant"}
    assert "Example: pliant run cases" in hidden(pliant, "run", "--help").stdout
    refused = hidden(pliant, "test")
    assert refused.returncode == 2 and "no command 'test'; there are: check, compare" in refused.stderr
    wrong = hidden(pliant, "run", "no_such.toml")
    assert wrong.returncode == 2 and "no_such.toml" in wrong.stderr


def test_nothing_names_the_checkout(prefix: Path) -> None:
    """But debug information, of which a release has none."""
    named = [file for file in prefix.rglob("*") if file.is_file() and str(ROOT).encode() in file.read_bytes()]
    assert not named


@pytest.mark.skipif(shutil.which("help2man") is None, reason="help2man is not installed")
def test_man_pages(prefix: Path) -> None:
    pages = {file.name: file.read_text() for file in (prefix / "share/man/man1").iterdir()}
    assert set(pages) == {"pliant.1", *(f"pliant-{command}.1" for command in COMMANDS)}
    run = pages["pliant-run.1"]
    assert re.search(r"^pliant\\?-run \\- simulate a scene file and draw it$", run, re.MULTILINE)
    assert r"\-\-checkpoint\-every" in run and "./pliant" not in "".join(pages.values())


def version() -> str:
    return re.search(r"project\(pliant VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
