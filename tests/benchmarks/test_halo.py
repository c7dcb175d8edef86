"""pliant_halo: several processes take the steps of one, bit for bit. EXACT."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest
import tomlkit

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(os.environ.get("PLIANT_ENGINE", ROOT / "build/release/pliant_engine")).with_name("pliant_halo")
STEPS = 300

pytestmark = pytest.mark.skipif(shutil.which("mpirun") is None or not PROGRAM.exists(),
                                reason="mpirun or pliant_halo is missing: ninja -C build/release pliant_halo")


def sliding_layers() -> str:
    """A low third body whose upper half slides over the lower one, a small distance away: grains get new neighbours."""
    scene = tomlkit.parse((ROOT / "cases/third_body_mini.toml").read_text())
    lower = scene["grains"][0]
    lower["packing"]["rows"] = 4
    upper = tomlkit.parse(tomlkit.dumps(lower))
    upper["name"] = "upper_half"
    upper["packing"]["origin"] = ["0.435 um", "4.53 um"]
    upper["velocity"] = {"uniform": ["1000 m/s", "0 m/s"]}
    scene["grains"].append(upper)
    wall = scene["walls"][1]
    wall["level"], wall["x"], wall["y"] = "9.04 um", {"velocity": "1000 m/s"}, {"pressure": "0.02 GPa"}
    return tomlkit.dumps(scene)


def call(processes: int, scene: Path, *options: str, steps: int = STEPS) -> subprocess.CompletedProcess[str]:
    environment = os.environ | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    # Processes that wait yield the core: there may be fewer cores than processes.
    launch = ["mpirun", "--oversubscribe", "--bind-to", "none", "--mca", "mpi_yield_when_idle", "1"]
    return subprocess.run([*launch, "-n", str(processes), PROGRAM, scene, str(steps), *options], capture_output=True,
                          text=True, env=environment, timeout=500)


def run(processes: int, scene: Path, *options: str) -> dict:
    result = call(processes, scene, *options)
    assert result.returncode == 0, result.stderr
    return json.loads(result.stdout)


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("halo") / "sliding.toml"
    file.write_text(sliding_layers())
    return file


@pytest.fixture(scope="module")
def alone(scene: Path) -> dict:
    return run(1, scene, "--alone")


@pytest.mark.parametrize("processes", [1, 2, 3, 4])
def test_processes_take_the_steps_of_the_engine(scene: Path, alone: dict, processes: int) -> None:
    result = run(processes, scene)
    assert result["rebuilds"] == alone["rebuilds"] > 0 and alone["contacts_of_process_0"] > 0
    parts = result["by_process"]
    assert sum(part["owned_bodies"] - 2 for part in parts) == 80  # all advance both walls
    if processes > 1:
        assert all(sum(part[name] for part in parts) > 0 for name in ["new_ghosts", "former_ghosts"])
    assert result["hash"] == alone["hash"]


def test_an_outline_that_is_not_sent_is_found(scene: Path, alone: dict) -> None:
    assert run(2, scene, "--omit-a-ghost")["hash"] != alone["hash"]


@pytest.mark.parametrize("old, new, named", [
    ('stiffness = "auto"', 'stiffness = "auto"\n[contact]\nself_contact = true', "self-contact"),
    ('integrator = "verlet"\ntolerance = 1e-2', 'integrator = "step-doubling"', 'integrator "step-doubling"')])
def test_what_is_not_supported_is_named(scene: Path, old: str, new: str, named: str) -> None:
    changed = scene.with_name("changed.toml")
    changed.write_text(scene.read_text().replace(old, new))
    result = call(2, changed)
    assert result.returncode == 2
    assert f"the halo prototype does not support {named}" in result.stderr


def test_a_wrong_number_of_steps_is_refused(scene: Path) -> None:
    result = call(1, scene, steps=0)
    assert result.returncode == 2 and "STEPS is '0', must be a number >= 1" in result.stderr
