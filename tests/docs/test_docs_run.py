"""Pages do what they say: each block of code and each command is run, in order, and what they show is what comes out.
Blocks that are not run say why in their source (scripts/pages/blocks.py), and are listed. EXACT, but for numbers that
say how near they come."""

from __future__ import annotations

import re
import subprocess
from functools import cache
from pathlib import Path

import pytest

from pages.blocks import BadPage, blocks
from pages.practice import Practice, Wrong, compare

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "verify/README.md", *sorted((ROOT / "docs").rglob("*.md"))]
LARGEST_PICTURE, LARGEST_FILM = 125_000, 3_000_000  # bytes
COMMAND = re.compile(r"`(\./pliant [^`]*)`")


def name(page: Path) -> str:
    return str(page.relative_to(ROOT))


def runs(page: Path) -> bool:
    return any("not run" not in block.notes for block in blocks(page))


@pytest.mark.parametrize("page", filter(runs, PAGES), ids=name)
def test_a_page_does_what_it_says(page: Path, tmp_path: Path) -> None:
    practice = Practice(tmp_path)
    for block in blocks(page):
        practice.do(block)


def test_what_is_not_run_says_why(capsys: pytest.CaptureFixture[str]) -> None:
    reasons = [f"{name(page)}:{block.line} {block.language}: {block.notes['not run']}"
               for page in PAGES for block in blocks(page) if "not run" in block.notes]
    with capsys.disabled():
        print(f"\n{len(reasons)} blocks are not run:", *reasons, sep="\n  ")
    assert all(len(reason.split(": ", 1)[1]) > 5 for reason in reasons)


@cache
def help_of(command: str) -> str:
    return subprocess.run([ROOT / "pliant", command, "--help"], capture_output=True, text=True, check=True).stdout


@pytest.mark.parametrize("page", PAGES, ids=name)
def test_commands_in_the_text_are_there_with_their_options(page: Path) -> None:
    for said in COMMAND.findall(page.read_text()):
        command, *rest = re.findall(r"[^\s\[]+", said.removeprefix("./pliant "))
        if re.fullmatch(r"[a-z-]+", command):
            known = help_of(command) if not command.startswith("-") else help_of("run")
            assert all(option in known for option in rest if re.fullmatch(r"--[a-z-]+", option)), said


def test_pictures_are_small_and_shown() -> None:
    shown = {(page.parent / address).resolve() for page in PAGES
             for address in re.findall(r"\]\(([^)]*\.(?:png|gif))\)", page.read_text())}
    kept = {*(ROOT / "docs").rglob("*.png"), *(ROOT / "docs").rglob("*.gif")}
    assert kept == shown
    largest = {".png": LARGEST_PICTURE, ".gif": LARGEST_FILM}
    assert [name(file) for file in kept if file.stat().st_size > largest[file.suffix]] == []


def page_of(folder: Path, text: str) -> Path:
    (folder / "page.md").write_text(text)
    return folder / "page.md"


def practise(folder: Path, text: str) -> Practice:
    """Does what a page says, in a folder of its own."""
    work = folder / "work"
    work.mkdir()
    practice = Practice(work)
    for block in blocks(page_of(folder, text)):
        practice.do(block)
    return practice


def test_files_are_written_added_to_and_changed(tmp_path: Path) -> None:
    work = practise(tmp_path, """# A page
```toml title="a/b.toml"
x = 1
[t]
```
```toml title="a/b.toml, at the end"
y = 2
```
```diff title="a/b.toml"
- x = 1
+ x = 3
  [t]
+ z = 4
```
""").folder
    assert (work / "a/b.toml").read_text() == "x = 3\n[t]\nz = 4\n\ny = 2\n"


@pytest.mark.parametrize("text, complaint", [
    ("```sh\nfalse\n```", "exit code 1 instead of 0"),
    ("<!-- exit code: 2 -->\n```sh\ntrue\n```", "exit code 0 instead of 2"),
    ("```sh\necho one\n```\n```text\ntwo\n```", "the page shows\n    two"),
    ("```python\nprint(1 / 0)\n```", "ZeroDivisionError"),
    ("```text\nalone\n```", "say why it is not run"),
    ("```cpp\nint i;\n```", "say why it is not run"),
    ('```toml title="a.toml"\nx =\n```', "no TOML"),
    ("<!-- not run: a part of a scene -->\n```toml\nx =\n```", "no TOML"),
    ('```toml title="a.toml, at the end"\nx = 1\n```', "is not there"),
    ('```toml title="a.toml"\nx = 1\n```\n```diff title="a.toml"\n- x = 2\n```', "0 times"),
    ("<!-- picture: a.png -->\n![x](b.png)", "no picture"),
    ("<!-- numbers: nearly -->\n```text\n1\n```", "say why it is not run"),
    ("```sh\necho 1\n```\n<!-- numbers: nearly -->\n```text\n1\n```", "within 3 %"),
])
def test_a_page_can_be_wrong(tmp_path: Path, text: str, complaint: str) -> None:
    with pytest.raises(Wrong, match=re.escape(complaint)):
        practise(tmp_path, text)


@pytest.mark.parametrize("text", ["```sh\ntrue", "<!-- nt run: x -->\n```sh\ntrue\n```", "text\n\n    code\n",
                                  "```toml {x}\n```"])
def test_blocks_that_cannot_be_read_are_refused(tmp_path: Path, text: str) -> None:
    with pytest.raises(BadPage):
        list(blocks(page_of(tmp_path, text)))


def test_lists_and_fences_in_fences_are_no_code(tmp_path: Path) -> None:
    found = list(blocks(page_of(tmp_path, "* one\n\n    more of it\n\n````md\n```sh\nfalse\n```\n````\n")))
    assert [(block.language, block.text) for block in found] == [("md", "```sh\nfalse\n```\n")]


def test_a_run_is_shortened_where_the_source_says_so(tmp_path: Path) -> None:
    page = page_of(tmp_path, "<!-- run with: --until 1 -->\n```sh\n./pliant run a.toml   # long\nls\n```\n")
    work = tmp_path / "work"
    work.mkdir()
    practice = Practice(work)
    (work / "pliant").unlink()
    (work / "pliant").write_text('#!/bin/bash\necho "$@"\n')
    (work / "pliant").chmod(0o755)
    practice.do(next(iter(blocks(page))))
    assert practice.output.splitlines()[0] == "run a.toml --until 1"


@pytest.mark.parametrize("expected, actual, tolerance, same", [
    ("a\nb\n", "a\nb\n", None, True), ("a\n", "a\nb\n", None, False), ("a\n...\n", "a\nb\n", None, True),
    ("...\nb\n", "a\nb\n", None, True), ("...\na\n", "a\nb\n", None, False), ("a\nb\n", "a\n", None, False),
    ("a ... c\n", "a b c\n", None, True), ("a ... c\n", "a b d\n", None, False), ("a.c\n", "abc\n", None, False),
    ("1.00 m\n", "1.01 m\n", None, False), ("1.00 m\n", "1.01 m\n", 0.02, True), ("1.00 m\n", "1.03 m\n", 0.02, False),
    ("1.00 m\n", "1.00 s\n", 0.02, False), ("-2e-3 x ... 5\n", "-0.002 x 7 5\n", 0.01, True),
    ("a\nb\n", "a\nt = 0.1 of 2 s | dt 1e-3 s\nb\n", None, True), ("a\nb\n", "b\na\n", None, False),
])
def test_output_is_compared(expected: str, actual: str, tolerance: float | None, same: bool) -> None:
    if same:
        compare(expected, actual, tolerance)
    else:
        with pytest.raises(Wrong):
            compare(expected, actual, tolerance)
