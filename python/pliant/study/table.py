"""The table of a study, a row a run, and what its kind makes of it."""

from __future__ import annotations

import csv
import io
import math
from typing import Any

from pliant.study.convergence import analyse
from pliant.study.folder import Folder, as_text, replace
from pliant.study.spec import number_of


def rows_of(folder: Folder) -> list[dict[str, Any]]:
    """Each with run, status, message, warnings, inputs and outputs by name."""
    rows = []
    for name in folder.read("study.json")["runs"]:
        outcome, gathered = folder.outcome(name), folder.read(f"runs/{name}/quantities.json")
        rows.append({"run": name, "status": outcome["status"], "message": outcome["message"],
                     "problems": gathered["problems"], "warnings": gathered.get("warnings", []), "inputs": folder.point(name).values,
                     "outputs": gathered["values"]})
    return rows


def mean_of_replicas(rows: list[dict], output: str, inputs: list[str]) -> list[dict[str, Any]]:
    """Rows with the same inputs in one: mean, and standard error where there are several. Only those that have it."""
    groups: dict[tuple, list[dict]] = {}
    for row in rows:
        if output in row["outputs"]:
            groups.setdefault(tuple(str(row["inputs"][name]) for name in inputs), []).append(row)
    means = []
    for members in groups.values():
        values = [member["outputs"][output]["value"] for member in members]
        mean = sum(values) / len(values)
        if len(values) > 1:
            error = math.sqrt(sum((v - mean)**2 for v in values) / (len(values) - 1) / len(values))
        else:
            error = members[0]["outputs"][output]["error"]
        means.append({"inputs": {name: members[0]["inputs"][name] for name in inputs}, "value": mean, "error": error,
                      "count": len(values), "values": values, "unit": members[0]["outputs"][output]["unit"]})
    return means


def means_of_replicas(rows: list[dict], names: list[str], inputs: list[str]) -> list[dict[str, Any]]:
    """For each choice of the inputs its means by name; replicas that lack a quantity count in the others."""
    groups: dict[str, dict[str, Any]] = {}
    for row in rows:
        chosen = {name: row["inputs"][name] for name in inputs}
        groups.setdefault(str(chosen), {"inputs": chosen, "outputs": {}})
    for name in names:
        for mean in mean_of_replicas(rows, name, inputs):
            groups[str(mean["inputs"])]["outputs"][name] = mean
    return list(groups.values())


def write_table(folder: Folder) -> None:
    about, rows = folder.read("study.json"), rows_of(folder)
    names = [quantity.name for quantity in folder.quantities()]
    table: dict[str, Any] = {"rows": rows, "quantities": names}
    if about["convergence"]:
        table["orders"] = _orders(about, rows)
    if about["regression"]:
        table["regression"] = _regression(about["regression"], rows)
    if about["replicas"]:
        table["means"] = means_of_replicas(rows, names, about["parameters"])
        replace(folder.path / "means.csv", _means_as_csv(table["means"], names, about["parameters"]))
    replace(folder.path / "table.csv", _as_csv(rows, names))
    replace(folder.path / "table.json", as_text(table))


def _unit(rows: list[dict], name: str) -> str:
    return next((row["outputs"][name]["unit"] for row in rows if name in row["outputs"]), "-")


def _as_csv(rows: list[dict], names: list[str]) -> str:
    inputs = list(rows[0]["inputs"]) if rows else []
    with_error = [name for name in names if any((row["outputs"].get(name) or {}).get("error") for row in rows)]
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["run", "status", *inputs, *(f"{name} [{_unit(rows, name)}]" for name in names),
                     *(f"{name} standard error" for name in with_error)])
    for row in rows:
        of = row["outputs"]
        writer.writerow([row["run"], row["status"], *row["inputs"].values(),
                         *(repr(of[name]["value"]) if name in of else "" for name in names),
                         *(repr(of[name]["error"]) if name in of and of[name]["error"] is not None else ""
                           for name in with_error)])
    return text.getvalue()


def _means_as_csv(means: list[dict], names: list[str], inputs: list[str]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    units = {name: next((m["outputs"][name]["unit"] for m in means if name in m["outputs"]), "-") for name in names}
    writer.writerow([*inputs, *(column for name in names
                                for column in (f"{name} [{units[name]}]", f"{name} standard error", f"{name} runs"))])
    for mean in means:
        cells = [mean["outputs"].get(name, {"value": None, "error": None, "count": 0}) for name in names]
        writer.writerow([*mean["inputs"].values(), *("" if value is None else repr(value) for cell in cells
                                                     for value in (cell["value"], cell["error"], cell["count"]))])
    return text.getvalue()


def _orders(about: dict, rows: list[dict]) -> list[dict[str, Any]]:
    """For each quantity and each choice of the other inputs."""
    settings = about["convergence"]
    others = [name for name in about["parameters"] if name != settings["by"]]
    result = []
    for output in settings["of"]:
        families: dict[tuple, list[dict]] = {}
        for mean in mean_of_replicas(rows, output, about["parameters"]):
            families.setdefault(tuple(str(mean["inputs"][name]) for name in others), []).append(mean)
        for members in families.values():
            sizes = [(number_of(m["inputs"][settings["by"]]) or math.nan)**settings["power"] for m in members]
            values = [m["value"] for m in members]
            found = analyse(sizes, values)
            result.append({"quantity": output, "unit": members[0]["unit"],
                           "of": {name: members[0]["inputs"][name] for name in others}, "sizes": sizes,
                           "values": values, "words": found.words(), **vars(found)})
    return result


def _regression(settings: dict, rows: list[dict]) -> list[dict[str, Any]]:
    """Each value beside the baseline's; a run or a value that is missing on either side is a difference."""
    baseline = {row["run"]: {key.split(" [")[0]: value for key, value in row.items()}
                for row in csv.DictReader(io.StringIO(settings["baseline"]))}
    result = []
    for row in rows:
        for name, tolerance in settings["tolerances"].items():
            now = row["outputs"].get(name, {}).get("value")
            text = baseline.get(row["run"], {}).get(name)
            then = number_of(text) if text else None
            if now is None or then is None:
                change = None
            else:
                change = 0.0 if now == then else (now - then) / abs(then) if then != 0 else math.inf
            result.append({"run": row["run"], "quantity": name, "now": now, "then": then, "change": change,
                           "tolerance": tolerance, "good": change is not None and abs(change) <= tolerance})
    gone = sorted(set(baseline) - {row["run"] for row in rows})
    result += [{"run": run, "quantity": "-", "now": None, "then": None, "change": None, "tolerance": 0, "good": False}
               for run in gone]
    return result
