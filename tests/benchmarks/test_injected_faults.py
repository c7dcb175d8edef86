"""benchmarks/injected_faults.py: places and commands; ./pliant bench faults itself is run by hand. All EXACT."""

from __future__ import annotations

from pathlib import Path

import pytest

import injected_faults

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.parametrize("place", [injected_faults.CONTACT, injected_faults.STEP], ids=lambda place: Path(place.file).stem)
def test_places_are_there(place: injected_faults.Place) -> None:
    before, behind = place.with_fault("seed();").split("\n  seed();")
    assert before.endswith(place.behind) and before + behind == (ROOT / place.file).read_text()


def test_a_place_that_moved_is_told() -> None:
    with pytest.raises(RuntimeError, match="stands 0 times in lib/dynamics/verlet.cpp"):
        injected_faults.Place("lib/dynamics/verlet.cpp", "no such text").with_fault("seed();")


def test_objects_are_linked_before_libraries() -> None:
    line = ": && /usr/bin/clang++ -O3 a.o 'b c.o' -o program -Wl,-rpath,/x liba.a -lm && cmake -D TARGET=program -P x"
    assert injected_faults.link_command(line, "program", Path("there/faulty.o"), Path("there/program")) == [
        "/usr/bin/clang++", "-O3", "a.o", "b c.o", "there/faulty.o", "-o", "there/program", "-Wl,-rpath,/x", "liba.a", "-lm"]
    with pytest.raises(RuntimeError, match="no command that links other"):
        injected_faults.link_command(line, "other", Path("faulty.o"), Path("other"))


@pytest.mark.parametrize("found, code, said", [(True, 0, "found"), (False, 1, "NOT FOUND")])
def test_exit_codes(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], found: bool, code: int,
                    said: str) -> None:
    monkeypatch.setattr(injected_faults, "FAULTS", {"a weed": lambda scratch: found})
    assert injected_faults.main([]) == code
    assert capsys.readouterr().out == f"faults: a weed: {said}\n"


@pytest.mark.parametrize("error", [RuntimeError("why"), IndexError("why"), ValueError("why"), FileNotFoundError("why")])
def test_what_cannot_be_asked_is_no_verdict(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str],
                                            error: Exception) -> None:
    def fails(scratch: Path) -> bool:
        raise error

    monkeypatch.setattr(injected_faults, "FAULTS", {"a weed": fails})
    assert injected_faults.main([]) == 2
    assert capsys.readouterr().err == "faults: a weed: could not be asked: why\n"
