"""docs/scene.md is what the program says. EXACT."""

from __future__ import annotations

from conftest import ROOT, Desk


def test_docs_are_up_to_date(desk: Desk) -> None:
    result = desk.engine("schema")
    assert result.returncode == 0, result.stderr
    assert result.stdout == (ROOT / "docs/scene.md").read_text(), "run ./pliant schema > docs/scene.md"
