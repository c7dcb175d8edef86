"""Pliant's results and scenes in Python.

    import pliant

    run = pliant.open("results/two_discs")         # what a run wrote: see pliant.results.Run
    run.summary["energy"]["balance_error"]
    run.probes.column("energy.kinetic").values     # [rows], in the unit that .unit names
    run.frames.positions("outlines", 0)            # [points x 2], m; frames are read one by one
    run.frames.bodies("rigid", 0, box)             # numbers of bodies, by kind and place; centres, polygons, contacts

    # from pliant import order, network, coarse: neighbours and clusters; chains of forces; means over cells

    scene = pliant.Scene.read("cases/two_discs.toml")
    scene["shapes.disc.nodes"] = 340
    scene.check()                                  # as the engine does; BadScene says what is wrong, and where
    pliant.run(scene, "results/finer", threads=2)  # the same folder, opened

Nothing here computes mechanics: that is the engine's.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from pliant import engine
from pliant.engine import BadScene, EngineWarning, RunFailed
from pliant.frames import BadFolder, Contacts, Frames, Grid
from pliant.results import Column, Run, Table, read_run

if TYPE_CHECKING:
    from pliant.scene import Scene

__all__ = ["BadFolder", "BadScene", "Column", "Contacts", "EngineWarning", "Frames", "Grid", "Run", "RunFailed", "Scene", "Table", "open", "run"]


def open(folder: str | Path) -> Run:  # noqa: A001: as h5py.File or PIL.Image.open
    """What a run wrote into a folder. BadFolder: it is none."""
    return read_run(Path(folder))


def run(scene: Scene | str | Path, folder: str | Path, threads: int = 1) -> Run:
    """Runs a scene, or the one in a file, into a folder, over what is there, and opens it. BadScene, RunFailed. What the
    engine warns of comes as EngineWarning."""
    if isinstance(scene, (str, Path)):
        return engine.run(Path(scene), Path(folder), threads)
    return scene.run(folder, threads)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


def __getattr__(name: str) -> Any:
    """Scene imports tomlkit, which reading results does without."""
    if name == "Scene":
        from pliant.scene import Scene

        return Scene
    raise AttributeError(f"module 'pliant' has no attribute '{name}'")
