"""Pictures of two bodies in contact: forces, their errors by mesh size, outlines."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

import two_bodies_discs as discs
import two_bodies_polygon as polygon
import two_bodies_push as push
from pictures import COLOURS, MARKERS, describe, draw_rate, legend, panels, save, set_ticks
from two_bodies_discs import Discs
from two_bodies_push import Push, Sliding
from two_bodies_study import RestStudy, Study, read
from verification import Case


def draw_forces(axes: Axes, studies: Sequence[Study], at: list[float], x: str) -> None:
    for known, colour in zip(studies, COLOURS):
        axes.plot(at, known.getfem.force, "s-", color=colour, fillstyle="none", label=f"GetFEM, {known.name}")
        axes.plot(at, known.limit(), "x", color=colour, label="engine, h = 0")
    describe(axes, x=x, y="force over mu R")
    legend(axes)


def draw_errors(axes: Axes, studies: Sequence[Study], of: str, what: str) -> None:
    """Rms over places by mesh size, with its order."""
    for known, colour, marker in zip(studies, COLOURS, MARKERS):
        draw_rate(axes, known.spacings, known.rms(), f"{known.name}, rms", colour, marker)
    set_ticks(axes, studies[0].spacings, [f"{h:.3f}" for h in studies[0].spacings])
    describe(axes, x=f"spacing of {of} over R", y=what)
    legend(axes)


def draw_outlines(axes: Axes, known: RestStudy, drawn: dict[str, list[tuple[str, int]]]) -> None:
    """Half outlines by GetFEM and the engine's nodes, of bodies at levels, by label."""
    stored, gap = known.outlines(), [[np.nan, np.nan]]
    for (label, bodies), colour in zip(drawn.items(), COLOURS):
        halves = [stored[body][level] for body, level in bodies]
        line = np.concatenate([part for half in halves for part in (half, half[::-1] * [-1, 1], gap)])
        nodes = np.concatenate([known.nodes(list(stored).index(body), level)[::3] for body, level in bodies])
        draw_line(axes, line, nodes, colour, label)


def draw_line(axes: Axes, line: np.ndarray, nodes: np.ndarray, colour: str, label: str) -> None:
    axes.plot(line[:, 0], line[:, 1], "-", color=colour, linewidth=1.0, label=f"GetFEM, {label}")
    axes.plot(nodes[:, 0], nodes[:, 1], ".", color=colour, markersize=3, label=f"engine, {label}")
    axes.set_aspect("equal")
    legend(axes)


def draw_discs(case: Case, known: RestStudy) -> None:
    figure, axes = panels(4, "Two discs between plates, the upper one twice as stiff", across=True)
    percent = [f"{100 * approach:g} %" for approach in discs.APPROACHES]
    draw_forces(axes[0], [known], [100 * approach for approach in discs.APPROACHES],
                "approach over the diameters [%]")
    for errors, what, colour, marker in zip(known.errors().T, percent, COLOURS[1:], MARKERS):
        axes[1].loglog(known.spacings, np.abs(errors), marker=marker, markersize=4, linewidth=1.0, color=colour,
                       label=what)
    draw_errors(axes[1], [known], "the outlines", "|force over GetFEM - 1|")
    draw_other_meshes(axes[2], percent)
    draw_outlines(axes[3], known, {percent[i]: [(name, i) for name in known.outlines()] for i in (0, -1)})
    axes[3].set_ylim(-2.1, 3.4)
    save(case, figure, "discs")


def draw_other_meshes(axes: Axes, percent: list[str]) -> None:
    """Errors of the third-party solvers, by rings of triangles in the soft disc."""
    getfem, calculix = read("discs_getfem_neo-hookean").of(), discs.calculix_by_rings()
    rings, finest = discs.RINGS["neo-hookean"][:-1], Discs.read_getfem("melody").force
    for i, (what, colour) in enumerate(zip(percent, COLOURS)):
        axes.loglog(rings, np.abs(getfem[:-1, i] / getfem[-1, i] - 1), "o-", color=colour, markersize=4, linewidth=1.0,
                    label=f"GetFEM, {what}")
        if i < calculix.shape[1]:
            axes.loglog(discs.CALCULIX_RINGS, np.abs(calculix[:, i] / finest[i] - 1), "s:", color=colour, markersize=4,
                        linewidth=1.0, label=f"CalculiX, {what}")
    ticks = sorted({*discs.CALCULIX_RINGS, *rings})
    set_ticks(axes, ticks, [f"{tick:g}" for tick in ticks])
    axes.set_ylim(1e-6, 1e-1)
    describe(axes, x="rings of triangles", y="|force over GetFEM's of 64 rings (CalculiX: 16) - 1|")
    axes.legend(fontsize=8, frameon=False, ncols=2, loc="upper center")


def draw_polygon(case: Case, *studies: RestStudy) -> None:
    figure, axes = panels(4, "A hexagon, twice as stiff, pressed into a disc", across=True)
    draw_forces(axes[0], studies, polygon.DEPTHS, "depth over R")
    draw_errors(axes[1], studies, "the disc's outline", "|force over GetFEM - 1|, rms of depths")
    for panel, known in zip(axes[2:], studies):
        draw_outlines(panel, known, {name: [(name, -1)] for name in known.outlines()})
    save(case, figure, "polygon")


def draw_push(case: Case, *studies: Sliding) -> None:
    figure, axes = panels(4, f"A stiff disc pushed along a soft block, friction {push.FRICTION:g}", across=True)
    coarsest, finest = (Push(size=push.CHOSEN["neo-hookean"][i]) for i in (0, -1))
    stored = push.getfem_samples("neo-hookean", push.RINGS["neo-hookean"][-1])
    for panel, known in zip(axes, studies):
        column = push.COLUMN[known.kind]
        panel.plot(stored[:, 0], stored[:, column], "ks", markersize=3, label="GetFEM")
        for setup, colour in zip((coarsest, finest), COLOURS):
            samples = push.by_engine(case, setup).samples
            panel.plot(samples[:, 0], samples[:, column], "-", color=colour, linewidth=1.0,
                       label=f"engine, h = {setup.spacing:.3f} R")
        describe(panel, x="push over R", y=f"{known.name}: force over mu R")
        legend(panel)
    for known, colour in zip(studies, COLOURS):
        off = np.abs(known.limit() / known.getfem.force - 1)[push.SLIPS]
        axes[2].axhline(np.sqrt((off**2).mean()), linestyle=":", color=colour, linewidth=1.0, label="at h = 0")
    draw_errors(axes[2], studies, "the block's outline", "|force in slip over GetFEM - 1|")
    for at, line, colour in zip(push.DRAWN, read("push_surfaces").outlines(), COLOURS):
        nodes = push.by_engine(case, finest).surface(finest.time_of(at))
        draw_line(axes[3], line, nodes, colour, f"push {at:g}")
    axes[3].set_ylim(-1.2, 1.4)
    axes[3].set_xlabel("x over R")
    save(case, figure, "push")
