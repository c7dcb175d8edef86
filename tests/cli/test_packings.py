"""Random packings and outlines from files, through the command line. All EXACT but where a tolerance is named."""

from __future__ import annotations

RING = """$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
6
1 -2 -2 0
2 2 -2 0
3 0 2 0
4 -1 -1 0
5 1 -1 0
6 0 1 0
$EndNodes
$Elements
6
1 2 0 1 2 4
2 2 0 2 5 4
3 2 0 2 3 5
4 2 0 3 6 5
5 2 0 3 1 6
6 2 0 1 4 6
$EndElements
"""

GRAINS = """
[time]
end = "2 ms"
[domain]
period = "8 cm"
[materials.rubber]
law = "neo-hookean"
density = "1000 kg/m3"
young = "200 kPa"
poisson = 0.4
[shapes.wedge]
kind = "file"
file = "wedge.csv"
diameter = "1 cm"
spacing = "1 mm"
[shapes.pebble]
kind = "fourier"
diameter = "1 cm"
descriptors = [0.12, 0.08]
variants = 2
nodes = 80
[[grains]]
shapes = [{ shape = "wedge", share = 0.5 }, { shape = "pebble", share = 0.5 }]
packing = { kind = "random", bottom = 0, top = "6 cm", solid_fraction = 0.7 }
species = [{ body = "compliant", material = "rubber", share = 0.5 }, { body = "rigid", material = "rubber", share = 0.5 }]
angle = "random"
seed = 3
[[walls]]
name = "lower"
material = "rubber"
solid = "below"
level = 0
[[walls]]
name = "upper"
material = "rubber"
solid = "above"
level = "6 cm"
y = { velocity = "-1 m/s" }
[[contacts]]
between = "all"
law = "mohr-coulomb"
friction = 0.3
"""
WEDGE = "x [mm], y [mm]\n0, 0\n3, 0\n3, 1\n1, 3\n0, 3\n"


def test_random_packing_of_outlines_from_files(desk) -> None:
    desk.write(GRAINS)
    (desk.folder / "wedge.csv").write_text(WEDGE)
    check = desk.engine("check", desk.scene)
    assert check.returncode == 0, check.stderr
    # 42.8 grains of 78.5 mm2 would be 0.7: 43 are 0.7036.
    assert "43 grains from y = 0 m to 60 mm, solid fraction 0.7036" in check.stdout, check.stdout
    assert "pairs of bodies close at the start" in check.stdout
    for threads in ("1", "2"):
        result = desk.run("--out", threads, "--threads", threads)
        assert result.returncode == 0, result.stderr
    one, two = desk.summary("1"), desk.summary("2")
    assert one["state_hash"] == two["state_hash"]
    # Within 1 %: grains are hit by a wall at 1 m/s.
    assert abs(one["energy"]["balance_error"]) < 1e-2


def expect_refusal(desk, message: str) -> None:
    before = desk.content()
    result = desk.run("--out", "out")
    assert result.returncode == 2
    assert message in result.stderr, result.stderr
    assert desk.content() == before


def test_body_with_a_hole(desk) -> None:
    desk.write(GRAINS.replace("wedge.csv", "ring.msh"))
    (desk.folder / "ring.msh").write_text(RING)
    expect_refusal(desk, "ring.msh:9: the outline has a hole")


def test_more_grains_than_room(desk) -> None:
    """EXACT: refused at once, and not after long growth."""
    desk.write(GRAINS.replace("solid_fraction = 0.7", "count = 3000"))
    (desk.folder / "wedge.csv").write_text(WEDGE)
    result = desk.engine("check", desk.scene)
    assert result.returncode == 2 and "times the area of their region" in result.stderr, result.stderr


def test_too_dense_a_packing(desk) -> None:
    desk.write(GRAINS.replace("solid_fraction = 0.7", "solid_fraction = 0.97"))
    (desk.folder / "wedge.csv").write_text(WEDGE)
    expect_refusal(desk, "do not come free of each other; without overlap 0.")


BLOCKS = """
[time]
end = "0.2 ms"
[materials.rubber]
law = "neo-hookean"
density = "1000 kg/m3"
young = "200 kPa"
poisson = 0.4
[materials.stone]
law = "rigid"
density = "2000 kg/m3"
[shapes.block]
kind = "polygon"
points = [["0 mm", "0 mm"], ["2 mm", "0 mm"], ["2 mm", "1 mm"], ["0 mm", "1 mm"]]
spacing = "0.25 mm"
[[grains]]
shape = "block"
species = [{ body = "compliant", material = "rubber", share = 0.5 }, { body = "rigid", material = "stone", share = 0.5 }]
species_order = "in turn"
packing = { kind = "file", file = "blocks.csv" }
velocity = { uniform = ["0 m/s", "-1 m/s"] }
[[contacts]]
between = "all"
law = "frictionless"
"""


def test_grains_from_a_file(desk) -> None:
    desk.write(BLOCKS)
    # Blocks of 2 mm2, the second twice as wide and high, turned and 0.1 mm deep in the first.
    (desk.folder / "blocks.csv").write_text("x [mm], y [mm], scale, angle [deg]\n0, 0, 1, 0\n1.9, 0, 2, 90\n9, 0, 1, 5\n")
    check = desk.engine("check", desk.scene)
    assert check.returncode == 0, check.stderr
    assert "compliant grains of rubber             2   0.004 kg/m" in check.stdout, check.stdout
    assert "rigid grains of stone                  1   0.016 kg/m" in check.stdout, check.stdout
    assert "1 pair of bodies, 'grains 0' and 'grains 1' deepest by 0.0001 m" in check.stdout, check.stdout
    assert "move 'grains 0' and 'grains 1' apart by 0.0001" in check.stdout  # rounded up
    assert desk.run("--out", "file").returncode == 0
    desk.write(BLOCKS.replace('kind = "file", file = "blocks.csv"',
                              'kind = "positions", positions = [[0, 0], ["2.1 mm", 0], ["9 mm", 0]]'))
    assert desk.run("--out", "listed").returncode == 0
    (desk.folder / "plain.csv").write_text("0 0\n2.1 0\n9 0\n")
    desk.write(BLOCKS.replace("blocks.csv", "plain.csv").replace(".csv\"", ".csv\", unit = \"mm\""))
    assert desk.run("--out", "plain").returncode == 0
    hashes = [desk.summary(out)["state_hash"] for out in ("file", "listed", "plain")]
    assert hashes[0] != hashes[1] == hashes[2]
    result = desk.reference("--out", "reference", "--quiet", "--dt", "10 us")
    assert result.returncode == 0, result.stderr


# Two blocks of 2 mm by 1 mm side by side, with two nodes each at their common border.
TWO_BLOCKS = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
2 1 "left"
2 2 "right"
$EndPhysicalNames
$Nodes
8
1 0 0 0
2 2 0 0
3 2 1 0
4 0 1 0
5 2 0 0
6 4 0 0
7 4 1 0
8 2 1 0
$EndNodes
$Elements
2
1 3 2 1 1 1 2 3 4
2 3 2 2 2 5 6 7 8
$EndElements
"""


def test_parts_of_a_mesh_in_place(desk) -> None:
    """They are what the same blocks are, given as polygons one by one."""
    polygon = BLOCKS[BLOCKS.index("[shapes.block]"):BLOCKS.index("spacing")]
    mesh = '[shapes.block]\nkind = "file"\nfile = "blocks.msh"\nunit = "mm"\n'
    meshed = BLOCKS.replace(polygon, mesh).replace('kind = "file", file = "blocks.csv"', 'kind = "in place"')
    (desk.folder / "blocks.msh").write_text(TWO_BLOCKS)
    desk.write(meshed)
    expect_refusal(desk, "blocks.msh:15: 2 parts, \"left\", \"right\"; allowed: one, chosen by its name, as in "
                         "parts = \"left\", or each a shape of its own, parts = \"all\"; they meet at 2 nodes")
    desk.write(meshed.replace(mesh, f'{mesh}parts = "all"\n'))
    check = desk.engine("check", desk.scene)
    assert check.returncode == 0, check.stderr
    assert "compliant grains of rubber             1   0.002 kg/m" in check.stdout, check.stdout
    assert "rigid grains of stone                  1   0.004 kg/m" in check.stdout, check.stdout
    assert "overlap" not in check.stdout and "pairs of bodies close at the start: 1" in check.stdout, check.stdout
    assert desk.run("--out", "mesh").returncode == 0
    assert (desk.folder / "mesh/outline_block.msh").read_text() == TWO_BLOCKS
    desk.write(BLOCKS.replace('kind = "file", file = "blocks.csv"',
                              'kind = "positions", positions = [["1 mm", "0.5 mm"], ["3 mm", "0.5 mm"]]'))
    assert desk.run("--out", "polygons").returncode == 0
    ours, theirs = (desk.summary(out)["energy"] for out in ("mesh", "polygons"))
    # Tolerance: rounding of the centres, 1e-16 of 1 mm, in a few dozens of steps.
    assert abs(ours["kinetic"] - theirs["kinetic"]) < 1e-10 * theirs["kinetic"]
