#!/usr/bin/python3
"""The converged solution of third_body.toml: the mean of two fine runs of the engine, as oracles/README.md tells.

    /usr/bin/python3 benchmarks/error_study/make_third_body_oracle.py
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "benchmarks"), str(ROOT / "scripts"), str(ROOT / "python")]

import numpy as np

from error_study.choices import Choice
from error_study.measure import Programs, Runner
from error_study.scenes import HERE, SCENES, layer_of, rms

NODES, SAFETY = 1200, 0.4
METHODS = ["mls", "es-t3"]


def main() -> None:
    scene = next(scene for scene in SCENES if scene.name == "third_body")
    build = ROOT / "build/release"
    with tempfile.TemporaryDirectory() as scratch:
        runner = Runner(Programs(build / "pliant_engine", build / "pliant_reference_solver"), Path(scratch), 1)
        layers = []
        for method in METHODS:
            message = runner.run(scene, Choice(method, "corrected", NODES, safety=SAFETY))
            if message:
                sys.exit(message)
            layers.append(layer_of(runner.out))
    mean, change = np.mean(layers, axis=0), np.ptp(np.mean(layers, axis=0), axis=1)[:, None]
    print(f"half of what they differ by: {rms((layers[0] - layers[1]) / 2 / change):.2e} of the changes, rms")
    np.savetxt(HERE / "oracles/third_body.csv", mean.T, delimiter=",", header="height,strain_energy", comments="",
               fmt="%.9g")


if __name__ == "__main__":
    main()
