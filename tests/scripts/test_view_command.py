"""scripts/view.py: what is chosen and refused, files, sizes and scales. All EXACT."""

from __future__ import annotations

import base64
import re
import resource
import zlib
from pathlib import Path

import h5py
import numpy as np
import pytest

from viewed_run import GRAINS, ROOT, about, write_viewed_run

import view
from pliant.frames import Frames
from synthetic_run import DIAMETER, write_run
from viewing.fields import LOOKS, Spread
from viewing.page import BEYOND, thinned


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_viewed_run(tmp_path_factory.mktemp("run"))


def test_the_page_needs_no_other_file(run: Path) -> None:
    text = (run / "view.html").read_text()
    assert "default-src 'none'" in text
    written = re.sub(r'<script type="text/plain".*', "", text)
    assert not re.search(r"https?:|\bsrc=|\bhref=|@import|url\(|fetch\(|\bimport\b", written)
    assert text.count("<script") == text.count("</script>")


def test_size_of_200_grains(tmp_path: Path) -> None:
    """40 frames of 200 grains of 169 nodes, all compliant. Positions and fields are pure noise, which nothing packs:
    half of the 30 MB that such a run may have."""
    write_run(tmp_path, 10, 20, 7, 40)
    random = np.random.default_rng(4)
    with h5py.File(tmp_path / "frames.h5", "a") as file:
        for grid in ("bodies", "outlines"):
            file[f"{grid}/kind"][...] = np.where(file[f"{grid}/kind"][()] == 1, 0, file[f"{grid}/kind"][()])
        for frame in file["bodies"].values():
            if isinstance(frame, h5py.Group):
                place = frame["position"][()]
                frame["position"][...] = place + random.normal(0, 0.02 * DIAMETER, place.shape)
                frame["velocity"][:, :2] = random.normal(0, 10, (len(frame["velocity"]), 2))
                frame["von_mises"][...] = random.exponential(1e8, frame["von_mises"].shape)
    assert view.main([str(tmp_path)]) == 0
    assert 5e6 < (tmp_path / "view.html").stat().st_size < 15e6


def chunk(page: Path, name: str) -> bytes:
    return zlib.decompress(base64.b64decode(re.search(rf'id="chunk-{name}">([^<]*)<', page.read_text())[1]))


def test_frames_and_fields_are_chosen(run: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    times = Frames(run / "frames.h5", None).times
    out = tmp_path / "a.html"
    for options, frames in [(["--every", "2"], [0, 2]), (["--times", repr(times[1]), "1"], [1, 2, 3]),
                            (["--times", "0", repr(times[2]), "--every", "2"], [0, 2])]:
        assert view.main([str(run), "--fields", "velocity", "von_mises", "--out", str(out), *options]) == 0
        data = about(out)
        assert data["frames"] == frames and data["times"] == [times[index] for index in frames]
        assert [field["name"] for field in data["fields"]] == ["velocity", "von_mises"]
        assert f"{len(frames)} frames of {GRAINS + 2} bodies: kind, velocity, von_mises" in capsys.readouterr().out
        assert chunk(out, f"von_mises-{len(frames) - 1}") and f"von_mises-{len(frames)}" not in out.read_text()


@pytest.mark.parametrize("options, said", [
    (["--fields", "von_mise"], "did you mean 'von_mises'?"), (["--fields", "velocity", "x"], "there are: velocity"),
    (["--times", "1", "2"], "no frame between 1 and 2 s"), (["--times", "2e-6", "1e-6"], "the earlier one"),
    (["--times", "nan", "1"], "the earlier one")])
def test_what_is_not_there(run: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], options: list[str],
                           said: str) -> None:
    assert view.main([str(run), "--out", str(tmp_path / "a.html"), *options]) == 2
    assert said in capsys.readouterr().err and not list(tmp_path.iterdir())


@pytest.mark.parametrize("options", [["--every", "0"], ["--every", "-1"], ["--every", "1.5"], ["--times", "1"],
                                     ["--fields"]], ids=" ".join)
def test_bad_options(run: Path, options: list[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        view.main([str(run), *options])
    assert stop.value.code == 2


def test_bad_folders(run: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert view.main([str(tmp_path / "none")]) == 2
    (tmp_path / "probes.csv").write_text("time [s],a\n1,2\n")
    assert view.main([str(tmp_path)]) == 2 and "no frame" in capsys.readouterr().err
    (tmp_path / "frames.h5").write_bytes((run / "frames.h5").read_bytes())
    with h5py.File(tmp_path / "frames.h5", "a") as file:
        del file["bodies/000003/von_mises"]
    assert view.main([str(tmp_path)]) == 2 and "frame 3 of 'bodies' has no von_mises" in capsys.readouterr().err
    assert {file.name for file in tmp_path.iterdir()} == {"probes.csv", "frames.h5"}


def test_a_page_that_cannot_be_written(run: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A full disk, as a limit on the size of files: the page of before stays, and nothing else."""
    assert view.main([str(run), "--out", str(tmp_path / "none/a.html")]) == 4
    page = tmp_path / "a.html"
    page.write_text("before")
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (20000, limits[1]))
    try:
        assert view.main([str(run), "--out", str(page)]) == 4
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert "a.html: cannot be written" in capsys.readouterr().err
    assert [(file.name, file.read_text()) for file in tmp_path.iterdir()] == [("a.html", "before")]


def test_the_table_of_fields_is_that_of_the_engine() -> None:
    """As docs/probes.md has it, which a unit test compares with the code."""
    text = (ROOT / "docs/probes.md").read_text()
    rows = re.findall(r"^\| `(\w+)` \| (\S+) \| (bodies|outlines) \| (points|cells)", text, re.MULTILINE)
    assert {name: (unit, grid, at) for name, unit, grid, at in rows} == {
        name: (look.unit, look.grid, "cells" if look.at == "cells" else "points") for name, look in LOOKS.items()}


def test_colours_of_all_fields_have_ends() -> None:
    assert {look.colours for look in LOOKS.values()} <= BEYOND.keys(), "EXACT"


@pytest.mark.parametrize("low, high, sides", [(0, 1, (0, 1)), (-1, 1, (-1, 1)), (-1, 0, (-1, 0)), (-0.01, 1, (0, 1))])
def test_scales(low: float, high: float, sides: tuple[float, float]) -> None:
    """Evenly spread values all stay inside: their end is near. A side with next to nothing on it has no place."""
    values = np.linspace(low, high, 100001) * 3.21e7
    spread = Spread(0.0)
    for part in np.array_split(values, 7):
        spread.add(part)
    scale = spread.scale(LOOKS["pressure"])
    assert (scale.least, scale.largest) == (values.min(), values.max())
    assert [scale.low, scale.high] == pytest.approx([side * 3.3e7 for side in sides])


def test_scales_leave_few_extremes_out() -> None:
    values = -1e7 * np.log(np.linspace(1, 0, 100001)[:-1])
    spread = Spread(0.0)
    spread.add(values)
    scale = spread.scale(LOOKS["von_mises"])
    assert -1e7 * np.log(0.005) <= scale.high <= 5.4e7 * (1 + 1e-9) and scale.largest == values[-1]


def test_long_curves_keep_their_extremes_and_the_frames() -> None:
    time = np.linspace(0, 1, 100001)
    values = np.sin(1e4 * time)
    values[[33333, 66666]] = 7, -7
    rows = thinned(time, values, np.array([0.123456]))
    assert len(rows) < 4000 and {0, 33333, 66666, 12346, 100000} <= set(rows.tolist()) and (np.diff(rows) > 0).all()
