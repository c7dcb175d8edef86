"""The report: one HTML file that holds all it shows."""

from __future__ import annotations

import base64
import os
import platform
from pathlib import Path
from typing import Any

import jinja2

from pliant.results import read_json
from pliant.study.folder import Folder, replace

HERE = Path(__file__).resolve().parent


def write_report(folder: Folder) -> None:
    about, table = folder.read("study.json"), folder.read("table.json")
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE), autoescape=True, trim_blocks=True,
                                     lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    environment.filters["figure"] = lambda value: "-" if value is None else f"{value:.4g}"
    rows = table["rows"]
    pictures = [{"title": drawn["title"],
                 "data": base64.b64encode((folder.path / drawn["file"]).read_bytes()).decode()}
                for drawn in folder.read("plots.json")]
    page = environment.get_template("report.html.j2").render(
        about=about, rows=rows, inputs=list(rows[0]["inputs"]) if rows else [], quantities=table["quantities"],
        failed=[row for row in rows if row["status"] != "finished" or row["problems"]], pictures=pictures,
        means=table.get("means", []), parameters=about["parameters"],
        orders=table.get("orders", []), regression=table.get("regression", []), machine=_machine(folder, rows),
        base=(folder.path / "base.toml").read_text())
    replace(folder.path / "report.html", page)


def _machine(folder: Folder, rows: list[dict]) -> dict[str, Any]:
    """Of the runs: what their summaries say of program and cost."""
    summaries = [read_json(folder.results(row["run"]) / "summary.json") for row in rows]
    return {"commits": sorted({s["commit"] for s in summaries if "commit" in s}),
            "compilers": sorted({s["compiler"] for s in summaries if "compiler" in s}),
            "system": f"{platform.system()} {platform.machine()}, {os.cpu_count()} cores",
            "seconds": sum(s.get("wall_seconds", 0) for s in summaries),
            "evaluations": sum(s.get("evaluations", 0) for s in summaries)}
