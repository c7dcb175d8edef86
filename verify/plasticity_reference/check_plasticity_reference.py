"""Von Mises plasticity in the reference solver: against closed forms in statics, and against the engine for a squeezed
disc and for a square in motion."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest

from pictures import COLOURS, draw_orders, legend, panels, save
from verification import Case, Label, Run

CASE = Case(__file__, cost=2)

MU, BULK = 1.0, 2.8 / (3 * (1 - 0.8))  # of the block and the disc
YIELD, HARDENING, SATURATION, SATURATION_RATE = 0.05, 0.2, 0.08, 8.0

# Block
STIFFNESS = 1e8  # of its supports
STATIC_STEPS = [0.1, 0.5]

# Disc
APPROACH, GAP, START = 0.28, 0.001, 0.1  # over the diameter; of either plate; share of the time
CLOCKS = 28
DURATIONS = [150.0, 300.0, 600.0]  # of the engine, s
INCREMENTS = [56, 112, 224]  # of the reference
# Bearings as in verify/plates_static: springs of 1 mu/R on the two segments at each end of both axes.
BEARINGS = [(0.0, "y"), (math.pi, "y"), (math.pi / 2, "x"), (-math.pi / 2, "x")]
REACH = 0.1  # rad to either side

# Square in motion
STEPS = [0.005, 0.0025, 0.00125]  # of the reference, s
SAFETIES = [0.8, 0.4, 0.2]  # of the engine: steps of 3.2 ms x safety / 0.8
RATES = {"without a rate": "", "with a rate": "viscoplastic_time = 0.2"}
MASS = ["--mass", "corrected"]


def yield_stress(a: float) -> float:
    return YIELD + HARDENING * a + (SATURATION - YIELD) * (1 - math.exp(-SATURATION_RATE * a))


@dataclass(frozen=True)
class Stretch:
    """A homogeneous deformation diag(x, y) along one direction of the logarithmic strain, so that flow has one
    direction, and any increments give the same."""

    name: str
    x: float
    y: float

    def scene(self) -> str:
        times = np.linspace(0, 1, 201)
        share = times**2 * (3 - 2 * times)

        def way(stretch: float) -> list[list[float]]:
            return [[float(t), float(u)] for t, u in zip(times, np.exp(math.log(stretch) * share) - 1)]

        return CASE.scene("block.toml", stiffness=STIFFNESS, right=way(self.x), top=way(self.y))

    def strains(self) -> np.ndarray:
        return np.array([math.log(self.x), math.log(self.y), 0.0])

    def deviator(self) -> np.ndarray:
        return self.strains() - self.strains().mean()

    def flow(self) -> float:
        """a with 2 mu sqrt(3/2) |dev e| = 3 mu a + sigma(a), by bisection."""
        trial = 2 * MU * math.sqrt(1.5) * float(np.linalg.norm(self.deviator()))
        low, high = 0.0, trial / (3 * MU)
        for _ in range(100):
            a = 0.5 * (low + high)
            low, high = (a, high) if trial - 3 * MU * a > yield_stress(a) else (low, a)
        return low

    def exact(self) -> dict[str, float]:
        """Von Mises stress (Cauchy), plastic strain, stored energy and plastic loss: the integral of sigma."""
        a, volume = self.flow(), float(self.strains().sum())
        loss = YIELD * a + HARDENING * a * a / 2 + (SATURATION - YIELD) * (a - (1 - math.exp(-SATURATION_RATE * a))
                                                                           / SATURATION_RATE)
        return {"stress.von_mises": yield_stress(a) / math.exp(volume), "strain.plastic_strain": a,
                "energy.strain": BULK / 2 * volume**2 + yield_stress(a)**2 / (6 * MU),
                "works.dissipated_by_plasticity": loss}

    def compliance(self) -> float:
        """Relative error of the strains by the supports: each side yields by its stress over their stiffness."""
        a, volume = self.flow(), float(self.strains().sum())
        share = yield_stress(a) / (math.sqrt(1.5) * float(np.linalg.norm(self.deviator())))  # of the deviator: 2 mu r
        stress = (BULK * volume + share * self.deviator()) / math.exp(volume)
        return 2 * float(np.abs(stress[:2]).sum()) / STIFFNESS / float(np.abs(self.strains()).max())


STRETCHES = [Stretch("uniaxial strain, shorter", 0.8, 1.0), Stretch("uniaxial strain, longer", 1.25, 1.0),
             Stretch("pure shear", 1.3, 1 / 1.3)]


@pytest.mark.parametrize("stretch", STRETCHES, ids=lambda s: s.name)
def test_block(stretch: Stretch) -> None:
    for dt in STATIC_STEPS:
        run = CASE.reference(f"block_{stretch.x:g}_{stretch.y:g}_{dt:g}", stretch.scene(), "--static", "--dt", repr(dt))
        for column, expected in stretch.exact().items():
            CASE.check(Label.EXACT, f"{stretch.name}, {column}, increments of {dt:g}", run.probe(column)[-1] / expected,
                       1, 4 * stretch.compliance(),
                       "radial flow, whose increments add up exactly; energies are quadratic in strains, which err by "
                       "the stress over the supports' stiffness")


def disc_scene(end: float) -> str:
    velocity = (APPROACH + GAP) / end / (1 - START / 2)
    bearings = "\n".join(f"""[[boundary]]
of = "disc"
part = {{ angles = [{direction - REACH!r}, {direction + REACH!r}] }}
{axis} = "fixed"
stiffness = 1
""" for direction, axis in BEARINGS)
    return CASE.scene("disc.toml", end=end, clock=end / CLOCKS, up=[[0, 0], [START * end, velocity]],
                      down=[[0, 0], [START * end, -velocity]], bearings=bearings)


@pytest.fixture(scope="module")
def discs() -> dict[str, list[Run]]:
    """Engine and reference, from coarse to fine."""
    end = DURATIONS[0]
    return {"engine": [CASE.engine(f"disc_{t:g}s", disc_scene(t)) for t in DURATIONS],
            "reference": [CASE.reference(f"disc_{n}_increments", disc_scene(end), "--static", "--dt", repr(end / n))
                          for n in INCREMENTS]}


def plate_force(run: Run) -> np.ndarray:
    return 0.5 * (run.probe("upper.force_y") - run.probe("lower.force_y"))


def limit(values: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Limit of values of first order at steps that halve, with its error: what the last halving changes of it."""
    coarse, fine = 2 * values[-2] - values[-3], 2 * values[-1] - values[-2]
    return fine, np.abs(fine - coarse)


READS = {"force": plate_force, "plastic loss": lambda run: run.probe("works.dissipated_by_plasticity"),
         "strain energy": lambda run: run.probe("energy.strain")}


def approaches() -> np.ndarray:
    """[clocks + 1] of both plates over the diameter, less the gaps."""
    t = np.linspace(0, 1, CLOCKS + 1)
    way = np.where(t < START, t**2 / (2 * START), t - START / 2) / (1 - START / 2)
    return (APPROACH + GAP) * way - GAP


COMPARED = slice(6, CLOCKS + 1)  # from 5 % on; before, two nodes touch each plate


def test_disc(discs: dict[str, list[Run]]) -> None:
    for name, read in READS.items():
        of = {program: limit([read(run)[COMPARED] for run in runs]) for program, runs in discs.items()}
        (engine, error), (reference, own) = of["engine"], of["reference"]
        CASE.check(Label.INDEPENDENT, f"disc, {name} from 5 to 28 %: engine over reference, least agreement",
                   np.abs(engine / reference - 1).max(), 0, ((error + own) / reference).max(),
                   "both to zero step, as the engine's drag falls with its speed and the reference's error with its "
                   "increments; what the last halvings change of the limits")


def test_disc_flows(discs: dict[str, list[Run]]) -> None:
    run = discs["reference"][-1]
    CASE.check(Label.EXACT, "disc: largest plastic strain", run.probe("largest.plastic_strain")[-1], 0.4, 0.2,
               "premise: strains are large")


@pytest.fixture(scope="module")
def squares() -> dict[str, dict[str, list[Run]]]:
    """By rate: engine and reference, from coarse to fine."""
    runs = {}
    for name, key in RATES.items():
        case = "rate" if key else "no_rate"
        runs[name] = {"engine": [CASE.engine(f"square_{case}_{s:g}", CASE.scene("pulled.toml", safety=s, rate=key))
                                 for s in SAFETIES],
                      "reference": [CASE.reference(f"square_{case}_{dt:g}s",
                                                   CASE.scene("pulled.toml", safety=SAFETIES[0], rate=key),
                                                   "--dt", repr(dt), *MASS) for dt in STEPS]}
    return runs


def moved(run: Run) -> np.ndarray:
    x = run.probe("square.position_x")
    return x - x[0]


def test_square_in_motion(squares: dict[str, dict[str, list[Run]]]) -> None:
    for name, programs in squares.items():
        of = {program: limit([moved(run) for run in runs]) for program, runs in programs.items()}
        (engine, error), (reference, own) = of["engine"], of["reference"]
        size = np.abs(engine).max()
        CASE.check(Label.INDEPENDENT, f"square in motion {name}: engine from reference",
                   np.abs(engine - reference).max() / size, 0, (error + own).max() / size,
                   "both to zero step, as flow by backward differences is of first order; what the last halvings "
                   "change of the limits")
        errors = [float(np.abs(moved(run) - engine).max() / size) for run in programs["reference"]]
        CASE.check_rate(f"square in motion {name}: reference", STEPS, errors, 1, 0.15,
                        "flow by backward differences, from the limit of the engine, whose own error adds; parts of "
                        "second order, a seventh of it at the largest step, lower the slope by 0.1")


def test_energy_of_the_square(squares: dict[str, dict[str, list[Run]]]) -> None:
    runs = squares["without a rate"]["reference"]
    CASE.check_rate("square in motion without a rate: balance of energy, reference", STEPS,
                    [run.balance_error for run in runs], 2, 0.2,
                    "work by the trapezoidal rule; losses are integrals of the yield stress over the flow")


def test_picture(discs: dict[str, list[Run]], squares: dict[str, dict[str, list[Run]]]) -> None:
    figure, axes = panels(3, "Von Mises plasticity: engine and reference", across=True)
    percent = 100 * approaches()[COMPARED]
    for (name, runs), colour, style in zip(discs.items(), COLOURS, ("-", "--")):
        axes[0].plot(percent, plate_force(runs[-1])[COMPARED], style, color=colour, linewidth=1.1, label=name)
    axes[0].set_ylabel("force on a plate over mu R")
    for (name, read), colour in zip(READS.items(), COLOURS):
        (engine, _), (reference, _) = (limit([read(run)[COMPARED] for run in discs[program]])
                                       for program in ("engine", "reference"))
        axes[1].semilogy(percent, np.abs(engine / reference - 1), color=colour, linewidth=1.1, label=name)
    axes[1].set_ylabel("|engine over reference - 1|, both to zero step")
    for panel in axes[:2]:
        panel.set_xlabel("approach over the diameter [%]")
        legend(panel)
    curves = []
    for name, programs in squares.items():
        end = limit([moved(run) for run in programs["engine"]])[0]
        curves.append((name, STEPS, [float(np.abs(moved(run) - end).max() / np.abs(end).max())
                                     for run in programs["reference"]]))
    draw_orders(axes[2], "square in motion: reference from the engine", curves, [1])
    save(CASE, figure, "plasticity_reference")
