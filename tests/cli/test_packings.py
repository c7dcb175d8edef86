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
mix = [{ body = "compliant", material = "rubber", share = 0.5 }, { body = "rigid", material = "rubber", share = 0.5 }]
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


def test_too_dense_a_packing(desk) -> None:
    desk.write(GRAINS.replace("solid_fraction = 0.7", "solid_fraction = 0.97"))
    (desk.folder / "wedge.csv").write_text(WEDGE)
    expect_refusal(desk, "do not come free of each other; without overlap 0.")
