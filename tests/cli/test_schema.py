"""docs/scene.md is what the program says. EXACT."""

from __future__ import annotations

from conftest import ROOT, Desk


def sources() -> list[str]:
    return [str(file) for folder in ("docs/keys", "cases") for file in sorted((ROOT / folder).glob("*.toml"))]


def test_docs_are_up_to_date(desk: Desk) -> None:
    result = desk.engine("schema", *sources())
    assert result.returncode == 0, result.stderr
    assert result.stdout == (ROOT / "docs/scene.md").read_text(), "run ./pliant schema > docs/scene.md"


def test_a_bad_scene_is_refused(desk: Desk) -> None:
    desk.write("[time]\n")
    result = desk.engine("schema", desk.scene)
    assert result.returncode == 2 and "missing key 'end'" in result.stderr
    assert desk.engine("schema").returncode == 2
