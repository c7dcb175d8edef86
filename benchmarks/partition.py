#!/usr/bin/python3
"""Counts what a run on many machines would send: bodies, ghosts, messages and bytes of a scene that is cut into parts.

    ./pliant bench partition results/third_body
    ./pliant bench partition results/third_body --parts 4 64 --frames 0 -1 --json partition.json
    ./pliant bench partition results/third_body --keep-cut      # later frames in the parts of the first one
    ./pliant bench partition --lattice 5000 20 --skin 32e-9 --reach 7.9e-9 --cost 2.3 0.3 0.8

The grains of a frame are cut by recursive coordinate bisection on their cost (Berger and Bokhari, IEEE Trans. Comput.
C-36 (1987) 570, doi 10.1109/TC.1987.1676942). A ghost of a part is a body of another part that the contact list of an
owned body holds: the outlines are closer than reach + 5 skins (VerletList::margin, lib/contact/verlet_list.cpp). No
other body can touch before the broad phase runs again, so the set of ghosts is fixed until then. A pair has contact
candidates if its outlines are closer than reach + skin (find_arcs, lib/contact/narrow_phase.hpp). A pair across a
border is computed in both parts, and no force is sent. Walls are copied to all parts that touch them: their pairs are
computed once, and their resultants are sums over parts.

--lattice takes the start of the paper's scene with other columns and rows: discs of 1 um and 48 nodes, without walls.

The cost comes from phase_seconds of the run's summary.json: internal forces and the bound count for compliant grains,
contact and candidates for pairs, outlines, update and output for all grains. --cost states it instead.

Exit codes: 0 counted, 2 bad input.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
import tomllib
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "python"))

from pliant import units
from pliant.frames import COMPLIANT, RIGID, WALL, BadFolder, Frames
from pliant.results import read_json, read_run

BAD_INPUT = 2
NUMBER = 8  # bytes
EXTRA_SKINS = 4  # extra_skins in lib/contact/verlet_list.cpp
DEFAULT_SKIN, DEFAULT_RANGE = 0.5, 0.12  # of the outline spacing: [contact] skin; range of cohesive contacts
MOTION, MOTION_WITH_VELOCITY = 6, 9  # position and force (RigidStep, lib/contact/energy_correction.hpp); and velocity


@dataclass
class Packing:
    outlines: list[np.ndarray]  # [bodies][nodes x 2] m; not wrapped into the period
    kinds: np.ndarray  # [bodies] COMPLIANT, RIGID or WALL
    period: float | None = None  # along x, m

    @property
    def grains(self) -> np.ndarray:
        """Numbers of the bodies that are not walls."""
        return np.flatnonzero(self.kinds != WALL)

    def centres(self) -> np.ndarray:
        """[bodies x 2] m, means of the nodes, with x in the period."""
        centres = np.array([outline.mean(axis=0) for outline in self.outlines])
        if self.period is not None:
            centres[:, 0] %= self.period
        return centres

    def spacings(self) -> np.ndarray:
        """[bodies] mean segment length, m."""
        return np.array([np.linalg.norm(np.diff(outline, axis=0), axis=1).mean() for outline in self.outlines])

    def bytes_of(self, body: int, velocity: bool = False, nodes: int | None = None) -> int:
        """Sent for a ghost: outline nodes of a compliant grain, all of them or some; motion of a rigid one."""
        if self.kinds[body] != COMPLIANT:
            return NUMBER * (MOTION_WITH_VELOCITY if velocity else MOTION)
        return NUMBER * (4 if velocity else 2) * (len(self.outlines[body]) if nodes is None else nodes)


@dataclass
class Pair:
    """Two bodies whose outlines are closer than the margin of the contact list."""
    first: int  # a grain
    second: int  # a later grain, or a wall
    gap: float  # m
    near: tuple[np.ndarray, np.ndarray]  # of each body, numbers of the nodes within reach + skin of the other outline


@dataclass
class Cut:
    owner: np.ndarray  # [bodies] part; -1: wall
    border: float  # length of all borders, each counted for both of its sides, m
    area: float  # of the box that was cut, m2


def bisect(packing: Packing, cost: np.ndarray, parts: int) -> Cut:
    """Cuts a box across its longer side, so that both halves have the cost of their numbers of parts, and each half
    likewise. `cost`: [bodies]. Equal coordinates are ordered by body number. A period that has not been cut yet has
    one border at the plane and one at its edge. Throws ValueError if there are more parts than grains."""
    grains = packing.grains
    if not 1 <= parts <= len(grains):
        raise ValueError(f"{parts} parts of {len(grains)} grains: give 1 to {len(grains)}")
    centres, owner, border = packing.centres(), np.full(len(packing.kinds), -1), 0.0
    points = np.concatenate([packing.outlines[g] for g in grains])
    box = np.array([points.min(axis=0), points.max(axis=0)])
    if packing.period is not None:
        box[:, 0] = 0, packing.period
    area = float(np.prod(box[1] - box[0]))
    stack = [(grains, box, packing.period is not None, 0, parts)]
    while stack:
        bodies, box, is_ring, first, count = stack.pop()
        if count == 1:
            owner[bodies] = first
            continue
        extent = box[1] - box[0]
        along = 0 if extent[0] >= extent[1] else 1
        place = centres[bodies, along]
        order = np.lexsort((bodies, place))
        lower = count // 2
        sums = np.cumsum(cost[bodies[order]])
        choices = np.arange(lower, len(bodies) - (count - lower) + 1)
        at = choices[np.argmin(np.abs(sums[choices - 1] - sums[-1] * lower / count))]
        plane = place[order[at - 1: at + 1]].mean()
        border += (2 if is_ring and along == 0 else 1) * 2 * extent[1 - along]
        below, above = box.copy(), box.copy()
        below[1, along] = above[0, along] = plane
        rest = is_ring and along == 1
        stack += [(bodies[order[:at]], below, rest, first, lower),
                  (bodies[order[at:]], above, rest, first + lower, count - lower)]
    return Cut(owner, border, area)


def distances(nodes: np.ndarray, begin: np.ndarray, end: np.ndarray) -> np.ndarray:
    """[nodes] least distance to the segments from `begin` to `end` [segments x 2], m; infinite without segments."""
    if len(begin) == 0 or len(nodes) == 0:
        return np.full(len(nodes), math.inf)
    along = end - begin
    from_begin = nodes[:, None] - begin
    square = np.maximum((along**2).sum(axis=1), np.finfo(float).tiny)
    share = np.clip((from_begin * along).sum(axis=2) / square, 0, 1)
    return np.linalg.norm(from_begin - share[..., None] * along, axis=2).min(axis=1)


class Outline:
    """One outline, closed or, of a wall, open and continued by its images."""

    def __init__(self, nodes: np.ndarray, closing: np.ndarray) -> None:
        """`closing`: end of the last segment."""
        self.nodes, self.ends = nodes, np.vstack([nodes[1:], closing])
        self.least, self.largest = np.minimum(nodes, self.ends).min(axis=0), np.maximum(nodes, self.ends).max(axis=0)

    def near(self, other: Outline, limit: float) -> tuple[np.ndarray, np.ndarray]:
        """Numbers of the nodes, and of the segments, in the box around another outline."""
        least, largest = other.least - limit, other.largest + limit
        nodes = ((self.nodes >= least) & (self.nodes <= largest)).all(axis=1)
        low, high = np.minimum(self.nodes, self.ends), np.maximum(self.nodes, self.ends)
        return np.flatnonzero(nodes), np.flatnonzero(((high >= least) & (low <= largest)).all(axis=1))

    def moved(self, x: float) -> Outline:
        return Outline(self.nodes + [x, 0], self.ends[-1] + [x, 0])


def meeting(a: Outline, b: Outline, margin: float, near: float) -> tuple[float, np.ndarray, np.ndarray]:
    """Least distance of two outlines, and the nodes of either within `near` of the other one. Outlines that cross have
    a distance of some part of a segment instead of none. Beyond the margin the distance is not exact."""
    (a_nodes, a_segments), (b_nodes, b_segments) = a.near(b, margin), b.near(a, margin)
    of_a = distances(a.nodes[a_nodes], b.nodes[b_segments], b.ends[b_segments])
    of_b = distances(b.nodes[b_nodes], a.nodes[a_segments], a.ends[a_segments])
    gap = min(of_a.min(initial=math.inf), of_b.min(initial=math.inf))
    return gap, a_nodes[of_a <= near], b_nodes[of_b <= near]


def pairs_of(packing: Packing, reach: float, skin: float) -> list[Pair]:
    """Pairs of the contact list, each once, however many images meet. Walls do not meet each other."""
    margin, near = reach + (1 + EXTRA_SKINS) * skin, reach + skin
    period, grains, centres = packing.period, packing.grains, packing.centres()
    outlines = {}
    for g in grains:
        nodes = packing.outlines[g] + (centres[g] - packing.outlines[g].mean(axis=0))
        outlines[g] = Outline(nodes, nodes[0])
    radius = np.array([np.linalg.norm(outlines[g].nodes - centres[g], axis=1).max() for g in grains])
    shifts = [0.0] if period is None else [-period, 0.0, period]
    places = np.concatenate([centres[grains] + [shift, 0] for shift in shifts])
    found: dict[tuple[int, int], Pair] = {}

    def add(a: int, b: int, image: Outline) -> None:
        gap, of_a, of_b = meeting(outlines[a], image, margin, near)
        if gap > margin:
            return
        if (a, b) in found:
            before = found[a, b]
            gap = min(gap, before.gap)
            of_a, of_b = np.union1d(of_a, before.near[0]), np.union1d(of_b, before.near[1])
        found[a, b] = Pair(a, b, gap, (of_a, of_b))

    tree = cKDTree(places)
    for i, candidates in enumerate(tree.query_ball_point(centres[grains], radius + radius.max(initial=0) + margin)):
        for candidate in sorted(candidates):
            image, j = divmod(candidate, len(grains))
            between = np.linalg.norm(places[candidate] - centres[grains[i]])
            if j > i and between <= radius[i] + radius[j] + margin:
                add(grains[i], grains[j], outlines[grains[j]].moved(shifts[image]))
    for wall in np.flatnonzero(packing.kinds == WALL):
        add_wall(packing, wall, outlines, margin, add)
    return [found[key] for key in sorted(found)]


def add_wall(packing: Packing, wall: int, outlines: dict, margin: float, add) -> None:
    """Pairs of a wall with the grains at its height."""
    nodes, period = packing.outlines[wall], packing.period
    step = 0.0 if period is None else math.copysign(period, nodes[-1, 0] - nodes[0, 0])
    line = Outline(nodes, nodes[0] + [step, 0] if step else nodes[-1])
    for g, outline in outlines.items():
        if outline.least[1] > line.largest[1] + margin or outline.largest[1] < line.least[1] - margin:
            continue
        if period is None:
            add(g, wall, line)
            continue
        first = math.ceil((outline.least[0] - margin - line.largest[0]) / period)
        last = math.floor((outline.largest[0] + margin - line.least[0]) / period)
        for image in range(first, last + 1):
            add(g, wall, line.moved(image * period))


@dataclass(frozen=True)
class Cost:
    """Seconds a step."""
    compliant: float  # of a grain, without its contacts
    rigid: float
    pair: float  # with contact candidates

    def of_bodies(self, packing: Packing, pairs: list[Pair], near: float) -> np.ndarray:
        """[bodies] with half of each pair, all of it if the other body is a wall; 0 for walls."""
        cost = np.choose(packing.kinds, [self.compliant, self.rigid, 0.0])
        for pair in pairs:
            if pair.gap <= near:
                is_wall = packing.kinds[pair.second] == WALL
                cost[pair.first] += self.pair if is_wall else 0.5 * self.pair
                cost[pair.second] += 0.0 if is_wall else 0.5 * self.pair
        return cost


def cost_from(summary: dict, packing: Packing, near_pairs: float) -> Cost:
    """Of the phases of a run. `near_pairs`: mean number of pairs with contact candidates."""
    try:
        steps = summary["steps"]
        step = {phase: seconds / steps for phase, seconds in summary["phase_seconds"].items()}
        grains, compliant = len(packing.grains), int((packing.kinds == COMPLIANT).sum())
        rigid = (step["outlines"] + step["update"] + step["output"]) / grains
        return Cost(rigid + (step["internal"] + step["bound"]) / max(1, compliant), rigid,
                    (step["contact"] + step["candidates"]) / max(1.0, near_pairs))
    except (KeyError, TypeError, ZeroDivisionError) as error:
        raise BadFolder(f"summary.json has no phase_seconds of any step; wait for the end of the run or give "
                        f"--cost ({error})") from error


@dataclass
class Counts:
    """Of one frame and one number of parts; lists are by part. Bytes are sent in a step."""
    time: float
    parts: int
    bodies: list[int]
    imbalance: float  # largest cost over the mean, without what is computed twice
    slowest: float  # largest work over a part's share of the work of one machine; counts what is computed twice
    ghosts: list[int]
    messages: list[int]
    bytes: list[int]
    bytes_with_velocity: list[int]
    bytes_of_arcs: list[int]  # if only nodes with contact candidates and their neighbours were sent
    pairs: int  # with contact candidates, those of walls included
    pairs_twice: int
    pairs_in_list: int
    wall_parts: list[int]  # of each wall, parts that touch it
    border: float  # m
    area: float  # of the box around all grains, m2
    moved: int = 0  # grains that had another part in the frame before


def count(packing: Packing, cut: Cut, pairs: list[Pair], cost: Cost, near: float, time: float = 0.0) -> Counts:
    owner, parts = cut.owner, int(cut.owner.max()) + 1
    sent: dict[tuple[int, int], set[int]] = {}  # (body, receiving part): numbers of its nodes with candidates
    walls = np.flatnonzero(packing.kinds == WALL)
    touched = {wall: set() for wall in walls}
    work = np.bincount(owner[packing.grains], np.choose(packing.kinds, [cost.compliant, cost.rigid, 0.0])[packing.grains],
                       parts)
    shares = np.bincount(owner[packing.grains], cost.of_bodies(packing, pairs, near)[packing.grains], parts)
    near_pairs = twice = 0
    for pair in pairs:
        a, b = owner[pair.first], owner[pair.second]
        if b < 0:
            touched[pair.second].add(a)
        elif a != b:
            for body, part, nodes in ((pair.first, b, pair.near[0]), (pair.second, a, pair.near[1])):
                size = len(packing.outlines[body])
                sent.setdefault((body, part), set()).update((n + k) % size for n in nodes for k in (-1, 0, 1))
        if pair.gap <= near:
            near_pairs += 1
            twice += b >= 0 and a != b
            work[a] += cost.pair
            if b >= 0 and a != b:
                work[b] += cost.pair
    ghosts, messages = np.zeros(parts, int), [set() for _ in range(parts)]
    bytes_, with_velocity, of_arcs = (np.zeros(parts, int) for _ in range(3))
    for (body, part), nodes in sent.items():
        ghosts[part] += 1
        messages[owner[body]].add(part)
        bytes_[owner[body]] += packing.bytes_of(body)
        with_velocity[owner[body]] += packing.bytes_of(body, velocity=True)
        of_arcs[owner[body]] += packing.bytes_of(body, nodes=len(nodes))
    return Counts(time, parts, np.bincount(owner[packing.grains], minlength=parts).tolist(),
                  float(shares.max() / shares.mean()), float(work.max() / shares.mean()), ghosts.tolist(),
                  [len(m) for m in messages], bytes_.tolist(), with_velocity.tolist(), of_arcs.tolist(), near_pairs,
                  int(twice), len(pairs), [len(touched[wall]) for wall in walls], cut.border, cut.area)


def lattice(columns: int, rows: int) -> Packing:
    """Hexagonal lattice of cases/third_body.toml, one period wide; compliant and rigid discs alternate up a column."""
    diameter, pitch, row_pitch, nodes = 1e-6, 0.87e-6, 1.002e-6, 48
    angle = 2 * np.pi * np.arange(nodes) / nodes
    ring = 0.5 * diameter * np.column_stack([np.cos(angle), np.sin(angle)])
    column, row = (index.ravel() for index in np.meshgrid(np.arange(columns), np.arange(rows)))
    centres = np.column_stack([(column + 0.5) * pitch, (row + 0.5 * (column % 2)) * row_pitch])
    return Packing([ring + centre for centre in centres], np.where(row % 2 == 0, COMPLIANT, RIGID), columns * pitch)


def packing_of(frames: Frames, index: int) -> Packing:
    return Packing(frames.polygons(index, np.arange(len(frames.kinds))), frames.kinds, frames.period)


def reach_of(scene: dict, spacings: np.ndarray) -> float:
    """Largest reach of the scene's contact laws, m. Throws ValueError for laws whose reach follows from a stiffness."""
    reach = 0.0
    for rule in scene.get("contacts", []):
        if rule.get("law") == "cohesive":
            given = rule.get("range", "auto")
            reach = max(reach, DEFAULT_RANGE * float(spacings.max()) if given == "auto" else units.length(given))
        elif "tension" in rule:
            raise ValueError("a contact has a tension, whose reach is tension over stiffness; give --reach")
    return reach


def skin_of(scene: dict, spacings: np.ndarray) -> float:
    """[contact] skin times the finest spacing, m."""
    skin = scene.get("contact", {}).get("skin", DEFAULT_SKIN)
    if not isinstance(skin, (int, float)):
        raise ValueError(f"[contact] skin is {skin!r}, not a number; give --skin")
    return skin * float(spacings.min())


HEADER = (f"{'us':>6} {'parts':>5} {'bodies':>11} {'imbalance':>9} {'slowest':>7} {'ghosts':>11} {'messages':>10} "
          f"{'kB sent':>11} {'with velocity':>13} {'arcs alone':>11} {'twice':>6} {'walls in':>8} {'moved':>6} {'ghosts a um':>11}")


def row(c: Counts) -> str:
    def both(values: list[int], scale: float = 1, form: str = ".1f") -> str:
        return f"{np.mean(values) * scale:{form}}, {max(values) * scale:{form}}"

    per_border = sum(c.ghosts) / (c.border * 1e6) if c.border > 0 else 0.0
    return (f"{c.time * 1e6:>6.2f} {c.parts:>5} {both(c.bodies, 1, '.0f'):>11} {c.imbalance:>9.3f} {c.slowest:>7.3f} "
            f"{both(c.ghosts):>11} {both(c.messages):>10} {both(c.bytes, 1e-3):>11} "
            f"{both(c.bytes_with_velocity, 1e-3):>13} {both(c.bytes_of_arcs, 1e-3):>11} "
            f"{c.pairs_twice / max(1, c.pairs):>6.1%} {', '.join(map(str, c.wall_parts)) or '-':>8} "
            f"{c.moved / sum(c.bodies):>6.1%} {per_border:>11.2f}")


def parse_arguments(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="./pliant bench partition", description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, nargs="?", help="of a run with frames")
    parser.add_argument("--lattice", type=int, nargs=2, metavar=("COLUMNS", "ROWS"), help="instead of a run; columns are even")
    parser.add_argument("--parts", type=int, nargs="+", default=[2, 4, 16, 64])
    parser.add_argument("--frames", type=int, nargs="+", help="numbers of frames; negative ones count from the last one; default: first and last")
    parser.add_argument("--skin", type=float, metavar="M", help="default: the scene's")
    parser.add_argument("--reach", type=float, metavar="M", help="of the contact laws; default: the scene's")
    parser.add_argument("--cost", type=float, nargs=3, metavar=("COMPLIANT", "RIGID", "PAIR"), help="us a step; default: from summary.json")
    parser.add_argument("--keep-cut", action="store_true", help="cut the first of the frames alone")
    parser.add_argument("--json", type=Path, help="file for all figures")
    options = parser.parse_args(arguments)
    if (options.folder is None) == (options.lattice is None):
        parser.error("give the folder of a run or --lattice COLUMNS ROWS")
    if options.lattice and (min(options.lattice) < 1 or options.lattice[0] % 2 != 0):
        parser.error(f"--lattice {options.lattice[0]} {options.lattice[1]}: an even number of columns and at least one row")
    if options.lattice and (options.skin is None or options.reach is None or options.cost is None):
        parser.error("--lattice needs --skin, --reach and --cost")
    if min(options.parts) < 1:
        parser.error(f"--parts {min(options.parts)}: at least 1")
    for name in ("skin", "reach"):
        value = getattr(options, name)
        if value is not None and not (math.isfinite(value) and value >= 0):
            parser.error(f"--{name} {value}: not a length of at least 0 m")
    if options.cost and not (min(options.cost) >= 0 and max(options.cost[:2]) > 0 and math.isfinite(sum(options.cost))):
        parser.error("--cost: three times of at least 0 us, and some grain takes some")
    return options


def chosen_frames(frames: Frames, wanted: list[int] | None) -> list[int]:
    total = len(frames.times)
    if wanted is None:
        return sorted({0, total - 1})
    for index in wanted:
        if not -total <= index < total:
            raise ValueError(f"no frame {index}; there are 0 to {total - 1}")
    return [index % total for index in wanted]


def read(options: argparse.Namespace) -> tuple[list[Packing], list[float], float, float]:
    """Packings of the chosen frames, their times, skin and reach."""
    if options.lattice:
        return [lattice(*options.lattice)], [0.0], options.skin, options.reach
    run = read_run(options.folder)
    if "outlines" not in run.frames.grids:
        raise BadFolder(f"{options.folder}: its frames have no outlines")
    if run.frames.in_cell:
        raise BadFolder(f"{options.folder}: has two periods; this program cuts domains with one period or none")
    chosen = chosen_frames(run.frames, options.frames)
    try:
        scene = tomllib.loads((options.folder / "scene.toml").read_text())
    except OSError as error:
        raise BadFolder(f"{options.folder}: has no scene.toml ({error})") from error
    spacings = packing_of(run.frames, 0).spacings()
    skin = options.skin if options.skin is not None else skin_of(scene, spacings)
    reach = options.reach if options.reach is not None else reach_of(scene, spacings)
    return [packing_of(run.frames, index) for index in chosen], run.frames.times[chosen].tolist(), skin, reach


def count_all(options: argparse.Namespace) -> tuple[list[Counts], str]:
    """Counts by frame and number of parts, and a line with the lengths and costs."""
    packings, times, skin, reach = read(options)
    grains = packings[0].grains.size
    if grains < max(options.parts):
        raise ValueError(f"--parts {max(options.parts)}: there are only {grains} grains")
    pairs = [pairs_of(packing, reach, skin) for packing in packings]
    near = reach + skin
    if options.cost:
        cost = Cost(*(1e-6 * value for value in options.cost))
    else:
        mean = float(np.mean([sum(pair.gap <= near for pair in of_frame) for of_frame in pairs]))
        cost = cost_from(read_json(options.folder / "summary.json"), packings[0], mean)
    found, cuts = [], {}
    for time, packing, of_frame in zip(times, packings, pairs):
        for parts in options.parts:
            before = cuts.get(parts)
            if before is None or not options.keep_cut:
                cuts[parts] = bisect(packing, cost.of_bodies(packing, of_frame, near), parts)
            counts = count(packing, cuts[parts], of_frame, cost, near, time)
            if before is not None:
                counts.moved = int((before.owner != cuts[parts].owner).sum())
            found.append(counts)
    line = (f"skin {skin * 1e9:.2f} nm, reach {reach * 1e9:.2f} nm, ghosts within "
            f"{(reach + (1 + EXTRA_SKINS) * skin) * 1e9:.1f} nm; us a step: compliant grain {cost.compliant * 1e6:.3f}, "
            f"rigid grain {cost.rigid * 1e6:.3f}, pair {cost.pair * 1e6:.3f}")
    return found, line


def main(arguments: list[str] | None = None) -> int:
    options = parse_arguments(arguments)
    try:
        found, line = count_all(options)
        print(line, "mean and largest of all parts:", HEADER, *map(row, found), sep="\n")
        if options.json:
            options.json.write_text(json.dumps([asdict(counts) for counts in found], indent=1) + "\n")
    except (BadFolder, ValueError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return BAD_INPUT
    return 0


if __name__ == "__main__":
    sys.exit(main())
