"""benchmarks/ab.py and history.py, with engines that make their seconds up. All EXACT but for p (CLOSED FORM)."""

from __future__ import annotations

import json
import math
import subprocess
from pathlib import Path

import pytest

import ab
import history
from ab import Comparison

# Says its name in a log and takes `seconds`, somewhat more each time; output takes 5 s besides, which do not count.
ENGINE = """#!/bin/bash
echo {name} >>{log}
n=$(grep -c . {log})
mkdir -p "$4"
awk -v n=$n 'BEGIN {{ s = {seconds} + 0.0001 * n; printf "{{\\"wall_seconds\\": %.9f, ", s + 5
  print "\\"phase_seconds\\": {{\\"output\\": 5}}}}" }}' >"$4/summary.json"
"""


def write_engine(file: Path, log: Path, seconds: str) -> str:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(ENGINE.format(name=file.stem, log=log, seconds=seconds))
    file.chmod(0o755)
    return str(file)


@pytest.fixture
def log(tmp_path: Path) -> Path:
    return tmp_path / "log"


@pytest.fixture
def scene(tmp_path: Path) -> list[str]:
    (tmp_path / "scene.toml").touch()
    return ["--scene", str(tmp_path / "scene.toml")]


@pytest.mark.parametrize("seconds, code, said", [
    ("2", 0, "no difference seen"), ("2.1", 1, "B is slower: B/A 1.05"), ("2.03", 0, "B is slower, by less than 2 %"),
    ("1.8", 0, "B is faster: B/A 0.9")])
def test_the_slower_one_is_told(tmp_path: Path, log: Path, scene: list[str], capsys: pytest.CaptureFixture[str],
                                seconds: str, code: int, said: str) -> None:
    engines = [write_engine(tmp_path / "one", log, "2"), write_engine(tmp_path / "two", log, seconds)]
    assert ab.main([*engines, *scene, "--json", str(tmp_path / "out.json")]) == code
    output = capsys.readouterr().out
    assert said in output
    content = json.loads((tmp_path / "out.json").read_text())
    assert [len(runs) for runs in content["seconds"].values()] == [9, 9, 9]
    assert content["seconds"]["A"][0] == pytest.approx(2.0001), "output does not count"
    assert f"| B | {engines[1]} | {min(content['seconds']['B']):.3f} |" in output


def test_runs_take_turns(tmp_path: Path, log: Path, scene: list[str]) -> None:
    engines = [write_engine(tmp_path / name, log, "2") for name in ("one", "two")]
    ab.main([*engines, *scene, "--pairs", "10"])
    assert log.read_text().split() == ["one", "one", "two", "two", "one", "one"] * 5


def test_a_restless_machine_is_not_judged(tmp_path: Path, log: Path, scene: list[str],
                                          capsys: pytest.CaptureFixture[str]) -> None:
    """Every run in the middle, A', takes 3 % longer."""
    engine = write_engine(tmp_path / "one", log, "(n % 3 == 2 ? 2.06 : 2)")
    assert ab.main([engine, engine, *scene]) == 2
    assert "not judged: A and A', the same program, differ by 3.0 %" in capsys.readouterr().out


def test_p_is_that_of_the_sign_of_complete_order() -> None:
    """All of B above all of A: 2 of the C(18, 9) orders are as far apart. CLOSED FORM."""
    a, b = [1 + 0.001 * i for i in range(9)], [2 + 0.001 * i for i in range(9)]
    assert Comparison(a, a, b).p == pytest.approx(2 / math.comb(18, 9))
    assert Comparison(a, a, a).p == pytest.approx(1, abs=0.05)


def test_a_run_that_fails_is_told(tmp_path: Path, log: Path, scene: list[str],
                                  capsys: pytest.CaptureFixture[str]) -> None:
    good, bad = write_engine(tmp_path / "one", log, "2"), tmp_path / "bad"
    bad.write_text("#!/bin/bash\necho 'error: inverted' >&2\nexit 3\n")
    bad.chmod(0o755)
    assert ab.main([good, str(bad), *scene]) == 2
    assert "exit code 3: error: inverted" in capsys.readouterr().err


@pytest.mark.parametrize("arguments, said", [
    (["--pairs", "8"], "at least 9"), (["--threads", "0"], "at least 1"),
    (["--scene", "no.toml"], "no.toml: no such file"), (["--record"], "--record is of commits")])
def test_bad_input(tmp_path: Path, log: Path, capsys: pytest.CaptureFixture[str], arguments: list[str],
                   said: str) -> None:
    engine = write_engine(tmp_path / "one", log, "2")
    with pytest.raises(SystemExit) as stop:
        ab.main([engine, engine, *arguments])
    assert stop.value.code == 2 and said in capsys.readouterr().err
    assert not log.exists()


def git(folder: Path, *arguments: str) -> str:
    identity = ["-c", "user.name=a", "-c", "user.email=a@example.org"]
    command = ["git", *identity, "-C", str(folder), *arguments]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


@pytest.fixture
def repository(tmp_path: Path, log: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Two commits, the first one tagged `before`; stubs of cmake and ninja build what the file `seconds` says."""
    folder, stubs = tmp_path / "repository", tmp_path / "stubs"
    (folder / "benchmarks").mkdir(parents=True)
    git(tmp_path, "init", "-q", str(folder))
    for seconds in ("2", "2.2"):
        (folder / "seconds").write_text(seconds)
        (folder / ".gitignore").write_text("/build/\n")
        if seconds == "2.2":
            counts = {"counts": {"step": {"instructions": 7, "libraries": 1}}}
            (folder / history.COUNTS).write_text(json.dumps(counts))
        git(folder, "add", ".")
        git(folder, "commit", "-q", "-m", seconds)
    git(folder, "tag", "before", "HEAD~1")
    made = write_engine(tmp_path / "made", log, "SECONDS")
    write_stub(stubs / "cmake", "mkdir -p build/release")
    write_stub(stubs / "ninja", f'sed "s/SECONDS/$(cat seconds)/" {made} >build/release/pliant_engine; '
                                "chmod +x build/release/pliant_engine")
    monkeypatch.setenv("PATH", f"{stubs}:/usr/bin:/bin")
    return folder


def write_stub(file: Path, body: str) -> None:
    file.parent.mkdir(exist_ok=True)
    file.write_text(f"#!/bin/bash\n{body}\n")
    file.chmod(0o755)


def test_commits_are_built_and_recorded(tmp_path: Path, repository: Path, scene: list[str],
                                        capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "results/history.jsonl"
    options = [*scene, "--repository", str(repository), "--history", str(file), "--record"]
    assert ab.main(["before", "HEAD", *options]) == 1
    assert "B is slower" in capsys.readouterr().out
    first, second = history.read(file)
    commits = git(repository, "rev-parse", "before", "HEAD").split()
    assert {line["commit"] for line in (first, second)} == set(commits)
    by_commit = {line["commit"]: line for line in (first, second)}
    before, after = (by_commit[commit] for commit in commits)
    assert before["instructions"] is None and after["instructions"] == {"step": 7}
    assert len(before["seconds"]) == 18 and len(after["seconds"]) == 9 and before["scene"] == "scene"
    assert set(before["machine"]) == {"cpu", "cores"} and before["date"].startswith("20")
    assert ab.main(["before", "HEAD", *options]) == 1, "worktrees are used again"
    assert [line["instructions"] for line in history.committed_counts(repository)] == [{"step": 7}]


def test_an_unknown_commit_is_bad_input(repository: Path, scene: list[str],
                                        capsys: pytest.CaptureFixture[str]) -> None:
    assert ab.main(["befor", "HEAD", *scene, "--repository", str(repository)]) == 2
    assert "no commit and no program 'befor'; did you mean 'before'?" in capsys.readouterr().err
    assert not (repository / "build").exists()


def test_a_build_that_fails_names_its_log(repository: Path, scene: list[str],
                                          capsys: pytest.CaptureFixture[str]) -> None:
    (repository.parent / "stubs/ninja").write_text("#!/bin/bash\nexit 1\n")
    assert ab.main(["before", "HEAD", *scene, "--repository", str(repository)]) == 2
    assert "does not build: " in capsys.readouterr().err


def test_a_torn_history_is_told(tmp_path: Path) -> None:
    file = tmp_path / "history.jsonl"
    file.write_text('{"commit": "a"}\n')
    with pytest.raises(ValueError, match="history.jsonl:1"):
        history.read(file)
    assert history.read(tmp_path / "none") == []
