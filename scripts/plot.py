#!/usr/bin/python3
"""Draws the pictures of a run into its result folder.

    ./pliant plot out/third_body_mini
    ./pliant plot out/third_body --times 1e-6 1.5e-6 6e-6 18.5e-6
    ./pliant plot out/coarse out/fine

grains.png (kinds at four times), velocity.png, von_mises.png, damage.png, fragments.png, a map of each other field of
the frames, chains.png (contact forces), network.png (their statistics), coarse.png (means over cells), steps.png,
forces.png, energy.png, probes.png (what else the scene's probes measure), failure.png (of a run that could not go on:
the place): what the run has data for; the rest is named and left out. Of several runs comparison.png alone, into the
first one's folder: their probes, a curve a run. Exit code 2: no such result folder, 4: a picture cannot be written.
"""

import argparse
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "python"))

from pliant.frames import BadFolder
from pliant.results import Run, read_run
from plots import curves, maps
from plots.chains import chains
from plots.coarse import FEWEST as FEWEST_GRAINS
from plots.coarse import coarse
from plots.comparison import MOST_RUNS, comparison
from plots.failure import failure
from plots.network import FEWEST as FEWEST_CONTACTS
from plots.network import network

BAD_INPUT, OUTPUT_FAILED = 2, 4
DOTS_PER_INCH = 200


def parse_arguments(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="pliant plot", description="Draws the pictures of a run into its result folder.",
        epilog="example: ./pliant plot out/third_body_mini",
    )
    parser.add_argument("folders", type=Path, nargs="+", metavar="folder",
                        help=f"result folder of `pliant run`; of 2 to {MOST_RUNS} their probes are drawn together")
    parser.add_argument("--times", type=float, nargs="+", metavar="SECONDS",
                        help="times of the maps; the nearest frames are drawn (default: four, evenly spread)")
    return parser.parse_args(arguments)


def chosen_frames(run: Run, times: list[float] | None) -> list[int]:
    """Indices of the frames that maps show, in order, each once."""
    if not run.has_frames:
        return []
    count = len(run.frames.times)
    wanted = [run.frames.nearest(t) for t in times] if times else np.linspace(0, count - 1, 4).round().astype(int)
    return sorted({int(index) for index in wanted})


def pictures(run: Run, times: list[float] | None) -> dict[str, tuple[Callable[[], Figure | None], str]]:
    """For each file what draws it, and what it needs."""
    chosen = chosen_frames(run, times)
    frames = run.has_frames and "bodies" in run.frames.grids
    return {
        "grains.png": (lambda: maps.grains(run, chosen) if frames else None, "frames"),
        "velocity.png": (lambda: maps.velocity(run, chosen) if frames else None, "frames with velocity"),
        "von_mises.png": (lambda: maps.von_mises(run, chosen) if frames else None, "frames with von_mises"),
        "damage.png": (lambda: maps.damage(run, chosen) if frames else None, "frames with bond_damage"),
        **({"fragments.png": (lambda: maps.fragments(run, chosen), "frames with fragment")}
           if frames and "fragment" in run.frames.names("bodies") else {}),
        **({f"{name}.png": (partial(maps.field, run, chosen, name), f"frames with {name}") for name in maps.others(run.frames)}
           if frames else {}),
        "steps.png": (lambda: curves.steps(run), "steps.csv"),
        "forces.png": (lambda: curves.forces(run), "probes of forces in probes.csv"),
        "energy.png": (lambda: curves.energy(run), "probe of energy in probes.csv"),
        "probes.png": (lambda: curves.probes(run), "other probes in probes.csv"),
        **(_of_contacts(run, chosen) if frames and run.frames.contacts(0) is not None else {}),
        **({"coarse.png": (lambda: coarse(run, chosen), "frames of 50 grains or more, or has two periods")}
           if frames and len(run.frames.bodies("grain")) >= FEWEST_GRAINS else {}),
        **({"failure.png": (lambda: failure(run), "failure.json with outlines")} if (run.folder / "failure.json").exists()
           else {}),
    }


def _of_contacts(run: Run, chosen: list[int]) -> dict[str, tuple[Callable[[], Figure | None], str]]:
    return {
        "chains.png": (lambda: chains(run, chosen), "contacts at these times"),
        "network.png": (lambda: network(run, chosen), f"{FEWEST_CONTACTS} contacts at the last of these times"),
    }


def save(figure: Figure, file: Path) -> None:
    """The file is whole or absent: written under another name first."""
    temporary = file.with_name(file.name + ".tmp")
    try:
        figure.savefig(temporary, format="png", dpi=DOTS_PER_INCH)
        temporary.replace(file)
    finally:
        temporary.unlink(missing_ok=True)
        plt.close(figure)


def draw_all(run: Run, times: list[float] | None) -> None:
    for name, (draw, needs) in pictures(run, times).items():
        figure = draw()
        if figure is None:
            print(f"{name}: left out, the run has no {needs}")
            continue
        save(figure, run.folder / name)
        print(run.folder / name)


def draw_together(runs: list[Run]) -> None:
    figure = comparison(runs)
    if figure is None:
        raise BadFolder("no two of these runs have a probe in common, or none has one that is not 0 all along")
    save(figure, runs[0].folder / "comparison.png")
    print(runs[0].folder / "comparison.png")


def main(arguments: list[str]) -> int:
    options = parse_arguments(arguments)
    try:
        if len(options.folders) > MOST_RUNS:
            raise BadFolder(f"{len(options.folders)} runs; allowed: 1 to {MOST_RUNS}")
        if len(options.folders) > 1 and options.times:
            raise BadFolder("--times chooses frames of one run; of several only probes are drawn")
        runs = [read_run(folder) for folder in options.folders]
        draw_all(runs[0], options.times) if len(runs) == 1 else draw_together(runs)
    except BadFolder as error:
        print(f"error: {error}", file=sys.stderr)
        return BAD_INPUT
    except OSError as error:
        print(f"error: {options.folders[0]}: a picture cannot be written: {error.strerror or error}; "
              "check the permissions and the free disk space", file=sys.stderr)
        return OUTPUT_FAILED
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
