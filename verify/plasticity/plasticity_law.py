"""The law of plasticity at one point, in 3x3 matrices by scipy alone, and paths of plane deformation for its table.

F = Fe Fp, Hencky energy, von Mises yield, associated flow, exponential return with a backward Euler step of a. It is
written in the intermediate configuration; `in_space` writes the same step with be, as a check of the first.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import expm, logm
from scipy.optimize import brentq

SAME = 1e-12  # largest difference of stresses and states by both forms, in units of the largest


@dataclass(frozen=True)
class Law:
    """Shear modulus G, bulk modulus K and the yield stress sigma(a) of the accumulated plastic strain a."""

    mu: float
    bulk: float
    yields: float
    hardening: float
    saturation: float
    rate: float

    @classmethod
    def of_young(cls, young: float, nu: float, *hardens: float) -> Law:
        return cls(young / (2 * (1 + nu)), young / (3 * (1 - 2 * nu)), *hardens)

    @property
    def young(self) -> float:
        return 9 * self.bulk * self.mu / (3 * self.bulk + self.mu)

    @property
    def nu(self) -> float:
        return (3 * self.bulk - 2 * self.mu) / (6 * self.bulk + 2 * self.mu)

    def limit(self, a: float) -> float:
        return self.yields + self.hardening * a + (self.saturation - self.yields) * (1 - float(np.exp(-self.rate * a)))

    def grown(self, q_trial: float, a: float) -> float:
        """Increment of a."""
        if q_trial <= self.limit(a):
            return 0.0
        return float(brentq(lambda more: q_trial - 3 * self.mu * more - self.limit(a + more), 0.0,
                            q_trial / (3 * self.mu), xtol=1e-17, rtol=1e-15))


@dataclass(frozen=True)
class State:
    """[3 x 3] the inverse plastic metric Cp^-1, and a."""

    metric: np.ndarray
    a: float


@dataclass(frozen=True)
class Answer:
    """[3 x 3] Kirchhoff stress tau, and the state at the end of the step."""

    tau: np.ndarray
    state: State


Step = Callable[[Law, np.ndarray, State], Answer]
LAW = Law(mu=0.8, bulk=1.9, yields=0.11, hardening=0.07, saturation=0.16, rate=9.0)
COLUMNS = "path,increment,Fxx,Fxy,Fyx,Fyy,Pxx,Pxy,Pyx,Pyy,sigma_zz,Cpi_xx,Cpi_xy,Cpi_yy,a".split(",")


def deviator(m: np.ndarray) -> np.ndarray:
    return m - np.trace(m) / 3 * np.eye(3)


def equivalent(stress: np.ndarray) -> float:
    return float(np.sqrt(1.5) * np.linalg.norm(deviator(stress)))


class Plastic:
    """Fp of the point, as in_middle has it."""

    def __init__(self) -> None:
        self.f, self.a = np.eye(3), 0.0

    def step(self, law: Law, f: np.ndarray) -> Answer:
        """Fe = F Fp^-1 = R U, Fp_new = exp(da N) Fp with N = 3/2 dev M / q and the Mandel stress M of ln U."""
        fe = f @ np.linalg.inv(self.f)
        e = logm(fe.T @ fe).real / 2
        mandel = law.bulk * np.trace(e) * np.eye(3) + 2 * law.mu * deviator(e)
        q = equivalent(mandel)
        da = law.grown(q, self.a)
        if da > 0:
            flow = 1.5 * deviator(mandel) / q
            self.f, self.a = expm(da * flow) @ self.f, self.a + da
            e, mandel = e - da * flow, mandel - 2 * law.mu * da * flow
        # The rotation of Fe is that of the trial: the plastic increment commutes with U.
        rotation = fe @ expm(-logm(fe.T @ fe).real / 2)
        inverse = np.linalg.inv(self.f)
        return Answer(rotation @ mandel @ rotation.T, State(inverse @ inverse.T, self.a))


def in_space(law: Law, f: np.ndarray, before: State) -> Answer:
    """be = F Cp^-1 F^T, e = ln sqrt(be), and back."""
    e = logm(f @ before.metric @ f.T).real / 2
    q = 2 * law.mu * equivalent(e)
    da = law.grown(q, before.a)
    kept = (1 - 3 * law.mu * da / q if da > 0 else 1.0) * deviator(e)
    inverse = np.linalg.inv(f)
    after = inverse @ expm(2 * (kept + np.trace(e) / 3 * np.eye(3))) @ inverse.T
    return Answer(law.bulk * np.log(np.linalg.det(f)) * np.eye(3) + 2 * law.mu * kept, State(after, before.a + da))


def solid(plane: np.ndarray) -> np.ndarray:
    f = np.eye(3)
    f[:2, :2] = plane
    return f


def strain(size: float, angle: float, volume: float) -> np.ndarray:
    """[2 x 2] stretch: exp of `size` along the angle and its opposite across it, and of `volume` all around."""
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, -s], [s, c]])
    return turn @ np.diag(np.exp([volume + size, volume - size])) @ turn.T


def rotation(angle: float) -> np.ndarray:
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def deformations() -> list[np.ndarray]:
    """[5 x 2 x 2] F by path, of six kinds in turn: elastic; a little beyond yield and back; one way to 30 %;
    to and fro; along changing axes; one way with large rotations. At each step the body is turned, too."""
    random = np.random.default_rng(20)
    paths = []
    for path in range(30):
        kind, axis = path % 6, random.uniform(0, np.pi)
        top = [0.025, 0.06, 0.3, 0.2, 0.3, 0.3][kind] * random.uniform(0.7, 1.0)
        shares = [[0.3, 0.6, 1.0, 0.2, -0.7], [0.7, 1.0, 0.5, -0.2, 0.1], [0.1, 0.3, 0.5, 0.8, 1.0],
                  [0.5, 1.0, 0.2, -0.8, 0.6], [0.3, 0.6, 0.9, 0.4, 1.0], [0.2, 0.4, 0.6, 0.8, 1.0]][kind]
        steps, turned = [], 0.0
        for share in shares:
            axis += {4: random.uniform(-0.8, 0.8)}.get(kind, random.uniform(-0.1, 0.1))
            turned += random.uniform(-0.3, 0.3) if kind < 5 else random.uniform(0.4, 1.2)
            steps.append(rotation(turned) @ strain(share * top, axis, random.uniform(-0.15, 0.15) * top))
        paths.append(np.array(steps))
    return paths


def paths() -> np.ndarray:
    """[paths * increments x columns]"""
    rows = []
    for number, steps in enumerate(deformations()):
        plastic, state = Plastic(), State(np.eye(3), 0.0)
        for increment, plane in enumerate(steps):
            f = solid(plane)
            answer, other = plastic.step(LAW, f), in_space(LAW, f, state)
            state = answer.state
            piola = answer.tau @ np.linalg.inv(f).T
            sigma = answer.tau / np.linalg.det(f)
            apart = max(np.abs(answer.tau - other.tau).max(), np.abs(state.metric - other.state.metric).max(),
                        abs(state.a - other.state.a), abs(np.linalg.det(state.metric) - 1))
            if apart > SAME:
                raise ArithmeticError(f"path {number}, increment {increment}: both forms differ by {apart}")
            rows.append([number, increment, *plane.ravel(), *piola[:2, :2].ravel(), sigma[2, 2],
                         state.metric[0, 0], state.metric[0, 1], state.metric[1, 1], state.a])
    return np.array(rows)
