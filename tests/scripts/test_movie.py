"""scripts/movie.py: films decoded again, pixel by pixel against what the run holds; errors; nothing half written."""

import io
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import h5py
import matplotlib
import numpy as np
import pytest

import movie
import synthetic_run
from moving_discs import (COMPLIANT, END, FRAMES, NEUTRAL, PERIOD, RADIUS, RIGID, WHITE, centres, decoded, described,
                          has, near, panels, times, write_run)
from plots import encoder, fields

ROOT = Path(__file__).resolve().parents[2]
WINDOW = (2e-6, 14e-6, -2e-6, 4e-6)


@pytest.fixture(scope="module")
def discs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_run(tmp_path_factory.mktemp("run"))


def film(folder: Path, out: Path, *options: object) -> Path:
    assert movie.main([str(folder), "--out", str(out), "--width", "400", *map(str, options)]) == 0
    return out


def code_of(*arguments: object) -> int:
    """Also of what argparse refuses."""
    try:
        return movie.main([str(argument) for argument in arguments])
    except SystemExit as error:
        return int(error.code)


def test_number_and_size_of_frames(discs: Path, tmp_path: Path) -> None:
    """EXACT."""
    stream = described(film(discs, tmp_path / "a.mp4", "--times", "1e-6", "4 us", "--fps", 7, "--width", 401))
    assert (stream["codec_name"], stream["pix_fmt"], stream["r_frame_rate"]) == ("h264", "yuv420p", "7/1")
    assert int(stream["nb_read_frames"]) == 4 and stream["width"] == 400 and stream["height"] % 2 == 0
    assert [file.name for file in tmp_path.iterdir()] == ["a.mp4"]


def test_bodies_have_their_colours_where_they_are(discs: Path, tmp_path: Path) -> None:
    """EXACT: each body at its centre in each frame, in a window that reaches over the edge of the period, so that body
    0 is in it wherever it is, and once more a period before."""
    pictures = decoded(film(discs, tmp_path / "a.mp4", "--window", *WINDOW, "--curve", "none"))
    panel, = panels(pictures[1])
    for picture, moment in zip(pictures, times()):
        (x, y), (other_x, other_y) = centres(moment)
        before = x - 1e-6  # its place in the last frame
        places = [(x, y, COMPLIANT), (before, y, WHITE), (other_x, other_y, RIGID), (other_x, other_y - 1.2e-6, WHITE)]
        if x - 10e-6 > WINDOW[0] + 0.1e-6:
            places.append((x - 10e-6, y, COMPLIANT))
        for *place, colour in places:
            assert has(picture, panel.pixel(*place, WINDOW), colour), (moment, place)


def test_one_layout_for_all_frames(discs: Path, tmp_path: Path) -> None:
    """EXACT: nothing but the insides of the two panels, where the mark is, and the clock changes."""
    pictures = decoded(film(discs, tmp_path / "a.mp4"))
    first = panels(pictures[1])
    assert len(first) == 2 and all(panels(picture) == first for picture in pictures[1:-1])
    changes = np.ptp(pictures, axis=0).max(axis=2) > 100
    assert changes[first[0].inside].any() and changes[first[1].inside].any()
    for panel in first:
        changes[panel.top - 4 : panel.bottom + 5, panel.left - 4 : panel.right + 5] = False
    rows, columns = np.nonzero(changes)
    assert len(rows) and rows.max() < first[0].top and columns.min() > 0.75 * pictures.shape[2]


def test_a_followed_body_stays_in_the_middle_and_whole(discs: Path, tmp_path: Path) -> None:
    """EXACT: over the edge of the period too; what it passes moves the other way."""
    pictures = decoded(film(discs, tmp_path / "a.mp4", "--follow", 0))
    panel, sizes = panels(pictures[1])[0], []
    box = (-10 * RADIUS, 10 * RADIUS, -10 * RADIUS / 1.6, 10 * RADIUS / 1.6)  # ten diameters wide
    for picture, moment in zip(pictures, times()):
        rows, columns = np.nonzero(near(picture[panel.inside], COMPLIANT))
        sizes.append(len(rows))
        assert rows.mean() + panel.top + 2 == pytest.approx(0.5 * (panel.top + panel.bottom), abs=1)
        assert columns.mean() + panel.left + 2 == pytest.approx(0.5 * (panel.left + panel.right), abs=1)
        x, y = centres(moment)[1] - centres(moment)[0]
        x = (x + 0.5 * PERIOD) % PERIOD - 0.5 * PERIOD
        seen = [x] if abs(x) < 4.5e-6 else [-4.7e-6, 4.7e-6]  # half of it at either side
        assert all(has(picture, panel.pixel(at, y, box), RIGID) for at in seen), moment
    assert max(sizes) < 1.05 * min(sizes)
    radius = RADIUS / (box[1] - box[0]) * (panel.right - panel.left) - 1.5  # but for its outline
    assert sizes[0] == pytest.approx(np.pi * radius**2, rel=0.1)
    assert (pictures[2][:, :, 2] > pictures[2][:, :, 0] + 60)[panel.inside].sum() > 50, "the outline is marked"


@pytest.mark.parametrize("options, together", [(["--window", "6e-6", "14e-6", "-2e-6", "1e-6"], False), ([], True)])
def test_the_shear_is_followed(tmp_path: Path, options: list[str], together: bool) -> None:
    """EXACT: a window goes along with the grains that it shows and no others, the whole with all of them."""
    write_run(tmp_path / "run", together)
    middles = []
    for name, more in (("still.mp4", []), ("moving.mp4", ["--follow-shear"])):
        pictures = decoded(film(tmp_path / "run", tmp_path / name, *options, *more))
        inside = panels(pictures[1])[0].inside
        middles.append([np.nonzero(near(picture[inside], COMPLIANT))[1].mean() for picture in pictures])
    assert np.ptp(middles[0]) > 40 and np.ptp(middles[1]) < 0.5


def test_one_scale_for_the_whole_film(discs: Path, tmp_path: Path) -> None:
    """INDEPENDENT: the stress of frame k is k fifths of the largest; rigid bodies, which have none, are grey."""
    pictures = decoded(film(discs, tmp_path / "a.mp4", "--window", *WINDOW, "--field", "von_mises"))
    panel = panels(pictures[1])[0]
    for index, moment in enumerate(times()):
        expected = 255 * np.array(matplotlib.colormaps["inferno"](index / (FRAMES - 1))[:3])
        body, other = centres(moment)
        assert has(pictures[index], panel.pixel(*body, WINDOW), expected), index
        assert has(pictures[index], panel.pixel(*other, WINDOW), NEUTRAL)


def test_vectors_are_shown_by_their_norm(discs: Path, tmp_path: Path) -> None:
    """INDEPENDENT: 3 and -4 m/s a frame on both bodies, 15 m/s of 25 in frame 3."""
    pictures = decoded(film(discs, tmp_path / "a.mp4", "--window", *WINDOW, "--field", "velocity"))
    panel, expected = panels(pictures[1])[0], 255 * np.array(matplotlib.colormaps["cividis"](0.6)[:3])
    assert all(has(pictures[3], panel.pixel(*body, WINDOW), expected) for body in centres(times()[3]))


def test_fields_along_outlines(discs: Path, tmp_path: Path) -> None:
    """EXACT: shear is positive on the upper halves, red, negative on the lower ones, blue; none in the first frame."""
    options = ["--window", 7e-6, 11e-6, -1e-6, 1e-6, "--field", "contact_shear"]
    pictures = decoded(film(discs, tmp_path / "a.mp4", *options))
    panel = panels(pictures[1])[0]
    first, second = (picture[panel.inside] for picture in pictures[:2])
    assert not (np.ptp(first, axis=2) > 60).any() and (first.sum(axis=2) < 330).sum() > 50, "a dark outline"
    redder = second[:, :, 0] - second[:, :, 2]
    upper, lower = redder[: len(redder) // 2 - 2], redder[len(redder) // 2 + 2 :]
    assert (upper > 60).sum() > 50 and (lower < -60).sum() > 50 and upper.min() > -60 and lower.max() < 60


@pytest.mark.parametrize("options, height", [(["--curve", "way.position_x"], lambda share: 0.05 + 0.9 * share),
                                             ([], lambda share: 0.5)])
def test_the_mark_goes_along_the_curve(discs: Path, tmp_path: Path, options: list[str],
                                       height: Callable[[float], float]) -> None:
    """EXACT: at the time of each frame; its dot on a curve that rises from corner to corner but for matplotlib's
    margins, and without a word on the friction factor, a constant."""
    pictures = decoded(film(discs, tmp_path / "a.mp4", *options, "--width", 1280))
    panel = panels(pictures[1])[1]
    for picture, moment in list(zip(pictures, times()))[1:-1]:
        below = picture[panel.inside]
        marked = below[:, :, 0] > below[:, :, 2] + 60
        column = panel.left + moment / END * (panel.right - panel.left)
        assert np.nonzero(marked)[1].mean() + panel.left + 2 == pytest.approx(column, abs=1.5)
        dot = np.nonzero(marked.sum(axis=1) >= 6)[0].mean() + panel.top + 2
        assert dot == pytest.approx(panel.bottom + height(moment / END) * (panel.top - panel.bottom), abs=2)


def test_without_friction_there_is_no_curve(discs: Path, tmp_path: Path) -> None:
    run = write_run(tmp_path / "run")
    (run / "probes.csv").unlink()
    assert len(panels(decoded(film(run, tmp_path / "a.mp4"))[1])) == 1


def test_a_gif_is_small(tmp_path: Path, capsys: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch) -> None:
    """EXACT: all frames, 640 wide; where they would be too large every second alone, in the same time."""
    synthetic_run.write_frames(tmp_path, columns=6, rows=4, rings=2, frames=26)
    assert movie.main([str(tmp_path), "--out", str(tmp_path / "a.gif")]) == 0
    whole = described(tmp_path / "a.gif")
    assert (whole["codec_name"], whole["width"], int(whole["nb_read_frames"])) == ("gif", 640, 26)
    size = (tmp_path / "a.gif").stat().st_size
    monkeypatch.setattr(encoder, "LARGEST_GIF", size // 2)
    assert movie.main([str(tmp_path), "--out", str(tmp_path / "b.gif")]) == 0
    part = described(tmp_path / "b.gif")
    every = int(re.search(r"one frame in (\d)\)", capsys.readouterr().out)[1])
    assert every == 2 and int(part["nb_read_frames"]) == 13 and (tmp_path / "b.gif").stat().st_size < 0.7 * size
    assert float(part["duration"]) == pytest.approx(float(whole["duration"]), abs=0.21), "a frame at 5 a second"
    assert {file.suffix for file in tmp_path.iterdir()} == {".h5", ".gif"}


@pytest.mark.parametrize("options, told", [
    (["--field", "von_mise"], "no field 'von_mise' in the frames; did you mean 'von_mises'? There are: kinds, vel"),
    (["--curve", "drag.friction"], "did you mean 'drag.friction_factor'? There are: way.position_x, drag"),
    (["--follow", "2"], "no body 2; there are 0 to 1"), (["--follow", "-1"], "no body -1"),
    (["--window", "0", "1e-6", "3e-6", "4e-6"], "grains and walls are in y -5e-07 to 2.5e-06 m"),
    (["--window", "1e-6", "0", "0", "1e-6"], "X0 must be less than X1"),
    (["--window", "0", "1", "0", "9 um"], "8 times"), (["--window", "0", "nan", "0", "1"], "'nan' is neither"),
    (["--window", "0", "1 s", "0", "1"], "'1 s' is neither a number (m) nor one with a unit"),
    (["--times", "6e-6", "7e-6"], "the run has 6 from 0 s to 5e-06 s"),
    (["--times", "2 us", "1 us"], "FROM must be less than TO"), (["--times", "1 us", "1.5 us"], "1 would be in it"),
    (["--fps", "0"], "'0' is no whole number from 1 to 60"), (["--width", "100000"], "from 320 to 4096"),
    (["--follow", "1", "--window", "0", "1", "0", "1"], "not allowed with"),
    (["--follow", "1", "--follow-shear"], "not allowed with")])
def test_bad_input(discs: Path, capsys: pytest.CaptureFixture, options: list[str], told: str) -> None:
    """EXACT: what, where, what there is; exit code 2 and no file."""
    before = sorted(discs.iterdir())
    assert code_of(discs, *options) == 2
    assert told in capsys.readouterr().err and sorted(discs.iterdir()) == before


@pytest.mark.parametrize("out", ["a.avi", "a", "a.MP4"])
def test_other_formats_are_bad_input(discs: Path, capsys: pytest.CaptureFixture, out: str) -> None:
    assert code_of(discs, "--out", out) == 2 and "must end with .mp4 or .gif" in capsys.readouterr().err


@pytest.mark.parametrize("frames, told", [(None, "[frames]"), (0, "[frames]"), (1, "1 would be in it")])
def test_runs_with_too_few_frames(tmp_path: Path, capsys: pytest.CaptureFixture, frames: int | None, told: str) -> None:
    run = write_run(tmp_path / "run")
    if frames is None:
        (run / "frames.h5").unlink()
    else:
        with h5py.File(run / "frames.h5", "a") as file:
            del file["times"]
            file["times"] = times()[:frames]
    assert code_of(run) == 2 and told in capsys.readouterr().err
    assert code_of(tmp_path / "nowhere") == 2 and "no such folder" in capsys.readouterr().err


def stub_encoder(folder: Path, body: str) -> str:
    """A PATH where ffmpeg is this."""
    folder.mkdir()
    (folder / "ffmpeg").write_text(f'#!/bin/bash\nout=${{!#}}\n{body}\n')
    (folder / "ffmpeg").chmod(0o755)
    return f"{folder}:{os.environ['PATH']}"


@pytest.mark.parametrize("name, body, told", [
    ("a.mp4", "head -c 1000 >$out; echo No space left >&2; exit 1", "No space left"),
    ("a.mp4", "cat >$out; echo cut off >&2; exit 1", "cut off"),
    ("a.mp4", "head -c 99999 >$out; kill -9 $$", "ended with -9"),
    ("a.gif", "touch $out; [[ $* != *pipe* ]] || cat >$out; [[ $* != *paletteuse* ]] || { echo big; exit 1; }", "big"),
    ("a.mp4", None, "install Debian's package ffmpeg")])
def test_a_film_that_fails_leaves_the_old_one(discs: Path, tmp_path: Path, capsys: pytest.CaptureFixture,
                                              monkeypatch: pytest.MonkeyPatch, name: str, body: str | None,
                                              told: str) -> None:
    """EXACT, whenever the encoder ends."""
    monkeypatch.setenv("PATH", stub_encoder(tmp_path / "bin", body) if body else "")
    out = tmp_path / "films" / name
    out.parent.mkdir()
    out.write_text("old")
    assert code_of(discs, "--width", 400, "--out", out) == (4 if body else 1)
    error = capsys.readouterr().err
    assert told in error and (str(out) in error or not body)
    assert [file.name for file in out.parent.iterdir()] == [name] and out.read_text() == "old"


def test_a_full_disk(discs: Path, tmp_path: Path) -> None:
    """EXACT, with the real encoder, which may write no more than some bytes."""
    command = ["prlimit", "--fsize=2000", sys.executable, "-B", ROOT / "scripts/movie.py", discs, "--out", "a.mp4"]
    result = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert result.returncode == 4 and "a.mp4: the film cannot be written" in result.stderr
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("out", ["nowhere/a.mp4", "folder.mp4"])
def test_an_unwritable_place(discs: Path, tmp_path: Path, capsys: pytest.CaptureFixture, out: str) -> None:
    (tmp_path / "folder.mp4").mkdir()
    assert code_of(discs, "--out", tmp_path / out) == 4 and "cannot be written" in capsys.readouterr().err
    assert [file.name for file in tmp_path.rglob("*")] == ["folder.mp4"]


@pytest.mark.parametrize("stop, code", [(signal.SIGTERM, 143), (signal.SIGINT, 130)])
def test_a_film_that_is_stopped_leaves_nothing(discs: Path, tmp_path: Path, stop: signal.Signals, code: int) -> None:
    """EXACT; the encoder ends with it."""
    pid = tmp_path / "pid"
    path = stub_encoder(tmp_path / "bin", f"echo $$ >{pid}.part; mv {pid}.part {pid}; exec sleep 60")
    (tmp_path / "films").mkdir()
    command = [sys.executable, "-B", ROOT / "scripts/movie.py", discs, "--out", tmp_path / "films/a.mp4"]
    process = subprocess.Popen(command, env={**os.environ, "PATH": path}, stderr=subprocess.PIPE, text=True)
    while not pid.exists():
        time.sleep(0.02)
    process.send_signal(stop)
    _, errors = process.communicate(timeout=30)
    assert process.returncode == code and "Traceback" not in errors and not list((tmp_path / "films").iterdir())
    with pytest.raises(ProcessLookupError):
        os.kill(int(pid.read_text()), 0)


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_progress_is_for_terminals(discs: Path, tmp_path: Path, capsys: pytest.CaptureFixture,
                                   monkeypatch: pytest.MonkeyPatch) -> None:
    """EXACT: elsewhere a line at the start and one at the end."""
    out = film(discs, tmp_path / "a.mp4")
    told = capsys.readouterr()
    assert re.fullmatch(rf"grains: 6 frames of 400 x \d+ pixels, 1.2 s\n{out} \(0.0\d+ MB\)\n", told.out)
    assert not told.err
    monkeypatch.setattr(sys, "stderr", Terminal())
    film(discs, out)
    assert re.search(r"frame 6 of 6, 0 s left\S*\r\S*$", sys.stderr.getvalue())


def test_units_are_those_of_the_table() -> None:
    """EXACT: docs/probes.md lists the fields of frames with their units."""
    text = (ROOT / "docs/probes.md").read_text()
    rows = re.findall(r"^\| `(\w+)` \| (\S+) \| (?:bodies|outlines) \|", text, re.MULTILINE)
    assert len(rows) > 20
    assert {name: unit for name, unit in rows if unit != "-"} == fields.UNITS
