"""The picture of shape functions, and what it is to show: moving least squares are continuous, radial point interpolation jumps."""

import os
import subprocess
from pathlib import Path

from shape_functions import evaluate, largest_jump

ROOT = Path(__file__).resolve().parents[2]
ENGINE = Path(os.environ["PLIANT_ENGINE"])


def test_only_rpim_jumps() -> None:
    """RATE: on a grid three times finer the largest step from point to point of a continuous function falls to a third."""
    ratio = {}
    for method in ("mls", "rpim"):
        coarse, fine = (largest_jump(evaluate(ENGINE, method, 100, 9, grid)) for grid in (101, 301))
        ratio[method] = fine / coarse
    assert abs(ratio["mls"] - 1 / 3) < 0.05
    assert ratio["rpim"] > 0.6


def test_values() -> None:
    """EXACT: radial point interpolation is 1 at its own node, but for the grid, and falls below zero; moving least squares do not interpolate."""
    rpim, mls = (evaluate(ENGINE, method, 100, 9, 301) for method in ("rpim", "mls"))
    assert abs(rpim.phi.max() - 1) < 0.02 and rpim.phi.min() < -0.01
    assert mls.phi.max() < 0.8 and mls.phi.min() > -0.03


def test_draws_and_refuses(tmp_path: Path) -> None:
    script = ["/usr/bin/python3", str(ROOT / "scripts/shape_functions.py"), "--nodes", "60", "--grid", "51"]
    done = subprocess.run([*script, "--out", str(tmp_path / "a.png")], capture_output=True, text=True)
    assert done.returncode == 0 and (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")
    refused = subprocess.run([*script, "--out", str(tmp_path / "no/a.png")], capture_output=True, text=True)
    assert refused.returncode == 4 and "no/a.png" in refused.stderr
    refused = subprocess.run([*script, "--support", "99"], capture_output=True, text=True)
    assert refused.returncode == 2 and "99" in refused.stderr
