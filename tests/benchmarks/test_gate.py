"""benchmarks/gate.py and callgrind.py: what is judged how, on made-up counts; nothing is run but git. All EXACT."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest

import callgrind
import gate
from callgrind import Count
from gate import Build, Values

CLANG = Build("Clang 19.1.7", "Release", "x86-64-v2")


def git(folder: Path, *arguments: str) -> None:
    identity = ["-c", "user.name=a", "-c", "user.email=a@example.org"]
    subprocess.run(["git", *identity, "-C", folder, *arguments], check=True, capture_output=True)


class Bench:
    """A repository with committed values of 100000 instructions each, and what is counted now."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.folder, self.values = folder, folder / "instructions.json"
        self.now = {name: Count(100000, 1000) for name in gate.NAMES}
        self.build = CLANG
        git(folder, "init", "-q")
        Values(CLANG, self.now.copy()).write(self.values)
        git(folder, "add", ".")
        self.commit("perf-accept: of values that are there now\n")
        monkeypatch.setattr(gate, "count_all", self.count)
        monkeypatch.setattr(gate, "build_of", lambda program: self.build)

    def count(self, programs: Path, names: list[str], scratch: Path) -> dict[str, Count]:
        return {name: self.now[name] for name in names if name in self.now}

    def commit(self, message: str) -> None:
        git(self.folder, "commit", "-q", "--allow-empty", "-m", message)

    def change(self, percent: float, name: str = "step") -> None:
        self.now[name] = Count(round(1000 * (100 + percent)), 1000)

    def __call__(self, *arguments: str) -> int:
        return gate.main(["--values", str(self.values), *arguments])


@pytest.fixture
def bench(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Bench:
    return Bench(tmp_path, monkeypatch)


@pytest.mark.parametrize("percent, code, said", [
    (0.4, 0, None), (1, 0, "warning: step: +1.00 %"), (3, 1, "FAILED step: +3.00 %"), (-1, 0, None),
    (-3, 0, "warning: step: -3.00 %, faster")])
def test_changes_are_judged(bench: Bench, capsys: pytest.CaptureFixture[str], percent: float, code: int,
                            said: str | None) -> None:
    bench.change(percent)
    assert bench() == code
    lines = capsys.readouterr().out.splitlines()
    share = 100 / (100 + percent)
    assert f"| step | {1000 * (100 + percent):,.0f} | {share:.1f} % | 100,000 | {percent:+.3f} % |" in lines
    loud = [line for line in lines if line.startswith(("warning", "FAILED", "accepted", "error"))]
    assert [line[:len(said)] for line in loud] == [said] if said else not loud


def test_what_a_commit_accepts_passes_with_its_reason(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    bench.change(3)
    bench.commit("A promise\n\nWhy.\nperf-accept:  forces are exact now \n")
    bench.commit("Later")
    assert bench() == 0
    said = capsys.readouterr().out
    assert "accepted step: +3.00 %" in said and "\nperf-accept: forces are exact now\n" in said and "FAILED" not in said


@pytest.mark.parametrize("message", ["no perf-accept: in a line", "perf-accept:\n", "perf-accepted: x"])
def test_other_messages_accept_nothing(bench: Bench, message: str) -> None:
    bench.change(3)
    bench.commit(message)
    assert bench() == 1


def test_new_values_end_what_was_accepted(bench: Bench) -> None:
    bench.commit("perf-accept: a reason")
    assert bench("--update") == 0
    bench.change(1)
    assert bench("--update") == 0
    bench.change(5)
    git(bench.folder, "add", ".")
    bench.commit("New values")
    assert bench() == 1


@pytest.mark.parametrize("there, word", [(True, "step has a value but is not counted"), (False, "step has no value")])
def test_a_list_that_does_not_fit_is_an_error(bench: Bench, capsys: pytest.CaptureFixture[str], there: bool,
                                              word: str) -> None:
    if there:
        del bench.now["step"]
    else:
        kept = {name: c for name, c in bench.now.items() if name != "step"}
        Values(CLANG, kept).write(bench.values)
    assert bench() == 2
    assert word in capsys.readouterr().out


def test_another_build_is_not_judged_and_not_counted(bench: Bench, capsys: pytest.CaptureFixture[str],
                                                     monkeypatch: pytest.MonkeyPatch) -> None:
    bench.build = Build("GNU 12.2.0", "Release", "x86-64-v2")
    monkeypatch.setattr(gate, "count_all", lambda *_: pytest.fail("counted"))
    assert bench() == 2
    said = capsys.readouterr().err
    assert "not judged" in said and "GNU 12.2.0" in said and "Clang 19.1.7" in said


def test_update_writes_what_was_counted(bench: Bench) -> None:
    bench.change(7)
    bench.build = Build("Clang 19.1.8", "Release", "x86-64-v2")
    assert bench("--update") == 0
    content = json.loads(bench.values.read_text())
    assert content["counts"]["step"] == {"instructions": 107000, "libraries": 1000}
    assert content["build"]["compiler"] == "Clang 19.1.8"
    assert bench() == 0


def test_libraries_are_blamed_for_what_is_theirs(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    bench.now["step"] = Count(103000, 4000)
    bench()
    assert "step: +3.00 %, most of it in libraries" in capsys.readouterr().out


def test_other_steps_are_told(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    bench.now["scene_plain"] = Count(100000, 1000, 40)
    bench("--update")
    assert json.loads(bench.values.read_text())["counts"]["scene_plain"]["evaluations"] == 40
    bench.now["scene_plain"] = Count(103000, 1000, 41)
    assert bench() == 1
    assert "scene_plain: +3.00 %, with 41 evaluations instead of 40" in capsys.readouterr().out


@pytest.mark.parametrize("arguments, said", [
    (["--only", "contact_force"], "did you mean 'contact_forces'"),
    (["--update", "--only", "step"], "leave --only out"), (["--no-such"], "unrecognized")])
def test_bad_input(bench: Bench, capsys: pytest.CaptureFixture[str], arguments: list[str], said: str) -> None:
    with pytest.raises(SystemExit) as stop:
        bench(*arguments)
    assert stop.value.code == 2 and said in capsys.readouterr().err


@pytest.mark.parametrize("content", [None, "{", '{"counts": {}}', '{"build": {"compiler": "x"}, "counts": {}}'])
def test_values_that_cannot_be_read(bench: Bench, capsys: pytest.CaptureFixture[str], content: str | None) -> None:
    bench.values.unlink()
    if content is not None:
        bench.values.write_text(content)
    with pytest.raises(SystemExit) as stop:
        bench()
    assert stop.value.code == 2 and "instructions.json: cannot be read" in capsys.readouterr().err


def test_only_asks_for_these(bench: Bench) -> None:
    bench.change(3, "outlines")
    assert bench("--only", "step", "contact_forces") == 0
    assert bench("--only", "outlines") == 1


def test_committed_values_are_of_all_that_is_counted() -> None:
    values = Values.read(gate.VALUES)
    assert list(values.counts) == gate.NAMES
    assert values.build.compiler.startswith("Clang 19") and values.build.architecture == "x86-64-v2"


def test_callees_are_counted_once() -> None:
    text = """version: 1
positions: line
events: Ir
ob=(1) /a/program
fn=(1) f
16 100
+3 20
cob=(2) /lib/libm.so.6
cfn=(2) exp
calls=4 0
* 400
-1 5
ob=(2)
fn=(2)
0 390
cfn=(3) g
calls=1 0
0 10
fn=(3)
0 10

totals: 525
"""
    assert callgrind.by_object(text) == {"/a/program": 125, "/lib/libm.so.6": 400}
