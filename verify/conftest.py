"""Resets the checks of each case, adds times and failures to them, and lists all of them at the end."""

from __future__ import annotations

import json
import os
import time
from collections import defaultdict
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")  # for numpy and dolfinx, before import, as cases run in parallel

import pytest

from report import report
from verification import OUT, commit_of_engine, read_rows, replace_file

BEGIN = "PLIANT_VERIFY_BEGIN"  # of the session, s


def pytest_configure(config: pytest.Config) -> None:
    """Reports of tests arrive at the process that writes the summary, not at the workers of pytest-xdist."""
    if not hasattr(config, "workerinput"):
        make_results_folder()
        os.environ[BEGIN] = str(time.time())  # the workers inherit it
        config.pluginmanager.register(Record(), "pliant-record")


def make_results_folder() -> None:
    try:
        OUT.mkdir(parents=True, exist_ok=True)
        (OUT / ".lock").touch()
    except OSError as error:
        raise pytest.UsageError(f"{OUT}: results cannot be written there: {error.strerror}; PLIANT_VERIFY_OUT names "
                                "another folder") from None


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Long cases start first, so that none remains at the end on one core."""
    items.sort(key=lambda item: -item.module.CASE.cost)


def pytest_collection_finish(session: pytest.Session) -> None:
    """Remove rows of earlier runs, which must not replace unreached checks. Workers collect while others run."""
    for case in {item.path.parent.name for item in session.items}:
        for file in (OUT / case / "checks.json", OUT / case / "failures.json"):
            with suppress(FileNotFoundError):  # another worker may have removed it between the two calls
                if file.stat().st_mtime < float(os.environ[BEGIN]):
                    file.unlink()


class Record:
    """Times and failures of this session's tests and, at the end, the report."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = defaultdict(float)
        self.messages: dict[str, str] = {}
        self.cases: list[report.CaseReport] = []

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        self.seconds[report.nodeid] += report.duration
        if report.failed:
            self.messages[report.nodeid] = str(report.longrepr)

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        """A case that cannot be loaded is red: rows of an earlier run do not count."""
        if report.failed and report.nodeid.endswith(".py"):
            (OUT / case_of(report.nodeid) / "checks.json").unlink(missing_ok=True)
            self.seconds[report.nodeid] = 0.0
            self.messages[report.nodeid] = str(report.longrepr)

    def pytest_sessionfinish(self) -> None:
        """One report with all cases that have results."""
        ran = {case_of(test) for test in self.seconds}
        for case in ran:
            self._complete(OUT / case)
        self.cases = [case for case in report.write(OUT, ran) if case.name in ran]

    def _complete(self, folder: Path) -> None:
        """Adds times to the rows of a case, and failures without a row."""
        rows = read_rows(folder / "checks.json")
        for row in rows:
            row["seconds"] = self.seconds.get(row["test"], 0.0)
        red = {row["test"] for row in rows if not row["green"]}
        failures = [report.Failure(folder.name, test.split("::")[-1], message.strip()[-2000:], commit_of_engine())
                    for test, message in self.messages.items() if case_of(test) == folder.name and test not in red]
        folder.mkdir(exist_ok=True)
        replace_file(folder / "checks.json", json.dumps(rows, indent=1) + "\n")
        replace_file(folder / "failures.json", json.dumps([asdict(failure) for failure in failures], indent=1) + "\n")

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        rows = [row for case in self.cases for row in case.rows]
        if not rows:
            return
        case_width, name_width = (max(len(getattr(row, key)) for row in rows) for key in ("case", "name"))
        terminalreporter.section("checks")
        heads = ("value", "expected", "tolerance")
        terminalreporter.write_line(f"{'':5} {'label':11} {'case':{case_width}} {'name':{name_width}} " +
                                    " ".join(f"{head:>12}" for head in heads))
        for row in sorted(rows, key=lambda row: not row.green):
            numbers = " ".join(f"{getattr(row, head):12.5g}" for head in heads)
            line = f"{row.label:11} {row.case:{case_width}} {row.name:{name_width}} {numbers}"
            terminalreporter.write("green " if row.green else "RED   ", green=row.green, red=not row.green)
            terminalreporter.write_line(line)
        share = ", ".join(f"{count} {label}" for label, count in report.totals(self.cases).items())
        terminalreporter.write_line(f"{len(rows)} checks: {share}; {sum(case.red for case in self.cases)} red")
        if stale := sum(case.stale for case in self.cases):
            terminalreporter.write_line(f"{stale} by an engine of another commit than the sources, {report.commit()}: "
                                        f"{commit_of_engine()}")
        terminalreporter.write_line(f"report: {OUT / 'report.html'}; table: {OUT / 'checks.json'}")


def case_of(test: str) -> str:
    """The folder of a test's file."""
    return Path(test.split("::")[0]).parent.name
