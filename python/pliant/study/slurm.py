"""Between Snakemake and Slurm, where each run is a job. As a program, which Snakemake calls for each job again and
again, it needs Python's own library alone: `slurm.py submit FOLDER RUN THREADS [OPTION OF SBATCH...]` prints the job's
number, `slurm.py status FOLDER JOB` prints running, success or failed."""

from __future__ import annotations

import hashlib
import re
import shlex
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[2]
ENDED = {"BOOT_FAIL", "CANCELLED", "COMPLETED", "DEADLINE", "FAILED", "NODE_FAIL", "OUT_OF_MEMORY", "PREEMPTED",
         "REVOKED", "TIMEOUT"}
STUCK = re.compile(r"^Partition|^Bad|[Hh]eld|NotAllowed|PerJob|NeverSatisfied")  # reasons that do not pass alone
FRESH = 3.0  # s that an answer of squeue counts: one for all jobs, not one each
WARNING = "--signal=B:USR1@60"  # to the step, this long before the time limit
TAKEN = {"--array": "-a", "--chdir": "-D", "--clusters": "-M", "--cpus-per-task": "-c", "--dependency": "-d",
         "--error": "-e", "--job-name": "-J", "--output": "-o", "--parsable": "", "--test-only": "", "--wait": "-W",
         "--wrap": ""}


class NoAnswer(Exception):
    """Slurm does not answer, or refuses; the message is its own."""


@dataclass
class Job:
    number: str
    state: str
    label: str
    reason: str


def call(*command: str) -> str:
    try:
        result = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL, check=False)
    except FileNotFoundError:
        raise NoAnswer(f"there is no {command[0]} here") from None
    if result.returncode != 0:
        raise NoAnswer(result.stderr.strip() or f"{command[0]} ended with {result.returncode}")
    return result.stdout.strip()


def check_options(options: list[str], threads: int) -> None:
    """As sbatch judges them; and none that the study sets itself. NoAnswer."""
    for option in options:
        name = option.partition("=")[0]
        for long, short in TAKEN.items():
            if (name.startswith("--") and long.startswith(name)) or (short and option.startswith(short)):
                raise NoAnswer(f"'{option}': {long} is for the study to set")
    call("sbatch", "--test-only", f"--cpus-per-task={threads}", *options, "--wrap=true")


def submit_command(folder: Path, options: list[str]) -> str:
    """For Snakemake, which fills in what is between braces and adds a script of its own: a comment here."""
    first, last = (shlex.join(words).replace("{", "{{").replace("}", "}}")
                   for words in ([*_program("submit"), str(folder)], options))
    return f"{first} {{wildcards.name:q}} {{threads}} {last} #"


def status_command(folder: Path) -> str:
    return shlex.join([*_program("status"), str(folder)])


def _program(name: str) -> list[str]:
    return [sys.executable, "-I", "-B", str(Path(__file__).resolve()), name]


def label_of(folder: Path, name: str = "") -> str:
    """A job's name: of its study, then of its run."""
    study, run = (hashlib.sha256(text.encode()).hexdigest()[:8] for text in (str(folder), name))
    return f"pliant-{study}-{run if name else ''}"


def log_of(folder: Path, name: str) -> Path:
    return folder / "runs" / name / "slurm.log"


def as_pattern(file: Path) -> str:
    """Of a name as sbatch takes it: with a backslash in it, it takes all others as they are."""
    return str(file).replace("\\", "\\\\") if "\\" in str(file) else str(file).replace("%", "%%")


def jobs_of(text: str) -> list[Job]:
    return [Job(*line.split(" ", 3)) for line in text.splitlines() if line]


def ask() -> str:
    """All jobs of this user, those that ended lately too."""
    return call("squeue", "--me", "--states=all", "--noheader", "--format=%i %T %j %r")


def submit(folder: Path, name: str, threads: str, *options: str) -> str:
    """A job for a run, unless it has one: of a study that was killed, say. One of another scene ends first."""
    label = label_of(folder, name)
    earlier = [job for job in jobs_of(ask()) if job.label == label and job.state not in ENDED]
    for job in earlier:
        if job.state in ("PENDING", "CONFIGURING") or (job.state != "COMPLETING" and is_of_now(folder, name)):
            say(f"{name}: is job {job.number} still; {log_of(folder, name)}")
            return noted(folder, name, job.number)
    if earlier:
        call("scancel", *(job.number for job in earlier))
        options = (f"--dependency=afterany:{':'.join(job.number for job in earlier)}", *options)
    step = [sys.executable, "-B", "-m", "pliant.study.steps", "run", str(folder), name, threads]
    script = f'trap "" USR1\nexec env {shlex.quote(f"PYTHONPATH={PACKAGE}")} {shlex.join(step)} "$SLURM_JOB_ID"'
    number = call("sbatch", "--parsable", f"--job-name={label}", f"--cpus-per-task={threads}",
                  f"--output={as_pattern(log_of(folder, name))}", "--open-mode=append", "--requeue", WARNING, *options,
                  f"--wrap={script}").partition(";")[0]
    say(f"{name}: job {number}; {log_of(folder, name)}")
    return noted(folder, name, number)


def is_of_now(folder: Path, name: str) -> bool:
    """Whether what runs is what it would be if it began now."""
    sys.path.insert(0, str(PACKAGE))
    from pliant.study.folder import Folder
    begun = Folder(folder).run(name) / "begun"
    return begun.exists() and begun.read_text() == Folder(folder).fingerprint(name)


def noted(folder: Path, name: str, number: str) -> str:
    file = folder / "workflow/jobs" / number
    file.parent.mkdir(exist_ok=True)
    file.write_text(name)
    return number


def status(folder: Path, number: str) -> str:
    name = (folder / "workflow/jobs" / number).read_text()
    try:
        job = find(folder, number, FRESH) or find(folder, number, 0)
    except NoAnswer as error:
        say(f"{error}; waiting")
        return "running"
    if job and job.state not in ENDED:
        return "running"
    if (job and job.state == "COMPLETED") or (folder / "runs" / name / "outcome.json").exists():
        say(last_line(log_of(folder, name)) or f"{name}: job {number} ended")
        return "success"
    say(f"{name}: job {number} ended{f' as {job.state}' if job else ''}; {log_of(folder, name)}")
    return "failed"


def last_line(file: Path) -> str:
    return file.read_text(errors="replace").strip().rpartition("\n")[2] if file.exists() else ""


def find(folder: Path, number: str, fresh: float) -> Job | None:
    file = folder / "workflow/queue"
    before = file.read_text() if file.exists() else ""
    if not before or abs(time.time() - file.stat().st_mtime) > fresh:
        file.write_text(ask() + "\n")
        for line in set(file.read_text().splitlines()) - set(before.splitlines()):
            tell_stuck(folder, *jobs_of(line))
    return next((job for job in jobs_of(file.read_text()) if job.number == number), None)


def tell_stuck(folder: Path, job: Job) -> None:
    if job.state not in ENDED and STUCK.search(job.reason) and job.label.startswith(label_of(folder)):
        say(f"job {job.number} waits, for ever unless something changes: {job.reason}")


def cancel(folder: Path) -> None:
    """All jobs of a study; they get SIGTERM, and are killed some time after."""
    try:
        numbers = [job.number for job in jobs_of(ask())
                   if job.label.startswith(label_of(folder)) and job.state not in ENDED]
        if numbers:
            call("scancel", *numbers)
    except NoAnswer as error:
        say(f"{error}; jobs may go on")


def say(what: str) -> None:
    print(what, file=sys.stderr, flush=True)


def main(what: str, folder: str, *more: str) -> int:
    try:
        print(submit(Path(folder), *more) if what == "submit" else status(Path(folder), *more))
    except NoAnswer as error:
        say(str(error))
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
