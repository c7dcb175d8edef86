"""A Slurm of one node in a temporary folder: munged, slurmctld and slurmd of this user, on the loopback address, with a
key, ports and a configuration of their own. What the system has of them is neither used nor changed. As a program:
`one_node_slurm.py FOLDER` waits until its input ends, then ends all that belongs to it."""

from __future__ import annotations

import os
import pwd
import secrets
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

PROGRAMS = ["munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "scancel"]
PATIENCE = 120.0  # s, for each thing that is waited for
STARTS = 3  # another process may take a port first
CONFIGURATION = """\
ClusterName=pliant
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ctld_port}
SlurmdPort={slurmd_port}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmdLogFile={folder}/stepd.log

PlugStackConfig={folder}/plugstack.conf
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0,sched_min_interval=0
SlurmdParameters=config_overrides
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
ReturnToService=2
KillWait=10
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} State=UNKNOWN
PartitionName=short Nodes={host} Default=YES MaxTime=60 State=UP
"""


class NoSlurm(Exception):
    """It did not start; the message has the daemons' logs."""


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def wait_for(what: str, is_there: Callable[[], bool], patience: float = PATIENCE) -> None:
    deadline = time.monotonic() + patience
    while not is_there():
        if time.monotonic() > deadline:
            raise TimeoutError(f"not within {patience:g} s: {what}")
        time.sleep(0.2)


class OneNodeSlurm:
    """Use it with `with`: at the end, or when this process is killed, nothing of it runs any more."""

    def __init__(self, cpus: int) -> None:
        path = f"{os.environ['PATH']}:/usr/sbin:/sbin"
        missing = [name for name in PROGRAMS if shutil.which(name, path=path) is None]
        if missing:
            raise NoSlurm(f"no {', '.join(missing)} here: ./pliant test installs them (group slurm of packages.txt)")
        self.folder = Path(tempfile.mkdtemp(prefix="slurm-"))  # short: a socket's path has at most 107 characters
        self.host = socket.gethostname().partition(".")[0]
        self.cpus = cpus
        others = {name: value for name, value in os.environ.items() if not name.startswith(("SLURM", "SBATCH"))}
        self.environment = {**others, "PATH": path, "SLURM_CONF": f"{self.folder}/slurm.conf"}
        self.daemons: dict[str, subprocess.Popen[bytes]] = {}

    def __enter__(self) -> OneNodeSlurm:
        self.guard = subprocess.Popen([sys.executable, "-I", "-B", __file__, self.folder], stdin=subprocess.PIPE,
                                      start_new_session=True)
        try:
            self._start_munge()
            for _ in range(STARTS):
                if self._start_slurm():
                    return self
                for name in self.daemons.keys() - {"munged"}:
                    self._end(name)
            raise NoSlurm(f"slurmctld and slurmd did not start\n{self.logs()}")
        except BaseException:
            self.__exit__()
            raise

    def __exit__(self, *_: object) -> None:
        for name in list(self.daemons):
            self._end(name)
        self.guard.communicate()
        if self.guard.returncode != 0:
            raise NoSlurm(f"not all of it ended: {self.processes()}")

    def call(self, *command: str) -> str:
        """What it prints; its errors as well."""
        try:
            result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False,
                                    stdin=subprocess.DEVNULL, env=self.environment, timeout=PATIENCE)
        except subprocess.TimeoutExpired:
            return f"{command[0]}: no answer"
        return result.stdout.strip()

    def logs(self) -> str:
        return "\n".join(f"--- {file.name}\n{file.read_text(errors='replace')[-4000:]}"
                         for file in sorted(self.folder.glob("*.log")))

    def processes(self, *marks: str) -> list[int]:
        return processes_of(self.folder, *marks)

    def _start(self, name: str, *command: str | Path) -> None:
        with (self.folder / f"{name}.log").open("wb") as output:
            self.daemons[name] = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=output,
                                                  stderr=subprocess.STDOUT, env=self.environment, cwd=self.folder,
                                                  start_new_session=True)

    def _end(self, name: str) -> None:
        daemon = self.daemons.pop(name)
        daemon.kill()
        daemon.wait()

    def _is_up(self, what: str, is_there: Callable[[], bool]) -> bool:
        """False: a daemon ended instead."""
        def ended() -> bool:
            return any(daemon.poll() is not None for daemon in self.daemons.values())

        try:
            wait_for(what, lambda: ended() or is_there())
        except TimeoutError as error:
            raise NoSlurm(f"{error}\n{self.logs()}") from error
        return not ended()

    def _start_munge(self) -> None:
        key, munge_socket = self.folder / "munge.key", self.folder / "munge.socket"
        key.write_bytes(secrets.token_bytes(128))
        key.chmod(0o600)
        self._start("munged", "munged", "--foreground", "--force", "--origin=127.0.0.1", f"--socket={munge_socket}",
                    f"--key-file={key}", f"--pid-file={self.folder}/munged.pid", f"--seed-file={self.folder}/seed")
        if not self._is_up("munged's socket", munge_socket.exists):
            raise NoSlurm(f"munged did not start\n{self.logs()}")

    def _start_slurm(self) -> bool:
        (self.folder / "plugstack.conf").touch()
        (self.folder / "cgroup.conf").write_text("CgroupPlugin=cgroup/v1\n")  # or it looks for what is mounted
        (self.folder / "slurm.conf").write_text(CONFIGURATION.format(
            folder=self.folder, host=self.host, user=pwd.getpwuid(os.getuid()).pw_name, cpus=self.cpus,
            ctld_port=free_port(), slurmd_port=free_port()))
        self._start("slurmctld", "slurmctld", "-D", "-c")
        if not self._is_up("slurmctld's answer", lambda: "is UP" in self.call("scontrol", "ping")):
            return False
        self._start("slurmd", "slurmd", "-D", "-c")
        return self._is_up("an idle node", lambda: self.call("sinfo", "--noheader", "--format=%T") == "idle")


def processes_of(folder: Path, *marks: str) -> list[int]:
    """Those that were started for it, jobs' included, by what their environment says."""
    wanted = {mark.encode() for mark in (f"SLURM_CONF={folder}/slurm.conf", *marks)}
    found = []
    for file in Path("/proc").glob("[0-9]*/environ"):
        try:
            if wanted <= set(file.read_bytes().split(b"\0")):
                found.append(int(file.parent.name))
        except OSError:  # ended meanwhile, or another user's
            pass
    return found


def end_all(folder: Path) -> None:
    def ended() -> bool:
        for process in (found := processes_of(folder)):
            with suppress(ProcessLookupError):
                os.kill(process, signal.SIGKILL)
        return not found

    wait_for("the end of all that was started", ended)
    shutil.rmtree(folder)


if __name__ == "__main__":
    sys.stdin.read()
    end_all(Path(sys.argv[1]))
