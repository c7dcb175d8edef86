"""What measurements say: the front of a scene, and what the paper's way costs against others at equal error."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass

from error_study.choices import DEFAULT, MASS_SCALING, PAPER, TARGETS, Choice
from error_study.measure import Measured
from error_study.pareto import cost_at, front

CORRECTED = Choice(mass="corrected")
SMOOTHED = Choice(method="es-t3", mass="corrected")
SCALED = Choice(mass_scaling=MASS_SCALING, safety=0.9)
NAMED = {"default": DEFAULT, "default, corrected mass": CORRECTED, "es-t3, corrected mass": SMOOTHED,
         "scaled mass, safety 0.9": SCALED}


@dataclass(frozen=True)
class AtEqualError:
    """What the paper's way costs over what another family does, at the error that it has with so many nodes."""

    scene: str
    nodes: int
    target: float  # of its step doubling
    error: float
    seconds: float
    ratios: dict[str, float | None]  # by name of the other family; None: that does not come as near


def finished(rows: list[Measured], scene: str) -> list[Measured]:
    return [row for row in rows if row.scene == scene and math.isfinite(row.error)]


def front_of(rows: list[Measured], scene: str, cost: str = "seconds") -> list[Measured]:
    """Of the engine's runs, by seconds or by evaluations."""
    engine = [row for row in finished(rows, scene) if row.choice.step is None]
    return front(engine, cost=lambda row: getattr(row, cost), error=lambda row: row.error)


def curve(rows: list[Measured], scene: str, choice: Choice) -> list[Measured]:
    """All sizes of a choice's family."""
    found = [row for row in finished(rows, scene) if row.choice.family == choice.family]
    return sorted(found, key=lambda row: row.choice.nodes)


def paper_against_others(rows: list[Measured], scene: str) -> list[AtEqualError]:
    """For each size and target of step doubling."""
    others = {name: [(row.seconds, row.error) for row in curve(rows, scene, choice)] for name, choice in NAMED.items()}
    found = []
    for row in finished(rows, scene):
        choice = row.choice
        if (choice.method, choice.mass, choice.integrator) != (PAPER.method, PAPER.mass, PAPER.integrator):
            continue
        costs = {name: cost_at(row.error, points) for name, points in others.items()}
        ratios = {name: row.seconds / cost if cost else None for name, cost in costs.items()}
        found.append(AtEqualError(scene, choice.nodes, choice.bound, row.error, row.seconds, ratios))
    return sorted(found, key=lambda one: (TARGETS.index(one.target), one.nodes))


def from_json(measured: list[dict]) -> list[Measured]:
    """The rows of as_json()."""
    return [Measured(row["scene"], Choice(**row["choice"]), *(math.nan if row[name] is None else row[name] for name in
            ("error", "evaluations", "seconds", "memory")), row["message"]) for row in measured]


def as_json(rows: list[Measured]) -> dict:
    scenes = list(dict.fromkeys(row.scene for row in rows))
    return {"measured": [{**asdict(row), "family": row.choice.family,
                          "error": row.error if math.isfinite(row.error) else None,
                          "seconds": row.seconds if math.isfinite(row.seconds) else None} for row in rows],
            "fronts": {scene: [{"family": row.choice.family, "nodes": row.choice.nodes, "error": row.error,
                                "seconds": row.seconds} for row in front_of(rows, scene)] for scene in scenes},
            "paper_at_equal_error": [asdict(one) for scene in scenes for one in paper_against_others(rows, scene)]}
