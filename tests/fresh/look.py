"""Whether files are there and not empty, and pictures among them (PNG, GIF) not blank. Exit code 1 where one is.

Run: /usr/bin/python3 tests/fresh/look.py FILE...
"""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

SMALLEST = 2000  # bytes of a file that shows something
LEAST_DRAWN = 0.01  # share of pixels that are not of the commonest colour: frame and letters alone take some 0.005


def drawn(pixels: np.ndarray) -> float:
    """Share of the pixels [rows x columns x colours] that are not of the commonest colour."""
    colours, counts = np.unique(pixels[..., :3].reshape(-1, 3), axis=0, return_counts=True)
    return 1 - counts.max() / counts.sum() if len(colours) > 1 else 0.0


def fault(file: Path) -> str:
    if not file.is_file():
        return "is not there"
    if file.stat().st_size < SMALLEST:
        return f"has {file.stat().st_size} bytes"
    if file.suffix in (".png", ".gif") and (share := drawn(plt.imread(file))) < LEAST_DRAWN:
        return f"is blank: {100 * share:.2f} % of it are drawn on"
    return ""


def main(files: list[str]) -> int:
    faults = {file: fault(Path(file)) for file in files}
    for file, what in faults.items():
        if what:
            print(f"{file} {what}")
    return 1 if any(faults.values()) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
