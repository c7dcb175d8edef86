"""Bad input: one clear message with file and line, exit code 2 (4 for output), nothing left behind. All EXACT."""

from __future__ import annotations

from dataclasses import dataclass

import pytest
from scenes import TWO_DISCS, line_of

BAD_INPUT, INPUT_OUTPUT = 2, 4


@dataclass
class Mistake:
    """A scene with one mistake: what is replaced by what, and what the message must name."""

    old: str
    new: str
    names: list[str]
    says_line: bool = True

    def text(self) -> str:
        assert self.old in TWO_DISCS, f"the scene has no {self.old!r}"
        return TWO_DISCS.replace(self.old, self.new, 1)


MISTAKES = {
    "unknown key": Mistake("poisson = 0.4", "poisson = 0.4\ncolour = 3", ["colour"]),
    "misspelt key": Mistake("young =", "yuong =", ["yuong", "young"]),
    "required key by another name": Mistake("density =", "rho =", ["rho", "density"]),
    "misspelt optional key": Mistake("velocity =", "velocitty =", ["velocitty", "velocity"]),
    "unknown table": Mistake("[frames]", "[frame]", ["frame"]),
    "wrong unit": Mistake('"2 GPa"', '"2 kg"', ["young", "kg"]),
    "not a unit": Mistake('"2 GPa"', '"2 gigapascalors"', ["gigapascalors"]),
    "wrong type": Mistake("nodes = 60", 'nodes = "many"', ["nodes"]),
    "missing key": Mistake('density = "1200 kg/m3"\n', "", ["density"], says_line=False),
    "missing material": Mistake('material = "soft"', 'material = "sotf"', ["sotf", "soft"]),
    "missing shape": Mistake('shape = "disc"', 'shape = "dsic"', ["dsic", "disc"]),
    "negative density": Mistake('"1200 kg/m3"', '"-1200 kg/m3"', ["density", "-1200"]),
    "NaN": Mistake("poisson = 0.4", "poisson = nan", ["poisson"]),
    "infinite": Mistake('end = "20 ns"', "end = inf", ["end"]),
    "infinite with unit": Mistake('"2 GPa"', '"inf GPa"', ["young"]),
    "incompressible": Mistake("poisson = 0.4", "poisson = 0.5", ["poisson", "0.5"]),
    "unknown law": Mistake('"neo-hookean"', '"neo-hokean"', ["neo-hokean", "neo-hookean"]),
    "unknown field": Mistake('"von_mises"', '"von_misses"', ["von_misses", "von_mises"]),
    "body wider than the period": Mistake('"8 um"', '"0.9 um"', ["period"], says_line=False),
    "packing that does not fit": Mistake(
        'packing = { kind = "positions", positions = [["2 um", "0 um"]] }',
        'packing = { kind = "hexagonal", columns = 9, rows = 2, pitch = "1 um", row_pitch = "1.1 um" }',
        ["period"], says_line=False),
    "TOML syntax": Mistake("nodes = 60", "nodes = = 60", []),
    "key given twice": Mistake("nodes = 60", "nodes = 60\nnodes = 61", ["nodes"]),
}


def assert_refused(desk, result, code: int = BAD_INPUT) -> None:
    assert result.returncode == code, result.stderr
    assert result.stderr.strip(), "no message"
    assert len(result.stderr.strip().splitlines()) <= 6, f"more than one message:\n{result.stderr}"
    assert "terminate called" not in result.stderr


@pytest.mark.parametrize("command", ["run", "check"])
@pytest.mark.parametrize("mistake", MISTAKES.values(), ids=MISTAKES.keys())
def test_mistake_in_a_scene(desk, mistake: Mistake, command: str) -> None:
    text = mistake.text()
    desk.write(text)
    before = desk.content()
    result = desk.engine(command, desk.scene)
    assert_refused(desk, result)
    assert desk.scene.name in result.stderr
    for name in mistake.names:
        assert name in result.stderr
    if mistake.says_line:
        first = changed_lines(text)
        assert any(f"{desk.scene.name}:{line}:" in result.stderr for line in first), f"line {first}:\n{result.stderr}"
    assert desk.content() == before


def changed_lines(text: str) -> list[int]:
    """Lines of `text` that the scene without mistake does not have."""
    good = set(TWO_DISCS.splitlines())
    return [number for number, line in enumerate(text.splitlines(), 1) if line not in good]


@pytest.mark.parametrize("content", [b"", b"\n\n", bytes(range(256)) * 20, b"\x00" * 100, b"\xff\xfe[time]"],
                         ids=["empty", "blank", "binary", "zeros", "not UTF-8"])
def test_not_a_scene(desk, content: bytes) -> None:
    desk.write(content)
    before = desk.content()
    result = desk.run()
    assert_refused(desk, result)
    assert desk.scene.name in result.stderr
    assert desk.content() == before


def test_no_such_file(desk) -> None:
    result = desk.engine("run", "absent.toml")
    assert_refused(desk, result)
    assert "absent.toml" in result.stderr
    assert not desk.content()


def test_folder_instead_of_a_file(desk) -> None:
    desk.scene.mkdir()
    before = desk.content()
    assert_refused(desk, desk.run())
    assert desk.content() == before


@pytest.mark.parametrize("arguments", [["--until", "soon"], ["--until", "3 kg"], ["--until", "-1 us"],
                                       ["--threads", "0"], ["--threads", "many"], ["--colour"], ["--until", ""],
                                       ["--out", ""], ["--checkpoint-every", ""], ["--until", "1 m"]], ids=" ".join)
def test_bad_option(desk, arguments: list[str]) -> None:
    desk.write(TWO_DISCS)
    before = desk.content()
    result = desk.run(*arguments)
    assert result.returncode == BAD_INPUT, result.stderr
    assert arguments[0].lstrip("-") in result.stderr
    assert desk.content() == before


def test_out_below_a_file_cannot_be_written(desk) -> None:
    desk.write(TWO_DISCS)
    (desk.folder / "file").write_text("mine")
    before = desk.content()
    result = desk.run("--out", "file/out")
    assert_refused(desk, result, INPUT_OUTPUT)
    assert "file/out" in result.stderr
    assert desk.content() == before


def test_existing_results_are_kept_without_force(desk) -> None:
    desk.write(TWO_DISCS)
    assert desk.run("--out", "out", "--until", "1 ns", "--quiet").returncode == 0
    first = desk.summary("out")
    result = desk.run("--out", "out", "--until", "2 ns", "--quiet")
    assert_refused(desk, result, INPUT_OUTPUT)
    assert "--force" in result.stderr
    assert desk.summary("out") == first


def test_force_overwrites_results(desk) -> None:
    desk.write(TWO_DISCS)
    assert desk.run("--out", "out", "--until", "1 ns", "--quiet").returncode == 0
    first = desk.summary("out")
    drawn = [desk.folder / "out" / name for name in ("grains.png", "frame_000001.vtu", "view.html")]
    for file in drawn:
        file.touch()
    assert desk.run("--out", "out", "--until", "2 ns", "--quiet", "--force").returncode == 0
    assert desk.summary("out")["state_hash"] != first["state_hash"]
    assert not any(file.exists() for file in drawn), "pictures of the run before"


def test_force_spares_a_folder_of_someone_else(desk) -> None:
    desk.write(TWO_DISCS)
    (desk.folder / "out").mkdir()
    (desk.folder / "out/thesis.tex").write_text("mine")
    before = desk.content()
    assert_refused(desk, desk.run("--out", "out", "--force"), INPUT_OUTPUT)
    assert desk.content() == before


def test_mistakes_are_found_where_they_are() -> None:
    """The helper that the other tests trust: the changed line is the one that has the mistake."""
    text = MISTAKES["negative density"].text()
    assert changed_lines(text) == [line_of(text, "-1200")]
