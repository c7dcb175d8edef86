"""Checks of the source tree that no compiler makes; each with its reason. Prints what it found; exit code 1 if any.

Run: /usr/bin/python3 tests/structure/check_structure.py .
"""

from __future__ import annotations

import ast
import os
import re
import sys
from collections.abc import Callable
from pathlib import Path

from order_of_draws import disordered_lines

# A folder of lib/ may include itself and the folders after it: arrows point down only.
ORDER = ["cli", "run", "results", "dynamics", "bonds", "contact", "setup", "boundary", "bodies", "materials", "discretisation",
         "input", "geometry", "files", "scene", "core"]
SOURCE_FOLDERS = ["lib", "reference", "verify", "benchmarks", "tests", "scripts", "python"]
TEXT_SUFFIXES = {".hpp", ".cpp", ".py", ".sh", ".md", ".toml", ".txt", ".cmake", ".json", ".cff", ""}
CODE_SUFFIXES = {".hpp", ".cpp", ".py", ".js", ".css"}
MAX_LINES = 500  # a file is one idea: beyond that it is two
MAX_COLUMNS = 120  # of what no formatter wraps: comments of C++, the launcher
SKIPPED_AT_THE_ROOT = re.compile(r"\.git|results|build.*")

CITED = ["docs/method.md", "docs/design.md"]
PYTHON_FOLDERS = ["python", "scripts", "verify", "benchmarks", "tests/support"]  # of modules that other folders import
JUDGED = ["lib", "reference"]  # by what they include

# All of lib/ that the reference solver may share: no mechanics (docs/design.md 6). Of core only these.
SHARED_FOLDERS = ["files", "geometry", "input", "scene"]
SHARED_CORE = {"errors.hpp", "floating_point_traps.hpp", "located.hpp", "memory.hpp", "stop_signals.hpp", "vec2.hpp"}

# What an #include names, in quotes or in brackets; or whatever else stands there, such as a macro.
INCLUDE = re.compile(r'^\s*(?:#|%:)\s*include(?:_next)?\b\s*(?:"([^"]+)"|<([^>]+)>|(.*))', re.MULTILINE)
COMMENT = re.compile(r"/\*[^\n]*?\*/")

# Not allowed in lib/: pattern, and why.
FORBIDDEN_IN_LIB = {
    r"\bstd::(uniform_\w+_distribution|normal_distribution|shuffle)\b": "differs between C++ libraries: map the "
                                                                        "generator's numbers yourself",
    r"\b(std::)?s?rand\s*\(": "one hidden state for all: use a seeded generator",
    r"#\s*pragma\s+omp\b.*\b(atomic|critical)\b": "order of additions depends on threads: let each body gather",
    r"#\s*pragma\s+omp\b.*\breduction\s*\(\s*[-+*]": "order of additions depends on threads: sum in fixed blocks",
    r"#\s*include\s*[\"<]\.\./": "include from the root of lib/",
    r"\busing\s+namespace\s+std\b": "spell std:: out",
}
# Not allowed anywhere.
FORBIDDEN = {
    r"(?<![\w.$}~-])/(home|root|Users|work|mnt|tmp)/\w": "path of one machine: make it relative or ask for it",
    r"-f" r"fast-math": "reorders sums, breaks the promise of the same bits",
    r"\b(TO" r"DO|FIX" r"ME|XX" r"X)\b": "do it, or write an issue",
}


def files_of(root: Path, suffixes: set[str], folders: list[str] | None = None) -> list[Path]:
    starts = [root / folder for folder in folders] if folders else [root]
    found = (file for start in starts for file in start.rglob("*") if file.is_file() and file.suffix in suffixes)
    return sorted(file for file in found if not is_skipped(file.relative_to(root)))


def is_skipped(file: Path) -> bool:
    return "__pycache__" in file.parts or SKIPPED_AT_THE_ROOT.fullmatch(file.parts[0]) is not None


def read(file: Path) -> str:
    return file.read_text(encoding="utf-8", errors="replace")


def includes(file: Path) -> list[tuple[str, str, str]]:
    return INCLUDE.findall(COMMENT.sub(" ", read(file).replace("\\\n", "")))


def included_files(root: Path, file: Path) -> list[Path]:
    """Files of lib/ and reference/ that a file includes in whichever form: from its own folder or from those that
    compilers are told to look in, which are lib/ and the root; other includes are the compiler's business."""
    found = []
    for name in (quoted or bracketed for quoted, bracketed, _ in includes(file)):
        candidates = (Path(os.path.normpath(start / name)) for start in (file.parent, root / "lib", root))
        own = (candidate for candidate in candidates if candidate.is_file()
               and candidate.is_relative_to(root) and candidate.relative_to(root).parts[0] in JUDGED)
        found += list(own)[:1]
    return found


def check_forms(root: Path) -> list[str]:
    """Nothing that is compiled may escape the checks of includes."""
    problems = []
    for file in (file for folder in JUDGED for file in sorted((root / folder).rglob("*")) if file.is_file()):
        if file.suffix not in (".hpp", ".cpp"):
            problems.append(f"{file.relative_to(root)}: sources of lib/ and reference/ end with .hpp or .cpp")
        problems += [f"{file.relative_to(root)}: includes {other or 'nothing'}: give a name in quotes or brackets"
                     for quoted, bracketed, other in includes(file) if not quoted and not bracketed]
    return problems


def check_arrows(root: Path) -> list[str]:
    lib, problems = root / "lib", []
    for file in files_of(root, {".hpp", ".cpp"}, ["lib"]):
        folder = file.relative_to(lib).parts[0]
        if folder not in ORDER:
            problems.append(f"{file.relative_to(root)}: folder {folder} has no place in the order {', '.join(ORDER)}")
            continue
        for included in included_files(root, file):
            if not included.is_relative_to(lib):
                continue  # see check_independence
            target = included.relative_to(lib)
            if target.parts[0] in ORDER and ORDER.index(target.parts[0]) < ORDER.index(folder):
                problems.append(f"{file.relative_to(root)}: includes {target}, but {target.parts[0]} is above {folder}")
    return problems


def imported_files(root: Path, file: Path) -> list[Path]:
    """Files of the repository that a Python file imports: for types alone and in functions, too. They are in its own
    folder or in those that programs look in. What is taken from a package counts as the module that it may be."""
    found, folders = [], [file.parent, *(root / folder for folder in PYTHON_FOLDERS)]
    for node in ast.walk(ast.parse(read(file))):
        if isinstance(node, ast.Import):
            found += [module_file(folders, [alias.name]) for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            starts = [file.parents[node.level - 1]] if node.level else folders
            package = f"{node.module}." if node.module else ""
            found += [module_file(starts, [package + alias.name, package.rstrip(".")]) for alias in node.names]
    return [module for module in found if module is not None]


def module_file(folders: list[Path], names: list[str]) -> Path | None:
    """Of the first of these names that is there."""
    paths = (folder / name.replace(".", "/") for name in names for folder in folders)
    files = (file for path in paths for file in (path.parent / f"{path.name}.py", path / "__init__.py"))
    return next((file for file in files if file.is_file()), None)


def check_cycles(root: Path) -> list[str]:
    problems, done = [], set()

    def visit(file: Path, path: list[Path], next_files: Callable[[Path, Path], list[Path]], kind: str) -> None:
        """Depth-first search; a file met again while it is still on the path closes a cycle."""
        if file in path:
            names = [str(step.relative_to(root)) for step in path[path.index(file):] + [file]]
            problems.append(f"{kind} cycle: " + " -> ".join(names))
        elif file not in done:
            for other in next_files(root, file):
                visit(other, path + [file], next_files, kind)
            done.add(file)

    for file in files_of(root, {".hpp", ".cpp"}, ["lib"]):
        visit(file, [], included_files, "include")
    for file in files_of(root, {".py"}, SOURCE_FOLDERS):
        visit(file, [], imported_files, "import")
    return problems


def check_independence(root: Path) -> list[str]:
    """Includes of reference/, and what it and the library that it shares are made of."""
    lib, problems = root / "lib", []
    for file in files_of(root, {".hpp", ".cpp"}, JUDGED):
        for included in included_files(root, file):
            name, into_lib = included.relative_to(root), included.is_relative_to(lib)
            if file.is_relative_to(lib) and not into_lib:
                problems.append(f"{file.relative_to(root)}: includes {name}: the engine uses nothing of the reference "
                                "solver")
            elif not file.is_relative_to(lib) and into_lib and not is_shared(included.relative_to(lib)):
                problems.append(f"{file.relative_to(root)}: includes {name}: the reference solver shares no mechanics "
                                "with the engine")
    return problems + check_link_lines(root)


def is_shared(target: Path) -> bool:
    return target.parts[0] in SHARED_FOLDERS or (target.parts[0] == "core" and target.name in SHARED_CORE)


def check_link_lines(root: Path) -> list[str]:
    """CMakeLists.txt links the reference solver with the shared folders alone."""
    cmake = root / "CMakeLists.txt"
    if not (root / "reference").is_dir() or not cmake.is_file():
        return []
    text, problems = read(cmake), []
    shared = re.search(r"set\(PLIANT_SHARED_FOLDERS ([^)]*)\)", text)
    if shared is None or not set(shared[1].split()) <= {"core", *SHARED_FOLDERS}:
        problems.append(f"CMakeLists.txt: PLIANT_SHARED_FOLDERS may be core {' '.join(SHARED_FOLDERS)} and nothing else")
    for target, libraries in re.findall(r"target_link_libraries\((pliant_reference\w*|pliant_scene)\s([^)]*)\)", text):
        if "pliant_lib" in libraries.split():
            problems.append(f"CMakeLists.txt: {target} links the engine")
    return problems


def check_lengths(root: Path) -> list[str]:
    files = [*files_of(root, CODE_SUFFIXES, SOURCE_FOLDERS), *files_of(root, {".sh", ".txt"}, ["launcher"]),
             *(file for file in [root / "pliant"] if file.exists())]
    problems = []
    for file, path in ((file, file.relative_to(root)) for file in files):
        lines = read(file).splitlines()
        if len(lines) > MAX_LINES:
            problems.append(f"{path}: {len(lines)} lines, at most {MAX_LINES}: split it")
        problems += [f"{path}:{number}: {len(line)} columns, at most {MAX_COLUMNS}: wrap it"
                     for number, line in enumerate(lines, 1) if file.suffix != ".py" and len(line) > MAX_COLUMNS]
    return problems


def check_words(root: Path, files: list[Path], forbidden: dict[str, str]) -> list[str]:
    problems = []
    for file in files:
        for number, line in enumerate(read(file).splitlines(), 1):
            problems += [f"{file.relative_to(root)}:{number}: '{match.group().strip()}': {reason}"
                         for pattern, reason in forbidden.items() if (match := re.search(pattern, line))]
    return problems


def check_citations(root: Path) -> list[str]:
    """Sections that texts cite are there, and so are the files that docs/design.md names."""
    problems, sections = [], {}
    for file in (file for name in CITED if (file := root / name).is_file()):
        sections[file.name] = set(re.findall(r"^## (\d+)\.", read(file), re.MULTILINE))
        for path in re.findall(r"`([\w.]+/[\w./-]*)`", read(file)):
            if not (root / path).exists():
                problems.append(f"{file.relative_to(root)}: names {path}, which is not there")
    for file in files_of(root, TEXT_SUFFIXES):
        for name, number in re.findall(r"docs/(\w+\.md)\s+(?:#|//+)?\s*(\d+)\b", read(file)):
            if f"docs/{name}" in CITED and number not in sections.get(name, set()):
                problems.append(f"{file.relative_to(root)}: cites docs/{name} {number}, a section that is not there")
    return problems


def check_draws(root: Path) -> list[str]:
    return [f"{file.relative_to(root)}:{line}: the compiler chooses which of these random numbers is drawn first: draw them "
            "one statement after the other, or between braces"
            for file in files_of(root, {".hpp", ".cpp"}, ["lib", "reference", "tests", "benchmarks"])
            for line in disordered_lines(read(file))]


def check_pragma_once(root: Path) -> list[str]:
    return [f"{file.relative_to(root)}: no #pragma once" for file in files_of(root, {".hpp"}, SOURCE_FOLDERS)
            if "#pragma once" not in read(file)]


def check_tree(root: Path) -> list[str]:
    texts = [file for file in files_of(root, TEXT_SUFFIXES) if file.name != "LICENSE"]
    return [*check_forms(root), *check_arrows(root), *check_cycles(root), *check_independence(root),
            *check_lengths(root), *check_pragma_once(root), *check_citations(root),
            *check_words(root, files_of(root, {".hpp", ".cpp"}, ["lib"]), FORBIDDEN_IN_LIB), *check_draws(root),
            *check_words(root, texts, FORBIDDEN)]


def main(arguments: list[str]) -> int:
    root = Path(arguments[1] if len(arguments) > 1 else ".").resolve()
    files = files_of(root, {".hpp", ".cpp"}, ["lib"])
    if not files:
        print(f"no source files under {root / 'lib'}: give the root of the repository")
        return 1
    problems = check_tree(root)
    print("\n".join(problems) if problems else f"{len(files)} files of lib/ and all others keep the rules")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
