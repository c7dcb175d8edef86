"""Each case of verify/ is a folder with its README and one check, and a row of the table of verify/README.md."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

VERIFY = Path(__file__).resolve().parents[2] / "verify"
CASES = sorted(file.parent.name for file in VERIFY.glob("*/check_*.py"))
ROWS = dict(re.findall(r"^\| \[(\w+)\]\(\1/README\.md\) \|.*\| *([^|]*?) *\|$",
                       (VERIFY / "README.md").read_text(), re.MULTILINE))


@pytest.mark.parametrize("case", CASES)
def test_a_case_is_whole(case: str) -> None:
    assert [file.name for file in (VERIFY / case).glob("check_*.py")] == [f"check_{case}.py"]
    assert (VERIFY / case / "README.md").read_text().startswith("# ")


@pytest.mark.parametrize("case", CASES)
def test_the_table_says_which_are_fast_and_which_are_long(case: str) -> None:
    said = re.search(r"^CASE = Case\(__file__(.*)\)$", (VERIFY / case / f"check_{case}.py").read_text(), re.M)[1]
    assert (ROWS[case] == "yes") == ("fast=True" in said)
    assert (ROWS[case] == "`--full`") == ("long=True" in said)


def test_the_table_has_no_other_rows() -> None:
    assert sorted(ROWS) == CASES
