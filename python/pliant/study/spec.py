"""What a study file says."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

AVERAGES = ["x", "points"]  # of the curves of replicas: at the same x, or of their points in order
TAKES = ["mean", "last", "max", "min", "peak", "plateau", "slope"]


@dataclass
class Parameter:
    """A name and values for keys of the scene, all set alike."""

    name: str
    paths: list[str]
    values: list[Any] = field(default_factory=list)
    limits: tuple[float, float, str] | None = None  # of a Latin hypercube: from, to, unit
    logarithmic: bool = False


@dataclass
class Quantity:
    """A number of each run: of its summary, of a column of its probes, or what a function makes of it."""

    name: str
    summary: str | None = None
    probe: str | None = None
    take: str = "last"
    window: tuple[Any, Any] | None = None  # times as scenes write them
    function: str | None = None  # file:name


@dataclass
class Plot:
    x: str
    y: str
    by: str | None
    log: list[str]


@dataclass
class Curve:
    """A curve of each run, of two columns of its probes or of what a function returns; means over replicas."""

    name: str
    x: str  # column, or the title of what the function returns
    y: str
    function: str | None  # file:name
    by: str | None
    log: list[str]
    average: str  # AVERAGES
    beside: str | None  # file:name, of a curve that is drawn beside each mean


@dataclass
class Figure:
    """Drawn by a function of the user's: of axes and the means over replicas."""

    name: str
    function: str  # file:name


@dataclass
class Convergence:
    """Size of the mesh or the step: a parameter to a power."""

    by: str
    power: float
    of: list[str]


@dataclass
class Regression:
    baseline: Path
    tolerances: dict[str, float]  # relative, by quantity


@dataclass
class Study:
    file: Path
    title: str
    scene: Path
    kind: str
    combine: str
    samples: int
    seed: int
    threads: int
    fixed: dict[str, Any]  # by path in the scene, of all runs alike
    parameters: list[Parameter]
    replicas: Parameter | None
    quantities: list[Quantity]
    plots: list[Plot]
    curves: list[Curve]
    figures: list[Figure]
    convergence: Convergence | None
    regression: Regression | None

    @property
    def name(self) -> str:
        return self.file.stem

    @property
    def functions(self) -> list[str]:
        """All that it names, as file:name."""
        named = [q.function for q in self.quantities] + [where for c in self.curves for where in (c.function, c.beside)]
        return [where for where in [*named, *(f.function for f in self.figures)] if where is not None]


def number_of(value: Any) -> float | None:
    """Of a parameter's value, "3 MPa" without its unit; None: it is no number."""
    try:
        if isinstance(value, str):
            return float(value.split()[0])
        return float(value) if isinstance(value, (int, float)) else None
    except (ValueError, IndexError):
        return None


def units_of(values: list[Any]) -> set[str]:
    return {value.strip().partition(" ")[2].strip() if isinstance(value, str) else "" for value in values}


def between(first: float, last: float, share: float, unit: str, logarithmic: bool) -> Any:
    """A share of the way; the ends as they are given. Whole numbers stay whole where nothing is lost."""
    if share in (0, 1):
        value = last if share else first
    else:
        value = float(f"{first * (last / first)**share if logarithmic else first + (last - first) * share:.12g}")
    if unit:
        return f"{value!r} {unit}"
    return int(value) if value == int(value) and abs(value) < 2**53 else value
