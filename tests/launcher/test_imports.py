"""Each command of the launcher installs what its programs import, however deep and however late. EXACT.

The launcher itself says which programs a command starts and which packages it asks for: it runs beside a Python that only
writes down what it was called with. What those programs import is read from their sources."""

from __future__ import annotations

import ast
import re
import shlex
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from conftest import ROOT, Launcher, write_script

COMMANDS = ["run a.toml", "reference a.toml", "check a.toml", "modes a.toml", "plot a", "movie a", "view a", "export a",
            "info a", "compare a b", "shape-functions", "study a.toml", "schema", "docs", "test", "verify", "verify --mutate",
            "fuzz", "lint", "bench scenes", "bench scaling", "bench error", "bench gate", "bench faults", "bench ab a b", "bench page",
            "bench partition a", "bench machines a.json",
            "bench --instructions", "bench --reference"]
# Modules whose package has another name, or that come with another one.
PACKAGE = {"ufl": "python3-dolfinx", "basix": "python3-dolfinx", "petsc4py": "python3-dolfinx", "slepc4py": "python3-dolfinx",
           "mpi4py": "python3-dolfinx", "mpl_toolkits": "python3-matplotlib", "PIL": "python3-matplotlib", "markupsafe": "python3-jinja2",
           "xdist": "python3-pytest-xdist", "snakemake": "snakemake", "mkdocs": "mkdocs", "pip": "python3-pip"}
FOLDERS = ["scripts", "python", "verify", "benchmarks", "tests/support"]  # of modules, beside that of who imports them
STARTED_BY = {"docs.py": ["scripts/pages/hooks.py"],  # by mkdocs, which mkdocs.yml tells
              "__main__.py": ["python/pliant/study/steps.py"]}  # by Snakemake


def local(name: str, importer: Path) -> Path | None:
    """The file of a module of this repository."""
    for folder in [importer.parent, *(ROOT / name for name in FOLDERS), *ROOT.glob("verify/*/")]:
        for file in (folder / f"{name.replace('.', '/')}.py", folder / name.replace(".", "/") / "__init__.py"):
            if file.is_file():
                return file
    return None


def named(node: ast.AST) -> Iterator[str]:
    """Modules that a statement imports, or that it starts Python with (-m NAME)."""
    if isinstance(node, ast.Import):
        yield from (alias.name for alias in node.names)
    elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
        yield node.module
        yield from (f"{node.module}.{alias.name}" for alias in node.names)
    elif isinstance(node, (ast.List, ast.Tuple, ast.Call)):
        words = node.args if isinstance(node, ast.Call) else node.elts
        values = [word.value if isinstance(word, ast.Constant) else None for word in words]
        yield from (str(name) for flag, name in zip(values, values[1:], strict=False) if flag == "-m" and name)


def imported(programs: list[Path]) -> dict[str, str]:
    """Modules from elsewhere that programs import, and the file that does."""
    waiting, done, found = list(programs), set(), {}
    while waiting:
        file = waiting.pop()
        if file in done:
            continue
        done.add(file)
        waiting += [ROOT / other for other in STARTED_BY.get(file.name, [])]
        for name in (name for node in ast.walk(ast.parse(file.read_text())) for name in named(node)):
            top = name.split(".")[0]
            if own := [found_file for part in (top, name) if (found_file := local(part, file))]:
                waiting += own
            elif top not in sys.stdlib_module_names:
                found.setdefault(top, str(file.relative_to(ROOT)))
    return found


def programs(calls: list[str], root: Path, tested: bool) -> tuple[list[Path], set[str]]:
    """Files that Python is started with, and modules by their names."""
    files, modules = [], set()
    for call in calls:
        words = shlex.split(call)
        files += [ROOT / Path(word).relative_to(root) for word in words if word.endswith(".py")]
        modules |= {name for flag, name in zip(words, words[1:], strict=False) if flag == "-m"}
        if "verify/pytest.ini" in call:
            files += ROOT.glob("verify/*/check_*.py")
            modules.add("xdist")
    if tested:
        files += [file for pattern in ("test_*.py", "conftest.py", "check_structure.py") for file in ROOT.glob(f"tests/**/{pattern}")]
        files += ROOT.glob("verify/*/check_*.py")
    return files, modules


@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_installs_what_its_programs_import(launcher: Launcher, command: str) -> None:
    write_script(launcher.root / "stubs/python", 'printf "%q " python "$@" >>"$LOG"; echo >>"$LOG"')
    text = (launcher.root / "pliant").read_text()
    (launcher.root / "pliant").write_text(re.sub(r"^python=\S+", "python=python", text, flags=re.MULTILINE))
    launcher(*command.split(), INSTALLED="")
    installed = {word for call in launcher.calls("apt-get install") for word in call.split()}
    files, modules = programs(launcher.calls("python"), launcher.root, command == "test")
    for name in [name for name in modules if name.startswith("pliant")]:
        files += ROOT.glob(f"python/{name.replace('.', '/')}/*.py")
        modules.remove(name)
    if command not in ("check a.toml", "modes a.toml", "schema", "lint"):
        assert files or modules, "no program of this command was seen"
    needed = imported(files) | dict.fromkeys(modules, command)
    missing = {name: file for name, file in needed.items() if PACKAGE.get(name, f"python3-{name}") not in installed}
    assert not missing, f"./pliant {command} does not install what these import: {missing}"


def test_late_and_indirect_imports_are_seen() -> None:
    seen = imported([ROOT / "scripts/plot.py"])
    assert {"h5py", "numpy", "matplotlib", "tomlkit"} <= set(seen) and "pliant" not in seen
    assert seen["tomlkit"] == "python/pliant/scene.py"
