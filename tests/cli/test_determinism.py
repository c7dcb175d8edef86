"""The hash of the final state over numbers of threads: equal within each build, EXACT. `./pliant test` asks one build;
continuous integration calls it again with more, which PLIANT_BUILDS names."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from conftest import ENGINE, ROOT, Desk

THREADS = [1, 2, 3, 4, 8]
HARD = ROOT / "verify/hard_cases"


def hard(name: str, method: str, end: str) -> str:
    """Of verify/hard_cases, up to an end."""
    text = (HARD / f"{name}.toml").read_text().replace("@method@", method)
    before = next(line for line in text.splitlines() if line.startswith("end = "))
    return text.replace(before, f"end = {end}")


def third_body() -> str:
    text = (ROOT / "cases/third_body_mini.toml").read_text()
    return text.replace('end = "4 us"', 'end = "0.001 us"')


def plastic_cell() -> str:
    """The compact of plastic discs, squeezed at once."""
    text = (ROOT / "cases/plastic_compact.toml").read_text().replace('end = "1400 ms"', 'end = "8 ms"')
    return "\n".join(f'{line[:2]} = [["0 ms", 1], ["8 ms", 0.84]]' if line.startswith(("xx = ", "yy = ")) else line
                     for line in text.splitlines())


SCENES = {"gear": lambda: hard("gear", "mls", "1.5"), "torn_cluster": lambda: hard("torn_cluster", "es-t3", "1.5"),
          "closing_ring": lambda: hard("closing_ring", "mls-gauss", "1"),
          "to_and_fro": lambda: hard("to_and_fro", "t3", "1"), "third_body_mini": third_body,
          "plastic_cell": plastic_cell}


@pytest.fixture(autouse=True)
def patient(monkeypatch: pytest.MonkeyPatch) -> None:
    """More threads than cores must not wait by spinning."""
    monkeypatch.setenv("OMP_WAIT_POLICY", "passive")
    monkeypatch.setenv("KMP_BLOCKTIME", "0")


def builds() -> list[Path]:
    """Of the presets named, each of which must be there."""
    return [ENGINE, *(ROOT / f"build/{preset}/pliant_engine" for preset in os.environ.get("PLIANT_BUILDS", "").split())]


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("engine", builds(), ids=lambda engine: engine.parent.name)
def test_same_bits_for_any_number_of_threads(desk: Desk, engine: Path, name: str) -> None:
    desk.write(SCENES[name]())
    hashes = set()
    for threads in THREADS:
        result = desk.call(engine, "run", desk.scene, "--out", f"out{threads}", "--threads", str(threads), "--quiet")
        assert result.returncode == 0, result.stderr
        summary = desk.summary(f"out{threads}")
        assert summary["steps"] > 50 and summary["threads"] == threads
        hashes.add(summary["state_hash"])
    print(f"{engine.parent.name:12} {name:18} {' '.join(hashes)}")
    assert len(hashes) == 1


@pytest.mark.parametrize("name", SCENES)
def test_same_bits_whatever_is_put_out(desk: Desk, name: str) -> None:
    """EXACT, with outputs of unrelated periods, some four a step. That they take candidates as they are is shown in
    tests/dynamics/observer_test.cpp."""
    text = SCENES[name]()
    end = next(line for line in text.splitlines() if line.startswith("end = ")).removeprefix("end = ").strip('"')
    number, unit = (*end.split(), "s")[:2]
    hashes, rows, more = set(), [], ""
    for _ in range(2):
        desk.write(text + more)
        assert desk.run("--out", "out", "--force", "--quiet").returncode == 0
        summary = desk.summary("out")
        table = desk.folder / "out/probes.csv"
        rows.append(len(table.read_text().splitlines()) if table.exists() else 0)
        frames = f'\n[frames]\nperiod = "{float(number) / 7.3} {unit}"\n' if "[frames]" not in text else ""
        more = frames + "".join(
            f'\n[[probes]]\nname = "more{i}"\nquantity = "energy"\nperiod = "{float(number) / count} {unit}"\n'
            for i, count in enumerate((31.7, 4.1 * summary["steps"])))
        hashes.add((summary["state_hash"], summary["steps"]))
    assert rows[1] > rows[0] + 4 * summary["steps"]
    assert len(hashes) == 1
