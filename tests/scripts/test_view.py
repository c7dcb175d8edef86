"""scripts/view.py: what a browser shows of the page against the frames. EXACT within the errors that it states."""

from __future__ import annotations

import json
import math
import re
import shutil
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import h5py
import matplotlib
import numpy as np
import pytest
from matplotlib.image import imread

from viewed_run import FRAMES, GRAINS, PERIOD, ROWS, TITLE, about, field_of, in_browser, write_viewed_run

import view
from browser import BROWSER, pictured
from pliant.frames import Frames
from synthetic_run import DIAMETER, ROW_PITCH
from viewing.fields import LOOKS

pytestmark = pytest.mark.skipif(BROWSER is None, reason="chromium is not installed")


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_viewed_run(tmp_path_factory.mktemp("run"))


def cell_middle(frames: Frames, index: int, cell: int) -> np.ndarray:
    """Put into the period."""
    x, y = frames.positions("bodies", index)[frames.grids["bodies"].cells[cell]].mean(axis=0)
    return np.array([x % PERIOD, y])


def number(text: str) -> tuple[float, float]:
    """As read, and half of the last digit."""
    digits = re.search(r"[\u2212\d.]+", text)[0].replace("\u2212", "-")
    return float(digits), 0.5 * 10.0 ** -len(digits.partition(".")[2])


def assert_value(told: str, field: dict[str, Any], expected: float) -> None:
    value, rounding = number(told.removeprefix(field["label"]))
    error = 0.5 * field["step"] * field["factor"] + rounding
    assert abs(value - expected * field["factor"]) <= error + 1e-9 * abs(value)


def hexadecimal(rgb: Iterable[float]) -> str:
    return "#" + "".join(f"{round(c):02x}" for c in list(rgb)[:3])


def assert_colour(rgb: list[float], field: dict[str, Any], value: float) -> None:
    """That of the map, or its neighbour where the step goes across."""
    index = int(256 * (value - field["low"]) / (field["high"] - field["low"]))
    allowed = 255 * matplotlib.colormaps[field["palette"]](np.clip([index - 1, index, index + 1], 0, 255))[:, :3]
    assert np.abs(allowed - np.array(rgb[:3])).max(axis=1).min() <= 1


def test_values_and_colours_move_with_the_slider(run: Path) -> None:
    page, frames = run / "view.html", Frames(run / "frames.h5", None)
    grid = frames.grids["bodies"]
    field = field_of(page, "pressure")
    values = [frames.field("bodies", index, "pressure") for index in (1, 3)]
    usable = (grid.kind == 0) & (0.7 * field["high"] < values[0]) & (values[0] < field["high"])
    cell = int(np.flatnonzero(usable & (values[1] < -0.3 * field["high"]) & (values[1] > field["low"]))[0])
    body, places = grid.body[cell], [cell_middle(frames, index, cell) for index in (1, 3)]
    (x, y), (u, v) = places
    found = in_browser(page, f"frame=1&field=pressure&at={x}:{y}&view={x}:{y}:5", f"""
        await shown(1);
        const first = [tip(), colour({x}, {y}), byId("time").textContent];
        slider.value = 3;
        slider.dispatchEvent(new Event("input"));
        await shown(3);
        state.pointer = {{ place: [{u}, {v}] }};
        Object.assign(view, {{ x: {u}, y: {v} }});
        await show();
        const second = [tip(), colour({u}, {v}), byId("time").textContent];
        document.querySelectorAll(".stretch")[1].click();
        await until(() => !byId("tip").hidden && now.field.stretch === 2);
        await show();
        return [first, second, colour({u}, {v})];""")
    assert_colour(found.pop(), field | {"low": 2 * field["low"], "high": 2 * field["high"]}, float(values[1][cell]))
    for (told, rgb, time), index, of in zip(found, (1, 3), values):
        value = float(of[cell])
        who, what = told.splitlines()
        assert who == f"body {body}, compliant" and what.endswith(" MPa")
        assert_value(what, field, value)
        assert_colour(rgb, field, value)
        assert number(time)[0] == pytest.approx(frames.times[index] * 1e6, abs=number(time)[1])


def test_a_picture_of_the_page(run: Path, tmp_path: Path) -> None:
    """The same pixel as the browser paints it; kinds in the colours of ./pliant plot."""
    frames = Frames(run / "frames.h5", None)
    grid = frames.grids["bodies"]
    places = [cell_middle(frames, 2, int(np.flatnonzero(grid.kind == kind)[7])) for kind in (0, 1)]
    address = f"frame=2&view={places[0][0]}:{places[0][1]}:1.5"
    pixels = in_browser(run / "view.html", address, f"""
        await shown(2);
        const {{ left, top }} = picture.getBoundingClientRect();
        return {json.dumps([list(p) for p in places])}.map(([x, y]) => [left + at(x, y)[0], top + at(x, y)[1]]);""")
    pictured(f"{(run / 'view.html').as_uri()}#{address}", tmp_path / "a.png")
    image = 255 * imread(tmp_path / "a.png")
    for (column, row), colour in zip(pixels, ("#f2c079", "#4a4a4a")):
        assert hexadecimal(image[int(row), int(column)]) == colour


def test_colours_along_outlines_and_of_walls(run: Path) -> None:
    """On the inner side of a segment, on the scale and beyond it; below a wall; out of the period."""
    page, frames = run / "view.html", Frames(run / "frames.h5", None)
    field, grid = field_of(page, "contact_pressure"), frames.grids["outlines"]
    values, place = frames.field("outlines", 1, "contact_pressure"), frames.positions("outlines", 1)
    means = values[grid.cells].mean(axis=1)
    usable = (grid.kind < 2) & (values[grid.cells].min(axis=1) > 0)
    beyond = means > field["high"]
    segments = [np.flatnonzero(usable & ~beyond)[9], np.flatnonzero(usable & beyond)[0]]
    middles = []
    for (ax, ay), (bx, by) in place[grid.cells[segments]]:
        length = math.hypot(bx - ax, by - ay)
        middles.append([(ax + bx) / 2 % PERIOD, (ay + by) / 2, (ay - by) / length, (bx - ax) / length])
    inside = cell_middle(frames, 1, 0)
    *along, wall, out, grain = in_browser(page, "frame=1&field=contact_pressure", f"""
        await shown(1);
        const found = [], outer = [colour({PERIOD / 2}, {-1.05 * ROW_PITCH}), colour({-0.02 * PERIOD}, 0),
          colour({inside[0]}, {inside[1]})];
        for (const [x, y, nx, ny] of {json.dumps(middles)}) {{
          Object.assign(view, {{ x, y, scale: 8 * view.smallest }});
          await show();
          found.push(colour(x + 4 / view.scale * nx, y + 4 / view.scale * ny));
        }}
        return [...found, ...outer];""")
    assert_colour(along[0], field, means[segments[0]])
    assert hexadecimal(along[1]) == about(page)["palettes"][field["palette"]]["above"]
    assert [hexadecimal(rgb) for rgb in (wall, out, grain)] == ["#a6a6a6", "#eef0f2", "#dddddd"]


def test_all_positions_and_fields(run: Path) -> None:
    """Decoded by the page's own script: each number of a frame within the error that the page states."""
    page, frames = run / "view.html", Frames(run / "frames.h5", PERIOD)
    data = about(page)
    found = in_browser(page, "", """
        await shown(0);
        const plain = (values) => [...values].map((value) => (Number.isNaN(value) ? null : value));
        const fields = {};
        for (const field of about.fields) fields[field.name] = plain(await loadField(field, 3));
        return { place: plain((await loadFrame(model, 3)).place), fields, outline: [...model.outlinePoints],
          soft: model.soft.length };""")
    place = np.array(found["place"]).reshape(-1, 2)
    bound = 0.75 * data["step"]
    assert data["step"] < 1e-3 * DIAMETER and number(data["error_text"])[0] == pytest.approx(bound * 1e12, rel=0.01)
    inner = frames.positions("bodies", 3)
    assert np.linalg.norm(place[: len(inner)] - inner, axis=1).max() <= bound
    assert np.linalg.norm(place[found["outline"]] - frames.positions("outlines", 3), axis=1).max() <= bound
    compliant = frames.grids["bodies"].kind == 0
    nodes = len(inner) // GRAINS
    softs = np.unique(frames.grids["bodies"].body[compliant])
    assert found["soft"] == nodes * len(softs), "rigid ones are told by motions"
    for field in data["fields"]:
        look = LOOKS[field["name"]]
        values = np.array(found["fields"][field["name"]], dtype=float)
        stored = frames.field(look.grid, 3, field["name"]).astype(float)
        expected = stored[:, :2].T.ravel() if stored.ndim == 2 else stored
        if look.of_compliant:
            expected = np.where(compliant, stored, np.nan)
        assert (np.isnan(values) == np.isnan(expected)).all(), field["name"]
        there = ~np.isnan(expected)
        error = 0 if look.step else field["step"] / 2 * (1 + 1e-9)
        assert np.abs(values - expected)[there].max() <= error, field["name"]


def test_keys_marks_zoom_and_curves(run: Path) -> None:
    page, frames = run / "view.html", Frames(run / "frames.h5", None)
    grid = frames.grids["bodies"]
    cell = int(np.flatnonzero(grid.kind == 0)[30])
    x, y = cell_middle(frames, 0, cell)
    found = in_browser(page, "field=pressure&probe=place.position_x", f"""
        await shown(0);
        const {{ left, top }} = overlay.getBoundingClientRect(), px = left + view.px({x}), py = top + view.py({y});
        const told = {{}}, marks = () => byId("marks").innerText;
        for (const kind of ["down", "up"]) pointer(kind, px, py, {{ buttons: 1 }});
        told.marks = [marks()];
        press("ArrowRight");
        await shown(1);
        told.marks.push(marks());
        told.curve = byId("probe-value").textContent;
        press("End");
        await shown(3);
        press("Home");
        await shown(0);
        press(" ");
        told.playing = state.playing;
        await shown(3);
        await until(() => !state.playing);
        const before = view.at(px - left, py - top), scale = view.scale;
        overlay.dispatchEvent(new WheelEvent("wheel", {{ deltaY: -500, clientX: px, clientY: py }}));
        told.zoom = [view.scale / scale, ...view.at(px - left, py - top).map((c, i) => (c - before[i]) * view.scale)];
        const from = view.at(0, 0);
        pointer("down", px, py, {{ buttons: 1 }});
        pointer("move", px + 40, py - 30, {{ buttons: 1 }});
        pointer("up", px + 40, py - 30);
        told.pan = view.at(0, 0).map((c, i) => (c - from[i]) * view.scale);
        told.afterDrag = state.marks.length;
        byId("reset").click();
        told.reset = view.scale === scale;
        press("Escape");
        told.unmarked = marks();
        const box = curve.getBoundingClientRect(), third = curve.axes.x(about.times[2] * about.time.factor);
        const place = {{ clientX: box.left + third + 3, clientY: box.top + 20, buttons: 1 }};
        curve.dispatchEvent(new PointerEvent("pointerdown", place));
        await shown(2);
        await new Promise((done) => setTimeout(done, 500));
        told.address = location.hash;
        return told;""")
    assert isinstance(found, dict), found
    field = field_of(page, "pressure")
    for told, index in zip(found["marks"], (0, 1)):
        who, what = told.split(" \u00b7 ")
        assert who == f"body {grid.body[cell]}, compliant"
        assert_value(what, field, float(frames.field("bodies", index, "pressure")[cell]))
    assert found["marks"][0] != found["marks"][1] and found["afterDrag"] == 1 and found["unmarked"] == ""
    assert found["playing"] and found["reset"]
    assert found["zoom"][0] == pytest.approx(math.exp(0.75))
    assert found["zoom"][1:] == pytest.approx([0, 0], abs=1), "the place under the pointer stays, to a pixel"
    assert found["pan"] == pytest.approx([-40, -30], abs=1e-6)
    read, rounding = number(found["curve"])
    assert read == pytest.approx(10 * (frames.times[1] - 1e-6) * 1e6, abs=rounding + 1e-5)
    assert found["curve"].endswith(" \u00b5m")
    assert found["address"] == "#frame=2&field=pressure&probe=place.position_x"


def test_whole_bodies_in_one_period_and_copies_at_its_edges(run: Path) -> None:
    """INDEPENDENT: which disc a place is in, images included, by the made-up centres."""
    frames = Frames(run / "frames.h5", None)
    place, body = frames.positions("bodies", 3), frames.grids["bodies"].point_body
    centres = np.array([place[body == grain].mean(axis=0) for grain in range(GRAINS)])
    samples = np.random.default_rng(5).uniform([0, 0], [PERIOD, (ROWS - 1) * ROW_PITCH], (800, 2))
    found = in_browser(run / "view.html", "frame=3", f"""
        await shown(3);
        const bodyAt = ([x, y]) => pick(model, now.frame, now.shown.walls, x, y)?.body ?? -1;
        return {{ inside: {json.dumps(samples.tolist())}.map(bodyAt), out: bodyAt([-1e-8, 1e-6]),
          boxes: [...now.frame.boxes], seen: now.shown.seen.map(([body, shift]) => [body, shift / view.scale]) }};""")
    checked = 0
    for sample, grain in zip(samples, found["inside"]):
        apart = sample - centres
        apart[:, 0] -= PERIOD * np.round(apart[:, 0] / PERIOD)
        distance = np.linalg.norm(apart, axis=1) / DIAMETER
        if distance.min() < 0.42 and np.sort(distance)[1] > 0.55:
            assert grain == distance.argmin()
            checked += 1
    assert checked > 300 and found["out"] == -1
    left, right = np.array(found["boxes"]).reshape(-1, 4)[:, :2].T
    for grain in range(GRAINS):
        shifts = sorted(shift for body, shift in found["seen"] if body == grain)
        images = np.arange(-60, 2) * PERIOD
        expected = images[(left[grain] + images < PERIOD) & (right[grain] + images > 0)]
        assert shifts == pytest.approx(expected)
    assert len(found["seen"]) > GRAINS


def test_images_in_a_cell_with_two_periods(run: Path, tmp_path: Path) -> None:
    """INDEPENDENT: all images of which some place lies in the cell are there, and none further off than its size."""
    folder = Path(shutil.copytree(run, tmp_path / "cell"))
    sides = np.array([[PERIOD, 0.1 * PERIOD], [0.4 * PERIOD, 0.8 * PERIOD]])
    with h5py.File(folder / "frames.h5", "a") as file:
        for index in range(FRAMES):
            for name, side in zip("ab", sides):
                file[f"cell/{index:06}/{name}"] = side[None]
    assert view.main([str(folder)]) == 0
    assert about(folder / "view.html")["cells"] == pytest.approx(np.tile(sides.ravel(), (FRAMES, 1)))
    found = in_browser(folder / "view.html", "frame=2", """
        await shown(2);
        return { boxes: [...now.frame.boxes],
          of: Array.from({ length: model.bodies }, (_, body) => shifts(now.frame, body)) };""")
    corners = np.array([[0, 0], sides[0], sides[1], sides.sum(axis=0)])
    random, back = np.random.default_rng(4), np.linalg.inv(sides)
    images = np.array([(i, j) for i in range(-3, 4) for j in range(-3, 4)]) @ sides
    for box, given in zip(np.array(found["boxes"]).reshape(-1, 4)[:GRAINS], found["of"]):
        places = random.uniform(box[[0, 2]], box[[1, 3]], (400, 2))
        coordinates = (places[:, None] + images) @ back
        needed = images[((coordinates > 0) & (coordinates < 1)).all(axis=2).any(axis=0)]
        for shift in needed:
            assert np.abs(np.array(given) - shift).sum(axis=1).min() < 1e-9 * PERIOD
        size = max(box[1] - box[0], box[3] - box[2])
        for x, y in given:
            assert box[0] + x - size < corners[:, 0].max() and box[1] + x + size > corners[:, 0].min()
            assert box[2] + y - size < corners[:, 1].max() and box[3] + y + size > corners[:, 1].min()
    assert sum(map(len, found["of"][:GRAINS])) > GRAINS


def test_names_are_text(run: Path) -> None:
    found = in_browser(run / "view.html", "", """
        await shown(0);
        return [document.querySelector("h1").textContent, document.title, document.querySelector("dl").innerText,
          document.getElementById("bad"), document.querySelectorAll("i, b").length];""")
    assert found[:2] == [TITLE, TITLE] and found[3] is None and found[4] == 0
    assert all(part in found[2] for part in ("a1b2<i>", "0123abcd", "18.5 \u00b5s", "finished", f"{GRAINS + 2}"))
