"""Friction factors of walls, from probes."""

import numpy as np

from pliant.results import Run, Table


def force_sources(table: Table) -> list[str]:
    """Names of the probes that hold both components of a force."""
    return [c.source for c in table.columns if c.name == "force_x" and table.get("force_y", c.source) is not None]


def friction(run: Run, table: Table, source: str) -> tuple[np.ndarray, np.ndarray]:
    """Times and friction factor of a wall: its own probe where there is one, else the ratio of its forces."""
    wall = run.probe_of.get(source, source)
    for column in table.columns:
        if column.name == "friction_factor" and run.probe_of.get(column.source, column.source) == wall:
            return table.sampled(column)
    force_x, force_y = table.get("force_x", source), table.get("force_y", source)
    assert force_x is not None and force_y is not None
    pressed = np.isfinite(force_x.values) & (np.abs(force_y.values) > 0)
    return table.time[pressed], force_x.values[pressed] / np.abs(force_y.values[pressed])


def loaded(table: Table, source: str, time: np.ndarray) -> np.ndarray:
    """Where a wall carries at least 5 % of its largest normal force: elsewhere a friction factor is 0 over 0."""
    force = table.get("force_y", source)
    assert force is not None
    sampled_time, values = table.sampled(force)
    magnitude = np.abs(np.interp(time, sampled_time, values))
    return magnitude >= 0.05 * np.abs(values).max(initial=0.0)
