"""The scenes, each with what it is measured by: an error against a converged solution, over the size of what is measured.

Units mu = R = rho = 1 and lambda = 4 but for the third body. oracles/README.md says where converged solutions come from.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from error_study.choices import Choice
from pliant.frames import Frames
from pliant.results import read_run

HERE = Path(__file__).resolve().parent
ORACLES = HERE.parents[1] / "verify/oracles"
YOUNG = 2.8
SPEED = 0.2  # of impacts, over that of shear waves
SWING = 0.19  # of the oscillation: half of what the stretch goes to and fro
APPROACHES = [0.05, 0.1, 0.2, 0.3]  # of plates, over the diameter
GAP, PAUSE, RAMP = 0.01, 8.0, 2.5  # of plates: at the start; from one approach to the next; of it in motion
COLUMNS, ROWS, PITCH, ROW_PITCH = 4, 6, 0.87e-6, 1.002e-6  # of the third body, m


@dataclass(frozen=True)
class Scene:
    name: str
    title: str
    measure: str  # what the error is of
    text: Callable[[Choice], str]
    error: Callable[[Path], float]  # of a finished run's folder
    known: float  # to which the converged solution is
    sizes: list[int]  # nodes of a body
    reference_sizes: list[int]  # of runs of the reference solver; none: it takes too long
    free_stiffness: bool = True  # of contact: the law leaves it open
    unit: float = 1.0  # of time, s


def filled(template: str, choice: Choice, **values: object) -> str:
    """A scene's text: every @name@ has a value, every value a place."""
    text = (HERE / f"{template}.toml").read_text()
    values |= {"time": choice.time_keys(), "discretisation": choice.discretisation_keys(), "nodes": choice.nodes}
    for name, value in values.items():
        if f"@{name}@" not in text:
            raise KeyError(f"{template}.toml: no @{name}@")
        text = text.replace(f"@{name}@", repr(value) if isinstance(value, float) else str(value))
    return text


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def outline_nodes(nodes: int) -> int:
    """Of a disc, a multiple of four: poles are alike."""
    return 4 * round(3.7 * math.sqrt(nodes) / 4)


def stiffness(choice: Choice) -> float:
    """The automatic one, 8 E / h, of a disc of radius 1, times the factor of the choice."""
    return choice.stiffness * 8 * YOUNG / (2 * math.sin(math.pi / outline_nodes(choice.nodes)))


# ---- a disc swings

def oscillation_text(choice: Choice) -> str:
    return filled("oscillation", choice)


def stretches(folder: Path) -> tuple[np.ndarray, np.ndarray]:
    """Times, and root of the second moment of the area in x over that at the start; x is linear in each triangle."""
    frames = Frames(folder / "frames.h5", None)
    triangles = frames.grids["bodies"].cells
    start = frames.positions("bodies", 0)[triangles]
    sides = start[:, 1:] - start[:, :1]
    areas = 0.5 * (sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0])
    moments = []
    for frame in range(len(frames.times)):
        x = frames.positions("bodies", frame)[triangles][:, :, 0]
        moments.append(((x**2).sum(axis=1) + x.sum(axis=1) ** 2) @ areas)
    return frames.times, np.sqrt(np.array(moments) / moments[0])


def oscillation_error(folder: Path) -> float:
    """At nine times, over half of the swing."""
    table = np.genfromtxt(ORACLES / "disc_oscillation.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")
    table = table[table["quantity"] == "s"]
    times, values = stretches(folder)
    if not np.allclose(times[1:], table["t_cs_over_R"]):
        raise ValueError(f"{folder}: frames at other times than the oracle's")
    return rms(values[1:] - table["value"]) / SWING


# ---- a disc between plates

def plates_text(choice: Choice) -> str:
    corners, closed = [], -GAP
    for i, approach in enumerate(APPROACHES):
        corners += [[i * PAUSE, 0.0], [i * PAUSE + RAMP / 2, 2 * (approach - closed) / RAMP], [i * PAUSE + RAMP, 0.0]]
        closed = approach
    return filled("plates", choice, outline=outline_nodes(choice.nodes), stiffness=stiffness(choice), up=corners,
                  down=[[time, -speed] for time, speed in corners], rest=PAUSE, end=PAUSE * len(APPROACHES))


def plates_error(folder: Path) -> float:
    """Relative, of the four forces."""
    table = np.genfromtxt(ORACLES / "disc_between_plates.csv", delimiter=",", names=True)
    force = dict(zip(np.round(table["approach_over_diameter"], 6), table["force_over_muR"]))
    probes = read_run(folder).probes
    found = probes.sampled(probes.column("upper.force_y"))[1][1:]
    return rms(found / np.array([force[approach] for approach in APPROACHES]) - 1)


# ---- discs that bounce

def wall_text(choice: Choice) -> str:
    return filled("impact", choice, outline=outline_nodes(choice.nodes), stiffness=stiffness(choice), speed=-SPEED)


def discs_text(choice: Choice) -> str:
    return filled("two_discs", choice, outline=outline_nodes(choice.nodes), stiffness=stiffness(choice), speed=SPEED,
                  back=-SPEED)


def bounce_error(column: str, sign: float) -> Callable[[Path], float]:
    """Of the centre's velocity while it bounces, over its speed."""

    def error(folder: Path) -> float:
        table = np.genfromtxt(HERE / "oracles/impact.csv", delimiter=",", names=True)
        probes = read_run(folder).probes
        times, found = probes.sampled(probes.column(column))
        if not np.allclose(times, table["time"], atol=1e-9):
            raise ValueError(f"{folder}: velocities at other times than the oracle's")
        return rms(sign * found - table["velocity"]) / SPEED

    return error


# ---- a small third body, pressed and sheared until just before its lattice breaks

def third_body_text(choice: Choice) -> str:
    return filled("third_body", choice, columns=COLUMNS, rows=ROWS, period=COLUMNS * PITCH,
                  top=(ROWS + 0.5) * ROW_PITCH, stiffness=choice.stiffness * 2.44e17, hard=choice.stiffness * 7.49e17)


def layer_of(folder: Path) -> np.ndarray:
    """[2 x samples] height of the upper wall, m, and strain energy, J/m."""
    probes = read_run(folder).probes
    return np.array([probes.sampled(probes.column(name))[1] for name in ("upper.position_y", "energy.strain")])


def third_body_error(folder: Path) -> float:
    table = np.genfromtxt(HERE / "oracles/third_body.csv", delimiter=",", names=True)
    expected = np.array([table["height"], table["strain_energy"]])
    return rms((layer_of(folder) - expected) / np.ptp(expected, axis=1)[:, None])


SCENES = [
    Scene("oscillation", "A disc swings by a fifth, three times", "stretch at nine times, over half of the swing",
          oscillation_text, oscillation_error, 3e-6 / SWING, [40, 84, 168, 340, 700, 1400], [168], free_stiffness=False),
    Scene("plates", "A disc between plates up to 30 %", "force at 5, 10, 20 and 30 %", plates_text, plates_error, 2e-4,
          [40, 84, 168, 340, 700, 1400], []),
    Scene("impact", "A disc hits a wall at a fifth of the shear waves' speed", "velocity of the centre, over its speed",
          wall_text, bounce_error("disc.velocity_y", 1.0), 4e-4, [40, 84, 168, 340, 700, 1400], [168]),
    Scene("two_discs", "Two discs meet, each at a fifth of the shear waves' speed", "velocity of a centre, over its speed",
          discs_text, bounce_error("left.velocity_x", -1.0), 4e-4, [40, 84, 168, 340, 700, 1400], []),
    Scene("third_body", "24 discs in turn compliant and rigid, cohesive, pressed and sheared",
          "height of the layer and strain energy, over what they change by", third_body_text, third_body_error, 2.6e-3,
          [60, 100, 168, 300, 600], [], free_stiffness=False, unit=1e-9),
]
