"""The list of mutations fits the code: each text stands where it says, once, and each case exists."""

from __future__ import annotations

import sys
from collections import Counter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "verify/mutations"))

from mutate import Mutation, read_mutations, red_lines

MUTATIONS = read_mutations()


@pytest.mark.parametrize("mutation", MUTATIONS, ids=lambda mutation: mutation.name)
def test_its_text_stands_once_in_its_file(mutation: Mutation) -> None:
    text = (ROOT / mutation.file).read_text()
    assert mutation.mutated(text) != text


@pytest.mark.parametrize("mutation", MUTATIONS, ids=lambda mutation: mutation.name)
def test_its_cases_exist(mutation: Mutation) -> None:
    for case in mutation.cases:
        assert (ROOT / "verify" / case / f"check_{case}.py").exists(), case


def test_names_are_unique() -> None:
    assert max(Counter(mutation.name for mutation in MUTATIONS).values()) == 1


def test_a_text_that_moved_is_told() -> None:
    mutation = Mutation("m", "what", "file", "a", "b", [])
    with pytest.raises(ValueError, match="2 times"):
        mutation.mutated("a a")


def test_what_is_red_without_a_mutation_finds_none() -> None:
    row = {"case": "a", "name": "b", "label": "EXACT", "value": 1.0, "expected": 2.0, "tolerance": 0.1, "green": False}
    assert red_lines({"checks": [{**row, "green": True}], "failures": []}) == []
    assert len(red_lines({"checks": [row], "failures": []})) == 1
