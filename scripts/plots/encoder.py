"""Films from frames, by ffmpeg. What is not whole never has the film's name."""

import contextlib
import subprocess
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import IO

LARGEST_GIF = 3_000_000  # bytes, about: more keeps a page waiting
_FEWEST_FRAMES = 12  # of a GIF
_FFMPEG = ["ffmpeg", "-hide_banner", "-loglevel", "error", "-y"]
# Colours are numbers here: they are kept more exactly than films of other things keep them.
_H264 = ["-vf", "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p", "-colorspace", "bt709", "-color_primaries",
         "bt709", "-color_trc", "bt709", "-c:v", "libx264", "-crf", "16", "-x264-params", "chroma-qp-offset=-6",
         "-movflags", "+faststart", "-f", "mp4"]
_LOSSLESS = ["-c:v", "libx264rgb", "-qp", "0", "-preset", "ultrafast", "-f", "matroska"]


class EncoderFailed(Exception):
    """ffmpeg could not go on; the message is its own."""


def write_film(out: Path, frames: Iterable[bytes], count: int, size: tuple[int, int], rate: float) -> int:
    """Whole or not at all. Returns which share of the frames it has, as one in so many: a GIF is kept small."""
    with tempfile.TemporaryDirectory(dir=out.parent, prefix=f"{out.name}.", suffix=".tmp") as folder:
        unfinished, every = Path(folder) / out.name, 1
        if out.suffix == ".gif":
            lossless = Path(folder) / "frames.mkv"
            _encode(frames, size, rate, [*_LOSSLESS, lossless])
            every = _write_gif(lossless, unfinished, count)
        else:
            _encode(frames, size, rate, [*_H264, unfinished])
        unfinished.replace(out)
    return every


def _encode(frames: Iterable[bytes], size: tuple[int, int], rate: float, output: list[str | Path]) -> None:
    raw = ["-f", "rawvideo", "-pix_fmt", "rgb0", "-video_size", f"{size[0]}x{size[1]}", "-framerate", f"{rate:g}"]
    with tempfile.TemporaryFile() as log:
        # In a group of its own: Ctrl-C is for who started it, which then ends it.
        command = [*_FFMPEG, *raw, "-i", "pipe:0", *output]
        encoder = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=log, stderr=log, process_group=0)
        try:
            with contextlib.suppress(BrokenPipeError):  # it ended early; its code tells
                for frame in frames:
                    encoder.stdin.write(frame)
            with contextlib.suppress(BrokenPipeError):
                encoder.stdin.close()
            _check(encoder.wait(), log)
        finally:
            encoder.kill()
            encoder.wait()


def _check(code: int, log: IO[bytes]) -> None:
    if code != 0:
        log.seek(0)
        said = log.read().decode(errors="replace").strip().splitlines()
        raise EncoderFailed(said[0] if said else f"ended with {code}")


def _write_gif(lossless: Path, out: Path, count: int) -> int:
    """One palette for all frames; every second, third, ... of them alone where all would make too large a file."""
    palette = out.with_name("palette.png")
    _call("-i", lossless, "-vf", "palettegen=max_colors=128", palette)
    every = 1
    while True:
        chosen = f"[0:v]select='not(mod(n,{every}))'[x];[x][1:v]paletteuse=dither=none:diff_mode=rectangle"
        timing = ["-vsync", "passthrough", "-final_delay", "100"]  # the last frame stays for a second
        _call("-i", lossless, "-i", palette, "-lavfi", chosen, *timing, "-f", "gif", out)
        size = out.stat().st_size
        if size <= LARGEST_GIF or count // (every + 1) < _FEWEST_FRAMES:
            return every
        every = min(max(every + 1, every * size // LARGEST_GIF), count // _FEWEST_FRAMES)


def _call(*arguments: str | Path) -> None:
    with tempfile.TemporaryFile() as log:
        command = [*_FFMPEG, "-nostdin", *arguments]
        _check(subprocess.run(command, stdout=log, stderr=log, check=False, process_group=0).returncode, log)
