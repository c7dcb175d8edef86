#!/usr/bin/python3
"""What each feature adds to a time step: instructions counted by callgrind on one small scene, features turned on one at a time.

    ./pliant bench --instructions
    ./pliant bench --instructions --baseline DIR/pliant_engine     # the same scene with an earlier engine

Counts are those of the steps alone, per force evaluation, of one thread: they hardly change from run to run, whatever else the machine
does. Engines must be built without AVX, of which valgrind does not know all: preset `counting`. The scene is nearly at rest, so that there is no search
for new contacts. Where a feature brings other contacts with it (friction, cohesion, sizes, loaded walls) its row counts their work too: the table shows
their number.
"""

import argparse
import json
import os
import sys
import tempfile
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import callgrind

ROOT = Path(__file__).resolve().parents[1]
MISSING = 2

PLAIN = """
[time]
end = "0.04 us"
stop_at_outputs = true
tolerance = 1e-2

[domain]
period = "4 um"

[materials.soft]
law = "neo-hookean"
density = "1200 kg/m3"
young = "2 GPa"
poisson = 0.4

[materials.hard]
law = "rigid"
density = "1200 kg/m3"

[shapes.disc]
kind = "disc"
diameter = "1 um"
nodes = 84

[[grains]]
name = "layer"
shape = "disc"
species = [{ body = "compliant", material = "soft", share = 0.5 }, { body = "rigid", material = "hard", share = 0.5 }]
seed = 1
packing = { kind = "grid", columns = 4, rows = 8, pitch = "1 um", row_pitch = "0.997 um", origin = ["0.5 um", "0.5 um"] }

[[walls]]
name = "lower"
material = "hard"
solid = "below"
level = "0 um"
thickness = "1 um"

[[walls]]
name = "upper"
material = "hard"
solid = "above"
level = "7.979 um"
thickness = "1 um"

[[contacts]]
between = "all"
law = "frictionless"
stiffness = "2e17 Pa/m"
"""


PAIR_RULES = """
[[contacts]]
between = ["soft", "hard"]
law = "frictionless"
stiffness = "2e17 Pa/m"

[[contacts]]
between = ["layer", "lower"]
law = "frictionless"
stiffness = "2e17 Pa/m"
"""


@dataclass
class Feature:
    name: str
    edit: Callable[[str], str]


def replaced(old: str, new: str) -> Callable[[str], str]:
    def edit(scene: str) -> str:
        assert old in scene, old
        return scene.replace(old, new)
    return edit


def appended(text: str) -> Callable[[str], str]:
    return lambda scene: scene + text


def both(first: Callable[[str], str], second: Callable[[str], str]) -> Callable[[str], str]:
    return lambda scene: second(first(scene))


def law(text: str) -> Callable[[str], str]:
    return replaced('law = "frictionless"', text)


FEATURES = [
    Feature("plain scene", lambda scene: scene),
    Feature("friction", law('law = "mohr-coulomb"\nfriction = 0.3')),
    Feature("cohesion", law('law = "cohesive"\nstrength = "200 MPa"')),
    Feature("bonds", appended('\n[[bonds]]\nbetween = "all"\ngap = "2 nm"\nstrength = "200 MPa"\nfracture_energy = "1 J/m2"\n')),
    Feature("restitution of rigid pairs", law('law = "frictionless"\nrestitution = 0.9')),
    Feature("smooth start of pressure", law('law = "frictionless"\nsmoothing = 0.02')),
    Feature("rules for three pairs", appended(PAIR_RULES)),
    Feature("present lengths", appended('\n[contact]\nlength = "current"\n')),
    Feature("self-contact", appended("\n[contact]\nself_contact = true\n")),
    Feature("refresh every 50 steps", appended("\n[contact]\nrefresh = 50\n")),
    Feature("viscosity", replaced("poisson = 0.4", 'poisson = 0.4\nviscosity = "0.01 Pa s"')),
    Feature("mass damping", replaced("poisson = 0.4", 'poisson = 0.4\nmass_damping = "1e6 s-1"')),
    Feature("sizes from 0.96 to 1", replaced("seed = 1", 'seed = 1\nsize = { distribution = "uniform", low = 0.96, high = 1 }')),
    Feature("servo wall", replaced('level = "7.979 um"', 'level = "7.979 um"\ny = { pressure = "0.1 GPa", damping = "1 MPa s/m" }')),
    Feature("pressure on one grain", appended('\n[[boundary]]\nof = "layer 5"\npressure = "1 MPa"\npart = { side = "top" }\n')),
    Feature("gravity", replaced("[materials.soft]", 'gravity = ["0 m/s2", "-10 m/s2"]\n\n[materials.soft]')),
    Feature("random angles", replaced("seed = 1", 'angle = "random"\nseed = 1')),
    Feature("driven and pressed wall", replaced('level = "7.979 um"', 'level = "7.979 um"\nx = { velocity = "1 m/s" }\ny = { pressure = "0.1 GPa" }')),
    Feature("energy probe, 40 rows", appended('\n[[probes]]\nname = "energy"\nquantity = "energy"\nperiod = "1 ns"\n')),
    Feature("frames, 5", appended('\n[frames]\nperiod = "10 ns"\nfields = ["von_mises", "velocity"]\n')),
    Feature("corrected mass", appended('\n[discretisation]\nmass = "corrected"\n')),
    Feature("method mls-gauss, 3 points", appended('\n[discretisation]\nmethod = "mls-gauss"\n')),
    Feature("method es-t3", appended('\n[discretisation]\nmethod = "es-t3"\n')),
    Feature("method t3", appended('\n[discretisation]\nmethod = "t3"\n')),
    Feature("law melody", replaced('law = "neo-hookean"', 'law = "melody"')),
    Feature("step doubling", replaced("tolerance = 1e-2", 'integrator = "step-doubling"')),
]


@dataclass
class Count:
    instructions: int
    libraries: int  # of them
    evaluations: int
    contacts: float

    def per_evaluation(self) -> float:
        return self.instructions / self.evaluations


def count(engine: Path, scene: str, folder: Path) -> Count:
    """Runs a scene under callgrind and counts its steps. Raises RuntimeError with the engine's own message."""
    folder.mkdir(parents=True)
    file = folder / "scene.toml"
    file.write_text(scene)
    command = [str(engine), "run", str(file), "--out", str(folder / "out"), "--threads", "1", "--quiet"]
    counted = callgrind.count(command, "pliant::Simulation::step(double, pliant::Observer const*)", folder)
    summary = json.loads((folder / "out/summary.json").read_text())
    steps = (folder / "out/steps.csv").read_text().splitlines()
    contacts = [float(row.rsplit(",", 1)[1]) for row in steps[1:]]
    return Count(counted.instructions, counted.libraries, summary["evaluations"] - 1, sum(contacts) / len(contacts))


def table(counts: dict[str, Count]) -> str:
    plain = counts["plain scene"].per_evaluation()
    lines = ["| scene | instructions an evaluation | more than plain | nodes in contact |", "|---|---|---|---|"]
    for name, c in counts.items():
        lines.append(f"| {name} | {c.per_evaluation():,.0f} | {100 * (c.per_evaluation() / plain - 1):+.2f} % | {c.contacts:.0f} |")
    return "\n".join(lines)


def parse_arguments(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="pliant bench --instructions", description="Instructions that each feature adds to a force evaluation.")
    parser.add_argument("--engine", type=Path, default=ROOT / "build/counting/pliant_engine", help="engine built without AVX")
    parser.add_argument("--baseline", type=Path, help="an earlier engine: compares the plain scene alone")
    parser.add_argument("--json", type=Path, help="writes the counts there as well")
    parser.add_argument("--only", nargs="+", metavar="NAME", help="features to count, by the beginning of their names")
    return parser.parse_args(arguments)


def main(arguments: list[str]) -> int:
    options = parse_arguments(arguments)
    with tempfile.TemporaryDirectory() as scratch, ThreadPoolExecutor(max_workers=os.cpu_count()) as pool:
        chosen = [f for f in FEATURES if f.name == "plain scene" or not options.only or any(f.name.startswith(n) for n in options.only)]
        if options.baseline:
            chosen = chosen[:1]
        jobs = {f.name: pool.submit(count, options.engine, f.edit(PLAIN), Path(scratch) / str(i)) for i, f in enumerate(chosen)}
        if options.baseline:
            jobs["plain scene, baseline"] = pool.submit(count, options.baseline, PLAIN, Path(scratch) / "baseline")
        try:
            counts = {name: job.result() for name, job in jobs.items()}
        except (RuntimeError, OSError) as error:
            print(f"error: {error}", file=sys.stderr)
            return MISSING
    print(table(counts))
    if options.json:
        options.json.write_text(json.dumps({name: vars(c) for name, c in counts.items()}, indent=2) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
