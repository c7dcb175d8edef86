"""What benchmarks/partition.py counts on made-up packings. EXACT: all numbers are counted by hand."""

from __future__ import annotations

import json
from pathlib import Path

import h5py
import numpy as np
import pytest

import partition
from partition import Cost, Packing
from pliant.frames import COMPLIANT, RIGID, WALL

PITCH, REACH, SKIN = 1.1, 0.2, 0.05  # squares of side 1: gaps of 0.1 to the sides and 0.14 across corners
NEAR = REACH + SKIN
EVEN = Cost(compliant=1.0, rigid=1.0, pair=0.0)


def square(x: float, y: float) -> np.ndarray:
    """Four nodes of a unit square about a place."""
    return np.array([[x - 0.5, y - 0.5], [x + 0.5, y - 0.5], [x + 0.5, y + 0.5], [x - 0.5, y + 0.5]])


def lattice(columns: int, rows: int, period: float | None = None, kind: int = COMPLIANT) -> Packing:
    """Numbered row by row."""
    outlines = [square(PITCH * i, PITCH * j) for j in range(rows) for i in range(columns)]
    return Packing(outlines, np.full(len(outlines), kind), period)


def counted(packing: Packing, parts: int, cost: Cost = EVEN) -> partition.Counts:
    pairs = partition.pairs_of(packing, REACH, SKIN)
    cut = partition.bisect(packing, cost.of_bodies(packing, pairs, NEAR), parts)
    return partition.count(packing, cut, pairs, cost, NEAR)


def test_a_square_lattice_in_four() -> None:
    """4 x 4 squares: a part owns 2 x 2 and sees two beside it, two above or below it and one across the corner."""
    found = counted(lattice(4, 4), 4)
    assert found.bodies == [4] * 4 and found.ghosts == [5] * 4 and found.messages == [3] * 4
    # The corner square goes to three parts, two others to one each: four nodes of two numbers.
    assert found.bytes == [5 * 4 * 2 * 8] * 4 and found.bytes_with_velocity == [5 * 4 * 4 * 8] * 4
    assert found.pairs == found.pairs_in_list == 12 + 12 + 18
    assert found.pairs_twice == 10 + 10 - 2  # across either line, less the two across the corner
    assert found.imbalance == 1 and found.wall_parts == []
    assert found.border == pytest.approx(2 * 4.3 + 2 * 2 * 2.15, rel=1e-12)
    assert found.area == pytest.approx(4.3**2, rel=1e-12)


def test_parts_meet_around_the_period() -> None:
    """The same with a period of four pitches: a part has a border on all sides but one."""
    found = counted(lattice(4, 4, 4 * PITCH), 4)
    assert found.ghosts == [4 + 2 + 2] * 4 and found.messages == [3] * 4
    assert found.pairs == 16 + 12 + 24
    # Across both borders in x 4 pairs to the sides and 6 across corners each, across the one in y 4 and 8.
    assert found.pairs_twice == 2 * 10 + 12 - 2 * 2
    # Two borders as high as the packing, and one in each half: 4.3 and 2.2 long, each counted for both of its sides.
    assert found.border == pytest.approx(2 * 2 * 4.3 + 2 * 2 * 2.2, rel=1e-12)


def test_a_pair_that_meets_twice_is_one_pair() -> None:
    """Two squares in a period of two pitches meet on both sides."""
    packing = lattice(2, 1, 2 * PITCH)
    pairs = partition.pairs_of(packing, REACH, SKIN)
    assert [(pair.first, pair.second) for pair in pairs] == [(0, 1)]
    assert pairs[0].gap == pytest.approx(0.1, rel=1e-12)
    assert pairs[0].near[0].tolist() == pairs[0].near[1].tolist() == [0, 1, 2, 3]
    assert counted(packing, 2).ghosts == [1, 1]


@pytest.mark.parametrize("gap, ghosts, pairs", [(0.24, 1, 1), (0.26, 1, 0), (0.44, 1, 0), (0.46, 0, 0)])
def test_ghosts_reach_as_far_as_the_contact_list(gap: float, ghosts: int, pairs: int) -> None:
    """Candidates end at reach + skin = 0.25, the list at reach + 5 skins = 0.45."""
    found = counted(Packing([square(0, 0), square(1 + gap, 0)], np.array([COMPLIANT, COMPLIANT])), 2)
    assert (found.ghosts, found.pairs) == ([ghosts] * 2, pairs)


def test_pairs_are_those_of_all_segments() -> None:
    """Against the distances of all nodes from all segments of all images, of squares thrown at random."""
    random = np.random.default_rng(1)
    packing = Packing([square(*place) for place in random.uniform([-5, 0], [15, 6], (25, 2))], np.full(25, COMPLIANT), 10.0)
    expected = {}
    for a in range(25):
        for b in range(a + 1, 25):
            own, other = packing.outlines[a], packing.outlines[b]
            images = [other + [10.0 * n, 0] for n in range(-3, 4)]
            gap = min(partition.distances(p, q, np.roll(q, -1, axis=0)).min() for image in images for p, q in [(own, image), (image, own)])
            if gap <= REACH + 5 * SKIN:
                expected[a, b] = gap
    found = {(pair.first, pair.second): pair.gap for pair in partition.pairs_of(packing, REACH, SKIN)}
    assert len(expected) > 10 and found == pytest.approx(expected, rel=1e-9, abs=1e-12)


def test_distances_are_those_of_segments() -> None:
    """A corner in front of the middle of a side."""
    tip = np.array([[0.6, 0.0], [1.6, -0.5], [1.6, 0.5]])
    pair, = partition.pairs_of(Packing([square(0, 0), tip], np.array([RIGID, RIGID])), REACH, SKIN)
    assert pair.gap == pytest.approx(0.1, rel=1e-12)
    assert pair.near[0].tolist() == [] and pair.near[1].tolist() == [0]


def test_rigid_grains_send_their_motion() -> None:
    """Position and force: 3 numbers each; velocity: 3 more."""
    found = counted(lattice(2, 1, kind=RIGID), 2)
    assert found.bytes == [48, 48] and found.bytes_with_velocity == [72, 72]


def test_arcs_are_nodes_with_candidates_and_their_neighbours() -> None:
    """Two hexadecagons side by side: of each only the node at the other one is near."""
    angle = 2 * np.pi * np.arange(16) / 16
    ring = np.column_stack([np.cos(angle), np.sin(angle)])
    found = counted(Packing([ring, ring + [2.2, 0]], np.array([COMPLIANT, COMPLIANT])), 2)
    assert found.bytes == [16 * 16, 16 * 16] and found.bytes_of_arcs == [3 * 16, 3 * 16]


def test_the_cut_balances_cost() -> None:
    """One grain costs as much as three: it stays alone. Three in two parts cannot be balanced."""
    packing = lattice(4, 1)
    packing.kinds = np.array([COMPLIANT, RIGID, RIGID, RIGID])
    cost = Cost(compliant=3.0, rigid=1.0, pair=0.0)
    found = counted(packing, 2, cost)
    assert found.bodies == [1, 3] and found.imbalance == 1
    assert counted(lattice(3, 1), 2).imbalance == pytest.approx(2 / 1.5)


def test_parts_that_are_no_power_of_two_have_equal_cost() -> None:
    found = counted(lattice(6, 1), 3)
    assert found.bodies == [2, 2, 2] and found.messages == [1, 2, 1]


def test_equal_coordinates_are_cut_by_number() -> None:
    for middle in ([1, 2], [2, 1]):
        places = dict(zip([0, *middle, 3], [(0.0, 0.0), (10.0, 0.0), (10.0, 1.2), (20.0, 0.0)]))
        packing = Packing([square(*places[b]) for b in range(4)], np.full(4, COMPLIANT))
        assert partition.bisect(packing, np.ones(4), 2).owner.tolist() == [0, 0, 1, 1]


def test_work_counts_pairs_of_both_sides() -> None:
    """Four in a row, three pairs: of two parts each computes its own pair and that between them."""
    cost = Cost(compliant=1.0, rigid=1.0, pair=1.0)
    found = counted(lattice(4, 1), 2, cost)
    assert found.imbalance == 1 and found.pairs == 3 and found.pairs_twice == 1
    assert found.slowest == pytest.approx((2 + 2) / ((4 + 3) / 2))


def test_walls_are_copied_and_their_pairs_computed_once() -> None:
    """A wall below two rows of four squares, over one period: both lower parts touch it, no ghost comes from it."""
    packing = lattice(4, 2, 4 * PITCH)
    floor = np.column_stack([np.linspace(0, 4 * PITCH, 8, endpoint=False), np.full(8, -0.6)])
    packing.outlines.append(floor), setattr(packing, "kinds", np.append(packing.kinds, WALL))
    cost = Cost(compliant=1.0, rigid=1.0, pair=1.0)
    pairs = partition.pairs_of(packing, REACH, SKIN)
    assert [pair.first for pair in pairs if pair.second == 8] == [0, 1, 2, 3]
    assert cost.of_bodies(packing, pairs, NEAR).tolist() == [1 + 5 / 2 + 1] * 4 + [1 + 5 / 2] * 4 + [0]
    cut = partition.bisect(packing, cost.of_bodies(packing, pairs, NEAR), 2)
    found = partition.count(packing, cut, pairs, cost, NEAR)
    assert cut.owner.tolist() == [0, 0, 1, 1] * 2 + [-1]
    assert found.wall_parts == [2] and found.ghosts == [4, 4] and found.pairs == 4 + 8 + 4 + 8
    assert found.pairs_twice == 2 * (2 + 2)


def test_a_wall_goes_on_in_the_next_period() -> None:
    """The last segment of a wall ends at its first node, one period on; here it is the only one below the square."""
    floor = np.array([[-1.0, -2.0], [-0.9, -0.6], [0.9, -0.6], [1.0, -2.0]]) + [6.0, 0]
    far = Packing([square(0, 0), floor + [4, 0]], np.array([RIGID, WALL]), 10.0)
    line = Packing([square(0, 0), np.array([[4.0, -0.6], [6.0, -0.6]])], np.array([RIGID, WALL]), 10.0)
    assert [pair.second for pair in partition.pairs_of(far, REACH, SKIN)] == [1]
    assert [pair.second for pair in partition.pairs_of(line, REACH, SKIN)] == [1]


def test_costs_come_from_the_phases() -> None:
    phases = {"outlines": 1.0, "update": 2.0, "output": 1.0, "internal": 6.0, "bound": 2.0, "contact": 9.0, "candidates": 3.0}
    packing = lattice(4, 1)
    packing.kinds = np.array([COMPLIANT, RIGID, COMPLIANT, RIGID])
    cost = partition.cost_from({"steps": 10, "phase_seconds": phases}, packing, near_pairs=3)
    assert (cost.rigid, cost.compliant, cost.pair) == pytest.approx((0.1, 0.1 + 0.4, 0.4))


def test_more_parts_than_grains_are_refused() -> None:
    with pytest.raises(ValueError, match="5 parts of 4 grains"):
        partition.bisect(lattice(2, 2), np.ones(4), 5)


SCENE = """title = "squares"
[domain]
period = "4.4 m"
[contact]
skin = 0.05
[[contacts]]
between = "all"
law = "cohesive"
range = "0.2 m"
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A run of 4 x 4 squares of spacing 1 with one frame."""
    packing = lattice(4, 4, 4.4)
    cells = np.array([[4 * b + i, 4 * b + (i + 1) % 4] for b in range(16) for i in range(4)])
    with h5py.File(tmp_path / "frames.h5", "w") as file:
        file["times"] = np.array([1e-6])
        file["outlines/cells"], file["outlines/kind"] = cells, np.zeros(64)
        file["outlines/body"], file["outlines/000000/position"] = np.repeat(np.arange(16), 4), np.concatenate(packing.outlines)
    (tmp_path / "scene.toml").write_text(SCENE)
    return tmp_path


def test_the_program_reads_a_run(folder: Path, capsys: pytest.CaptureFixture) -> None:
    arguments = [str(folder), "--parts", "2", "4", "--cost", "1", "1", "0", "--json", str(folder / "partition.json")]
    assert partition.main(arguments) == 0
    assert "skin 50000000.00 nm, reach 200000000.00 nm" in capsys.readouterr().out
    two, four = json.loads((folder / "partition.json").read_text())
    assert (two["parts"], two["time"], two["ghosts"]) == (2, 1e-6, [8, 8])
    assert (four["parts"], four["ghosts"], four["bytes"]) == (4, [8] * 4, [8 * 64] * 4)


def test_a_cut_can_be_kept(folder: Path, capsys: pytest.CaptureFixture) -> None:
    """In the second frame the two left columns have changed places with the two right ones."""
    with h5py.File(folder / "frames.h5", "a") as file:
        del file["times"]
        file["times"] = np.array([1e-6, 2e-6])
        position = file["outlines/000000/position"][()]
        file["outlines/000001/position"] = position.reshape(4, 4, 4, 2)[:, [2, 3, 0, 1]].reshape(-1, 2)
    moved = {}
    for keep in ([], ["--keep-cut"]):
        arguments = [str(folder), "--parts", "2", "--cost", "1", "1", "0", "--json", str(folder / "partition.json"), *keep]
        assert partition.main(arguments) == 0
        before, after = json.loads((folder / "partition.json").read_text())
        assert before["moved"] == 0 and after["ghosts"] == [8, 8]
        moved[bool(keep)] = after["moved"]
    assert moved == {False: 16, True: 0}


@pytest.mark.parametrize("arguments, message", [
    (["--parts", "17"], "only 16 grains"), (["--frames", "1"], "no frame 1; there are 0 to 0"), ([], "phase_seconds")])
def test_what_a_run_lacks_is_named(folder: Path, arguments: list[str], message: str, capsys: pytest.CaptureFixture) -> None:
    cost = ["--cost", "1", "1", "0"] if arguments else []
    assert partition.main([str(folder), "--parts", "4", *cost, *arguments]) == 2
    assert message in capsys.readouterr().err


def test_a_tension_needs_a_reach(folder: Path, capsys: pytest.CaptureFixture) -> None:
    (folder / "scene.toml").write_text(SCENE.replace('"cohesive"\nrange = "0.2 m"', '"mohr-coulomb"\ntension = "1 MPa"'))
    assert partition.main([str(folder), "--parts", "4", "--cost", "1", "1", "0"]) == 2
    assert "give --reach" in capsys.readouterr().err


def test_a_missing_folder_is_named(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    assert partition.main([str(tmp_path / "none")]) == 2
    assert "no such folder" in capsys.readouterr().err


def test_a_lattice_takes_the_place_of_a_run(capsys: pytest.CaptureFixture) -> None:
    """8 x 6 discs in a period, in two parts: each sees the column of the other one at either border."""
    lengths = ["--skin", "32e-9", "--reach", "8e-9", "--cost", "1", "1", "1"]
    assert partition.main(["--lattice", "8", "6", "--parts", "2", *lengths]) == 0
    work = 24 + 4 * 5 + 3 * 11 + 2 * 11  # grains, pairs up the columns, between own columns and across both borders
    expected = ["1.000", f"{work / ((48 + 128) / 2):.3f}", "12.0,", "12.0"]
    assert capsys.readouterr().out.splitlines()[-1].split()[4:8] == expected
    packing = partition.lattice(8, 6)
    pairs = partition.pairs_of(packing, 8e-9, 32e-9)
    assert len(pairs) == 8 * 5 + 8 * 11  # up the columns, and between neighbouring ones
    assert (packing.kinds == COMPLIANT).sum() == 24


@pytest.mark.parametrize("arguments", [
    ["folder", "--parts", "0"], ["folder", "--skin", "-1"], ["folder", "--reach", "nan"], ["folder", "--cost", "0", "0", "1"], [],
    ["folder", "--lattice", "2", "2"], ["--lattice", "2", "2"],
    ["--lattice", "3", "2", "--skin", "0", "--reach", "0", "--cost", "1", "1", "1"]])
def test_bad_arguments_are_refused(arguments: list[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        partition.parse_arguments(arguments)
    assert ended.value.code == 2
