"""What the launcher installs, and when. All EXACT."""

from __future__ import annotations

import re

import pytest
from conftest import ROOT, Launcher, all_packages


def test_missing_packages_are_installed_once(launcher: Launcher) -> None:
    present = " ".join(name for name in all_packages() if name not in {"cmake", "libeigen3-dev", "valgrind"})
    result = launcher("check", "a.toml", INSTALLED=present)
    update, install = launcher.calls("apt-get")
    assert " update" in update
    assert install.endswith(" cmake libeigen3-dev") and "--no-install-recommends" in install
    assert "installing 2 Debian packages" in result.stderr
    launcher("check", "a.toml", INSTALLED="")
    assert len(launcher.calls("apt-get")) == 2, "the second call must not look again"


def test_packages_are_looked_for_again_when_the_list_changes(launcher: Launcher) -> None:
    launcher("check", "a.toml")
    with (launcher.root / "packages.txt").open("a") as file:
        file.write("libnew-dev required something new\n")
    launcher("check", "a.toml")
    assert launcher.calls("apt-get")[-1].endswith(" libnew-dev")


def test_openmp_is_unpacked_where_it_would_remove_another(launcher: Launcher) -> None:
    present = " ".join(name for name in all_packages() if name not in {"clang-19", "libomp-19-dev", "libomp5-19"})
    result = launcher("check", "a.toml", INSTALLED=present, APT_FAILS="install*libomp-19-dev")
    assert result.returncode == 0
    install, refused, download = launcher.calls("apt-get")[1:]
    assert install.endswith(" clang-19") and "--no-remove" in install and "--no-remove" in refused
    assert download == "apt-get download libomp-19-dev libomp5-19" and len(launcher.calls("dpkg")) == 2
    assert (launcher.root / "build/openmp/usr/lib").is_dir() and not (launcher.root / "build/openmp.part").exists()
    assert "not installed: libomp-19-dev" in result.stderr and "unpacking them in build/openmp" in result.stderr
    assert "g++" not in result.stderr


@pytest.mark.parametrize("missing, fails", [("libomp-19-dev", "libomp-19-dev"), ("clang-19", "clang-19")])
def test_without_the_fast_compiler_its_cost_is_told(launcher: Launcher, missing: str, fails: str) -> None:
    present = " ".join(name for name in all_packages() if name != missing)
    result = launcher("check", "a.toml", INSTALLED=present, APT_FAILS=fails)
    assert result.returncode == 0
    assert f"not installed: {missing}" in result.stderr
    assert "g++ builds instead of clang-19: forces take 1.9 times as long" in result.stderr
    assert not (launcher.root / "build/openmp").exists()


def test_what_others_need_does_not_stop_a_run(launcher: Launcher) -> None:
    """Packages of tests and benchmarks, which are not even asked for."""
    of_others = {"test": "libgtest-dev", "verify": "python3-dolfinx", "bench": "libbenchmark-dev", "movie": "ffmpeg"}
    present = " ".join(name for name in all_packages() if name not in of_others.values())
    assert launcher("run", "a.toml", INSTALLED=present, APT_FAILS="lib").returncode == 0
    assert not launcher.calls("apt-get")
    for command, package in of_others.items():
        result = launcher(command, INSTALLED=present, APT_FAILS=package)
        assert result.returncode == 1 and re.search(f"could not install: .*{package}", result.stderr)
    assert not launcher.calls("ctest")


def test_groups_are_few_and_each_is_explained() -> None:
    text = (ROOT / "packages.txt").read_text()
    groups = {line.split()[1] for line in text.splitlines() if line and not line.startswith("#")}
    assert groups == set(re.findall(r"^#   (\w+) ", text, re.MULTILINE)) and len(groups) <= 6
    assert len(all_packages()) == len(set(all_packages()))


def test_a_target_that_was_left_out_is_looked_for_again(launcher: Launcher) -> None:
    ninja = launcher.root / "build/release/build.ninja"
    launcher("run", "a.toml")
    configured = len(launcher.calls("cmake"))
    launcher("run", "a.toml")
    assert len(launcher.calls("cmake")) == configured
    launcher("test")
    assert len(launcher.calls("cmake")) == configured + 1, "configured without packages of the tests"
    ninja.write_text("build pliant_tests: x\n")
    launcher("test")
    assert len(launcher.calls("cmake")) == configured + 1


def test_failed_installation_stops(launcher: Launcher) -> None:
    present = " ".join(name for name in all_packages() if name != "cmake")
    result = launcher("check", "a.toml", INSTALLED=present, APT_FAILS="cmake")
    assert result.returncode == 1
    assert "could not install: cmake" in result.stderr
    assert not launcher.calls("ninja")


def test_failed_build_stops_and_looks_for_packages_again(launcher: Launcher) -> None:
    result = launcher("check", "a.toml", NINJA_EXIT="1")
    assert result.returncode == 1
    assert "building failed" in result.stderr and "[check]" not in result.stdout
    assert not (launcher.root / "build/packages.stamp").exists()
