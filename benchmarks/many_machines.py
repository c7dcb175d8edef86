#!/usr/bin/python3
"""Predicts the time of a step on many machines from counts of benchmarks/partition.py and times of one machine.

    ./pliant bench partition results/third_body --json partition.json
    ./pliant bench machines partition.json

A part has n grains, its neighbours m, and a border of length l. With the figures a border length and the time t of a
grain and step on one core that the counts and docs/speed.md give,

    step = imbalance n t / (cores efficiency) + l pairs t_pair / 2 / (cores efficiency)
           + m latency + l ghosts bytes / bandwidth + reductions latency log2(nodes)

A part of a square domain has a square of n times the area of a grain: l is its perimeter, m is 8. A part of a strip
has all of its height: l is twice the height, m is 2. Exchange and computation do not overlap. The last column is the
time if the exchange is hidden behind contacts of owned grains alone.

Exit codes: 0 predicted, 2 bad input.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
from dataclasses import dataclass
from pathlib import Path

BAD_INPUT = 2
CONTACT = 0.5  # share of a step (docs/speed.md, Shares of a step)
CORES = (16, 64)


@dataclass(frozen=True)
class Node:
    """Measured and predicted figures of docs/speed.md for packings of so many grains."""
    grains: int
    two_threads: float  # s, of a grain and step (Step of many grains)
    efficiency: dict[int, float]  # by cores (More threads)

    @property
    def one_thread(self) -> float:
        """Two threads take 0.53 of the time of one (Step of many grains)."""
        return self.two_threads / 0.53


NODES = (Node(2000, 1.195e-6, {16: 0.72, 64: 0.37}), Node(20000, 1.45e-6, {16: 0.85, 64: 0.59}))


@dataclass(frozen=True)
class Network:
    latency: float = 2e-6  # s
    bandwidth: float = 10e9  # bytes/s
    reductions: int = 2  # of all parts, one after the other, in a step


@dataclass(frozen=True)
class Surface:
    """Figures a border length, 1/m, and others of a packing."""
    ghosts: float  # of one side
    bytes: float  # of a ghost
    pairs: float  # across the border
    pairs_a_grain: float
    area: float  # of a grain, m2
    height: float  # m
    imbalance: float


def surface_of(counts: dict, height: float) -> Surface:
    """Of the counts of one frame and number of parts. `height`: of the strip, m."""
    ghosts, grains, border = sum(counts["ghosts"]), sum(counts["bodies"]), counts["border"]
    if not (ghosts > 0 and border > 0):
        raise ValueError(f"{counts['parts']} parts have no ghosts")
    return Surface(ghosts / border, sum(counts["bytes"]) / ghosts, counts["pairs_twice"] / (border / 2),
                   counts["pairs"] / grains, counts["area"] / grains, height, counts["imbalance"])


@dataclass(frozen=True)
class Step:
    """Seconds."""
    compute: float
    twice: float  # pairs of which another part computes the other half
    exchange: float
    reductions: float
    hidden: float  # exchange that contacts of owned grains alone can cover
    ghosts: float
    bytes: float
    messages: int

    @property
    def total(self) -> float:
        return self.compute + self.twice + self.exchange + self.reductions


def node_for(grains: float) -> Node:
    """The packing whose size is nearest, by the ratio."""
    return min(NODES, key=lambda node: abs(math.log(grains / node.grains)))


def predict(grains: float, nodes: int, cores: int, shape: str, surface: Surface, network: Network) -> Step:
    """`shape`: "square" or "strip"."""
    own = grains / nodes
    node = node_for(own)
    grain = node.one_thread / (cores * node.efficiency[cores])
    length = 4 * math.sqrt(own * surface.area) if shape == "square" else 2 * surface.height
    messages = 8 if shape == "square" else 2
    ghosts = surface.ghosts * length
    pair = CONTACT * grain / surface.pairs_a_grain
    across = surface.pairs * length
    compute = surface.imbalance * own * grain
    exchange = messages * network.latency + ghosts * surface.bytes / network.bandwidth
    inner = max(0.0, own * surface.pairs_a_grain - 0.5 * across) * pair
    return Step(compute, 0.5 * across * pair, exchange, network.reductions * network.latency * math.log2(nodes),
                min(exchange, inner), ghosts, ghosts * surface.bytes, messages)


HEADER = (f"{'grains':>8} {'shape':>7} {'cores':>5} {'compute':>8} {'twice':>6} {'ghosts':>6} {'kB':>6} {'messages':>8} "
          f"{'exchange':>8} {'reductions':>10} {'step, us':>8} {'compute/step':>12} {'hidden, us':>10}")


def row(grains: float, shape: str, cores: int, step: Step) -> str:
    return (f"{grains:>8.0e} {shape:>7} {cores:>5} {step.compute * 1e6:>8.0f} {step.twice * 1e6:>6.1f} {step.ghosts:>6.0f} "
            f"{step.bytes * 1e-3:>6.0f} {step.messages:>8} {step.exchange * 1e6:>8.1f} {step.reductions * 1e6:>10.0f} "
            f"{step.total * 1e6:>8.0f} {step.compute / step.total:>12.0%} {(step.total - step.hidden) * 1e6:>10.0f}")


def parse_arguments(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="./pliant bench machines", description=__doc__.splitlines()[0])
    parser.add_argument("counts", type=Path, help="file of bench partition --json; its last entry with --parts counts")
    parser.add_argument("--parts", type=int, default=4, help="of the entry")
    parser.add_argument("--height", type=float, default=20.5e-6, metavar="M", help="of the strip; default: the paper's")
    parser.add_argument("--grains", type=float, nargs="+", default=[1e5, 1e6])
    parser.add_argument("--nodes", type=int, default=64)
    parser.add_argument("--latency", type=float, default=2, metavar="US")
    parser.add_argument("--bandwidth", type=float, default=10, metavar="GB/s")
    parser.add_argument("--reductions", type=int, default=2, help="in a step")
    options = parser.parse_args(arguments)
    if min(options.height, options.bandwidth, options.nodes, *options.grains) <= 0 or min(options.latency, options.reductions) < 0:
        parser.error("height, grains, nodes and bandwidth are positive; latency and reductions at least 0")
    return options


def main(arguments: list[str] | None = None) -> int:
    options = parse_arguments(arguments)
    network = Network(options.latency * 1e-6, options.bandwidth * 1e9, options.reductions)
    try:
        entries = [entry for entry in json.loads(options.counts.read_text()) if entry["parts"] == options.parts]
        if not entries:
            raise ValueError(f"{options.counts}: no entry of {options.parts} parts; give --parts")
        surface = surface_of(entries[-1], options.height)
    except (OSError, ValueError, KeyError, TypeError) as error:
        print(f"error: {error if not isinstance(error, KeyError) else f'{options.counts}: no {error}'}", file=sys.stderr)
        return BAD_INPUT
    print(f"a um of border: {surface.ghosts * 1e-6:.2f} ghosts of {surface.bytes:.0f} bytes, {surface.pairs * 1e-6:.2f} pairs across; "
          f"a grain: {surface.pairs_a_grain:.2f} pairs, {surface.area * 1e12:.3f} um2; imbalance {surface.imbalance:.3f}", HEADER, sep="\n")
    for grains in options.grains:
        for shape in ("square", "strip"):
            for cores in CORES:
                print(row(grains, shape, cores, predict(grains, options.nodes, cores, shape, surface, network)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
