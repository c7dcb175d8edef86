"""Whether files are there and not empty, and pictures among them (PNG, GIF) not blank. Exit code 1 where one is.

Run: /usr/bin/python3 tests/fresh/look.py FILE...
"""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

SMALLEST = 2000  # bytes of a file that shows something
LEAST_COLOURED = 5e-4  # share of pixels: bodies and curves have colours, frames and letters are grey


def coloured(pixels: np.ndarray) -> float:
    """Share of the pixels [rows x columns x colours] that are not grey."""
    colours = pixels[..., :3].astype(float) / (255 if pixels.dtype == np.uint8 else 1)
    return float((np.ptp(colours, axis=-1) > 0.1).mean())


def fault(file: Path) -> str:
    if not file.is_file():
        return "is not there"
    if file.stat().st_size < SMALLEST:
        return f"has {file.stat().st_size} bytes"
    if file.suffix in (".png", ".gif") and (share := coloured(plt.imread(file))) < LEAST_COLOURED:
        return f"is blank: {100 * share:.2f} % of it have a colour"
    return ""


def main(files: list[str]) -> int:
    faults = {file: fault(Path(file)) for file in files}
    for file, what in faults.items():
        if what:
            print(f"{file} {what}")
    return 1 if any(faults.values()) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
