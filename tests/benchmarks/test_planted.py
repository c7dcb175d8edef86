"""benchmarks/planted.py: places and commands; ./pliant bench planted itself runs in continuous integration. All EXACT."""

from __future__ import annotations

from pathlib import Path

import pytest

import planted

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.parametrize("place", [planted.CONTACT, planted.STEP], ids=lambda place: Path(place.file).stem)
def test_places_are_there(place: planted.Place) -> None:
    before, behind = place.planted("seed();").split("\n  seed();")
    assert before.endswith(place.behind) and before + behind == (ROOT / place.file).read_text()


def test_a_place_that_moved_is_told() -> None:
    with pytest.raises(RuntimeError, match="stands 0 times in lib/dynamics/verlet.cpp"):
        planted.Place("lib/dynamics/verlet.cpp", "no such text").planted("seed();")


def test_objects_are_linked_before_libraries() -> None:
    line = ": && /usr/bin/clang++ -O3 a.o 'b c.o' -o program -Wl,-rpath,/x liba.a -lm && cmake -D TARGET=program -P x"
    assert planted.link_command(line, "program", Path("there/planted.o"), Path("there/program")) == [
        "/usr/bin/clang++", "-O3", "a.o", "b c.o", "there/planted.o", "-o", "there/program", "-Wl,-rpath,/x", "liba.a", "-lm"]
    with pytest.raises(RuntimeError, match="no command that links other"):
        planted.link_command(line, "other", Path("planted.o"), Path("other"))


@pytest.mark.parametrize("found, code, said", [(True, 0, "found"), (False, 1, "NOT FOUND")])
def test_exit_codes(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], found: bool, code: int,
                    said: str) -> None:
    monkeypatch.setattr(planted, "PLANTS", {"a weed": lambda scratch: found})
    assert planted.main([]) == code
    assert capsys.readouterr().out == f"planted: a weed: {said}\n"


@pytest.mark.parametrize("error", [RuntimeError("why"), IndexError("why"), ValueError("why"), FileNotFoundError("why")])
def test_what_cannot_be_asked_is_no_verdict(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str],
                                            error: Exception) -> None:
    def fails(scratch: Path) -> bool:
        raise error

    monkeypatch.setattr(planted, "PLANTS", {"a weed": fails})
    assert planted.main([]) == 2
    assert capsys.readouterr().err == "planted: a weed: could not be asked: why\n"
