"""Does what a page tells its reader to do, in order, in a folder like a fresh checkout, and compares what comes out."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import tomllib
from pathlib import Path

from pages.blocks import Block

ROOT = Path(__file__).resolve().parents[2]
LINKED = ("pliant", "cases", "studies", "verify", "python", "scripts", "docs", "packages.txt")
AT_THE_END = ", at the end"  # of a title: the block is added to the file
PROGRESS = re.compile(r"t = .* \| dt .*")  # lines that come and go with the speed of a machine
NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?"
LONGEST = 600.0  # s, of a block


class Wrong(Exception):
    """What a page says is not what happens."""


class Practice:
    """The work of one reader of one page."""

    def __init__(self, folder: Path, longest: float = LONGEST) -> None:
        self.folder, self.longest = folder, longest
        self.output: str | None = None  # of the last commands, until it is compared
        self.shortened = False  # whether some run was: what it draws may be missing
        for name in LINKED:
            (folder / name).symlink_to(ROOT / name)

    def do(self, block: Block) -> None:
        """Throws Wrong."""
        try:
            self._do(block)
        except Wrong as error:
            raise Wrong(f"{block.place}: {error}") from None

    def _do(self, block: Block) -> None:
        reason = block.notes.get("not run")
        if block.language == "toml" and (reason is None or reason.startswith("a part of")):
            _parse(block.text)
        if reason is not None:
            return
        if block.language == "image":
            self._look(block)
        elif block.language == "diff":
            self._change(block)
        elif block.title:
            self._write(block)
        elif block.language == "sh":
            self.shortened |= "run with" in block.notes
            self._call(["bash", "-euo", "pipefail", "-c", _shortened(block)], int(block.notes.get("exit code", 0)))
        elif block.language == "python":
            self._call([sys.executable, "-"], 0, block.text)
        elif block.language == "text" and self.output is not None:
            compare(block.text, self.output, _tolerance(block))
            self.output = None
        else:
            raise Wrong('a block that is neither a file (title="FILE"), nor commands (sh, python), nor what they print '
                        "(text): say why it is not run")

    def _write(self, block: Block) -> None:
        file = self.folder / block.title.removesuffix(AT_THE_END)
        added = block.title.endswith(AT_THE_END)
        if added and not file.exists():
            raise Wrong(f"{file.name}, to be added to, is not there")
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(f"{file.read_text()}\n{block.text}" if added else block.text)

    def _change(self, block: Block) -> None:
        file = self.folder / block.title
        lines = block.text.splitlines(keepends=True)
        before = "".join(line[1:].removeprefix(" ") for line in lines if line[0] in "- ")
        after = "".join(line[1:].removeprefix(" ") for line in lines if line[0] in "+ ")
        text = file.read_text()
        if text.count(before) != 1:
            raise Wrong(f"{file.name} has {text.count(before)} times what is to be changed:\n{before}")
        file.write_text(text.replace(before, after))

    def _call(self, command: list[str], code: int, given: str = "") -> None:
        environment = {"OMP_WAIT_POLICY": "passive", **os.environ, "PYTHONPATH": str(ROOT / "python"),
                       "PYTHONDONTWRITEBYTECODE": "1"}
        process = subprocess.Popen(command, cwd=self.folder, env=environment, text=True, start_new_session=True,
                                   stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        try:
            self.output, _ = process.communicate(given, timeout=self.longest)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGTERM)  # runs end in order
            self.output, _ = process.communicate()
            raise Wrong(f"not done after {self.longest:.0f} s:\n{self.output}") from None
        if process.returncode != code:
            raise Wrong(f"exit code {process.returncode} instead of {code}:\n{self.output}")

    def _look(self, block: Block) -> None:
        """What is shown is there, and so is what it was made from."""
        made = self.folder / block.notes["picture"]
        for file in [block.page.parent / block.text, *([] if self.shortened else [made])]:
            if not file.is_file():
                raise Wrong(f"no picture {file}")


def _parse(text: str) -> None:
    try:
        tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise Wrong(f"no TOML: {error}") from None


def _shortened(block: Block) -> str:
    options = block.notes.get("run with", "")
    run = re.compile(r"^\./pliant run [^#\n]*", re.MULTILINE)
    return run.sub(lambda call: f"{call[0].rstrip()} {options} ", block.text)


def _tolerance(block: Block) -> float | None:
    """As a share; None: numbers are text."""
    note = block.notes.get("numbers")
    if note is None:
        return None
    share = re.fullmatch(rf"within ({NUMBER}) %", note)
    if share is None:
        raise Wrong(f"write <!-- numbers: within 3 % -->, not '{note}'")
    return float(share[1]) / 100


def compare(expected: str, actual: str, tolerance: float | None) -> None:
    """Line by line; three dots stand for anything in a line, and on a line of their own for any lines. Throws Wrong."""
    said = [line.rstrip() for line in actual.splitlines() if not PROGRESS.fullmatch(line)]
    at, free = 0, False  # where the next line is looked for, and whether lines may be left out before it
    for line in expected.rstrip("\n").split("\n"):
        if line.strip() == "...":
            free = True
            continue
        found = next((i for i in range(at, len(said) if free else min(at + 1, len(said)))
                      if _is(line.rstrip(), said[i], tolerance)), None)
        if found is None:
            raise Wrong(f"the page shows\n    {line}\nand there came\n{_indented(said[at:])}")
        at, free = found + 1, False
    if at < len(said) and not free:
        raise Wrong(f"the page does not show\n{_indented(said[at:])}")


def _indented(lines: list[str]) -> str:
    return "\n".join(f"    {line}" for line in lines)


def _is(expected: str, actual: str, tolerance: float | None) -> bool:
    parts = re.split(rf"(\.\.\.|{NUMBER})" if tolerance is not None else r"(\.\.\.)", expected)
    numbers = [float(part) for part in parts[1::2] if part != "..."]
    between = [re.escape(part) for part in parts[::2]]
    marks = [".*?" if part == "..." else f"({NUMBER})" for part in parts[1::2]] + [""]
    match = re.fullmatch("".join(text + mark for text, mark in zip(between, marks)), actual)
    return match is not None and all(abs(float(there) - number) <= (tolerance or 0) * abs(number)
                                     for there, number in zip(match.groups(), numbers))
