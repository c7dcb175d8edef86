"""What was measured of a commit: lines of JSON in benchmarks/results/history.jsonl, and counts that commits carry."""

from __future__ import annotations

import json
import os
import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
HISTORY = ROOT / "benchmarks/results/history.jsonl"
COUNTS = "benchmarks/instructions.json"


def git(repository: Path, *arguments: str) -> str:
    """What git says. Raises ValueError with its own words when it refuses."""
    result = subprocess.run(["git", "-C", repository, *arguments], capture_output=True, text=True)
    if result.returncode != 0:
        raise ValueError(result.stderr.strip() or f"git {' '.join(arguments)} failed")
    return result.stdout


def machine() -> dict[str, str | int]:
    text = Path("/proc/cpuinfo").read_text()
    model = re.search(r"^model name\s*: *(.*)$", text, re.MULTILINE)
    return {"cpu": model[1].strip() if model else "unknown", "cores": os.cpu_count() or 1}


def counts_of(repository: Path, commit: str) -> dict[str, int] | None:
    """Instructions that a commit carries, by name; None where it has no such file."""
    try:
        counts = json.loads(git(repository, "show", f"{commit}:{COUNTS}"))["counts"]
    except (ValueError, KeyError):
        return None
    return {name: count["instructions"] for name, count in counts.items()}


def date_of(repository: Path, commit: str) -> str:
    return git(repository, "show", "--no-patch", "--format=%cI", commit).strip()


def record(file: Path, repository: Path, commit: str, scene: str, seconds: list[float]) -> None:
    line = {"commit": commit, "date": date_of(repository, commit), "machine": machine(), "scene": scene,
            "instructions": counts_of(repository, commit), "seconds": seconds}
    file.parent.mkdir(parents=True, exist_ok=True)
    with file.open("a") as history:
        history.write(json.dumps(line) + "\n")


def read(file: Path) -> list[dict]:
    """Lines of a history, the oldest commit first. Raises ValueError with file and line."""
    lines = []
    for number, text in enumerate(file.read_text().splitlines() if file.exists() else [], 1):
        try:
            line = json.loads(text)
            lines.append({key: line[key] for key in ("commit", "date", "machine", "scene", "instructions", "seconds")})
        except (ValueError, KeyError, TypeError) as error:
            raise ValueError(f"{file}:{number}: no line of a history: {error}") from error
    return sorted(lines, key=lambda line: line["date"])


def committed_counts(repository: Path) -> list[dict]:
    """Commit, date and instructions of each commit that changed them, the oldest first; none outside of git."""
    try:
        log = git(repository, "log", "--reverse", "--format=%H %cI", "--", COUNTS).split("\n")
    except ValueError:
        return []
    commits = [line.split() for line in log if line]
    found = [{"commit": commit, "date": date, "instructions": counts_of(repository, commit)}
             for commit, date in commits]
    return [line for line in found if line["instructions"]]
