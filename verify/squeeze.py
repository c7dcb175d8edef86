"""A disc between two frictionless plates in the engine and the reference solver, for the cases plates and locking.

Units mu = R = rho = 1. The approach is that of the plates over the diameter, counted from the true circle.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from histories import speeds
from verification import Case, Run

SCENE = "../plates/scene.toml"
METHODS = ["mls", "mls-gauss", "t3", "es-t3"]
OUTLINE = {168: 48, 340: 68, 700: 100, 1400: 140}  # outline nodes: multiples of four, so both poles are equal
GAP = 0.01  # of either plate at the start
PAUSE, RAMP = 8.0, 2.5  # s between approaches; s of motion in each
DAMPING = 3.0  # 1/s, of the mass
# For comparisons on the same nodes, at full rest. The slowest motion is sideways on the springs at the poles, w = 0.7.
# A damping of twice w removes it fastest, by exp(-0.7 x 29). Its stored energy is damping over w times the kinetic one.
LONG_PAUSE, LOW_DAMPING, STORED = 32.0, 1.5, 2.0
NEWTON = 1e-9  # of forces of the reference: 1e-10 of the forces that cancel at each of some ten nodes in contact
HOLD = 6.0  # springs at the poles, mu / R, over a length of 0.14: five hundred times softer than contact


@dataclass(frozen=True)
class Squeeze:
    """One run: a disc with a corner or, turned by half a segment, a facet at each pole."""

    approaches: tuple[float, ...]
    method: str = "mls"
    nodes: int = 168
    facet: bool = False
    stiffness: float = 3e3  # of the contact, mu / R
    poisson: float = 0.4
    pause: float = PAUSE
    damping: float = DAMPING

    def at_full_rest(self) -> Squeeze:
        return replace(self, pause=LONG_PAUSE, damping=LOW_DAMPING)

    def name(self) -> str:
        turned = "facet" if self.facet else "corner"
        return f"{self.method}_{self.nodes}_{turned}_{self.stiffness:g}_{self.poisson:g}_{len(self.approaches)}_{self.pause:g}"

    def scene(self, case: Case) -> str:
        up = speeds([-GAP, *self.approaches], self.pause, RAMP)
        outline = OUTLINE[self.nodes]
        quadrature = "segments" if self.method == "t3" else "nodes"  # with contact at nodes, light nodes of t3 rattle
        return case.scene(SCENE, method=self.method, quadrature=quadrature, nodes=self.nodes, outline=outline,
                          hold=HOLD, rest=self.pause, damping=self.damping,
                          angle=np.pi / outline if self.facet else 0.0, end=self.pause * len(self.approaches),
                          young=2 * (1 + self.poisson), poisson=self.poisson, stiffness=self.stiffness,
                          up=up, down=[[t, -v] for t, v in up])


class Rests:
    """Results at the end of each pause, [approaches] each: force on a plate, energies, horizontal diameter."""

    def __init__(self, squeeze: Squeeze, run: Run) -> None:
        at = squeeze.pause * np.arange(1, len(squeeze.approaches) + 1)
        self.upper, self.lower = run.at("upper.force_y", at), -run.at("lower.force_y", at)
        self.force = (self.upper + self.lower) / 2
        names = ("kinetic", "strain", "contact", "boundary")
        self.kinetic, self.strain, self.contact, self.boundary = (run.at(f"energy.{name}", at) for name in names)
        self.stored = self.strain + self.contact + self.boundary
        self.diameter = run.at("disc.diameter_x", at)
        self.gap = 2 * run.at("plate.position_y", at)

    def unrest(self) -> np.ndarray:
        """Relative bound of the effect of residual motion on forces at full rest."""
        return force_of_motion(self.force, self.gap, self.kinetic, STORED) / self.force


def force_of_motion(force: np.ndarray, gap: np.ndarray, kinetic: np.ndarray, stored: float) -> np.ndarray:
    """Bound of the difference between a force on plates and that at rest, for a residual kinetic energy.

    A motion x that decays slowly with damping c of the mass, x' = -s x, has c/s times its kinetic energy E stored as
    x.K x / 2; `stored` is this ratio. It changes the force by g.K x, with g the motion of closing the gap. For the
    positive stiffness K, Cauchy and Schwarz give (g.K x)^2 <= g.K g x.K x: at most dF/dgap times 2 stored E.
    """
    return np.sqrt(2 * stored * kinetic * np.abs(np.gradient(force, gap)))


def by_engine(case: Case, squeeze: Squeeze) -> Rests:
    return Rests(squeeze, case.engine(squeeze.name(), squeeze.scene(case)))


def by_reference(case: Case, squeeze: Squeeze) -> Rests:
    """Statics, with eight load steps per approach."""
    run = case.reference(squeeze.name() + "_reference", squeeze.scene(case), "--static", "--dt", repr(PAUSE / 8))
    return Rests(squeeze, run)


def worst_over_reference(case: Case, squeeze: Squeeze, reference: dict[float, float]) -> tuple[float, float]:
    """The worst ratio of the engine's forces at full rest to the reference's, by approach, and its tolerance."""
    rests = by_engine(case, squeeze.at_full_rest())
    ratio = rests.force / [reference[approach] for approach in squeeze.approaches]
    allowed = rests.unrest() + NEWTON
    i = int((np.abs(ratio - 1) / allowed).argmax())
    return float(ratio[i]), float(allowed[i])


def both_ways(case: Case, squeeze: Squeeze) -> list[Rests]:
    """With corners and with facets at the poles: nodes come into contact at other approaches, so errors alternate."""
    return [by_engine(case, replace(squeeze, facet=facet)) for facet in (False, True)]


def to_zero_spacing(nodes: list[int], values: list[np.ndarray]) -> np.ndarray:
    """A straight line in the square of the outline's node spacing, at zero. [sizes] of [approaches].

    Least squares with weights for errors proportional to that square, like the saw tooth of the contact edges.
    """
    squares = np.array([OUTLINE[count] ** -2.0 for count in nodes])
    return np.polyfit(squares, np.array(values), 1, w=1 / squares)[1]


def to_rigid_contact(soft: np.ndarray, stiff: np.ndarray, ratio: float) -> np.ndarray:
    """From contact stiffnesses k and ratio x k: the error is of order 1 / k."""
    return (ratio * stiff - soft) / (ratio - 1)
