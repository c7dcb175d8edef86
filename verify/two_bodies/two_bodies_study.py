"""Shared by all pairs of bodies: setups of runs, states of rest, and forces by mesh size against other solvers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import astuple, dataclass, replace
from pathlib import Path
from typing import ClassVar

import numpy as np

from fields import frames_of
from foreign.stored import Table, distances_from_half
from squeeze import force_of_motion
from verification import Case, Run, weights_of_limit

FOLDER = Path(__file__).parent / "oracles"
LAWS = ("neo-hookean", "melody")
HARDER = 2.0  # times the contact stiffness
RAMP = 8.0  # s of motion in a pause
# Solver, ratio of live to stored values less 1, tolerance and its source.
Again = tuple[str, Callable[[Path], np.ndarray], float, str]


def read(name: str) -> Table:
    return Table(FOLDER / f"{name}.csv")


@dataclass(frozen=True, kw_only=True)
class Setup:
    """Parameters of a run; the `ways` of a size are variants with different outlines."""

    size: int
    way: int = 0
    law: str = LAWS[0]
    stiffness: float = 3e3  # of contact, mu / R
    pause: float = 24.0  # s between states of rest

    WAYS: ClassVar[int]
    LEVELS: ClassVar[list[float]]  # loads at which bodies rest
    FIRST_REST: ClassVar[int] = 1  # pauses until then
    STEP: ClassVar[float] = RAMP  # s, largest load step in statics
    STORED: ClassVar[float]  # stored over residual kinetic energy: damping over the rate of the slowest motion
    AXIS: ClassVar[float] = 0.0  # x

    @property
    def rests(self) -> np.ndarray:
        """[levels] the ends of their pauses, s."""
        return self.pause * np.arange(self.FIRST_REST, self.FIRST_REST + len(self.LEVELS))

    def ways(self) -> list[Setup]:
        return [replace(self, way=way) for way in range(self.WAYS)]

    def run_name(self) -> str:
        values = (f"{value:g}" if isinstance(value, float) else str(value) for value in astuple(self))
        return "_".join([type(self).__name__.lower(), *values])

    def by_engine(self, case: Case) -> Run:
        return case.engine(self.run_name(), self.scene(case))

    def by_reference(self, case: Case) -> Run:
        """Statics; load steps end at the points of the histories and at outputs."""
        return case.reference(self.run_name() + "_reference", self.scene(case), "--static", "--dt", repr(self.STEP))


def outline(run: Run, body: int, time: float) -> np.ndarray:
    """[nodes x 2] of a body."""
    frames = frames_of(run)
    there = frames.grids["outlines"].point_body == body
    return frames.positions("outlines", frames.nearest(time))[there, :2]


class Rests:
    """Results at the end of each pause, [levels]."""

    def __init__(self, setup: Setup, run: Run) -> None:
        self.setup, self.run = setup, run
        self.force, self.gap = setup.forces(run)
        self.kinetic = run.at("energy.kinetic", setup.rests)

    def unrest(self) -> np.ndarray:
        """Relative bound of the effect of residual motion on forces."""
        return force_of_motion(self.force, self.gap, self.kinetic, self.setup.STORED) / self.force

    def outline(self, body: int, level: int) -> np.ndarray:
        """[nodes x 2] about the axis."""
        return outline(self.run, body, self.setup.rests[level]) - [self.setup.AXIS, 0]


def lost_by_penalty(usual: np.ndarray, harder: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """[places] mean loss of force by the penalty, of order 1 / stiffness, and half of its range, from [ways x
    places]."""
    lost = HARDER / (HARDER - 1) * (harder / usual - 1)
    return lost.mean(axis=0), np.ptp(lost, axis=0) / 2


class Study:
    """One force of a pair of bodies at several places, by mesh size, without penalty. `read_getfem(law)` and
    `read_calculix()` give those of other solvers."""

    name: str
    places: list[str]
    compared: range  # places of the engine's forces
    between: range  # places of GetFEM's over CalculiX's
    long: dict[str, str] = {}  # laws whose runs are long, and why they need --full
    orders: tuple[int, ...] = (2,)  # of errors in the spacing: forces at h = 0 are the mean of lines in these powers
    counted: slice | np.ndarray = slice(None)  # places of rms
    own: str  # sources of errors: of the engine; of others, by solver; of GetFEM over CalculiX; of the order
    others: dict[str, str]
    both: str
    order: tuple[str, str] | None = None  # its quantity, if the order is known

    spacings: np.ndarray  # [sizes]
    force: np.ndarray  # [sizes x places]
    scatter: np.ndarray  # [sizes x places] error of the force, relative
    penalty: np.ndarray  # [places] relative
    penalty_error: np.ndarray

    def __init__(self, case: Case, law: str) -> None:
        self.case, self.law, self.getfem = case, law, self.read_getfem(law)

    def errors(self) -> np.ndarray:
        """[sizes x places] relative."""
        return self.force / self.getfem.force - 1

    def rms(self) -> np.ndarray:
        """[sizes] rms of errors over the evaluated places."""
        return np.sqrt((self.errors()[:, self.counted] ** 2).mean(axis=1))

    def weights(self) -> np.ndarray:
        """[orders x sizes]"""
        return np.array([weights_of_limit(self.spacings, order) for order in self.orders])

    def limit(self) -> np.ndarray:
        """[places] forces at h = 0."""
        return (self.weights() @ self.force).mean(axis=0)

    def limit_error(self) -> np.ndarray:
        """[places] relative error by the order, saw tooth and penalty."""
        order = np.ptp(self.weights() @ self.force, axis=0) / 2 / self.getfem.force
        return order + np.abs(self.weights().mean(axis=0)) @ self.scatter + self.penalty_error

    def slope_error_of(self, own: np.ndarray, common: float) -> float:
        """Error of the order in h, from [sizes] independent relative errors, and from one common to all sizes."""
        logs = np.log(self.spacings) - np.log(self.spacings).mean()
        independent = np.sqrt(((logs * own / self.rms()) ** 2).sum())
        return float((independent + np.abs((logs * common / self.rms()).sum())) / (logs**2).sum())


class RestStudy(Study):
    """Study of setups of several sizes, with all ways of each."""

    scatters = 1.0  # times the error of a mean over ways
    group: Callable[[np.ndarray], np.ndarray]  # at a single place scatter may be accidentally small
    shape: str  # sources of errors of outlines
    bodies: tuple[str, ...]
    table: str  # of stored outlines

    def __init__(self, case: Case, law: str, setups: list[Setup]) -> None:
        super().__init__(case, law)
        self.setups, self.spacings = setups, np.array([setup.spacing for setup in setups])
        self.rests = [[Rests(way, way.by_engine(case)) for way in setup.ways()] for setup in setups]
        ways = np.array([[rests.force for rests in each] for each in self.rests])  # [sizes x ways x levels]
        harder = [Rests(way, way.by_engine(case)).force
                  for way in replace(setups[0], stiffness=HARDER * setups[0].stiffness).ways()]
        self.penalty, self.penalty_error = lost_by_penalty(ways[0], np.array(harder))
        self.force = ways.mean(axis=1) * (1 + self.penalty)
        self.saw = self.scatters * ways.std(axis=1, ddof=1) / np.sqrt(ways.shape[1]) / self.getfem.force
        self.scatter = type(self).group(self.saw)

    @classmethod
    def outlines(cls) -> dict[str, np.ndarray]:
        """By body [places x nodes x 2] of the halves x >= 0, from the lowest point up, by GetFEM."""
        return {name: read(cls.table).outlines(body=i) for i, name in enumerate(cls.bodies)}

    def lost(self, level: int) -> float:
        """Error of the finest size's force, relative."""
        return float(np.abs(self.errors()[-1, level]) + self.penalty[level] + self.scatter[-1, level])

    def nodes(self, body: int, level: int) -> np.ndarray:
        """[nodes x 2] of the finest size."""
        return self.rests[-1][0].outline(body, level)

    def off(self, body: int, level: int, half: np.ndarray) -> float:
        """R. The rms distance of nodes from a stored half outline."""
        return float(np.sqrt((distances_from_half(self.nodes(body, level), half) ** 2).mean()))
