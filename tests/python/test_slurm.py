"""Studies on a real Slurm of one node (one_node_slurm.py): the same bits as without it, whatever Slurm does to jobs."""

from __future__ import annotations

import os
import signal
import subprocess
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

import one_node_slurm
import pytest
from one_node_slurm import PATIENCE, NoSlurm, OneNodeSlurm, wait_for
from test_study import ROOT, SCENE, Desk

from pliant.engine import engine
from pliant.results import read_json

SIX, ONE = "5, 6, 7, 16001, 16002, 16003", "16001"
LONG = ["end=16001", "end=16002", "end=16003"]
RUN = LONG[0]
STUDY = """
scene = "scene.toml"
[[parameters]]
name = "end"
path = "time.end"
values = [{values}]
[[quantities]]
name = "strain"
probe = "energy.strain"
take = "max"
"""
# The engine, but that long runs pause after their first checkpoint until they are told to end. Slurm tells the engine
# too, which a second SIGTERM would end at once.
PAUSING_ENGINE = """#!/bin/sh
case "$*" in
  run*--resume*) ;;
  run*end=1600*)
    for out; do [ "$last" != --out ] || break; last=$out; done
    rm -f "$out/checkpoint.bin"
    {engine} "$@" &
    engine=$!
    end() {{ kill -CONT $engine; sleep ${{LAG-1}}; kill $engine; touch "$out/../ended"; }}
    trap end TERM
    until [ -e "$out/checkpoint.bin" ]; do sleep 0.05; done
    kill -STOP $engine
    touch "$out/../pauses"
    wait $engine || wait $engine
    exit
    ;;
esac
exec {engine} "$@"
"""


class SlurmDesk(Desk):
    def __init__(self, folder: Path, slurm: OneNodeSlurm, values: str, pauses: bool = True) -> None:
        folder.mkdir(exist_ok=True)
        super().__init__(folder)
        self.slurm, self.environment = slurm, {**slurm.environment, "PYTHONPATH": str(ROOT / "python"), "CI": "true"}
        scene = SCENE.format(end="1 s").replace("period = 0.1", "period = 1")
        (folder / "scene.toml").write_text(f'{scene}[checkpoint]\nperiod = "0.05 s"\n')
        self.study(STUDY.format(values=values))
        self.said = folder / "said"
        if pauses:
            program = folder / "pausing_engine"
            program.write_text(PAUSING_ENGINE.format(engine=f"'{engine().absolute()}'"))
            program.chmod(0o755)
            self.environment["PLIANT_ENGINE"] = str(program)

    def start(self, *options: str, slurm: bool = True) -> subprocess.Popen[bytes]:
        with self.said.open("wb") as output:
            command = ["env", "--default-signal=INT", *self.command(*["--slurm"] * slurm, *options)]
            return subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=output,
                                    stderr=subprocess.STDOUT, env=self.environment, start_new_session=True)

    def end(self, study: subprocess.Popen[bytes]) -> int:
        try:
            return study.wait(2 * PATIENCE)
        except subprocess.TimeoutExpired:
            os.killpg(study.pid, signal.SIGKILL)
            study.wait()
            pytest.fail(f"the study does not end\n{self.all_said()}")

    def all_said(self) -> str:
        return "\n".join([self.said.read_text(), self.slurm.call("squeue", "--states=all"), self.slurm.logs()])

    def file(self, run: str, name: str) -> Path:
        return self.out / "runs" / run / name

    def wait_until(self, what: str, is_so: Callable[[], bool]) -> None:
        try:
            wait_for(what, is_so)
        except TimeoutError as error:
            pytest.fail(f"{error}\n{self.all_said()}")

    def wait_for(self, *files: Path) -> None:
        self.wait_until(", ".join(map(str, files)), lambda: all(file.exists() for file in files))

    def begin_now(self, run: str) -> None:
        """Its job, which is queued again: it would wait two minutes."""
        def is_waiting() -> bool:
            waits = self.state(self.job(run), "%T %r") == "PENDING BeginTime"
            return waits or self.file(run, "outcome.json").exists()

        self.wait_until(f"job {self.job(run)} queued again", is_waiting)
        self.slurm.call("scontrol", "update", f"JobId={self.job(run)}", "StartTime=now")

    def state(self, job: str, what: str = "%T") -> str:
        return self.slurm.call("squeue", "--states=all", "--noheader", f"--format={what}", "--jobs", job)

    def job(self, run: str) -> str:
        """That the study said it has."""
        return next(line.split("; ")[0].rpartition(" ")[2] for line in self.said.read_text().splitlines()
                    if line.startswith(f"{run}: job "))


@pytest.fixture(scope="module")
def slurm() -> Iterator[OneNodeSlurm]:
    with OneNodeSlurm(cpus=8) as running:
        yield running


@pytest.fixture(scope="module", autouse=True)
def limited(slurm: OneNodeSlurm, tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple]:
    """Slurm looks at limits every half a minute, and warns as much earlier: in the meantime the other tests run."""
    desk = SlurmDesk(tmp_path_factory.mktemp("limited"), slurm, ONE)
    study = desk.start("--sbatch", "--time=2")
    yield desk, study
    if study.poll() is None:
        os.killpg(study.pid, signal.SIGKILL)
        study.wait()


def test_what_slurm_does_to_jobs_changes_no_bit(slurm: OneNodeSlurm, tmp_path: Path) -> None:
    """EXACT: one job is killed with all its processes, one cancelled, one queued again as after the failure of a node;
    the study, called again, ends with the states and the table of one without Slurm."""
    desk = SlurmDesk(tmp_path / "it's 100%j", slurm, SIX)
    without = SlurmDesk(tmp_path / "without", slurm, SIX, pauses=False)
    reference = without.start(slurm=False)
    study = desk.start()
    desk.wait_for(*(desk.file(run, "pauses") for run in LONG))
    killed, cancelled, requeued = map(desk.job, LONG)
    for process in slurm.processes(f"SLURM_JOB_ID={killed}"):
        with suppress(ProcessLookupError):  # with one of them another may have gone
            os.kill(process, signal.SIGKILL)
    slurm.call("scancel", cancelled)
    slurm.call("scontrol", "requeue", requeued)
    desk.begin_now(LONG[2])
    assert desk.end(study) == 1, desk.all_said()
    said = desk.said.read_text()
    for run, job, state in zip(LONG, (killed, cancelled), ("FAILED", "CANCELLED")):
        assert f"{run}: job {job} ended as {state}; {desk.file(run, 'slurm.log')}" in said, desk.all_said()
        assert not desk.file(run, "outcome.json").exists(), "or it was not disturbed"
    assert read_json(desk.file(LONG[2], "outcome.json"))["job"] == requeued
    assert desk.end(desk.start()) == 0, desk.all_said()
    for run in LONG:
        assert f"{run}: finished after a checkpoint" in desk.file(run, "slurm.log").read_text()
    jobs = {read_json(file)["job"] for file in desk.out.glob("runs/*/outcome.json")}
    assert len(jobs) == 6 and all(job.isdigit() for job in jobs)
    assert without.end(reference) == 0, without.all_said()
    assert {read_json(file)["job"] for file in without.out.glob("runs/*/outcome.json")} == {""}
    assert len(desk.hashes()) == 6 and desk.hashes() == without.hashes()
    assert (desk.out / "table.csv").read_text() == (without.out / "table.csv").read_text()


def test_a_stopped_study_cancels_its_jobs(slurm: OneNodeSlurm, tmp_path: Path) -> None:
    """Which have the time to write their checkpoints, here six seconds; the next call waits for them."""
    desk = SlurmDesk(tmp_path, slurm, ONE)
    desk.environment["LAG"] = "6"
    study = desk.start()
    desk.wait_for(desk.file(RUN, "pauses"))
    os.killpg(study.pid, signal.SIGINT)
    assert desk.end(study) == 1
    assert desk.state(desk.job(RUN)) in ("COMPLETING", "CANCELLED"), desk.all_said()
    assert not desk.file(RUN, "ended").exists()
    assert desk.end(desk.start()) == 0, desk.all_said()
    assert desk.file(RUN, "ended").exists()
    assert f"{RUN}: finished after a checkpoint" in desk.file(RUN, "slurm.log").read_text()


def test_a_killed_study_finds_its_jobs_again(slurm: OneNodeSlurm, tmp_path: Path) -> None:
    """Those of the same scene alone. That of another is over before the next begins, though it takes its time."""
    desk = SlurmDesk(tmp_path, slurm, ONE)
    desk.environment["LAG"] = "8"

    def kill(study: subprocess.Popen[bytes]) -> None:
        os.killpg(study.pid, signal.SIGKILL)
        study.wait()

    study = desk.start()
    desk.wait_for(desk.file(RUN, "pauses"))
    first = desk.job(RUN)
    kill(study)
    study = desk.start()
    desk.wait_until("the same job", lambda: f"{RUN}: is job {first} still" in desk.said.read_text())
    kill(study)
    desk.file(RUN, "pauses").unlink()
    scene = desk.folder / "scene.toml"
    scene.write_text(scene.read_text().replace("density = 1", "density = 2"))
    study = desk.start()
    desk.wait_until("another job", lambda: f"{RUN}: job " in desk.said.read_text())
    desk.wait_until("that it waits", lambda: desk.state(desk.job(RUN), "%E") == f"afterany:{first}(unfulfilled)")
    desk.wait_for(desk.file(RUN, "pauses"))
    assert desk.state(first) == "CANCELLED", desk.all_said()
    kill(study)
    assert "density = 2" in desk.file(RUN, "results/scene.toml").read_text()


@pytest.mark.parametrize("options, message", [
    (["--slurm", "--sbatch", "--partition=none"], "invalid partition"),
    (["--slurm", "--sbatch", "--time=1 --nonsense"], "nonsense"),
    (["--slurm", "--sbatch", "-o x.log"], "'-o': --output is for the study"),
    (["--slurm", "--sbatch=--job-n=x"], "'--job-n=x': --job-name is for the study"),
    (["--slurm", "--sbatch", "--comment='"], "quot"),
    (["--sbatch", "--time=1"], "--sbatch has no meaning without --slurm"),
])
def test_bad_options_run_nothing(slurm: OneNodeSlurm, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
                                 options: list[str], message: str) -> None:
    desk = SlurmDesk(tmp_path, slurm, ONE)
    monkeypatch.setenv("SLURM_CONF", slurm.environment["SLURM_CONF"])
    result = desk.call(*options)
    assert result.returncode == 2 and message in result.stderr, result.stderr
    assert not desk.out.exists()


def test_a_time_limit_is_announced(slurm: OneNodeSlurm, limited: tuple[SlurmDesk, subprocess.Popen[bytes]]) -> None:
    """The run writes a checkpoint, and its job is queued again and goes on from there, all in one call."""
    desk, study = limited
    desk.wait_for(desk.file(RUN, "pauses"))
    desk.begin_now(RUN)
    assert desk.end(study) == 0, desk.all_said()
    assert read_json(desk.file(RUN, "outcome.json"))["job"] == desk.job(RUN)
    log = desk.file(RUN, "slurm.log").read_text()
    assert "; the same job goes on" in log and f"{RUN}: finished after a checkpoint" in log


def test_without_slurm_it_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    desk = Desk(tmp_path)
    monkeypatch.setenv("PATH", str(tmp_path))
    result = desk.call("--slurm")
    assert result.returncode == 2 and "there is no sbatch here" in result.stderr and not desk.out.exists()


def test_without_the_packages_it_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(one_node_slurm, "PROGRAMS", ["munged", "no-such-daemon"])
    with pytest.raises(NoSlurm, match="^no no-such-daemon here: .*group slurm of packages.txt"):
        OneNodeSlurm(cpus=1)
