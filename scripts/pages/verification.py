"""What `./pliant verify` found last, from its checks.json, for the pages of verification."""

from __future__ import annotations

import json
import os
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CASES = ROOT / "verify"
PLACE = "<!-- what ./pliant verify found -->"
LABELS = ("EXACT", "RATE", "INDEPENDENT", "FROZEN")


def found() -> dict:
    """{} where nothing was run."""
    file = Path(os.environ.get("PLIANT_VERIFY_OUT", ROOT / "results/verify")) / "checks.json"
    return json.loads(file.read_text()) if file.is_file() else {}


def complete(markdown: str, source: Path) -> str:
    """A page with what was found: all of it, or the checks of its case."""
    if PLACE in markdown:
        return markdown.replace(PLACE, overview(found()))
    if source.parent.parent == CASES and source.name == "README.md":
        return markdown + case_section(source.parent.name, found())
    return markdown


def overview(results: dict) -> str:
    if not results:
        return "Nothing was run where this site was built: `./pliant verify`, then `./pliant docs`, and it stands here."
    cases = sorted({check["case"] for check in results["checks"] + results["failures"]})
    rows = [_case_row(case, results) for case in cases]
    labels = ", ".join(f"{count} {label}" for label, count in results["totals"].items())
    return "\n".join([
        f"{len(results['checks'])} checks ({labels}), {results['red']} red, {results['stale']} by an engine of another "
        f"commit than the sources, {results['commit']}, written {results['written']}.", "",
        f"| case | {' | '.join(LABELS)} | red | seconds |", "|---|" + "---:|" * (len(LABELS) + 2), *rows])


def _case_row(case: str, results: dict) -> str:
    checks = [check for check in results["checks"] if check["case"] == case]
    count = Counter(check["label"] for check in checks)
    red = sum(not check["green"] for check in checks) + sum(failure["case"] == case for failure in results["failures"])
    seconds = sum({check["test"]: check["seconds"] for check in checks}.values())
    numbers = [count[label] or "" for label in LABELS] + [f"**{red}**" if red else 0, f"{seconds:.0f}"]
    return f"| [{case}](verify/{case}/README.md) | " + " | ".join(map(str, numbers)) + " |"


def case_section(case: str, results: dict) -> str:
    checks = [check for check in results.get("checks", []) if check["case"] == case]
    failures = [failure for failure in results.get("failures", []) if failure["case"] == case]
    if not checks and not failures:
        return f"\n\n## What was found\n\nNothing was run where this site was built: `./pliant verify {case}`.\n"
    rows = [_check_row(check) for check in checks]
    red = [f"* **red**: `{failure['test']}` ended before it wrote a check down" for failure in failures]
    head = "| | label | check | value | expected | tolerance | source |\n|---|---|---|---:|---:|---:|---|\n"
    return "\n\n## What was found\n\n" + "\n".join(red) + "\n\n" + (head + "\n".join(rows) if rows else "") + "\n"


def _check_row(check: dict) -> str:
    numbers = " | ".join(f"{check[key]:.5g}" for key in ("value", "expected", "tolerance"))
    colour = "green" if check["green"] else "**red**"
    return f"| {colour} | {check['label']} | {_cell(check['name'])} | {numbers} | {_cell(check['source'])} |"


def _cell(text: str) -> str:
    return text.replace("|", "\\|")
