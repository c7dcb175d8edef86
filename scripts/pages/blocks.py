"""Blocks of code in pages, and what their sources say about them.

A block is a fence with a language. Comments right above it, which no reader sees, say how it is tested:

    <!-- not run: REASON -->               the only way for a block not to be run
    <!-- run with: --until "2 ns" -->      options that a test adds to each ./pliant run, where it would take too long
    <!-- exit code: 2 -->                  of a block of commands that ends otherwise than with 0
    <!-- numbers: within 3 % -->           of a block of output; without, numbers are as they stand
    <!-- picture: results/a/grains.png --> above an image: the file that it was made from (scripts/pages/pictures.py)
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

NOTES = {"not run", "run with", "exit code", "numbers", "picture"}
FENCE = re.compile(r'(`{3,})(\w*)(?: title="([^"]*)")?$')
NOTE = re.compile(r"<!-- ([\w ]+): (.*?) -->$")
IMAGE = re.compile(r"!\[[^]]*\]\(([^)]*)\)$")


class BadPage(Exception):
    """A page that cannot be read; the message says where."""


@dataclass
class Block:
    """A fence, or an image that has notes: then of language "image", with its address as text."""

    page: Path
    line: int  # from 1
    language: str
    title: str
    text: str
    notes: dict[str, str] = field(default_factory=dict)

    @property
    def place(self) -> str:
        return f"{self.page.name}:{self.line}"


def blocks(page: Path) -> Iterator[Block]:
    lines = page.read_text().splitlines()
    notes: dict[str, str] = {}
    number = 0
    while number < len(lines):
        line, at = lines[number], number + 1
        number += 1
        if note := NOTE.match(line):
            if note[1] not in NOTES:
                raise BadPage(f"{page}:{at}: no note '{note[1]}'; there are: {', '.join(sorted(NOTES))}")
            notes[note[1]] = note[2]
        elif fence := FENCE.match(line):
            end = next((i for i in range(number, len(lines)) if lines[i] == fence[1]), None)
            if end is None:
                raise BadPage(f"{page}:{at}: the block does not end")
            yield Block(page, at, fence[2], fence[3] or "", "\n".join(lines[number:end]) + "\n", notes)
            number, notes = end + 1, {}
        elif line.startswith("```"):
            raise BadPage(f"{page}:{at}: write ```LANGUAGE or ```LANGUAGE title=\"FILE\"")
        elif line.startswith("    ") and not lines[at - 2].strip() and not _in_list(lines[:at - 2]):
            raise BadPage(f"{page}:{at}: code that is indented; between fences it has a language and is run")
        else:
            if (image := IMAGE.match(line)) and notes:
                yield Block(page, at, "image", "", image[1], notes)
            notes = {}


def _in_list(lines: list[str]) -> bool:
    """Whether the paragraph before an indented line is of a list."""
    before = next((line for line in reversed(lines) if line.strip() and not line.startswith("  ")), "")
    return bool(re.match(r"[*-] |\d+\. ", before))
