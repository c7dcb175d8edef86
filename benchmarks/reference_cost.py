"""What a step of the reference solver costs against its degrees of freedom: factorisation and memory.

    ./pliant bench --reference

One compliant disc of more and more nodes hits nothing: two implicit steps each, so that every factorisation has the same pattern.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SCENE = """\
title = "Disc of {nodes} nodes"
[time]
end = "{end} ns"
[materials.soft]
law = "neo-hookean"
density = "1200 kg/m3"
young = "2 GPa"
poisson = 0.4
[shapes.disc]
kind = "disc"
diameter = "1 um"
nodes = {nodes}
[[grains]]
shape = "disc"
body = "compliant"
material = "soft"
packing = {{ kind = "positions", positions = [["0 m", "0 m"]] }}
velocity = {{ gradient = [["1e8 s-1", "0 s-1"], ["0 s-1", "-1e8 s-1"]] }}
[[contacts]]
between = ["soft", "soft"]
law = "frictionless"
"""


def cost(solver: Path, nodes: int, folder: Path) -> dict:
    scene = folder / f"disc_{nodes}.toml"
    scene.write_text(SCENE.format(nodes=nodes, end=0.2))
    out = folder / f"out_{nodes}"
    command = [solver, scene, "--out", out, "--dt", "0.1 ns", "--quiet"]
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode != 0:
        sys.exit(result.stderr)
    return json.loads((out / "summary.json").read_text())


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="./pliant bench --reference", description=__doc__.splitlines()[0])
    parser.add_argument("--solver", type=Path, default=ROOT / "build/release/pliant_reference_solver")
    parser.add_argument("--nodes", type=int, nargs="+", default=[168, 700, 2500, 10000])
    options = parser.parse_args(arguments)
    print(f"{'DOF':>7} {'Newton iterations':>18} {'a factorisation':>16} {'of all time':>12} {'peak memory':>12}")
    with tempfile.TemporaryDirectory() as folder:
        for nodes in options.nodes:
            summary = cost(options.solver, nodes, Path(folder))
            parts = summary["factorisation"]
            share = parts["seconds"] / summary["wall_seconds"]
            each = parts["seconds"] / parts["factorisations"]
            print(f"{summary['dofs']:>7} {summary['evaluations']:>18} {each * 1e3:>13.1f} ms {share:>11.0%} "
                  f"{summary['peak_memory_bytes'] / 2**20:>8.0f} MiB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
