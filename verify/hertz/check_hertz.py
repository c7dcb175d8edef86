"""A cylinder pressed against a rigid flat: the profile of the pressure and its peak after Hertz."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
from matplotlib.axes import Axes

from curved_block import NODES, RADIUS, YOUNG, block, levels, spread, top_above_centroid
from fields import along_outline
from foundation import half_width, pressure_on_springs
from pictures import COLOURS, MARKERS, describe, draw_rate, legend, panels, save, set_ticks
from verification import FULL, Case, Label, Run

CASE = Case(__file__)

SEGMENTS = [50, 70, 100, 140, *([200] if FULL else [])]  # of the arc
APPROACHES = [0.0008, 0.0009, 0.001, 0.0011, 0.0012]  # each has contact edges at other positions between the nodes
REST, RISE = 12.0, 5.0  # s between states of rest; s of motion in each
MIDDLE = 2.0  # x of the block's middle, where the flat has a node
ELEMENTS = 600  # of the solution on springs: 3e-6 of the peak
FIRST, MIDDLING, FINEST = SEGMENTS[0], 100, SEGMENTS[-1]


def automatic(segments: int) -> float:
    """Contact stiffness 8 E/h."""
    return 8 * YOUNG * segments / 2


@dataclass
class Pressed:
    """A state of rest: load, N/m, and pressures along the face, Pa."""

    load: float
    x: np.ndarray
    pressure: np.ndarray
    stiffness: float

    @property
    def peak(self) -> float:
        """Hertz's, 2 P/(pi a)."""
        return 2 * self.load / (np.pi * half_width(self.load))

    @cached_property
    def hertz(self) -> np.ndarray:
        return spread(self.load, half_width(self.load), self.x)

    @cached_property
    def on_springs(self) -> np.ndarray:
        return np.interp(self.x, *pressure_on_springs(self.load, self.stiffness, ELEMENTS))

    def peak_error(self, expected: np.ndarray) -> float:
        """Error of the profile's height in the middle half, by least squares, as single nodes are noisy."""
        middle = np.abs(self.x) < 0.5 * half_width(self.load)
        return float(self.pressure[middle] @ expected[middle] / (expected[middle] @ expected[middle]) - 1)

    def profile_error(self, expected: np.ndarray) -> float:
        """L2 error over the contact, relative to the peak."""
        share = (self.x[1] - self.x[0]) / (2 * half_width(self.load))
        return float(np.sqrt(((self.pressure - expected) ** 2).sum() * share)) / self.peak


def scene(segments: int, stiffness: float, beside: float, approaches: list[float]) -> str:
    """The flat has one node for each of the block's, offset by the share `beside` of their spacing."""
    points, spacing = block(segments), 2 / segments
    return CASE.scene(points=points, nodes=NODES[segments], outline=3 * segments, centre=top_above_centroid(points),
                      left=MIDDLE + beside * spacing, spacing=spacing, stiffness=float(stiffness), method="es-t3",
                      rest=REST, end=REST * len(approaches), press=levels(approaches, REST, RISE))


@cache
def pressed(segments: int, stiffness: float, beside: float = 0.25) -> list[Pressed]:
    """States of rest at all approaches."""
    run = CASE.engine(f"engine_{segments}_{stiffness:g}_{beside:g}", scene(segments, stiffness, beside, APPROACHES))
    return rests(run, segments, stiffness, beside)


def rests(run: Run, segments: int, stiffness: float, beside: float) -> list[Pressed]:
    loads = np.abs(run.probe("flat.force_y"))[1:]
    return [Pressed(float(load), *along_face(run, segments, beside, i + 1), stiffness) for i, load in enumerate(loads)]


def along_face(run: Run, segments: int, beside: float, frame: int) -> tuple[np.ndarray, np.ndarray]:
    places, pressure = along_outline(run, 0, "contact_pressure", frame)
    x = places[:, 0] - MIDDLE - beside * 2 / segments
    face = np.flatnonzero((np.abs(x) < 0.5 + 0.5 / segments) & (places[:, 1] > -0.1))
    face = face[np.argsort(x[face])]
    return x[face], pressure[face]


def over_rests(errors: list[float]) -> float:
    return float(np.sqrt(np.mean(np.square(errors))))


def spacings() -> list[float]:
    return [2 / n for n in SEGMENTS]


def errors_of(what: str, expected: str, segments: int) -> list[float]:
    """Error of "peak" or "profile" against "hertz" or "on_springs", for each state of rest."""
    return [getattr(rest, f"{what}_error")(getattr(rest, expected)) for rest in pressed(segments, automatic(segments))]


def mesh_errors(what: str) -> list[float]:
    return [over_rests(errors_of(what, "on_springs", n)) for n in SEGMENTS]


def test_solution_on_springs() -> None:
    """The numerical solution without springs against Hertz."""
    load = pressed(FINEST, automatic(FINEST))[-1].load
    errors = []
    for elements in (ELEMENTS // 2, ELEMENTS, 2 * ELEMENTS):
        x, pressure = pressure_on_springs(load, 1e12, elements)
        errors.append(abs(pressure.max() * np.pi * half_width(load) / (2 * load) - 1))
    CASE.check_rate("solution without springs: error of the peak over elements", [2.0, 1.0, 0.5], errors, 2, 0.2,
                    "middle of smooth pressures: second order; scatter by the position of first-order edge elements")
    CASE.check(Label.EXACT, f"solution without springs: peak over Hertz's - 1, {ELEMENTS} elements", errors[1], 0,
               errors[0], "Hertz; error of half as many elements")


def scatter_of_slope() -> float:
    """Two standard errors of the slope, from the scatter of profile errors between states of rest."""
    scatter = np.mean([np.std(np.log(errors_of("profile", "on_springs", n)), ddof=1) for n in SEGMENTS])
    logarithms = np.log(spacings())
    return float(2 * scatter / np.sqrt(len(APPROACHES)) / np.sqrt(((logarithms - logarithms.mean()) ** 2).sum()))


def test_profile() -> None:
    CASE.check_rate("profile: L2 error, penalty's share known", spacings(), mesh_errors("profile"), 1,
                    scatter_of_slope(), "self-similar in h at an edge: errors of the root of h/a at a few nodes, on a "
                    "share h/a; two standard errors by the scatter of the states of rest")


def test_peak() -> None:
    found = [over_rests(errors_of("peak", "hertz", n)) for n in SEGMENTS]
    CASE.check_rate("peak: error against Hertz, automatic stiffness", spacings(), found, 1.5, 0.5,
                    "second order of mesh and polygon, first of the penalty 8 E/h: between them")
    errors, rest = errors_of("peak", "on_springs", FINEST), pressed(FINEST, automatic(FINEST))[-1]
    CASE.check(Label.INDEPENDENT, f"peak over Hertz's with the penalty's share - 1, {FINEST} segments, rms",
               over_rests(errors), 0, mesh_errors("peak")[0] * (FIRST / FINEST) ** 2 + finite_size(rest),
               f"half-plane on springs; error of {FIRST} segments scaled by h^2, plus dolfinx's error of finite size")


def finite_size(rest: Pressed) -> float:
    """Effect of the error of ACROSS, 0.001, on the half width and thus on the peak."""
    return RADIUS * 0.001 * rest.load


def test_share_of_the_penalty() -> None:
    """Half the stiffness on one mesh: only the penalty's share changes."""
    stiff, soft = (pressed(MIDDLING, automatic(MIDDLING) / by) for by in (1, 2))
    found, expected = ([peak_change(a, b, with_springs) for a, b in zip(stiff, soft)] for with_springs in (False, True))
    share = 2 / MIDDLING / half_width(stiff[0].load)
    CASE.check(Label.INDEPENDENT, f"peak: change by half the stiffness over that on springs, {MIDDLING} segments",
               np.mean(found) / np.mean(expected), 1, share,
               "half-plane on springs; both of order h/a, next terms a share h/a of them")


def peak_change(stiff: Pressed, soft: Pressed, with_springs: bool) -> float:
    """Change of the height over Hertz's at the same load; with `with_springs`, of the solution on springs at the same
    nodes."""
    heights = []
    for rest in (stiff, soft):
        profile = Pressed(rest.load, rest.x, rest.on_springs, rest.stiffness) if with_springs else rest
        heights.append(profile.peak_error(rest.hertz))
    return heights[0] - heights[1]


def test_share_of_the_polygon() -> None:
    """The flat's nodes lie opposite the block's, which are on the arc, or opposite the middles of facets."""
    corners, middles = (errors_of_peak(beside) for beside in (0.0, 0.5))
    most = (2 / MIDDLING / half_width(pressed(MIDDLING, automatic(MIDDLING))[0].load)) ** 2 / 12
    CASE.check(Label.EXACT, f"peak: facets less corners opposite the flat's nodes, {MIDDLING} segments, largest",
               np.abs(middles - corners).max(), 0, most, "facets lie h^2/(12 R) inside in the mean, relative to "
               "a^2/(2 R) twice that share; half of it in one of two passes")


def errors_of_peak(beside: float) -> np.ndarray:
    return np.array([rest.peak_error(rest.on_springs) for rest in pressed(MIDDLING, automatic(MIDDLING), beside)])


def test_picture() -> None:
    figure, axes = panels(3, "A cylinder on a rigid flat: Hertz", across=True)
    draw_profile(axes[0])
    draw_errors(axes[1])
    draw_shares(axes[2])
    for panel in axes:
        legend(panel)
    save(CASE, figure, "hertz")


def draw_profile(axes: Axes) -> None:
    for segments, colour, marker in zip((FIRST, FINEST), COLOURS, MARKERS):
        rest = pressed(segments, automatic(segments))[-1]
        axes.plot(rest.x / half_width(rest.load), rest.pressure / rest.peak, marker, markersize=4, fillstyle="none",
                  color=colour, label=f"{segments} segments")
    a = half_width(rest.load)
    x = np.linspace(-1.2 * a, 1.2 * a, 500)
    axes.plot(x / a, spread(rest.load, a, x) / rest.peak, "k-", linewidth=1, label="Hertz")
    axes.plot(x / a, np.interp(x, *pressure_on_springs(rest.load, automatic(FIRST), ELEMENTS)) / rest.peak, "--",
              color=COLOURS[0], linewidth=1, label=f"on springs, stiffness of {FIRST}")
    axes.set_xlim(-1.2, 1.2)
    axes.set_ylim(-0.03, 1.45)
    describe(axes, "pressure over the peak", "x / a")


def draw_errors(axes: Axes) -> None:
    for what, colour in (("profile", COLOURS[0]), ("peak", COLOURS[1])):
        for expected, style in (("hertz", "-"), ("on_springs", "--")):
            found = [over_rests(errors_of(what, expected, n)) for n in SEGMENTS]
            name = "Hertz" if expected == "hertz" else "on springs"
            draw_rate(axes, spacings(), found, f"{what}, {name}", colour, "o", style)
    set_ticks(axes, spacings(), [f"{h:.3f}" for h in spacings()])
    describe(axes, "errors, rms over five loads", "spacing of the face")


def draw_shares(axes: Axes) -> None:
    """Peak over Hertz's, over the half width."""
    for segments, colour in zip(SEGMENTS, COLOURS):
        rests_there = pressed(segments, automatic(segments))
        a = [half_width(rest.load) * segments / 2 for rest in rests_there]
        axes.plot(a, [100 * rest.peak_error(rest.hertz) for rest in rests_there], "o-", color=colour, markersize=4,
                  linewidth=1, label=f"{segments} segments")
        axes.plot(a, [100 * peak_on_springs(rest) for rest in rests_there], "k:", linewidth=1.2,
                  label="" if segments != FINEST else "penalty alone, on springs")
    describe(axes, "peak over Hertz's, less 1 [%]", "a / h")


def peak_on_springs(rest: Pressed) -> float:
    return Pressed(rest.load, rest.x, rest.on_springs, rest.stiffness).peak_error(rest.hertz)
