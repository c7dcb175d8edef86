"""A disc pushed along a block: runs of engine and reference, and what they show."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fields import frames_of
from make_pushed_disc_oracles import DEPTH, FRICTION, LAWS, SLIDING, STUCK
from verification import Case, Run

GAP = 0.001  # at the start, as in scene.toml
PRESSES = 2  # rests on the way down
WINDOWS = [(0.4, 0.8), (0.8, 1.2)]  # of the push, over which forces in slip are averaged
# Outlines of the discs with a corner and with a facet at the lowest point, nodes of either; outlines of the blocks,
# whose segments lie differently below it, nodes of either.
SIZES = {10: ((48, 50), 168, (82, 80), 380), 14: ((68, 70), 340, (114, 112), 740),
         20: ((100, 102), 700, (162, 160), 1450), 28: ((140, 142), 1400, (228, 226), 2900)}


@dataclass(frozen=True)
class Push:
    """Of a size of SIZES, with either disc and block."""

    size: int
    facet: bool = False
    shifted: bool = False
    stiffness: float = 3e3  # of contact, mu / R
    pause: float = 40.0  # s from a rest to the next, half of it in motion; while it slides, 0.1 R
    friction: float = FRICTION
    points: int = 16  # of a ramp's history
    slides: bool = True
    law: str = LAWS[0]
    sample: float = 0.0025  # of the push in slip: of outputs

    @property
    def speed(self) -> float:
        """Of the disc that slides."""
        return 0.1 / self.pause

    @property
    def rests(self) -> np.ndarray:
        """[pushes of STUCK] their times, s."""
        return self.pause * np.arange(PRESSES, PRESSES + len(STUCK))

    @property
    def end(self) -> float:
        return float(self.rests[-1] + (SLIDING[-1] - STUCK[-1]) / self.speed * self.slides)

    @property
    def spacing(self) -> float:
        """Of the block's outline, R."""
        return 16 / float(np.mean(SIZES[self.size][2]))

    def name(self) -> str:
        way = ("facet" if self.facet else "corner") + ("_shifted" if self.shifted else "")
        way += "" if self.slides else "_stuck"
        return f"{self.law}_{self.size}_{way}_{self.stiffness:g}_{self.pause:g}_{self.friction:g}"

    def ways(self, count: int = 4) -> list[Push]:
        """With other discs and blocks; the first two differ in both."""
        chosen = [(False, False), (True, True), (True, False), (False, True)][:count]
        return [replace(self, facet=facet, shifted=shifted) for facet, shifted in chosen]

    def scene(self, case: Case) -> str:
        discs, disc_nodes, blocks, block_nodes = SIZES[self.size]
        low = DEPTH + GAP
        down = [-low * (i + 1) / PRESSES for i in range(PRESSES)]
        along = smooth_rises([0.0] * PRESSES + STUCK[1:], self.pause, self.points)
        along += [[self.end, float(SLIDING[-1])]] * self.slides
        return case.scene(end=self.end, output=self.pause * self.sample / 0.1, frame=self.pause, friction=self.friction,
                          law=self.law, disc_nodes=disc_nodes, disc_outline=discs[self.facet], block_nodes=block_nodes,
                          block_outline=blocks[self.shifted], stiffness=self.stiffness, along=along,
                          down=smooth_rises(down, self.pause, self.points))


def smooth_rises(heights: list[float], pause: float, points: int) -> list[list[float]]:
    """[[time, height], ...] from 0 to each height in turn, in the first half of each pause."""
    share = np.linspace(0, 1, points + 1)
    table, before = [[0.0, 0.0]], 0.0
    for i, height in enumerate(heights):
        table += [[float(pause * (i + s / 2)), float(before + (height - before) * s**2 * (3 - 2 * s))]
                  for s in share[1:]] if height != before else []
        table.append([float(pause * (i + 1)), height])
        before = height
    return table


@dataclass
class Forces:
    """On the block: along and across at the pushes of STUCK, then their means over WINDOWS if it slides."""

    along: np.ndarray  # [stuck + windows]
    across: np.ndarray


def forces(push: np.ndarray, along: np.ndarray, across: np.ndarray) -> Forces:
    """From samples by push, those of STUCK and of SLIDING among them."""
    stuck = np.abs(push[:, None] - STUCK).argmin(axis=0)
    means = [hann(push, *window) for window in WINDOWS if push[-1] >= window[1] - 1e-9]
    return Forces(*(np.concatenate([values[stuck], [weights @ values for weights in means]])
                    for values in (along, across)))


def hann(push: np.ndarray, low: float, high: float) -> np.ndarray:
    """[samples] weights of a mean from which what repeats twice or more between low and high is gone."""
    share = np.clip((push - low) / (high - low), 0, 1)
    weights = 1 - np.cos(2 * np.pi * share)
    return weights / weights.sum()


class Result:
    """Of a run."""

    def __init__(self, push: Push, run: Run) -> None:
        self.run = run
        times = run.times("disc.force_x")
        sliding = times > push.rests[-1] * (1 + 1e-9)
        self.push = np.concatenate([STUCK, STUCK[-1] + (times[sliding] - push.rests[-1]) * push.speed])
        at = np.concatenate([push.rests, times[sliding]])
        self.along, self.across = -run.at("disc.force_x", at), run.at("disc.force_y", at)
        self.forces = forces(self.push, self.along, self.across)

    def surface(self, time: float) -> np.ndarray:
        """[nodes x 2] of the block's top, without its corners."""
        frames = frames_of(self.run)
        there = frames.grids["outlines"].point_body == 1
        first = frames.positions("outlines", 0)[there, :2]
        top = (first[:, 1] > -1e-6) & (np.abs(first[:, 0]) < 2.99)
        return frames.positions("outlines", frames.nearest(time))[there, :2][top]


def by_engine(case: Case, push: Push) -> Result:
    return Result(push, case.engine(push.name(), push.scene(case)))


def by_reference(case: Case, push: Push) -> Result:
    """Statics: load steps end at the points of the histories and at outputs, fewer in slip than the engine's."""
    push = replace(push, sample=0.00625)
    name = f"{push.name()}_{push.points}_reference"
    run = case.reference(name, push.scene(case), "--static", "--dt", repr(push.pause))
    return Result(push, run)
