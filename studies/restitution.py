"""Quantities of studies/restitution.toml."""

from __future__ import annotations

from pliant import Run


def restitution(run: Run) -> float:
    """Ratio of separation and approach speeds, by the discs' mean velocities."""
    left, right = (run.probes.column(f"velocity_{side}.velocity_x").values for side in ("left", "right"))
    apart, before = right[-1] - left[-1], left[0] - right[0]
    if apart <= 0:
        raise ValueError("the discs have not parted by the end")
    return apart / before
