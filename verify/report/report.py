"""The report of ./pliant verify: checks.json for programs, report.html for people."""

from __future__ import annotations

import fcntl
import json
import subprocess
from collections import Counter
from dataclasses import dataclass, fields
from datetime import datetime, timezone
from functools import cache
from pathlib import Path

import jinja2
import markdown

from verification import Label, Row, read_rows, replace_file

HERE = Path(__file__).resolve().parent
CASES = HERE.parent


@dataclass
class Failure:
    """A test that ended without a red row: a solver or the check itself failed."""

    case: str
    test: str
    message: str
    commit: str = ""  # that the engine was built from


@dataclass
class CaseReport:
    """Results of a case: its rows, red first."""

    name: str
    readme: str  # HTML
    rows: list[Row]
    failures: list[Failure]
    pictures: list[str]  # relative to the report
    now: bool  # run in the session that writes the report

    def is_stale(self, result: Row | Failure) -> bool:
        """Whether it may come from other than the current sources. Uncommitted changes have no name, so only results of
        the current run are known to include them."""
        return result.commit != commit() or not (self.now or is_definite(result.commit))

    @property
    def stale(self) -> int:
        return sum(self.is_stale(result) for result in [*self.rows, *self.failures])

    @property
    def commits(self) -> list[str]:
        return sorted({result.commit or "unknown" for result in [*self.rows, *self.failures]})

    @property
    def seconds(self) -> float:
        """Total time of its tests; rows of one test share its time."""
        return sum({row.test: row.seconds for row in self.rows}.values())

    @property
    def red(self) -> int:
        return sum(not row.green for row in self.rows) + len(self.failures)

    def count(self, label: Label) -> int:
        return sum(row.label == label.value for row in self.rows)


@dataclass
class Mutations:
    """Last results of ./pliant verify --mutate."""

    written: str
    rows: list[dict]  # each with its commit

    @property
    def killed(self) -> int:
        return sum(row["killed"] for row in self.rows)


def write(out: Path, ran: set[str] = frozenset()) -> list[CaseReport]:
    """Report of all cases with results in this folder; those in `ran` ran now. Several runs may end concurrently."""
    with (out / ".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        cases = [read_case(out, file.parent, file.parent.name in ran) for file in sorted(out.glob("*/checks.json"))]
        replace_file(out / "checks.json", json.dumps(as_json(cases), indent=1) + "\n")
        replace_file(out / "report.html", as_html(cases, _mutations(out)))
    return cases


def read_case(out: Path, folder: Path, now: bool) -> CaseReport:
    rows = [Row(**own_fields(Row, row)) for row in read_rows(folder / "checks.json")]
    failures = [Failure(**own_fields(Failure, failure)) for failure in read_rows(folder / "failures.json")]
    pictures = sorted(str(file.relative_to(out)) for file in folder.glob("*.png"))
    return CaseReport(folder.name, _readme(folder.name), sorted(rows, key=lambda row: row.green), failures, pictures, now)


def own_fields(kind: type, values: dict) -> dict:
    """Values of the class's fields; rows of an earlier version may have others."""
    return {field.name: values[field.name] for field in fields(kind) if field.name in values}


def as_json(cases: list[CaseReport]) -> dict:
    return {"commit": commit(), "written": now(), "totals": totals(cases), "red": sum(case.red for case in cases),
            "stale": sum(case.stale for case in cases),
            "checks": [{**vars(row), "stale": case.is_stale(row)} for case in cases for row in case.rows],
            "failures": [{**vars(failure), "stale": case.is_stale(failure)} for case in cases
                         for failure in case.failures]}


def as_html(cases: list[CaseReport], mutations: Mutations | None) -> str:
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE), autoescape=True, trim_blocks=True,
                                     lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    environment.filters["number"] = number
    rows = sum(len(case.rows) for case in cases)
    return environment.get_template("report.html.j2").render(
        cases=cases, commit=commit(), now=now(), labels=list(Label), totals=totals(cases), rows=rows,
        red=sum(case.red for case in cases), stale=sum(case.stale for case in cases), mutations=mutations,
        seconds=sum(case.seconds for case in cases))


def totals(cases: list[CaseReport]) -> dict[str, int]:
    count = Counter(row.label for case in cases for row in case.rows)
    return {label.value: count[label.value] for label in Label}


def number(value: float) -> str:
    return "0" if value == 0 else f"{value:.5g}"


@cache
def commit() -> str:
    """Commit of the sources, in the form of cmake/build_info.cmake."""
    result = subprocess.run(["git", "-C", str(CASES), "describe", "--always", "--dirty", "--abbrev=12", "--exclude=*"],
                            capture_output=True, text=True)
    return result.stdout.strip() or "unknown"


def is_definite(commit: str) -> bool:
    return commit != "unknown" and not commit.endswith("-dirty")


def now() -> str:
    return datetime.now(timezone.utc).strftime("%Y-%m-%d %H:%M UTC")


def _readme(case: str) -> str:
    file = CASES / case / "README.md"
    if not file.exists():
        return ""
    return markdown.markdown(file.read_text(), extensions=["tables", "fenced_code"])


def _mutations(out: Path) -> Mutations | None:
    file = out / "mutations.json"
    if not file.exists():
        return None
    found = json.loads(file.read_text())
    return Mutations(found["written"], [{"commit": "unknown", **row} for row in found["rows"]])
