"""The errors that `./pliant check` foretells, kept in a header of the engine's. FROZEN: written here alone, which prints old and new."""

from __future__ import annotations

import re
from pathlib import Path

from error_study.choices import MASSES, METHODS, Choice
from error_study.judge import curve
from error_study.measure import Measured

HEADER = Path(__file__).resolve().parents[2] / "lib/cli/measured_errors.hpp"
KEPT = ["oscillation", "plates", "impact"]  # scenes
ENTRY = re.compile(r"\{DiscretisationMethod::(\w+),\s*Mass::(\w+),\s*\{([^}]*)\},\s*\{([^}]*)\},\s*\{([^}]*)\}\}")
TEXT = """#pragma once

#include "scene/scene.hpp"

namespace pliant {{

// FROZEN: written by `./pliant bench error --keep`, which prints what it changes. Errors in three of its scenes, in two
// digits.
inline constexpr int measured_nodes[] = {{{nodes}}};

struct MeasuredErrors {{
  DiscretisationMethod method;
  Mass mass;
  double oscillation[{count}], plates[{count}], impact[{count}];
}};

inline constexpr MeasuredErrors measured_errors[] = {{
{entries}
}};

}}  // namespace pliant
"""


def table_of(rows: list[Measured]) -> dict[tuple[str, str], list[list[float]]]:
    """[scenes][sizes] errors by method and mass, in two digits. ValueError where a run is missing or failed."""
    table, sizes = {}, {}
    for method in METHODS:
        for mass in MASSES:
            curves = [curve(rows, scene, Choice(method, mass)) for scene in KEPT]
            sizes |= {tuple(row.choice.nodes for row in found): method for found in curves}
            table[method, mass] = [[float(f"{row.error:.1e}") for row in found] for found in curves]
    if len(sizes) != 1 or () in sizes:
        raise ValueError(f"all methods and masses need the same sizes in {', '.join(KEPT)}")
    return table


def header_of(table: dict[tuple[str, str], list[list[float]]], nodes: list[int]) -> str:
    def numbers(values: list) -> str:
        return ", ".join(f"{value:g}" for value in values)

    entries = [f"    {{DiscretisationMethod::{method.replace('-', '_')},\n     Mass::{mass},\n     "
               + ",\n     ".join(f"{{{numbers(errors)}}}" for errors in table[method, mass]) + "},"
               for method, mass in table]
    return TEXT.format(nodes=numbers(nodes), count=len(nodes), entries="\n".join(entries))


def read_header(text: str) -> dict[tuple[str, str], list[list[float]]]:
    return {(method.replace("_", "-"), mass): [[float(number) for number in numbers.split(",")] for numbers in scenes]
            for method, mass, *scenes in ENTRY.findall(text)}


def keep(rows: list[Measured], header: Path = HEADER) -> None:
    """Writes the header and prints what was otherwise before."""
    table = table_of(rows)
    nodes = [row.choice.nodes for row in curve(rows, KEPT[0], Choice())]
    old = read_header(header.read_text()) if header.exists() else {}
    for (method, mass), scenes in table.items():
        before = old.get((method, mass), [[]] * len(KEPT))
        for scene, was, now in zip(KEPT, before, scenes):
            if was != now:
                print(f"{scene}, {method}, {mass}: {was or 'nothing'} -> {now}")
    header.write_text(header_of(table, nodes))
