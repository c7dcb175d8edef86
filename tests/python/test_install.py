"""The package as pip installs it, away from the repository."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(os.environ.get("PLIANT_SOURCE_DIR", Path(__file__).parents[2]))
USE = """
import sys
from pathlib import Path
import pliant, pliant.order, pliant.coarse
from pliant.study.__main__ import HERE
assert Path(pliant.__file__).is_relative_to(sys.argv[1]), pliant.__file__
assert (HERE / "Snakefile").is_file() and (HERE / "report.html.j2").is_file()
scene = pliant.Scene.read(sys.argv[2])
scene["time.end"], scene["shapes.disc.nodes"] = "1 ns", 40
print(pliant.run(scene, "out").summary["status"])
"""


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Nothing is downloaded; building leaves traces beside the sources, so it works on a copy."""
    folder = tmp_path_factory.mktemp("install")
    shutil.copytree(ROOT / "python", folder / "python", ignore=shutil.ignore_patterns("__pycache__"))
    result = subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--no-index", "--no-deps",
                             "--no-build-isolation", "--target", folder / "site", folder / "python"],
                            capture_output=True, text=True, check=False, timeout=300)
    assert result.returncode == 0, result.stderr
    return folder / "site"


def test_an_installed_package_runs_scenes(installed: Path, tmp_path: Path) -> None:
    """EXACT"""
    engine = os.environ.get("PLIANT_ENGINE", str(ROOT / "build/release/pliant_engine"))
    result = subprocess.run([sys.executable, "-B", "-c", USE, installed, ROOT / "cases/two_discs.toml"], cwd=tmp_path,
                            env={**os.environ, "PYTHONPATH": str(installed), "PLIANT_ENGINE": engine},
                            capture_output=True, text=True, check=False, timeout=300)
    assert (result.returncode, result.stdout) == (0, "finished\n"), result.stderr
