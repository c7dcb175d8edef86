"""Four scenes of cases/ run to their ends, or for a while, on two threads: with sanitizers in the engine, these look on."""

from __future__ import annotations

import pytest
from conftest import ROOT

# Seconds or less in a fast build, minutes with a sanitizer: compliant, rigid and walls; memory; a body's own contact;
# dashpots.
CASES = {"fatigue_cluster": "6 ns", "self_contact": "2 ms", "servo_wall": "5 ns", "restitution": "0.3 s"}


@pytest.mark.parametrize("name, until", CASES.items())
def test_case_runs(desk, name: str, until: str) -> None:
    """EXACT: nothing is said, momentum is kept to rounding."""
    result = desk.engine("run", ROOT / f"cases/{name}.toml", "--out", "out", "--until", until, "--threads", "2", "--quiet")
    assert result.returncode == 0, result.stderr
    assert result.stderr == ""
    summary = desk.summary("out")
    assert summary["steps"] > 200
    assert summary["momentum_error"] < 1e-12
