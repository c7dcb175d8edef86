"""A made-up run with a field of every kind, its page, and a browser that shows it."""

from __future__ import annotations

import html
import json
import re
from pathlib import Path
from typing import Any

import h5py
import numpy as np

import view
from browser import dumped
from synthetic_run import DIAMETER, PITCH, write_run

ROOT = Path(__file__).resolve().parents[2]

COLUMNS, ROWS, RINGS, FRAMES = 6, 4, 3, 4
GRAINS, PERIOD = COLUMNS * ROWS, COLUMNS * PITCH
TITLE = '</script><b id="bad">&amp; "Kugeln" {{ 7 * 7 }}'


def moved(start: np.ndarray, rigid: np.ndarray, index: int, random: np.random.Generator) -> np.ndarray:
    """All grains go on by 0.3 periods a frame and turn, each at its rate; compliant ones are ragged too."""
    grains = start.reshape(GRAINS, -1, 2)
    centres = grains.mean(axis=1, keepdims=True)
    turn = np.exp(1j * index * (np.arange(GRAINS) % 5 - 2.2))[:, None]
    arms = turn * ((grains - centres) @ (1, 1j))
    place = centres + [0.3 * PERIOD * index, 0.0] + np.stack([arms.real, arms.imag], axis=2)
    return (place + ~rigid[:, None, None] * random.normal(0, 0.004 * DIAMETER, place.shape)).reshape(-1, 2)


def add_fields(folder: Path) -> None:
    """Of every kind: on both sides of zero, along outlines, with gaps, in whole numbers, written once."""
    random = np.random.default_rng(3)
    with h5py.File(folder / "frames.h5", "a") as file:
        cells, points = len(file["bodies/cells"]), len(file["outlines/000000/position"])
        file["bodies/material"] = random.integers(0, 3, cells).astype("f4")
        start = file["bodies/000000/position"][()].astype(float)
        rigid = file["bodies/kind"][()].reshape(GRAINS, -1)[:, 0] == 1
        for index in range(FRAMES):
            bodies, outlines = file[f"bodies/{index:06}"], file[f"outlines/{index:06}"]
            bodies["position"][...] = moved(start, rigid, index, random)
            rings = bodies["position"][()].reshape(GRAINS, -1, 2)[:, -6 * RINGS:]
            outlines["position"][: GRAINS * 6 * RINGS] = rings.reshape(-1, 2)
            bodies["pressure"] = random.normal(0, 2e8, cells).astype("f4")
            bodies["contact_count"] = random.integers(0, 7, cells).astype("f4")
            pressure = np.where(random.random(points) < 0.5, 0, random.exponential(3e8, points))
            if index == 1:
                pressure[5:9] = 5e9
            outlines["contact_pressure"] = pressure.astype("f4")
            outlines["contact_gap"] = np.where(pressure > 0, -1e-9 * random.random(points), np.nan).astype("f4")
            outlines["bond_damage"] = np.where(np.arange(points) % 3, np.nan, index / 3).astype("f4")


def write_viewed_run(folder: Path) -> Path:
    """The folder, with view.html in it."""
    write_run(folder, COLUMNS, ROWS, RINGS, FRAMES)
    add_fields(folder)
    scene = (folder / "scene.toml").read_text()
    (folder / "scene.toml").write_text(scene.replace('title = "Synthetic"', f"title = '{TITLE}'"))
    (folder / "summary.json").write_text(json.dumps({"status": "finished", "time": 1.85e-5, "state_hash": "a1b2<i>",
                                                     "commit": "0123abcd"}))
    assert view.main([str(folder)]) == 0
    return folder


def about(page: Path) -> dict[str, Any]:
    return json.loads(re.search(r'id="about">(.*?)</script>', page.read_text())[1])


def field_of(page: Path, name: str) -> dict[str, Any]:
    return next(field for field in about(page)["fields"] if field["name"] == name)


_PRELUDE = """
const until = async (test) => { while (!test()) await new Promise((done) => setTimeout(done, 10)); };
const shown = (index) => until(() => document.body.dataset.shown === `${index}`);
const tip = () => byId("tip").innerText;
const at = (x, y) => [Math.floor(view.px(x)), Math.floor(view.py(y))];
const colour = (x, y) => [...picture.getContext("2d").getImageData(...at(x, y), 1, 1).data];
const press = (key) => document.body.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
const pointer = (kind, x, y, more = {}) => overlay.dispatchEvent(
  new PointerEvent(`pointer${kind}`, { clientX: x, clientY: y, pointerId: 1, bubbles: true, ...more }));
overlay.setPointerCapture = curve.setPointerCapture = () => {};  // there is no real pointer
"""


def in_browser(page: Path, address: str, script: str) -> Any:
    """What the script returns, on a copy of the page."""
    script = f"""{_PRELUDE}(async () => {{ {script} }})().catch((error) => error.stack)
        .then((found) => {{ byId("result").textContent = JSON.stringify(found); }});"""
    copy = page.with_name("copy.html")
    added = f"<pre id='result' hidden></pre><script>{script}</script></body>"
    copy.write_text(page.read_text().replace("</body>", added))
    found = re.search(r'<pre id="result" hidden="">(.*?)</pre>', dumped(f"{copy.as_uri()}#{address}"), re.DOTALL)[1]
    assert found, "the page did not get so far"
    return json.loads(html.unescape(found))
