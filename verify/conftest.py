"""Starts the checks of each case afresh, and shows all of them at the end."""

from __future__ import annotations

import fcntl
import json
from collections import Counter
from pathlib import Path

import pytest

from verification import OUT, Label, read_rows


def pytest_collection_finish(session: pytest.Session) -> None:
    """Rows of an earlier run must not stand for checks that this one does not reach."""
    for case in cases_of(session):
        (OUT / case / "checks.json").unlink(missing_ok=True)


def cases_of(session: pytest.Session) -> list[str]:
    return list(dict.fromkeys(item.path.parent.name for item in session.items))


def pytest_sessionfinish(session: pytest.Session) -> None:
    """All cases that ever ran, in one file. Several sessions may end at once."""
    if not OUT.is_dir():
        return
    with (OUT / ".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        rows = [row for file in sorted(OUT.glob("*/checks.json")) for row in read_rows(file)]
        temporary = OUT / "checks.json.tmp"
        temporary.write_text(json.dumps(rows, indent=1) + "\n")
        temporary.replace(OUT / "checks.json")
    session.config.stash[shown] = [row for row in rows if row["case"] in cases_of(session)]


shown = pytest.StashKey[list]()


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
    rows = config.stash.get(shown, [])
    if not rows:
        return
    case_width, name_width = (max(len(row[key]) for row in rows) for key in ("case", "name"))
    terminalreporter.section("checks")
    heads = ("value", "expected", "tolerance")
    terminalreporter.write_line(f"{'':5} {'label':11} {'case':{case_width}} {'name':{name_width}} " +
                                " ".join(f"{head:>12}" for head in heads))
    for row in rows:
        numbers = " ".join(f"{row[head]:12.5g}" for head in heads)
        line = f"{row['label']:11} {row['case']:{case_width}} {row['name']:{name_width}} {numbers}"
        terminalreporter.write("green " if row["green"] else "RED   ", green=row["green"], red=not row["green"])
        terminalreporter.write_line(line)
    count = Counter(row["label"] for row in rows)
    share = ", ".join(f"{count[label.value]} {label.value}" for label in Label)
    terminalreporter.write_line(f"{len(rows)} checks: {share}; {sum(not row['green'] for row in rows)} red")
    terminalreporter.write_line(f"table: {Path(OUT) / 'checks.json'}")
