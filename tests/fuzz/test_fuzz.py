"""What tests/fuzz/fuzz.py makes of a fuzzer's output, with programs that play one. EXACT."""

from __future__ import annotations

from pathlib import Path

import pytest

import fuzz

STATISTICS = 'echo "#9 NEW    cov: 77 ft: 99" >&2; echo "stat::number_of_executed_units: 1234" >&2'
PREFIX = 'for a in "$@"; do case $a in -artifact_prefix=*) prefix=${a#*=};; esac; done'


def play(folder: Path, body: str) -> None:
    """All targets' programs are this script."""
    folder.mkdir(exist_ok=True)
    for target in fuzz.TARGETS:
        program = folder / f"{target}_fuzz"
        program.write_text(f"#!/bin/sh\n{body}\n")
        program.chmod(0o755)


def call(tmp_path: Path, *options: str) -> int:
    return fuzz.main([*options, "--programs", str(tmp_path / "programs"), "--out", str(tmp_path / "out")])


def test_nothing_found(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    play(tmp_path / "programs", STATISTICS)
    assert call(tmp_path) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == len(fuzz.TARGETS) == 5
    assert all("1234 runs" in line and "77 edges, nothing found" in line for line in lines)


def test_a_finding_is_told_and_kept(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    play(tmp_path / "programs", f'{STATISTICS}; {PREFIX}; echo bad > "${{prefix}}crash-1"; exit 77')
    assert call(tmp_path, "scene", "--seconds", "1") == 1
    assert "findings/crash-1" in capsys.readouterr().out
    assert (tmp_path / "out/scene/findings/crash-1").read_text() == "bad\n"


def test_a_program_that_fails_without_a_finding(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    play(tmp_path / "programs", "exit 1")
    assert call(tmp_path, "scene") == 2
    assert "exit code 1" in capsys.readouterr().err


def test_bad_options(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for options in (["scnee"], ["--seconds", "0"]):
        with pytest.raises(SystemExit) as left:
            call(tmp_path, *options)
        assert left.value.code == 2
    assert "no target 'scnee'; there are: checkpoint, outline" in capsys.readouterr().err


@pytest.mark.parametrize("target", [target for target in fuzz.TARGETS if target != "checkpoint"])
def test_every_target_has_seeds(tmp_path: Path, target: str) -> None:
    """A checkpoint's are written by its fuzzer."""
    fuzz.seeds(target, tmp_path)
    assert any(file.stat().st_size > 0 for file in tmp_path.iterdir())


def test_dictionary_has_keys_and_choices() -> None:
    words = fuzz.words_of_scenes()
    assert {"outline_nodes", '"neo-hookean"', '"es-t3"'} <= set(words)
    assert fuzz.dictionary(['"t3"', "a\\b"]) == '"\\"t3\\""\n"a\\\\b"\n'
