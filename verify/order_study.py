"""Errors of both solvers over their time step, each against the finest run of the other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from verification import Case, Label, Run, largest_difference

# In units of the requested step: the time after which the engine's short first steps, growing by 1.15, have reached it.
START = 20


@dataclass
class Quantity:
    """Columns of one unit, compared together."""

    name: str
    columns: list[str]


@dataclass
class Study:
    """Runs by time step, s; all measured at `times`."""

    engine: dict[float, Run]
    reference: dict[float, Run]
    steps: list[float]  # those evaluated for errors
    finest: float
    times: np.ndarray

    def engine_errors(self, quantity: Quantity) -> list[float]:
        return [self._difference(self.engine[dt], self.reference[self.finest], quantity) for dt in self.steps]

    def reference_errors(self, quantity: Quantity) -> list[float]:
        return [self._difference(self.reference[dt], self.engine[self.finest], quantity) for dt in self.steps]

    def differences(self, quantity: Quantity) -> list[float]:
        """Between the solvers at one step."""
        return [self._difference(self.engine[dt], self.reference[dt], quantity) for dt in self.steps]

    def all_steps(self) -> list[float]:
        return [*self.steps, self.finest]

    def all_differences(self, quantity: Quantity) -> list[float]:
        """Between the solvers at one step, the finest too."""
        return [*self.differences(quantity), self.finest_difference(quantity)]

    def solvers(self) -> list[tuple[str, dict[float, Run]]]:
        return [("engine", self.engine), ("reference", self.reference)]

    def finest_runs(self) -> dict[str, Run]:
        return {name: runs[self.finest] for name, runs in self.solvers()}

    def finest_difference(self, quantity: Quantity) -> float:
        return self._difference(self.engine[self.finest], self.reference[self.finest], quantity)

    def curves(self, quantity: Quantity) -> list[tuple[str, list[float], list[float]]]:
        return [("engine", self.steps, self.engine_errors(quantity)),
                ("reference", self.steps, self.reference_errors(quantity)),
                ("engine - reference", self.steps, self.differences(quantity))]

    def _difference(self, a: Run, b: Run, quantity: Quantity) -> float:
        return largest_difference(a, b, quantity.columns, self.times)


def run_study(case: Case, name: str, steps: list[float], finest: float, times: np.ndarray, template: str = "scene.toml",
              **values: object) -> Study:
    """The scene's @dt@ is the period of a probe; both solvers end steps at outputs, so it is their step."""
    engine, reference = {}, {}
    for dt in [*steps, finest]:
        scene = case.scene(template, dt=dt, **values)
        engine[dt] = case.engine(f"{name}_engine_{dt:g}", scene)
        reference[dt] = case.reference(f"{name}_reference_{dt:g}", scene, "--dt", repr(dt))
        check_steps(engine[dt], dt)
    return Study(engine, reference, steps, finest, times)


def check_differences(case: Case, name: str, study: Study, quantity: Quantity, order: float, tolerance: float,
                      source: str) -> None:
    """Check that the solvers converge to each other: the order, and the decrease of the last difference."""
    errors = study.all_differences(quantity)
    case.check_rate(f"{name}: {quantity.name}, engine - reference", study.all_steps(), errors, order, tolerance, source)
    ratio = (study.steps[-1] / study.finest) ** 0.6
    case.check(Label.INDEPENDENT, f"{name}: {quantity.name}, difference at the finest step", errors[-1], 0,
               errors[-2] / ratio, "0.6 of first order from the step before: the solvers have no residual difference")


def check_same_motion(case: Case, name: str, study: Study, quantity: Quantity) -> None:
    case.check(Label.INDEPENDENT, f"{name}: {quantity.name}, difference at the finest step",
               study.finest_difference(quantity), 0,
               1.5 * study.differences(quantity)[-1] * (study.finest / study.steps[-1]) ** 2,
               "second order from the step before, and half as much again")


def check_steps(run: Run, dt: float) -> None:
    """Except for the short first steps, stability and error control must not have reduced the engine's steps."""
    later = run.steps("dt")[run.steps("time") > START * dt]
    if len(later) == 0 or not np.allclose(later, dt, rtol=1e-6):
        raise RuntimeError(f"{run.folder}: steps of {later.min(initial=np.inf):g} s, not {dt:g} s")
