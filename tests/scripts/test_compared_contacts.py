"""scripts/compare.py on the pairs in touch of two runs. All EXACT."""

import re
import subprocess
from pathlib import Path

import h5py
import numpy as np

from moving_discs import FRAMES, write_run

ROOT = Path(__file__).resolve().parents[2]
PAIRS = {(0, 1, 0): (4.0, 2e-7), (0, 1, -1): (8.0, 3e-7), (1, 2, 0): (0.5, 1e-7)}  # bodies, image: N/m, m


def write(folder: Path, pairs: dict[tuple[int, int, int], tuple[float, float]]) -> Path:
    write_run(folder)
    keys = np.array(list(pairs)).reshape(-1, 3)
    values = np.array(list(pairs.values())).reshape(-1, 2)
    with h5py.File(folder / "frames.h5", "a") as file:
        for index in range(FRAMES):
            group = file.create_group(f"contacts/{index:06}")
            group["bodies"], group["images"], group["length"] = keys[:, :2], keys[:, 2], values[:, 1]
            group["force"] = np.column_stack([values[:, 0], 0 * values[:, 0]])
            group["point"] = np.column_stack([keys[:, 1] + 0.0, keys[:, 2] + 0.0])
    return folder


def compared(code: int, *arguments: object) -> str:
    command = ["/usr/bin/python3", "-B", str(ROOT / "scripts/compare.py"), *map(str, arguments)]
    result = subprocess.run(command, capture_output=True, text=True)
    assert result.returncode == code, result.stderr + result.stdout
    return result.stdout


def largest(text: str, field: str) -> list[float]:
    """Absolute and relative; none when the field is the same in both."""
    row = re.search(rf"frames contacts/{field} +(\S+) absolute +(\S+) relative", text)
    return [float(number) for number in row.groups()] if row else []


def test_pairs_are_the_same_whatever_their_order(tmp_path: Path) -> None:
    write(tmp_path / "a", PAIRS)
    write(tmp_path / "b", dict(reversed(PAIRS.items())))
    assert "equal bit by bit" in compared(0, tmp_path / "a", tmp_path / "b")


def test_a_pair_that_one_has_alone_has_no_force_in_the_other(tmp_path: Path) -> None:
    write(tmp_path / "a", PAIRS)
    write(tmp_path / "b", {key: values for key, values in PAIRS.items() if key != (1, 2, 0)})
    for folders in (("a", "b"), ("b", "a")):
        text = compared(1, *(tmp_path / folder for folder in folders))
        assert largest(text, "force") == [0.5, 0.5 / 8] and largest(text, "length") == [1e-7, 0.3333]
        assert largest(text, "point") == []
    compared(0, tmp_path / "a", tmp_path / "b", "--tolerance", 0.4)


def test_images_of_a_pair_are_two(tmp_path: Path) -> None:
    write(tmp_path / "a", PAIRS)
    write(tmp_path / "b", PAIRS | {(0, 1, -1): (7.0, 3e-7)})
    assert largest(compared(1, tmp_path / "a", tmp_path / "b"), "force") == [1.0, 0.125]


def test_a_frame_in_which_nothing_touches(tmp_path: Path) -> None:
    write(tmp_path / "a", PAIRS)
    write(tmp_path / "b", {})
    text = compared(1, tmp_path / "a", tmp_path / "b")
    assert largest(text, "force") == [8.0, 1.0] and largest(text, "point") == []
    assert "equal bit by bit" in compared(0, tmp_path / "b", tmp_path / "b")


def test_contacts_of_one_run_alone_are_told(tmp_path: Path) -> None:
    write(tmp_path / "a", PAIRS)
    write_run(tmp_path / "b")
    assert "frames contacts: only in the first run" in compared(1, tmp_path / "a", tmp_path / "b")
