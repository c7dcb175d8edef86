"""What a scene leaves to its author: discretisation, scheme, step, stiffness of contact; and the choices that are compared."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product

METHODS = ["mls", "mls-gauss", "t3", "es-t3"]
MASSES = ["lumped", "corrected"]
SAFETIES = [0.2, 0.4, 0.6, 0.9]
TOLERANCES = [1e-3, 1e-4]
TARGETS = [1e-4, 1e-3, 1e-2, 1e-1]  # of step doubling; the first is the paper's
STIFFNESSES = [0.25, 0.5, 2.0, 4.0, 16.0]
MASS_SCALING = 3.0  # that how_to/stiffness.md offers
REFERENCE_STEPS = [0.04, 0.02, 0.01]  # over the scene's unit of time


@dataclass(frozen=True)
class Choice:
    """Of one run. As it stands: the engine's defaults."""

    method: str = "mls"
    mass: str = "lumped"
    nodes: int = 168
    integrator: str = "verlet"
    bound: float = 1e-2  # tolerance of verlet, target of step doubling
    safety: float = 0.8
    stiffness: float = 1.0  # of contact, over the automatic one
    mass_scaling: float = 1.0  # of lumped mass
    step: float | None = None  # of the reference solver, in the scene's unit of time; None: the engine

    @property
    def family(self) -> str:
        """All but the number of nodes, as curves are named."""
        if self.step is not None:
            return f"reference, {self.method}, {self.mass}, dt {self.step:g}"
        scheme = f"safety {self.safety:g}" if self.integrator == "verlet" else "step doubling"
        if self.integrator != "verlet" or self.bound != 1e-2:
            scheme += f", {self.bound:g}"
        stiff = "" if self.stiffness == 1 else f", {self.stiffness:g} x kn"
        scaled = "" if self.mass_scaling == 1 else f" and scaled by {self.mass_scaling:g}"
        return f"{self.method}, {self.mass}{scaled}, {scheme}{stiff}"

    def time_keys(self) -> str:
        """Lines of [time]."""
        if self.integrator == "verlet":
            return f'integrator = "verlet"\ntolerance = {self.bound!r}\nsafety = {self.safety!r}'
        return f'integrator = "step-doubling"\ntarget = {self.bound!r}'

    def discretisation_keys(self) -> str:
        """Lines of [discretisation]."""
        scaling = "" if self.mass_scaling == 1 else f"\nmass_scaling = {self.mass_scaling!r}"
        return f'method = "{self.method}"\nmass = "{self.mass}"{scaling}'


DEFAULT = Choice()
PAPER = Choice("mls-gauss", "lumped", integrator="step-doubling", bound=TARGETS[0])  # three points a triangle


def of_space(sizes: list[int]) -> Iterator[Choice]:
    """All methods and masses on all sizes, else by default."""
    for method, mass, nodes in product(METHODS, MASSES, sizes):
        yield Choice(method, mass, nodes)


def of_paper(sizes: list[int]) -> Iterator[Choice]:
    """The paper's discretisation and scheme, at its own target and at others."""
    for target, nodes in product(TARGETS, sizes):
        yield replace(PAPER, nodes=nodes, bound=target)


def of_time(nodes: int) -> Iterator[Choice]:
    """Steps and schemes of either mass, on one size."""
    for mass in MASSES:
        base = Choice(mass=mass, nodes=nodes)
        yield from (replace(base, safety=safety) for safety in SAFETIES)
        yield from (replace(base, bound=tolerance) for tolerance in TOLERANCES)
        yield from (replace(base, integrator="step-doubling", bound=target) for target in TARGETS)


def of_longer_steps(sizes: list[int]) -> Iterator[Choice]:
    """What makes the steps of dense layers longer: mass scaling, a larger safety, both."""
    for scaling, safety in ((MASS_SCALING, 0.8), (1.0, 0.9), (MASS_SCALING, 0.9)):
        yield from (Choice(mass_scaling=scaling, safety=safety, nodes=nodes) for nodes in sizes)


def of_stiffness(sizes: list[int]) -> Iterator[Choice]:
    for mass, factor, nodes in product(MASSES, STIFFNESSES, sizes):
        yield Choice(mass=mass, nodes=nodes, stiffness=factor)


def of_reference(sizes: list[int]) -> Iterator[Choice]:
    for step, nodes in product(REFERENCE_STEPS, sizes):
        yield Choice(nodes=nodes, step=step)
