"""A double cantilever beam: the crack's length and the load against beam theory."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from pictures import COLOURS, legend, panels, save
from verification import FULL, Case, Label, Run

CASE = Case(__file__, cost=0.5)

STRENGTH, ENERGY, SPACING = 0.005, 2.5e-5, 0.2
END, OPENING = 2000.0, 0.7  # s, and of both ends together then
NOTCH, POINT = 4.0, 0.51  # length of the crack at the start; height at which the arms are held
MODULUS = 1 / (1 - 0.3**2)  # E'
INERTIA = 1 / 12
ROOT = 0.663  # of the height: rotation of the arms where they join (Hashemi, Kinloch, Williams 1990; isotropic)
# Length of a cohesive zone in slender arms, (E' G/strength^2)^(1/4) H^(3/4) (Yang and Cox 2005, 10.1007/s10704-005-4729-6)
ZONE = (MODULUS * ENERGY / STRENGTH**2) ** 0.25


def scene(period: float) -> str:
    reach = 0.6 * SPACING
    return CASE.scene(
        "dcb.toml", end=END, damping=0.05, spacing=SPACING, down=[[0, 0], [END, -OPENING / 2]],
        up=[[0, 0], [END, OPENING / 2]], low=-POINT - reach, high=-POINT + reach, low_of_upper=POINT - reach,
        high_of_upper=POINT + reach, strength=STRENGTH, energy=ENERGY, period=period, frame=END / 10)


@cache
def pulled_apart() -> Run:
    return CASE.engine("dcb", scene(END / 200))


def opening(run: Run) -> np.ndarray:
    return run.times("works.dissipated_by_bonds") / END * OPENING


def crack(run: Run) -> np.ndarray:
    """Length by the energy that bonds have taken."""
    return NOTCH + run.probe("works.dissipated_by_bonds") / ENERGY


def crack_of_beams(opened: np.ndarray) -> np.ndarray:
    """G = P^2 a^2/(E' I) is the fracture energy, with the opening 2 P a^3/(3 E' I)."""
    return (9 * MODULUS * INERTIA * opened**2 / (4 * ENERGY)) ** 0.25 - ROOT


def load_of_beams(opened: np.ndarray, length: np.ndarray) -> np.ndarray:
    return 3 * MODULUS * INERTIA * opened / 2 / length**3


def test_crack_length() -> None:
    run = pulled_apart()
    found, opened = crack(run), opening(run)
    for at in (0.42, 0.56, 0.7):
        k = int(np.abs(opened - at).argmin())
        CASE.check(Label.EXACT, f"crack length at an opening of {at}", found[k], crack_of_beams(opened[k]), ZONE / 2,
                   "beam theory with rotation of the root; the tip by energy lies within the cohesive zone")


def test_energy_is_that_of_the_torn_bonds() -> None:
    run = pulled_apart()
    torn, softening = (run.probe(f"bonds.{name}_bonds")[-1] for name in ("torn", "softening"))
    middle = (2 * torn + softening) / 2 * SPACING
    CASE.check(Label.EXACT, "energy of bonds over the fracture energy, as a length", crack(run)[-1] - NOTCH, middle,
               softening / 2 * SPACING, "torn bonds take all of it, softening ones between nothing and all")
    CASE.check(Label.EXACT, "balance of energy", run.balance_error, 0, 1e-3, "specified")


def test_load() -> None:
    run = pulled_apart()
    load, length, opened = run.probe("load.applied_force_y"), crack(run) + ROOT, opening(run)
    grows = opened > 0.35
    ratio = load[grows] / load_of_beams(opened[grows], length[grows])
    CASE.check(Label.EXACT, "load over that of beams of this length, mean while the crack grows", ratio.mean(), 1, 0.05,
               "vibrations after tears, 10 % over some ten periods; rotation of the root and mesh, 2 %")
    figure, (lengths, loads) = panels(2, "Double cantilever beam")
    lengths.plot(opened, crack(run), color=COLOURS[0], label="engine")
    lengths.plot(opened[grows], crack_of_beams(opened[grows]), "--", color=COLOURS[1], label="beam theory")
    lengths.set(xlabel="opening over the height of an arm", ylabel="length of the crack")
    legend(lengths)
    loads.plot(opened, load, color=COLOURS[0])
    loads.plot(opened[grows], load_of_beams(opened[grows], crack_of_beams(opened[grows]) + ROOT), "--",
               color=COLOURS[1])
    loads.set(xlabel="opening over the height of an arm", ylabel="load")
    save(CASE, figure, "dcb")


@pytest.mark.skipif(not FULL, reason="the static solution takes half a minute")
def test_static_reference() -> None:
    run, static = pulled_apart(), CASE.reference("dcb_static", scene(END / 40), "--static", "--dt", f"{END / 40} s")
    times = static.times("bonds.torn_bonds")
    numbers, strain = [], []
    for solver in (run, static):
        at = [int(np.abs(solver.times("bonds.torn_bonds") - t).argmin()) for t in times]
        numbers.append(solver.probe("bonds.torn_bonds")[at] + solver.probe("bonds.softening_bonds")[at] / 2)
        strain.append(solver.probe("energy.strain")[at])
    CASE.check(Label.INDEPENDENT, "engine - statics: length of the crack in segments, largest difference",
               np.abs(numbers[0] - numbers[1]).max(), 0, 1, "bonds tear one by one, with vibrations a tear sooner or later")
    early = (times >= 0.1 * END) & (numbers[1] <= 0.5)
    CASE.check(Label.INDEPENDENT, "engine over statics: strain energy until the second bond softens, largest difference",
               np.abs(strain[0][early] / strain[1][early] - 1).max(), 0, 1e-2,
               "kinetic energy of the ends, 1 % of the strain energy at a tenth of the time")
