"""The folder of a study: what stands where in it."""

from __future__ import annotations

import hashlib
import json
import os
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from pliant.engine import engine
from pliant.study.points import Point
from pliant.study.spec import Curve, Quantity, Study


def replace(file: Path, text: str) -> None:
    """Whole or not at all."""
    file.parent.mkdir(parents=True, exist_ok=True)
    part = file.with_name(f"{file.name}.part")
    part.write_text(text)
    os.replace(part, file)


def replace_if_other(file: Path, text: str) -> None:
    """So that what depends on it is made anew only if it changed."""
    if not file.exists() or file.read_text() != text:
        replace(file, text)


def copy_if_other(source: Path, target: Path) -> None:
    content = source.read_bytes()
    if not target.exists() or target.read_bytes() != content:
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(content)


def state_beside(name: str) -> str:
    """What the copy of a state is called that a scene starts from, by how the scene names it."""
    return f"start_{hashlib.sha256(name.encode()).hexdigest()[:12]}.bin"


def as_text(value: Any) -> str:
    return json.dumps(value, indent=1) + "\n"


@dataclass
class Folder:
    path: Path

    @property
    def beside(self) -> Path:
        """Files that the scene names."""
        return self.path / "beside"

    def files_beside(self) -> list[Path]:
        return sorted(file for file in self.beside.rglob("*") if file.is_file())

    @property
    def engine_file(self) -> Path:
        """Which engine runs were made by; of a regression alone."""
        return self.path / "engine.json"

    def run(self, name: str) -> Path:
        return self.path / "runs" / name

    def scene(self, name: str) -> Path:
        return self.run(name) / "scene.toml"

    def fingerprint(self, name: str) -> str:
        """Of all that a run depends on."""
        digest = hashlib.sha256(self.scene(name).read_bytes())
        for file in [*self.files_beside(), self.engine_file]:
            if file.exists():
                digest.update(file.read_bytes())
        return digest.hexdigest()

    def results(self, name: str) -> Path:
        return self.run(name) / "results"

    def outcome_file(self, name: str) -> Path:
        return self.run(name) / "outcome.json"

    def outcome(self, name: str) -> dict:
        file = self.outcome_file(name)
        return json.loads(file.read_text()) if file.exists() else {"status": "not run", "message": ""}

    def read(self, name: str) -> Any:
        return json.loads((self.path / name).read_text())

    def point(self, name: str) -> Point:
        return Point(**self.read(f"points/{name}.json"))

    def quantities(self) -> list[Quantity]:
        return [Quantity(**table) for table in self.read("quantities.json")]

    def curves(self) -> list[Curve]:
        return [Curve(**table) for table in self.read("curves.json")]

    def lay_out(self, study: Study, points: list[Point], files: dict[str, Path]) -> None:
        """All that the steps read, renewed where it differs. `files`: those that scenes name, by what they
        are called beside the scene."""
        replace_if_other(self.path / "base.toml", study.scene.read_text("utf-8-sig"))
        for name, file in files.items():
            copy_if_other(file, self.beside / name)
        for other in self.files_beside():
            if str(other.relative_to(self.beside)) not in files:
                other.unlink()
        if study.regression:  # another engine is what it is there to see
            replace_if_other(self.engine_file, as_text(hashlib.sha256(engine().read_bytes()).hexdigest()))
        else:
            self.engine_file.unlink(missing_ok=True)
        for point in points:
            replace_if_other(self.path / f"points/{point.name}.json", as_text(asdict(point)))
        quantities = [asdict(quantity) for quantity in study.quantities]
        functions = {where: Path(where.rpartition(":")[0]).read_text() for where in study.functions}
        replace_if_other(self.path / "functions.json", as_text(functions))  # gathered anew when one changes
        replace_if_other(self.path / "quantities.json", as_text(quantities))
        replace_if_other(self.path / "curves.json", as_text([asdict(curve) for curve in study.curves]))
        about = {
            "title": study.title, "study": study.file.read_text(), "scene": study.scene.name, "kind": study.kind,
            "runs": [point.name for point in points], "parameters": [p.name for p in study.parameters],
            "replicas": study.replicas.name if study.replicas else None,
            "plots": [asdict(plot) for plot in study.plots],
            "figures": [asdict(figure) for figure in study.figures],
            "convergence": asdict(study.convergence) if study.convergence else None,
            "regression": {"baseline": study.regression.baseline.read_text("utf-8-sig"),
                           "tolerances": study.regression.tolerances} if study.regression else None,
        }
        replace_if_other(self.path / "study.json", as_text(about))
