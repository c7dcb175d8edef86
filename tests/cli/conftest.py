"""Runs the engine on scene files written into a fresh folder."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

ROOT = Path(os.environ.get("PLIANT_SOURCE_DIR", Path(__file__).parents[2]))
ENGINE = Path(os.environ.get("PLIANT_ENGINE", ROOT / "build/release/pliant_engine"))
REFERENCE = Path(os.environ.get("PLIANT_REFERENCE", ROOT / "build/release/pliant_reference_solver"))
sys.path[:0] = [str(ROOT / "scripts"), str(ROOT / "python")]

from pliant.results import Table, read_json, read_table


@dataclass
class Desk:
    """A folder with a scene file in it, from which the engine is called."""

    folder: Path

    @property
    def scene(self) -> Path:
        return self.folder / "scene.toml"

    def write(self, text: str | bytes) -> None:
        self.scene.write_bytes(text if isinstance(text, bytes) else text.encode())

    def engine(self, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
        return self.call(ENGINE, *arguments)

    def call(self, program: Path, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
        return subprocess.run([program, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=300,
                              stdin=subprocess.DEVNULL)

    def reference(self, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
        return self.call(REFERENCE, self.scene, *arguments)

    def run(self, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
        return self.engine("run", self.scene, *arguments)

    def summary(self, out: str | Path) -> dict:
        return read_json(self.folder / out / "summary.json")

    def table(self, file: str | Path) -> Table:
        table = read_table(self.folder / file)
        assert len(table.time) > 0, f"{file} has no row"
        return table

    def content(self) -> set[Path]:
        return set(self.folder.rglob("*"))


@pytest.fixture
def desk(tmp_path: Path) -> Desk:
    return Desk(tmp_path)
