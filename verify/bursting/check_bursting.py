"""A disc of bonded cells bursts and its fragments collide without friction: does the energy balance hold?"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np

from bonded_cells import draw_fragments, edges
from fields import frames_of
from pictures import COLOURS, MARKERS, describe, draw_rate, legend, panels, save, set_ticks
from verification import FULL, Case, Label, Run, observed_order

CASE = Case(__file__, long=True, cost=6 if FULL else 2)

END = 150e-6  # s
ENERGY = 1200.0  # of a crack, J/m2
SAFETIES = [0.8, 0.4, 0.2]
SEEDS = [1, 2, 3] if FULL else [1]
BROKEN = 30e-6  # s: the disc has burst; the tension needs R/c = 3 us to come back from the edge


@cache
def burst(safety: float, seed: int = 1, consistent: bool = True) -> Run:
    return CASE.engine(f"safety_{safety:g}_{seed}" + ("" if consistent else "_uncorrected"), CASE.scene(
        end=END, spacing=1.5e-3, cells=100, seed=seed, safety=safety, sample=END / 150, frame=END / 10, energy=ENERGY,
        consistent="true" if consistent else "false"))


def times(run: Run) -> np.ndarray:
    return run.times("energy.balance_error")


def error(run: Run) -> np.ndarray:
    return np.abs(run.probe("energy.balance_error"))


def after(run: Run) -> np.ndarray:
    return error(run)[times(run) > BROKEN]


def while_bursting(run: Run) -> np.ndarray:
    return error(run)[times(run) <= BROKEN]


def errors(part: Callable[[Run], np.ndarray]) -> list[float]:
    """[safeties] largest error of a part of the time, root of the mean square over seeds."""
    return [float(np.sqrt(np.mean([part(burst(safety, seed)).max() ** 2 for seed in SEEDS]))) for safety in SAFETIES]


def test_balance() -> None:
    for safety in SAFETIES:
        worst = max(error(burst(safety, seed)).max() for seed in SEEDS)
        CASE.check(Label.EXACT, f"balance of energy, safety {safety:g}, largest error", worst, 0, 1e-3, "specified")
    momentum = burst(SAFETIES[0]).probe("energy.momentum_error").max()
    CASE.check(Label.EXACT, "momentum, largest error", momentum, 0, 1e-11, "rounding of 1e-16 in 1e4 steps")


def test_no_growth() -> None:
    """Energy that collisions create would multiply their number and force, and grow exponentially."""
    for safety in SAFETIES:
        run = burst(safety)
        second, third = (part.max() for part in np.array_split(after(run), 3)[1:])
        CASE.check(Label.EXACT, f"largest error in the last third over that in the second, safety {safety:g}",
                   third / second, 0.75, 0.75, "errors of collisions add up in proportion to time at most")


def test_order() -> None:
    """While the disc bursts, runs with all steps follow the same motion."""
    ratios = np.array(SAFETIES)
    highest = observed_order(SAFETIES, list(ratios**2 / (1 - ratios**2)))
    CASE.check_rate("error of the balance until 30 us over the time step", SAFETIES, errors(while_bursting),
                    (highest + 2) / 2, (highest - 2) / 2,
                    "Verlet: order 2 for low frequencies; error in q^2/(1 - q^2) for the highest")


def test_energy_of_cracks() -> None:
    run = burst(SAFETIES[0])
    frames = frames_of(run)
    ends = frames.positions("outlines", 0)[edges(frames), :2]
    lengths = np.hypot(*(ends[:, 1] - ends[:, 0]).T)
    torn, softening = (run.probe(f"bonds.{name}_bonds")[-1] for name in ("torn", "softening"))
    crack = ENERGY * lengths.mean()
    CASE.check(Label.EXACT, "energy of bonds over that of the torn ones",
               run.probe("energy.dissipated")[-1] / (torn * crack), 1 + softening / torn / 2,
               softening / torn / 2 + lengths.std() / lengths.mean() / np.sqrt(torn),
               "torn bonds take all of it, softening ones a part; lengths of segments scatter")


def test_picture() -> None:
    runs = {f"safety {safety:g}": burst(safety) for safety in SAFETIES}
    runs["safety 0.8, contact not corrected"] = burst(SAFETIES[0], consistent=False)
    figure, (balance, order, pieces) = panels(3, "Bursting disc, fragments without friction", across=True)
    for (name, run), colour in zip(runs.items(), COLOURS):
        balance.semilogy(1e6 * times(run)[1:], error(run)[1:], color=colour, linewidth=1, label=name)
    balance.set_ylim(1e-9, 1e-3)
    describe(balance, "time steps over the stability bound", "time [us]", "error of the energy balance")
    legend(balance)
    bursting = errors(while_bursting)
    draw_rate(order, SAFETIES, bursting, "while the disc bursts", COLOURS[0], MARKERS[0])
    draw_rate(order, SAFETIES, errors(after), "afterwards", COLOURS[1], MARKERS[1])
    order.loglog(SAFETIES, bursting[-1] * (np.array(SAFETIES) / SAFETIES[-1]) ** 2, "--", color=COLOURS[6], linewidth=1,
                 label="slope 2")
    set_ticks(order, SAFETIES, [f"{safety:g}" for safety in SAFETIES])
    describe(order, "largest errors and their order", "time step over the stability bound",
             "error of the energy balance")
    legend(order)
    frames = frames_of(runs["safety 0.8"])
    last = len(frames.times) - 1
    draw_fragments(pieces, frames, last)
    describe(pieces, f"fragments at {1e6 * frames.times[last]:.0f} us", "x [mm]", "y [mm]")
    save(CASE, figure, "bursting")
