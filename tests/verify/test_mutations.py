"""The list of mutations fits the code: each text stands where it says, once, and each case exists."""

from __future__ import annotations

import time
from collections import Counter
from pathlib import Path

import pytest

import mutate
from mutate import Mutation, Sound, judge, read_mutations, red_lines
from unit_tests import in_short, red_tests, unfinished

ROOT = Path(__file__).resolve().parents[2]
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


def test_unit_tests_that_fail_crash_or_do_not_end_find_one() -> None:
    said = """[ RUN      ] A.passes
[       OK ] A.passes (1 ms)
[ RUN      ] A.is_skipped
[  SKIPPED ] A.is_skipped (0 ms)
[ RUN      ] A.fails/0
a.cpp:3: Failure
[  FAILED  ] A.fails/0, where GetParam() = 1 (0 ms)
[ RUN      ] A.speaks
a warning[       OK ] A.speaks (2 ms)
[ RUN      ] B.crashes
"""
    assert unfinished(said) == ["A.fails/0", "B.crashes"]
    assert in_short(["a", "b"]) == "a, b"
    assert in_short(list("abcdef")) == "a, b, c, d and 2 more"


def test_a_test_that_hangs_is_not_waited_for_once_others_are_red(tmp_path: Path) -> None:
    program = tmp_path / "tests"
    program.write_text("""#!/bin/sh
echo '[ RUN      ] A.fails'
echo '[  FAILED  ] A.fails (1 ms)'
echo '[ RUN      ] A.hangs'
sleep 300
""")
    program.chmod(0o755)
    start = time.monotonic()
    assert set(red_tests(program, tmp_path / "out", longest=300, usual=0.5)) == {"A.fails"}
    assert time.monotonic() - start < 150


@pytest.mark.parametrize(("check", "tests", "killer"), [
    (["case: a check\tits value"], ["A.b", "A.is_red_anyway"], "case: a check; unit tests A.b"),
    ([], ["A.b"], "unit tests A.b"), ([], ["A.is_red_anyway"], "")])
def test_what_finds_one_is_named(check: list[str], tests: list[str], killer: str, tmp_path: Path,
                                 monkeypatch: pytest.MonkeyPatch) -> None:
    source = tmp_path / "a.hpp"
    source.write_text("one two")
    built = []
    monkeypatch.setattr(mutate, "SOURCE", tmp_path)
    monkeypatch.setattr(mutate, "build", lambda: built.append(source.read_text()))
    monkeypatch.setattr(mutate, "run_cases", lambda cases, name, *options: check)
    monkeypatch.setattr(mutate, "red_tests", lambda program, folder, longest, usual: tests if (longest, usual) == (63, 63) else [])
    verdict = judge(Mutation("m", "what", "a.hpp", "two", "three", ["case"]), Sound(["case"], ["A.is_red_anyway"], 1.0))
    assert (verdict.killed, verdict.killer) == (bool(killer), killer)
    assert built == ["one three"]
    assert source.read_text() == "one two", "as it was"
