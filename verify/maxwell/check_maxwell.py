"""A neo-Hookean solid with a Maxwell branch: creep at small strains by modes; large strains, engine and reference."""

from __future__ import annotations

import numpy as np
import pytest

from pictures import COLOURS, draw_orders, legend, panels, save
from verification import Case, Label, Run

CASE = Case(__file__, fast=True)

MU, BRANCH, RELAXATION = 1.0, 3.0, 0.3
SMALL, END = 1e-4, 8.0
LARGE, LARGE_END = 0.6, 3.0
STEPS = [0.02, 0.01, 0.005]
MASS = ["--mass", "corrected"]  # lumped mass lowers the first frequency by percents
FINE = 0.05  # safety of the engine run compared with the reference: steps of some 1 ms


def scene(pull: float, end: float, safety: float = 0.5, integrator: str = "verlet", target: float = 1e-6) -> str:
    text = CASE.scene("creep.toml", pressure=-pull, end=end, safety=safety, branch=BRANCH, relaxation=RELAXATION,
                      integrator=integrator, target=target)
    unused = "target" if integrator == "verlet" else "tolerance safety"
    return "\n".join(line for line in text.splitlines() if line.split(" ")[0] not in unused.split())


@pytest.fixture(scope="module")
def small() -> dict[str, Run]:
    return {"engine": CASE.engine("small_engine", scene(SMALL, END)),
            "step-doubling": CASE.engine("small_doubling", scene(SMALL, END, integrator="step-doubling")),
            "reference": CASE.reference("small_reference", scene(SMALL, END), "--dt", "0.01", *MASS)}


@pytest.fixture(scope="module")
def large() -> dict[str, Run]:
    text = scene(LARGE, LARGE_END, FINE)
    runs = {f"{dt:g}": CASE.reference(f"large_reference_{dt:g}", text, "--dt", repr(dt), *MASS) for dt in STEPS}
    return {"engine": CASE.engine("large_engine", text), **runs}


def way_of_centre(t: np.ndarray) -> np.ndarray:
    """Mean of u by modes, each with a cubic of s: rho u_tt = stress_x on a bar of length 1, held at x = 0, with the
    traction SMALL at x = 1. The Laplace transform of the stress is 2 (mu + m s T / (1 + s T)) u_x."""
    mean = np.zeros_like(t)
    for number in range(200):
        k = (number + 0.5) * np.pi
        cubic = np.array([RELAXATION, 1.0, 2 * k**2 * (MU + BRANCH) * RELAXATION, 2 * k**2 * MU])
        roots, slope = np.roots(cubic), np.polyder(cubic)
        answer = 1 / (2 * k**2 * MU) + sum((1 + s * RELAXATION) / (s * np.polyval(slope, s)) * np.exp(s * t)
                                           for s in roots).real
        mean += 2 * SMALL * np.sin(k) / k * answer
    return mean


def moved(run: Run) -> np.ndarray:
    x = run.probe("square.position_x")
    return x - x[0]


def test_creep(small: dict[str, Run]) -> None:
    for name, run in small.items():
        t = run.times("square.position_x")
        late = t >= 1
        error = float(np.abs(moved(run)[late] / way_of_centre(t[late]) - 1).max())
        CASE.check(Label.EXACT, f"creep in small strains, {name}", error, 0, 0.003,
                   "by modes; the support's compliance is 2e-4 of the bar's; first frequencies err by some 1e-3 "
                   "(corrected mass), which gives 1e-3 of the oscillating displacement; the stretch errs by as much")


def test_energy_balance(small: dict[str, Run], large: dict[str, Run]) -> None:
    instant = np.sqrt(2 * (MU + BRANCH)) * np.pi / 2  # frequency of the first mode, 1/s
    for name, run in {**small, "large strains, engine": large["engine"],
                      "large strains, reference": large[f"{STEPS[-1]:g}"]}.items():
        dt = STEPS[-1] if "reference" in name else float(run.steps("dt").max())
        order = 1 if name == "step-doubling" else 2
        CASE.check(Label.EXACT, f"balance of energy, {name}", run.balance_error, 0, (instant * dt) ** order,
                   f"order {order} in the step times frequency of the first mode, which carries the energy")


def differences(large: dict[str, Run]) -> list[float]:
    engine = moved(large["engine"])
    return [float(np.abs(moved(large[f"{dt:g}"]) - engine).max() / np.abs(engine).max()) for dt in STEPS]


def test_large_strains(large: dict[str, Run]) -> None:
    stretch = 2 * moved(large["engine"]).max()
    CASE.check(Label.EXACT, "large strains: the square's stretch", stretch, 0.4, 0.25, "premise: strains are large")
    CASE.check_rate("large strains: reference against the engine at fine steps", STEPS, differences(large), 2, 0.15,
                    "both are of second order, with different rules: trapezoidal and exponential")


def test_picture(small: dict[str, Run], large: dict[str, Run]) -> None:
    figure, axes = panels(3, "Neo-Hookean square with a Maxwell branch", across=True)
    for (name, run), colour, style in zip(small.items(), COLOURS, ("-", "--", "-.")):
        axes[0].plot(run.times("square.position_x"), moved(run) / SMALL, style, color=colour, linewidth=1.1, label=name)
    t = np.linspace(0, END, 400)
    axes[0].plot(t, way_of_centre(t) / SMALL, ":", color=COLOURS[6], linewidth=1.5, label="closed form")
    axes[0].set_title("small strains: displacement of the centre over the traction", fontsize=10, loc="left")
    for name, colour, style in zip(("engine", f"{STEPS[-1]:g}"), COLOURS, ("-", "--")):
        run = large[name]
        axes[1].plot(run.times("square.position_x"), moved(run), style, color=colour, linewidth=1.1,
                     label=name if name == "engine" else f"reference, {name} s")
    axes[1].set_title("large strains: displacement of the centre", fontsize=10, loc="left")
    for panel in axes[:2]:
        panel.set_xlabel("time [s]")
        legend(panel)
    curves = [("displacement", STEPS, differences(large))]
    draw_orders(axes[2], "large strains: reference against engine", curves, [1, 2])
    save(CASE, figure, "maxwell")
