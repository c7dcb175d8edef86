"""Coarse fields and contact networks of frames made by hand. EXACT unless said otherwise."""

from __future__ import annotations

import os
from pathlib import Path

import h5py
import numpy as np
import pytest

import pliant
from pliant.coarse import coarse_fields, profile
from pliant.frames import COMPLIANT, RIGID, WALL, BadFolder, Frames
from pliant.network import of_frame

ROOT = Path(os.environ.get("PLIANT_SOURCE_DIR", Path(__file__).parents[2]))
SINGLE = 1e-6  # numbers are stored in single precision, some are sums of a few


def square(x: float, y: float, side: float = 1.0) -> np.ndarray:
    """Corners, counter-clockwise from the lower left."""
    return np.array([(x, y), (x + side, y), (x + side, y + side), (x, y + side)])


def velocity_at(points: np.ndarray) -> np.ndarray:
    """Linear, so that triangles have it exactly."""
    return np.column_stack([2 + 3 * points[:, 1], -points[:, 0], np.zeros(len(points))])


def write(folder: Path, squares: list[np.ndarray], contacts: dict[str, object] | None = None,
          kinds: list[int] | None = None) -> Path:
    """Squares as bodies of two triangles; walls are outlines alone."""
    kinds = kinds or [RIGID] * len(squares)
    grains = [i for i, kind in enumerate(kinds) if kind != WALL]
    points = np.concatenate([squares[i] for i in grains])
    with h5py.File(folder / "frames.h5", "w") as file:
        file["times"] = [0.0]
        triangles = np.array([(4 * g + a, 4 * g + b, 4 * g + c) for g in range(len(grains)) for a, b, c in
                              ((0, 1, 2), (0, 2, 3))])
        lines = np.array([(4 * b + i, 4 * b + (i + 1) % 4) for b in range(len(squares)) for i in range(4)])
        for name, cells, bodies in (("bodies", triangles, np.repeat(grains, 2)),
                                    ("outlines", lines, np.repeat(np.arange(len(squares)), 4))):
            file[f"{name}/cells"], file[f"{name}/body"] = cells, bodies.astype("f4")
            file[f"{name}/kind"] = np.array(kinds, dtype="f4")[bodies]
        file["bodies/000000/position"] = points.astype("f4")
        file["bodies/000000/velocity"] = velocity_at(points).astype("f4")
        file["outlines/000000/position"] = np.concatenate(squares).astype("f4")
        for name, values in (contacts or {}).items():
            file[f"contacts/000000/{name}"] = np.array(values, dtype="f4")
    return folder / "frames.h5"


def test_squares_that_fill_cells(tmp_path: Path) -> None:
    """A whole cell, half of one on either side of an edge, none."""
    frames = Frames(write(tmp_path, [square(0, 0), square(1.5, 1)]), None)
    fields = coarse_fields(frames, 0, 1.0, (0, 3, 0, 2))
    assert fields.solid_fraction == pytest.approx(np.array([[1, 0, 0], [0, 0.5, 0.5]]), abs=SINGLE)
    assert fields.velocity is not None and fields.stress is None
    assert fields.velocity[0, 0] == pytest.approx([2 + 3 * 0.5, -0.5], rel=SINGLE)
    assert fields.velocity[1, 1] == pytest.approx([2 + 3 * 1.5, -1.75], rel=SINGLE)
    assert np.isnan(fields.velocity[0, 1]).all()


def test_area_is_kept_wherever_a_square_lies(tmp_path: Path) -> None:
    frames = Frames(write(tmp_path, [square(0.123, 0.456)]), None)
    fields = coarse_fields(frames, 0, 0.7, (0, 2.1, 0, 2.1))
    assert fields.solid_fraction.sum() * 0.49 == pytest.approx(1, rel=SINGLE)
    # A cell's edge cuts pieces of a quarter of its width at most, which count on one side or the other.
    assert fields.solid_fraction[0, 0] == pytest.approx((0.7 - 0.123) * (0.7 - 0.456) / 0.49, abs=0.25 * 2 / 2)


def test_a_square_over_the_seam_counts_on_both_sides(tmp_path: Path) -> None:
    frames = Frames(write(tmp_path, [square(3.5, 0)]), 4.0)
    fields = coarse_fields(frames, 0, 1.0)
    assert fields.solid_fraction == pytest.approx(np.array([[0.5, 0, 0, 0.5]]), abs=SINGLE)


def test_profiles_are_means_over_x_and_time(tmp_path: Path) -> None:
    """A square in a period of two that lies a layer higher in the second frame, and far away in the third."""
    file = write(tmp_path, [square(0, 0)])
    with h5py.File(file, "a") as frames:
        del frames["times"]
        frames["times"] = [0.0, 1.0, 2.0]
        for index, height in ((1, 1.0), (2, 5.0)):
            points = square(0, height)
            frames[f"bodies/{index:06}/position"] = frames[f"outlines/{index:06}/position"] = points.astype("f4")
            frames[f"bodies/{index:06}/velocity"] = velocity_at(points).astype("f4")
    layers = profile(Frames(file, 2.0), (0, 1), 1.0)
    assert layers.y == pytest.approx([0.5, 1.5]) and layers.stress is None
    assert layers.solid_fraction == pytest.approx([0.25, 0.25], rel=SINGLE)
    assert layers.velocity == pytest.approx(np.array([[3.5, -0.5], [6.5, -0.5]]), rel=SINGLE)
    both = profile(Frames(file, 2.0), (0, 1), 3.0, (0, 2, 0, 3))
    assert both.solid_fraction == pytest.approx([1 / 6], rel=SINGLE)
    assert both.velocity == pytest.approx(np.array([[5, -0.5]]), rel=SINGLE), "weighted by area"
    assert np.isnan(profile(Frames(file, 2.0), (0, 0), 1.0, (0, 2, 0, 2)).velocity[1]).all()
    with pytest.raises(ValueError, match="no frame from 3 to 4 s"):
        profile(Frames(file, 2.0), (3, 4), 1.0)


def test_profiles_have_the_stress_of_contacts(tmp_path: Path) -> None:
    layers = profile(chain(tmp_path), (0, 0), 1.0, (0, 2, 0, 1))
    assert layers.stress == pytest.approx(np.array([[[-2.5, 0], [-0.5, -1.75]]]), rel=SINGLE)


def test_wrong_cells_are_refused(tmp_path: Path) -> None:
    frames = Frames(write(tmp_path, [square(0, 0)]), None)
    for cell, box in ((0.0, None), (1.0, (1, 0, 0, 1))):
        with pytest.raises(ValueError, match="allowed"):
            coarse_fields(frames, 0, cell, box)


# Two squares pressed onto each other by 5 N/m along x, a wall under the first that bears 7 N/m.
CHAIN = {"bodies": [(0, 1), (0, 2)], "images": [0, 0], "point": [(1, 0.5), (0.5, 0)], "force": [(5, 1), (0, -7)],
         "length": [1, 1]}
CHAIN_BODIES = [square(0, 0), square(1, 0), square(-1, -1, 3)]
CHAIN_KINDS = [RIGID, COMPLIANT, WALL]


def chain(folder: Path) -> Frames:
    return Frames(write(folder, CHAIN_BODIES, CHAIN, CHAIN_KINDS), None)


def test_a_cell_with_two_periods_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    frames = Frames(write(tmp_path, [square(0, 0)]), None)
    monkeypatch.setattr(Frames, "in_cell", True)
    with pytest.raises(BadFolder, match="one period at most"):
        coarse_fields(frames, 0, 1.0)


def test_forces_along_and_across_the_line_of_centres(tmp_path: Path) -> None:
    network = of_frame(chain(tmp_path), 0)
    assert network.normals == pytest.approx(np.array([[1, 0], [0, -1]]))
    assert network.compression == pytest.approx([5, 7])
    assert network.shear == pytest.approx([1, 0])
    assert network.coordination(np.array([0, 1])).tolist() == [2, 1]
    assert network.strong_share() == 0.5
    assert network.fabric(np.array([3.0, 1.0])) == pytest.approx(np.diag([0.75, 0.25]))


def test_stress_of_a_chain(tmp_path: Path) -> None:
    """The sum over all cells times their area is the sum of forces times arms, and in each cell that is crossed by the
    line of centres it is the force's share of the line: half of it for each of the squares' halves here."""
    fields = coarse_fields(chain(tmp_path), 0, 1.0, (0, 2, 0, 1))
    assert fields.stress is not None and fields.pressure is not None
    # Body 0 bears (-5, -1) on the arm (0.5, 0) and (0, 7) on (0, -0.5); body 1 bears (5, 1) on (-0.5, 0).
    assert fields.stress[0, 0] == pytest.approx(np.array([[-2.5, 0], [-0.5, -3.5]]), rel=SINGLE)
    assert fields.stress[0, 1] == pytest.approx(np.array([[-2.5, 0], [-0.5, 0]]), rel=SINGLE)
    assert fields.pressure[0] == pytest.approx([3, 1.25], rel=SINGLE)
    fine = coarse_fields(chain(tmp_path), 0, 0.25, (0, 2, 0, 1)).stress
    assert fine is not None
    assert fine.sum(axis=(0, 1)) / 16 == pytest.approx(fields.stress.sum(axis=(0, 1)), rel=SINGLE)
    # Along the line from 0.5 to 1.5 each cell of a quarter has the same: 5 N/m x 0.25 over 1/16.
    assert fine[2, 2:6, 0, 0] == pytest.approx([-20] * 4, rel=SINGLE)


def test_images_are_seen_across_the_period(tmp_path: Path) -> None:
    contacts = {"bodies": [(0, 1)], "images": [-1], "point": [(0, 0.5)], "force": [(-3, 0)], "length": [1]}
    frames = Frames(write(tmp_path, [square(0, 0), square(3, 0)], contacts), 4.0)
    network = of_frame(frames, 0)
    assert network.normals == pytest.approx(np.array([[-1, 0]])) and network.compression == pytest.approx([3])
    stress = coarse_fields(frames, 0, 1.0).stress
    assert stress is not None
    assert stress[0, :, 0, 0] == pytest.approx([-1.5, 0, 0, -1.5], rel=SINGLE)


def test_runs_without_contacts_say_so(tmp_path: Path) -> None:
    frames = Frames(write(tmp_path, [square(0, 0)]), None)
    assert frames.contacts(0) is None
    with pytest.raises(BadFolder, match="contacts = true"):
        of_frame(frames, 0)


def test_bodies_by_kind_and_place(tmp_path: Path) -> None:
    frames = chain(tmp_path)
    assert frames.bodies("grain").tolist() == [0, 1] and frames.bodies("compliant").tolist() == [1]
    assert frames.bodies("wall").tolist() == [2]
    assert frames.bodies("grain", 0, (1, 2, 0, 1)).tolist() == [1]
    assert frames.centres(0) == pytest.approx(np.array([[0.5, 0.5], [1.5, 0.5], [0.5, 0.5]]))
    assert np.array_equal(frames.polygons(0, [1])[0], square(1, 0))
    assert frames.cells("bodies", [1]).tolist() == [False, False, True, True]
    assert frames.contacts(0).of(frames.bodies("grain")).bodies.tolist() == [[0, 1]]
    with pytest.raises(ValueError, match="no kind 'rigit'"):
        frames.bodies("rigit")


def test_sums_over_cells_are_those_of_the_engine(tmp_path: Path) -> None:
    """INDEPENDENT: the probes of the mean contact stress, from forces on nodes, and of the solid fraction, with exact
    areas. A contact's force acts at one point here: nodes have arms to it of half of its length, L/2, and normals that
    turn by as much over the grain's radius, R; so its share of the stress is off by F L^2/4R at most."""
    scene = pliant.Scene.read(ROOT / "cases/probes.toml")
    scene["time.end"] = "0.26 us"
    scene["frames.period"] = "0.26 us"
    scene["frames.contacts"] = True
    run = pliant.run(scene, tmp_path / "out")
    last = len(run.frames.times) - 1
    fields, network = coarse_fields(run.frames, last, 0.5e-6), of_frame(run.frames, last)
    assert fields.stress is not None
    area = (fields.box[1] - fields.box[0]) * (fields.box[3] - fields.box[2]) / fields.solid_fraction.size
    region = fields.solid_fraction.sum() * area / run.probes.column("dense.solid_fraction").values[-1]
    height = np.diff([run.frames.centres(last)[wall, 1] for wall in run.frames.bodies("wall")])[0]
    assert region == pytest.approx(height * run.frames.period, rel=1e-3)  # triangles have less than the outlines' area
    off = (network.magnitude * network.contacts.length**2 / 4 / 0.5e-6).sum() / region
    for name, (i, j) in {"xx": (0, 0), "xy": (0, 1), "yx": (1, 0), "yy": (1, 1)}.items():
        expected = run.probes.column(f"packed.stress_{name}").values[-1]
        assert fields.stress[:, :, i, j].sum() * area / region == pytest.approx(expected, abs=off)
    assert off < 0.05 * -run.probes.column("packed.stress_yy").values[-1]
