"""What docs/commands.md says of each command, and its help. All EXACT."""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs/commands.md"
COMPLETE = ["run", "check", "modes", "plot", "view", "movie", "compare", "study", "export", "verify",
            "docs"]  # rows with all options


def help_of(*command: str) -> str:
    return subprocess.run([ROOT / "pliant", *command, "--help"], capture_output=True, text=True, check=True).stdout


def rows() -> list[str]:
    return [line for line in PAGE.read_text().splitlines() if line.startswith("| `./pliant")]


def listed_commands() -> dict[str, str]:
    """Rows of the table of commands: what stands in backticks, by command."""
    quoted = [" ".join(re.findall(r"`([^`]*)`", row)) for row in rows()]
    return {command: row for row in quoted for command in re.findall(r"\./pliant (\w+)", row)}


def options(text: str) -> set[str]:
    return set(re.findall(r"--[a-z-]+", text))


def test_every_command_is_listed() -> None:
    assert set(listed_commands()) == set(re.findall(r"\./pliant (\w+)", help_of()))


@pytest.mark.parametrize("command", [*COMPLETE, "test", "build"])
def test_page_and_help_have_the_same_options(command: str) -> None:
    usage = re.match(r".*(\n +.*)*", help_of(command))[0]
    listed = options(listed_commands()[command])
    assert listed <= options(usage)
    if command in COMPLETE:
        assert listed == options(usage)


def test_presets_are_the_same_everywhere() -> None:
    presets = json.loads((ROOT / "CMakePresets.json").read_text())["configurePresets"]
    names = {preset["name"] for preset in presets if not preset.get("hidden")}
    assert all(re.search(rf"\b{name}\b", help_of("build")) for name in names)
    row = next(row for row in rows() if row.startswith("| `./pliant build"))
    assert names == set(re.findall(r"`([a-z-]+)`", row))
