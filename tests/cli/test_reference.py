"""The reference solver on the command line."""

from __future__ import annotations

import json
import os
import pty
import signal
import subprocess
import sys

import h5py
import pytest
from conftest import ENGINE, REFERENCE, ROOT, Desk
from scenes import TWO_DISCS

SHORT = TWO_DISCS.replace('end = "20 ns"', 'end = "2 ns"').replace('period = "2 ns"', 'period = "0.5 ns"').replace(
    'period = "10 ns"', 'period = "1 ns"')


def test_writes_what_compare_reads(desk) -> None:
    desk.write(SHORT)
    assert desk.run("--out", "engine", "--quiet", "--threads", "1").returncode == 0
    result = desk.reference("--out", "reference", "--dt", "0.01 ns")
    assert result.returncode == 0, result.stderr
    summary = desk.summary("reference")
    assert summary["status"] == "finished" and summary["solver"] == "reference, Newmark"
    assert len(desk.table("reference/probes.csv").time) == 5 and len(desk.table("reference/steps.csv").time) == 200
    with h5py.File(desk.folder / "reference/frames.h5") as frames:
        assert frames["times"][()].tolist() == pytest.approx([0, 1e-9, 2e-9])
    command = [sys.executable, "-B", ROOT / "scripts/compare.py", "engine", "reference"]
    compared = subprocess.run(command, cwd=desk.folder, capture_output=True, text=True)
    assert compared.returncode == 1 and "frames bodies/position" in compared.stdout, compared.stdout
    # INDEPENDENT: both are of order two in time; the engine at its bound errs by percents, so it is asked for more.
    desk.write(SHORT.replace("[time]", "[time]\nsafety = 0.1"))
    assert desk.run("--out", "fine", "--quiet", "--threads", "1").returncode == 0
    ours, theirs = (desk.table(f"{folder}/probes.csv").column("energies.strain").values[-1]
                    for folder in ("reference", "fine"))
    assert ours == pytest.approx(theirs, rel=0.02)


def test_friction_factors_have_the_same_sign(desk) -> None:
    text = SHORT.replace('law = "frictionless"', 'law = "mohr-coulomb"\nfriction = 0.3').replace(
        '["20 m/s", "0 m/s"]', '["20 m/s", "20 m/s"]').replace("[frames]", """\
[materials.hard]
law = "rigid"
density = "1200 kg/m3"

[[walls]]
name = "upper"
material = "hard"
solid = "above"
level = "0.51 um"
thickness = "1 um"
x = "fixed"
y = "fixed"

[[contacts]]
between = "all"
law = "mohr-coulomb"
friction = 0.3

[[probes]]
name = "upper"
quantity = "friction_factor"
of = "upper"
period = "0.5 ns"

[frames]""").replace("[time]", "[time]\nsafety = 0.1")
    desk.write(text)
    assert desk.run("--out", "engine", "--quiet", "--threads", "1").returncode == 0
    assert desk.reference("--out", "reference", "--quiet", "--dt", "0.01 ns").returncode == 0
    ours, theirs = (desk.table(f"{folder}/probes.csv").column("upper.friction_factor").values[-1]
                    for folder in ("reference", "engine"))
    assert theirs > 0.01  # the disc pulls the wall along
    assert ours == pytest.approx(theirs, rel=0.05)  # INDEPENDENT: as above


def test_info_of_it_and_what_is_next(desk) -> None:
    desk.write(SHORT)
    assert desk.reference("--out", "out", "--quiet", "--dt", "0.1 ns").returncode == 0
    summary = desk.folder / "out/summary.json"
    for status, then in [("finished", "./pliant compare"), ("running", "--force"), ("stopped: SIGINT", "--force")]:
        summary.write_text(json.dumps({**desk.summary("out"), "status": status}))
        result = subprocess.run([sys.executable, "-B", ROOT / "scripts/info.py", "out"], cwd=desk.folder,
                                capture_output=True, text=True)
        assert result.returncode == 0, result.stderr
        told = dict(line.split(maxsplit=1) for line in result.stdout.splitlines())
        assert "Newton iterations" in told["steps"] and "reference, Newmark" in told["speed"]
        assert then in told["next"] and "--resume" not in told["next"] and told["checkpoint"] == "none"


def test_draws(desk, tmp_path) -> None:
    desk.write(SHORT)
    assert desk.reference("--out", "out", "--quiet", "--dt", "0.1 ns").returncode == 0
    command = [sys.executable, "-B", ROOT / "scripts/plot.py", "out"]
    drawn = subprocess.run(command, cwd=desk.folder, capture_output=True, text=True)
    assert drawn.returncode == 0, drawn.stderr
    assert {"grains.png", "energy.png"} <= {file.name for file in (desk.folder / "out").glob("*.png")}


def test_verbose_progress_is_a_line_a_step(desk) -> None:
    desk.write(SHORT)
    for option, lines in ("--verbose", 4), ("--quiet", 0):
        result = desk.reference("--out", "out", "--dt", "0.5 ns", "--force", option)
        told = [line for line in result.stderr.splitlines() if line.startswith("t = ")]
        assert len(told) == lines and (result.stdout == "") == (option == "--quiet"), result.stderr
        assert all(part in line for line in told for part in ("Newton iterations", "residual", "least J", "balance"))


# Long enough to be interrupted, in steps of some milliseconds.
LONG = SHORT.replace('end = "2 ns"', 'end = "1 us"')


def started(desk: Desk, errors: int, *options: str, answers: signal.Signals = signal.SIGINT) -> subprocess.Popen[str]:
    return subprocess.Popen([REFERENCE, desk.scene, "--out", "out", "--dt", "0.01 ns", *options], cwd=desk.folder,
                            text=True, stdout=subprocess.PIPE, stderr=errors, stdin=subprocess.DEVNULL,
                            preexec_fn=lambda: signal.signal(answers, signal.SIG_DFL))  # ignored in the background


@pytest.mark.parametrize("stop, code", [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_stops_in_order(desk, stop: signal.Signals, code: int) -> None:
    """After the first step."""
    desk.write(LONG)
    process = started(desk, subprocess.PIPE, "--verbose", answers=stop)
    while not process.stderr.readline().startswith("t = "):
        assert process.poll() is None
    process.send_signal(stop)
    said = process.stderr.read()
    assert process.wait(60) == code and process.stdout.read() == ""
    last = said.splitlines()[-1]
    assert last.startswith(f"stopped by {stop.name} at t = ") and "--force" in last, said
    summary = desk.summary("out")
    assert summary["status"] == f"stopped: {stop.name}" and 0 < summary["time"] < summary["end"]
    assert summary["steps"] == len(desk.table("out/steps.csv").time)
    assert desk.table("out/steps.csv").time[-1] == summary["time"]
    with h5py.File(desk.folder / "out/frames.h5") as frames:
        assert len(frames["times"]) == sum(name.isdigit() for name in frames["bodies"])


def test_progress_on_a_terminal_is_one_line(desk) -> None:
    """Written anew every second; what follows begins on the next."""
    desk.write(LONG)
    try:
        ours, terminal = pty.openpty()
    except OSError:
        pytest.skip("no pseudo-terminal here, as in a chroot or a container without /dev/pts")
    process = started(desk, terminal)
    os.close(terminal)
    said = b""
    while b"\x1b[Kt = " not in said:
        said += os.read(ours, 1000)
    process.send_signal(signal.SIGINT)
    while b"--force" not in said:
        said += os.read(ours, 1000)
    assert process.wait(60) == 130
    lines = said.decode().replace("\r\n", "\n").split("\n")
    assert lines[0].startswith("\r\x1b[Kt = ") and lines[1].startswith("stopped by SIGINT at t = "), lines


# A disc falls on a stiff floor. Units mu = R = rho = 1.
BOUNCE = """\
[time]
end = 3
[domain]
period = 4
[materials]
hard = { law = "rigid", density = 1 }
soft = { law = "neo-hookean", density = 1, young = 2.8, poisson = 0.4 }
[shapes.disc]
kind = "disc"
diameter = 2
nodes = 30
[[grains]]
shape = "disc"
body = "compliant"
material = "soft"
packing = { kind = "positions", positions = [[2, 1.05]] }
velocity = { uniform = [0, -0.3] }
[[walls]]
name = "floor"
material = "hard"
solid = "below"
level = 0
[[contacts]]
between = "all"
law = "frictionless"
stiffness = 3000
"""


def test_natural_frequencies_are_those_of_the_engine(desk) -> None:
    """INDEPENDENT: the engine's stiffness is differences of its forces, to 1e-11."""
    desk.write(SHORT)
    assert desk.reference("--modes", "reference.json").returncode == 0
    engine = subprocess.run([ENGINE, "modes", "scene.toml", "--count", "1000", "--json", "engine.json"], cwd=desk.folder)
    assert engine.returncode == 0 and not (desk.folder / "results").exists()
    ours, theirs = (json.loads((desk.folder / name).read_text())["bodies"] for name in ("reference.json", "engine.json"))
    assert len(ours) == len(theirs) == 1 and ours[0]["like_it"] == 1
    assert ours[0] | {"frequencies": []} == theirs[0] | {"frequencies": []}
    assert ours[0]["frequencies"] == pytest.approx(theirs[0]["frequencies"], rel=1e-8)


def test_natural_frequencies_need_a_compliant_body(desk) -> None:
    rigid = SHORT.replace('body = "compliant"', 'body = "rigid"')
    desk.write(rigid.replace('"frictionless"', '"frictionless"\nstiffness = 1e18'))
    result = desk.reference("--modes", "modes.json")
    assert result.returncode == 2 and "no compliant body" in result.stderr
    assert not (desk.folder / "modes.json").exists()


def test_steps_that_make_energy_are_warned_of_once(desk) -> None:
    """Long against the vibrations of the floor's springs."""
    desk.write(BOUNCE)
    warned = desk.reference("--out", "out", "--dt", "0.1", "--verbose")
    assert warned.returncode == 0
    assert warned.stderr.count("have made energy: up to ") == 1
    assert "give a smaller --dt, such as 0.025 s, or --hht -0.1" in warned.stderr
    share = float(warned.stderr.split("made energy: up to ")[1].split(" %")[0])
    balance = max(float(line.split("balance ")[1].split(" ")[0]) for line in warned.stderr.splitlines() if "dt" in line
                  and "balance" in line)
    assert share == pytest.approx(100 * balance, rel=0.5) and share > 10
    assert "made energy" not in desk.reference("--out", "out", "--dt", "0.005", "--force").stderr
    assert desk.reference("--out", "out", "--dt", "0.1", "--force", "--quiet").stderr == ""
    desk.write(BOUNCE.replace("[0, -0.3]", "[0, 0]"))  # nothing but rounding
    assert "made energy" not in desk.reference("--out", "out", "--dt", "0.1", "--force").stderr


@pytest.mark.parametrize("arguments, message", [
    (["--dt", "2 m"], "--dt 2 m"), (["--hht", "0.3"], "--hht"), (["--mass", "heavy"], "--mass"),
    (["--tolerance", "1"], "--tolerance"), (["--until", "-1 s"], "--until")])
def test_bad_options(desk, arguments: list[str], message: str) -> None:
    desk.write(SHORT)
    before = desk.content()
    result = desk.reference("--out", "out", *arguments)
    assert result.returncode == 2 and message in result.stderr, result.stderr
    assert desk.content() == before


@pytest.mark.parametrize("old, new, message", [
    ('law = "frictionless"', 'law = "frictionless"\nrestitution = 0.5', "restitution"),
    ("[frames]", '[discretisation]\nmethod = "rpim"\n\n[frames]', "rpim"),
    ("[frames]", '[contact]\nlength = "current"\n\n[frames]', 'length = "current" of contacts at nodes'),
    ("[frames]", "[contact]\nself_contact = true\n\n[frames]", "self_contact")])
def test_what_it_has_not_is_refused(desk, old: str, new: str, message: str) -> None:
    desk.write(SHORT.replace(old, new))
    before = desk.content()
    result = desk.reference("--out", "out")
    assert result.returncode == 2 and message in result.stderr, result.stderr
    assert desk.content() == before


def test_existing_results_are_kept(desk) -> None:
    desk.write(SHORT)
    assert desk.reference("--out", "out", "--quiet", "--dt", "1 ns").returncode == 0
    assert desk.reference("--out", "out", "--quiet", "--dt", "1 ns").returncode == 4
    assert desk.reference("--out", "out", "--quiet", "--dt", "1 ns", "--force").returncode == 0


def test_a_quantity_that_it_does_not_measure_is_left_out_with_a_warning(desk) -> None:
    desk.write(SHORT + '\n[[probes]]\nname = "pairs"\nquantity = "coordination"\nof = "all"\nperiod = "1 ns"\n')
    result = desk.reference("--out", "out", "--dt", "1 ns")
    assert result.returncode == 0 and "probe 'pairs'" in result.stderr
    assert all(column.source != "pairs" for column in desk.table("out/probes.csv").columns)


def test_failure_is_told_with_exit_code_3(desk) -> None:
    desk.write(SHORT.replace('[["3.02 um", "0.1 um"]]', '[["2.1 um", "0.1 um"]]'))
    result = desk.reference("--out", "out", "--dt", "1 ns")
    assert result.returncode == 3 and "penetration" in result.stderr, result.stderr


# A disc that touches its own images along both periods. Units mu = R = rho = 1.
CELL = """\
[time]
end = 1
[domain]
periods = [2.02, 2.2]
[domain.cell]
xx = [[0, 1], [1, 0.98]]
yy = [[0, 1], [1, 0.9]]
[materials]
soft = { law = "neo-hookean", density = 1, young = 2.8, poisson = 0.4 }
[shapes.disc]
kind = "disc"
diameter = 2
nodes = 30
[[grains]]
name = "disc"
shape = "disc"
body = "compliant"
material = "soft"
packing = { kind = "positions", positions = [[0.2, 0.1]] }
[[contacts]]
between = "all"
law = "frictionless"
stiffness = 100
[frames]
period = 1
"""
PROBES = "".join(
    f'[[probes]]\nname = "{name}"\nquantity = "{quantity}"\nperiod = 1\n{more}' for name, quantity, more in (
        ("cell", "cell_stress", ""), ("strain", "cell_gradient", ""), ("packing", "solid_fraction", 'of = "all"\n'),
        ("part", "solid_fraction", 'of = "all"\nbox = [[0, 0], [1, 1]]\n')))


def test_measures_a_cell(desk) -> None:
    desk.write(CELL + PROBES)
    result = desk.reference("--out", "out", "--static", "--dt", "0.1")
    assert result.returncode == 0 and "probe 'part'" in result.stderr, result.stderr
    last = {name: desk.table("out/probes.csv").column(name).values[-1] for name in (
        "cell.pressure", "strain.gradient_yy", "strain.cell_area", "packing.solid_fraction")}
    assert last["cell.pressure"] > 0
    # EXACT: the gradient of the scene; the area of the disc is that of a circle but for its compression by 5 % at most.
    assert last["strain.gradient_yy"] == pytest.approx(0.9) and last["strain.cell_area"] == pytest.approx(1.9796 * 1.98)
    assert last["packing.solid_fraction"] == pytest.approx(3.1416 / (1.9796 * 1.98), rel=0.05)
    with h5py.File(desk.folder / "out/frames.h5") as frames:
        assert frames["cell/000001/b"][()].ravel().tolist() == pytest.approx([0, 1.98])


def test_refuses_a_cell_under_a_given_stress(desk) -> None:
    desk.write(CELL.replace("xx = [[0, 1], [1, 0.98]]", "stress_xx = -0.1"))
    result = desk.reference("--out", "out", "--static")
    assert result.returncode == 2 and "follows given gradients alone" in result.stderr, result.stderr
    assert not (desk.folder / "out").exists()
