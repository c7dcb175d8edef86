"""Makes the pictures of pages again, by doing what the pages tell.

    /usr/bin/python3 scripts/pages/pictures.py docs/tutorial.md
    /usr/bin/python3 scripts/pages/pictures.py docs/gallery.md shapes      (only what makes gallery/shapes.png)

An image with a note `picture: FILE` in its page gets that file, made smaller. PLIANT_ENGINE may name the engine.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from PIL import Image

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from pages.blocks import Block, blocks
from pages.practice import Practice

WIDTH, COLOURS = 800, 64
LONGEST = 3600.0  # s, of a block


def shrink(source: Path, target: Path) -> None:
    picture = Image.open(source).convert("RGB")
    width = min(WIDTH, picture.width)
    picture = picture.resize((width, round(picture.height * width / picture.width)), Image.Resampling.LANCZOS)
    target.parent.mkdir(parents=True, exist_ok=True)
    picture.quantize(COLOURS, dither=Image.Dither.NONE).save(target, optimize=True)


def wanted(page: Path, names: list[str]) -> Iterator[Block]:
    """All blocks; with names only those between the image before and the named ones."""
    section: list[Block] = []
    for block in blocks(page):
        section.append(block)
        if block.language == "image":
            if not names or Path(block.text).stem in names:
                yield from section
            section = []


def main(arguments: list[str]) -> None:
    parser = argparse.ArgumentParser(description="Makes the pictures of a page again.")
    parser.add_argument("page", type=Path)
    parser.add_argument("names", nargs="*", help="of pictures, without .png: only what is right before each")
    options = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as folder:
        practice = Practice(Path(folder), LONGEST)
        for block in wanted(options.page, options.names):
            block.notes.pop("run with", None)
            if block.language == "image":
                target = options.page.parent / block.text
                shrink(practice.folder / block.notes["picture"], target)
                print(target, f"{target.stat().st_size / 1000:.0f} kB")
            elif block.language != "text":
                practice.do(block)


if __name__ == "__main__":
    main(sys.argv[1:])
