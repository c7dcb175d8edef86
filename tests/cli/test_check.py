"""What `check` foretells, against what it prints of known scenes and against a run. EXACT but where said."""

from __future__ import annotations

import math
import os
import re
from pathlib import Path

import pytest
from scenes import TWO_DISCS

BLOCK = """\
[time]
end = "5 ms"
[domain]
period = "1 m"
[materials.stone]
law = "rigid"
density = 2000
[shapes.block]
kind = "polygon"
points = [[0, 0], [0.1, 0], [0.1, 0.1], [0, 0.1]]
spacing = 0.01
[[grains]]
shape = "block"
body = "rigid"
material = "stone"
packing = { kind = "positions", positions = [[0.3, 0.04999]] }
[[walls]]
name = "floor"
material = "stone"
solid = "below"
level = 0
[[walls]]
name = "lid"
material = "stone"
solid = "above"
level = 0.5
thickness = 0.01
y = { pressure = [["0 ms", 0], ["1 ms", 1000]] }
[[contacts]]
between = "all"
law = "mohr-coulomb"
friction = 0.3
stiffness = 1e8
"""


def checked(desk, text: str, *arguments: str) -> dict[str, str]:
    """Lines of the report by heading; lines without one belong to the heading above."""
    desk.write(text)
    result = desk.engine("check", desk.scene, "--threads", "1", *arguments)
    assert result.returncode == 0, result.stderr
    rows: dict[str, str] = {}
    heading = ""
    for line in result.stdout.splitlines():
        heading = line[:12].strip() or heading
        rows[heading] = rows.get(heading, "") + line[13:] + "\n"
    return rows


def bytes_of(text: str) -> float:
    number, prefix = re.fullmatch(r"([\d.e+]+) (k|M|G|)B", text).groups()
    return float(number) * {"": 1, "k": 1e3, "M": 1e6, "G": 1e9}[prefix]


def test_bodies_and_masses(desk) -> None:
    rows = checked(desk, BLOCK)
    assert rows["bodies"].startswith("3: compliant 0, rigid 1, walls 2")
    masses = {" ".join(line.split()[:-3]): line.split()[-2] for line in rows["mass"].splitlines()}
    assert masses["rigid grains of stone"] == "20"  # 0.1 m x 0.1 m of 2000 kg/m3
    assert masses["wall lid of stone"] == "20"  # 1 m x 0.01 m
    assert masses["all bodies"] == "40"
    assert re.search(r"wall floor of stone +1 +none given", rows["mass"])


def test_contact_and_its_cost(desk) -> None:
    rows = checked(desk, BLOCK)
    assert "stone - wall of stone" in rows["contact"] and "mohr-coulomb" in rows["contact"]
    assert "1e+08 Pa/m given" in rows["contact"]
    friction = re.search(r"^friction = .*$", BLOCK, re.MULTILINE)[0]
    assert f"; friction {friction.split()[-1]}" in rows["contact"]
    assert "friction 0.577" in checked(desk, BLOCK.replace(friction, 'friction = "30 deg"'))["contact"]  # its tangent
    assert "0.1 % of h deep at 1 kPa" in rows["contact"]  # 1000 Pa / 1e8 Pa/m = 10 um of 10 mm
    assert "10 times as stiff: 3.2 times as many steps" in rows["time step"]  # sqrt(10): nothing but contact is stiff


def test_automatic_stiffness_of_compliant_discs(desk) -> None:
    rows = checked(desk, TWO_DISCS)
    kn, h = re.search(r"([\d.e+]+) Pa/m auto +h ([\d.]+) nm", rows["contact"]).groups()
    assert float(kn) == pytest.approx(8 * 2e9 / (float(h) * 1e-9), rel=0.01)  # 8 E/h; three digits are printed


def test_step_doubling_has_no_bound_of_its_own(desk) -> None:
    rows = checked(desk, TWO_DISCS.replace('end = "20 ns"', 'end = "20 ns"\nintegrator = "step-doubling"'))
    assert "step doubling sets its own" in rows["time step"]


def test_fast_bodies_are_told_about_the_skin(desk) -> None:
    fast = BLOCK.replace("0.04999]] }", '0.04999]] }\nvelocity = { uniform = ["500 m/s", 0] }')
    assert "a larger [contact] skin" in checked(desk, fast)["time step"]
    assert "skin allows" not in checked(desk, BLOCK)["time step"]


def test_a_drift_uses_up_no_skin(desk) -> None:
    """The first disc, at 80 times the speed of its waves, moves away from the other: no contact bears such a hit."""
    drift = 'velocity = { uniform = ["-90 km/s", "-50 km/s"] }'
    alone = TWO_DISCS.replace('velocity = { uniform = ["20 m/s", "0 m/s"] }', drift)
    both = alone.replace('"0.1 um"]] }', f'"0.1 um"]] }}\n{drift}')
    assert "contact skin" in checked(desk, alone)["time step"]
    assert "contact skin" not in checked(desk, both)["time step"]


def test_forecast_agrees_with_a_run(desk) -> None:
    rows = checked(desk, TWO_DISCS)
    assert desk.run("--out", "out", "--threads", "1", "--quiet").returncode == 0
    summary = desk.summary("out")
    assert rows["evaluations"].startswith(f"{summary['evaluations']} until 20 ns, counted"), rows["evaluations"]
    size = sum((desk.folder / "out" / name).stat().st_size
               for name in ["frames.h5", "frames.xdmf", "probes.csv", "steps.csv"])
    foretold = bytes_of(re.match(r"about ([\d.e+]+ \w*B)", rows["output"])[1])
    assert foretold == pytest.approx(size, rel=0.4)  # compression is foretold by one share for all scenes
    memory = bytes_of(re.match(r"about ([\d.e+]+ \w*B)", rows["memory"])[1])
    assert memory == pytest.approx(summary["peak_memory_bytes"], rel=0.4)  # allocators and libraries differ by as much


def test_until_shortens_the_forecast(desk) -> None:
    rows = checked(desk, TWO_DISCS, "--until", "10 ns")
    assert "until 10 ns" in rows["evaluations"] and " 2 frames" in rows["output"]


def test_lanes_of_different_shapes(desk) -> None:
    case = Path(os.environ["PLIANT_SOURCE_DIR"], "cases", "same_topology.toml").read_text()
    rows = checked(desk, case)
    assert rows["lanes"].startswith("of one shape: 0 bodies; of one topology: 48; vectorised over nodes: 0")
    assert "lanes" not in checked(desk, case.replace("variants = 48\n", ""))  # one shape


def test_rotational_inertia_is_that_of_a_run(desk) -> None:
    """EXACT: the energy of a disc that starts to spin, over that of its polygon."""
    spinning = TWO_DISCS.replace('uniform = ["20 m/s", "0 m/s"]', 'rotation = "1 rad/s"')
    head, one, _ = spinning.replace("nodes = 60", "nodes = {nodes}").split("[[grains]]")
    rest = "[[contacts]]" + spinning.split("[[contacts]]")[1]
    alone = f'{head}[[grains]]{one}{rest}[discretisation]\nmass = "{{mass}}"\n'
    for nodes, mass, excess in (60, "lumped", 6.8), (168, "lumped", 2.3), (60, "corrected", 0.49):  # FROZEN, %
        text = alone.replace("{nodes}", str(nodes)).replace("{mass}", mass)
        told = checked(desk, text)["mind"]
        assert f"up to {excess} % more rotational inertia" in told, told
        assert ('mass = "corrected" leaves' in told) == (mass == "lumped")
        assert desk.run("--out", "out", "--until", "1 fs", "--force", "--quiet").returncode == 0
        sides = round(3.7 * math.sqrt(nodes))
        turn, radius = 2 * math.pi / sides, 0.5e-6
        corner = radius * math.sqrt(turn / math.sin(turn))
        moment = 1200 * sides / 12 * corner**4 * math.sin(turn) * (2 + math.cos(turn))
        kinetic = desk.summary("out")["energy"]["kinetic"]
        assert 100 * (kinetic / (moment / 2) - 1) == pytest.approx(excess, abs=0.06)  # as it is rounded


def test_facets_and_restitution_are_stated_where_there_are_some(desk) -> None:
    assert "mind" not in checked(desk, BLOCK)
    assert "29 facets tilt the normals of a smooth outline by up to 6.2 degrees" in checked(desk, TWO_DISCS)["mind"]
    bounce = BLOCK.replace("friction = 0.3", "friction = 0.3\nrestitution = 0.5")
    assert "mind" not in checked(desk, bounce)  # nothing rolls
    steps = [checked(desk, text)["time step"] for text in (BLOCK, bounce)]
    assert "dashpots" not in steps[0] and re.search(r"dashpots of restitution take \d", steps[1]), steps
    disc = 'kind = "disc"\ndiameter = 0.1\nnodes = 60\n'
    rolls = checked(desk, re.sub(r'kind = "polygon"\n.*\n.*\n', disc, bounce))
    assert "restitution 0.5 resists rolling" in rolls["mind"]


def test_short_edges_are_told(desk) -> None:
    """By `check` and `run`; points nearer than 1e-6 of the extent are one."""
    def text(edge: float | None, method: str = "mls") -> str:
        corner = "" if edge is None else f", [1e-6, {edge * 1e-6:.12f}]"
        square = f'kind = "polygon"\npoints = [[0, 0], [1e-6, 0]{corner}, [1e-6, 1e-6], [0, 1e-6]]\nspacing = "0.1 um"\n'
        scene = TWO_DISCS.replace('kind = "disc"\ndiameter = "1 um"\nnodes = 60\n', square)
        return f'{scene}[discretisation]\nmethod = "{method}"\n'

    steps = {}
    for edge, method, is_told in ((None, "mls", False), (2e-3, "mls", True), (5e-7, "mls", False), (2e-3, "es-t3", True)):
        told = checked(desk, text(edge, method)).get("mind", "")
        result = desk.run("--out", "out", "--force", "--until", "0.2 ns")
        assert result.returncode == 0, result.stderr
        for said in told, result.stderr:
            assert ("'disc' has an edge of 2e-09 m" in said) == is_told, said
        steps[edge, method] = desk.summary("out")["state_hash"]
    assert steps[5e-7, "mls"] == steps[None, "mls"], "the point is left out"


def test_limbs_of_few_segments_across_are_told(desk) -> None:
    strip = 'kind = "polygon"\npoints = [[0, 0], ["4 um", 0], ["4 um", "1 um"], [0, "1 um"]]\nspacing = "{} um"'
    disc = 'kind = "disc"\ndiameter = "1 um"\nnodes = 60'
    assert disc in TWO_DISCS
    check = {across: checked(desk, TWO_DISCS.replace(disc, strip.format(1 / across)).replace("3.02 um", "6.3 um").replace("8 um", "12 um"))
             for across in (2, 5)}
    assert "'disc' is 2 segments across, 1e-06 m" in check[2]["bending"]
    assert "bent 20 % too far" in check[2]["bending"]
    assert "bending" not in check[5]


def test_too_fine_an_outline_is_told_how_many_nodes_fit(desk) -> None:
    fine = TWO_DISCS.replace("nodes = 60", "nodes = 60\noutline_nodes = 48")
    desk.write(fine)
    said = desk.engine("check", desk.scene).stderr
    assert "48 outline nodes are too fine for 60 nodes" in said and "support" not in said, said
    fewer, more = (re.search(rf"{key} = (\d+) or {word}", said)[1] for key, word in
                   (("outline_nodes", "fewer"), (" nodes", "more")))
    for advised in fine.replace("= 48", f"= {fewer}"), fine.replace("nodes = 60", f"nodes = {more}"):
        checked(desk, advised)
