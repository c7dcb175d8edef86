"""Messages that come after reading name the line of the scene file; warnings of what never happens. All EXACT."""

from __future__ import annotations

import pytest
from scenes import TWO_DISCS, line_of

PERIODIC = TWO_DISCS + """
[[walls]]
name = "floor"
material = "soft"
solid = "below"
level = "-2 um"
"""


@pytest.mark.parametrize("text, at, says", [
    (TWO_DISCS.replace("nodes = 60", "nodes = 60\noutline_nodes = 59"), "[shapes.disc]", "mesh"),
    (TWO_DISCS.replace("nodes = 60", "nodes = 20\noutline_nodes = 20"), "[shapes.disc]", "leave none for the interior"),
    (TWO_DISCS.replace("nodes = 60", "nodes = 7\noutline_nodes = 6"), "[shapes.disc]", "discretisation"),
    (TWO_DISCS.replace('packing = { kind = "positions", positions = [["2 um", "0 um"]] }',
                       'seed = 1\npacking = { kind = "random", bottom = 0, top = "3 um", solid_fraction = 0.95 }'),
     "[[grains]]", "do not come free of each other"),
], ids=["no room", "no interior", "too few neighbours", "packing"])
def test_meshing_and_packing_name_the_line(desk, text: str, at: str, says: str) -> None:
    desk.write(text)
    before = desk.content()
    for command in ["run", "check"]:
        result = desk.engine(command, desk.scene)
        assert result.returncode == 2, result.stderr
        assert f"{desk.scene.name}:{line_of(text, at)}:1: " in result.stderr, result.stderr
        assert says in result.stderr, result.stderr
        assert desk.content() == before


DRIVEN = PERIODIC + """x = { velocity = "1 m/s", from = "10 ns" }
thickness = "1 um"

[[boundary]]
of = "grains"
pressure = "1 kPa"
from = "30 ns"

[[bonds]]
between = "all"
from = "35 ns"
strength = "1 MPa"
fracture_energy = "10 J/m2"
"""


def test_what_sets_in_after_the_end_is_warned_of(desk) -> None:
    desk.write(DRIVEN)
    for command in ["run", "check"]:
        result = desk.engine(command, desk.scene)
        assert result.returncode == 0, result.stderr
        assert result.stderr.count("warning") == 2, result.stderr
        assert "bonds between 'all' and 'all' are made at 3.5e-08 s, but the run ends at 2e-08 s" in result.stderr
        line = line_of(DRIVEN, "[[boundary]]")
        assert f"scene.toml:{line}:1: 'grains' is acted on from 3e-08 s, but the run ends at 2e-08 s" in result.stderr
    result = desk.run("--out", "longer", "--until", "40 ns")
    assert result.returncode == 0 and "acted on" not in result.stderr
    result = desk.run("--out", "shorter", "--until", "10 ns")
    assert result.stderr.count("acted on") == 2, "the wall's drive as well"
