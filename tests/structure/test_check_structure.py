"""The checks of the source tree can fail: each finds its mistake in a small bad tree. All EXACT."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

CHECK = Path(__file__).with_name("check_structure.py")
CMAKE = """\
set(PLIANT_SHARED_FOLDERS core files geometry input scene)
target_link_libraries(pliant_lib PUBLIC pliant_scene)
target_link_libraries(pliant_reference PUBLIC pliant_scene
  umfpack)
target_link_libraries(pliant_reference_solver PRIVATE pliant_reference)
"""
GOOD = {
    "lib/core/sums.hpp": '#pragma once\n#include <vector>\n',
    "lib/scene/scene.hpp": '#pragma once\n#include "core/sums.hpp"\n',
    "lib/contact/laws/cohesive.hpp": '#pragma once\n#include "scene/scene.hpp"\n',
    "lib/cli/options.hpp": "#pragma once\n",
    "lib/contact/pairs.hpp": "#pragma once\n",
    "lib/contact/pairs.cpp": '#include "contact/laws/cohesive.hpp"\n',
    "reference/bodies.cpp": '#include "scene/scene.hpp"\n#include "reference/jet.hpp"\n',
    "reference/jet.hpp": "#pragma once\n#include <vector>\n",
    "CMakeLists.txt": CMAKE,
    "docs/method.md": "# The method\n\n## 1. Bodies\n\nIn `lib/core/sums.hpp` and `lib/contact/`.\n",
    "lib/core/cites.hpp": "#pragma once\n// As in (docs/method.md\n/// 1).\n",
    "tests/core/sums_test.cpp": '#include "core/sums.hpp"\n',
}
BAD = {
    "arrow up": ("lib/core/up.cpp", '#include "scene/scene.hpp"\n', "scene is above core"),
    "arrow up into a subfolder": ("lib/bodies/up.cpp", '#include "contact/laws/cohesive.hpp"\n', "above bodies"),
    "arrow up from lib/results": ("lib/results/up.cpp", '#include "cli/options.hpp"\n', "cli is above results"),
    "unknown folder": ("lib/helpers/x.cpp", "int f();\n", "no place in the order"),
    "cycle": ("lib/core/sums.hpp", '#pragma once\n#include "core/sums.hpp"\n', "include cycle"),
    "long file": ("lib/core/long.cpp", "int f();\n" * 501, "501 lines"),
    "wide comment": ("lib/core/wide.cpp", f"// {'x' * 118}\n", "wide.cpp:1: 121 columns"),
    "no pragma": ("lib/core/twice.hpp", "int f();\n", "#pragma once"),
    "relative include in brackets": ("lib/core/near.cpp", "#include<../core/sums.hpp>\n", "root of lib/"),
    "relative include": ("lib/core/near.cpp", '#include "../core/sums.hpp"\n', "root of lib/"),
    "unportable random numbers": ("lib/core/random.cpp", "std::uniform_real_distribution<double> u;\n", "random.cpp:1"),
    "draws in any order": ("tests/core/x_test.cpp", "void f(Random& random) {\n  g(random.below(3),\n    h(random));\n}\n",
                           "x_test.cpp:2: the compiler chooses"),
    "a product of draws": ("tests/core/x_test.cpp", "double f(Random& random) {\n  return random.below(2) * "
                           "random.below(3);\n}\n", "x_test.cpp:2"),
    "atomic": ("lib/core/atomic.cpp", "\n#pragma omp atomic\n", "atomic.cpp:2"),
    "unordered sum": ("lib/core/sum.cpp", "#pragma omp parallel for reduction(+ : s)\n", "fixed blocks"),
    "a section that is not there": ("lib/core/x.cpp", "// docs/method.md 2\n", "a section that is not there"),
    "a section over the end of a line": ("lib/core/x.cpp", "// docs/method.md\n// 2.\n", "method.md 2, a section"),
    "a file that is not there": ("docs/design.md", "`lib/core/none.hpp`\n", "names lib/core/none.hpp"),
    "path of a machine": ("scripts/plot.py", 'OUT = "/home/' 'me/out"\n', "path of one machine"),
    "engine in the reference": ("reference/x.cpp", '#include "contact/pairs.hpp"\n', "shares no mechanics"),
    "core's mathematics in the reference": ("reference/x.hpp", '#pragma once\n#include "core/sums.hpp"\n', "no mechanics"),
    "engine in the reference, from the root": ("reference/x.cpp", '#include "lib/contact/pairs.hpp"\n', "no mechanics"),
    "engine in the reference, in brackets": ("reference/x.cpp", "#include <contact/pairs.hpp>\n", "no mechanics"),
    "engine in the reference, in brackets from the root": ("reference/x.cpp", "#  include <lib/contact/pairs.hpp>\n",
                                                           "no mechanics"),
    "engine in the reference, from its folder": ("reference/x.cpp", '#include "../lib/contact/pairs.hpp"\n', "no mechanics"),
    "engine in the reference, without a space": ("reference/x.cpp", '#include"contact/pairs.hpp"\n', "no mechanics"),
    "engine in the reference, after a comment": ("reference/x.cpp", '#include /* of */ "contact/pairs.hpp"\n',
                                                 "no mechanics"),
    "engine in the reference, over two lines": ("reference/x.cpp", '#include \\\n"contact/pairs.hpp"\n', "no mechanics"),
    "engine in the reference, by a macro": ("reference/x.cpp", '#define PAIRS "contact/pairs.hpp"\n#include PAIRS\n',
                                            "in quotes or brackets"),
    "a source that nobody reads": ("reference/x.inl", '#include "contact/pairs.hpp"\n', "end with .hpp or .cpp"),
    "arrow up from the root": ("lib/core/up.cpp", '#include "lib/scene/scene.hpp"\n', "scene is above core"),
    "arrow up in brackets": ("lib/core/up.cpp", "#include <scene/scene.hpp>\n", "scene is above core"),
    "cycle through its own folder": ("lib/core/sums.hpp", '#pragma once\n#include "sums.hpp"\n', "include cycle"),
    "reference in the engine, in brackets": ("lib/cli/x.cpp", "#include <reference/jet.hpp>\n", "nothing of the reference"),
    "reference in the engine": ("lib/cli/x.cpp", '#include "reference/jet.hpp"\n', "nothing of the reference"),
    "more than the scene is shared": ("CMakeLists.txt", CMAKE.replace("core files", "core bodies files"),
                                      "PLIANT_SHARED_FOLDERS"),
    "the engine is linked": ("CMakeLists.txt", CMAKE.replace("PUBLIC pliant_scene\n", "PUBLIC pliant_scene pliant_lib\n"),
                             "links the engine"),
    "fast math": ("cmake/options.cmake", "add_compile_options(-f" "fast-math)\n", "same bits"),
    "postponed": ("lib/core/later.cpp", "// TO" "DO\n", "later.cpp:1"),
}


def check(root: Path, files: dict[str, str]) -> tuple[int, str]:
    for name, text in files.items():
        file = root / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    result = subprocess.run([sys.executable, "-B", CHECK, root], capture_output=True, text=True)
    return result.returncode, result.stdout + result.stderr


def test_a_good_tree_passes(tmp_path: Path) -> None:
    code, output = check(tmp_path, GOOD)
    assert code == 0, output


@pytest.mark.parametrize("file, text, message", BAD.values(), ids=BAD.keys())
def test_a_bad_tree_fails(tmp_path: Path, file: str, text: str, message: str) -> None:
    code, output = check(tmp_path, GOOD | {file: text})
    assert code == 1
    assert len(output.strip().splitlines()) == 1, output
    assert file in output or "cycle" in output
    assert message in output


def test_draws_one_after_the_other_pass(tmp_path: Path) -> None:
    code, output = check(tmp_path, GOOD | {"tests/core/x_test.cpp": """\
double f(Random& random) {
  const double a = random.below(2), b = random.below(3);
  const Vec2 x{random.below(2), random.below(3)};
  for (int i = 0; i < random.below(2); ++i) g(random, random.below(2));
  return g(random, random.below(2));
}
"""})
    assert code == 0, output


def test_a_cycle_over_three_files(tmp_path: Path) -> None:
    ring = {f"lib/core/{a}.hpp": f'#pragma once\n#include "core/{b}.hpp"\n' for a, b in ["ab", "bc", "ca"]}
    code, output = check(tmp_path, GOOD | ring)
    assert code == 1
    assert "lib/core/a.hpp -> lib/core/b.hpp -> lib/core/c.hpp -> lib/core/a.hpp" in output


@pytest.mark.parametrize("importing", [
    "import one\n", "from one import f\n", "from pack import one\n", "from . import one\n", "from .one import f\n",
    "import pack.one\n", "from pack.one import f\n", "def g():\n    from pack import one\n",
    "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from pack.one import f\n"])
def test_an_import_cycle(tmp_path: Path, importing: str) -> None:
    ring = {"python/pack/__init__.py": "", "python/pack/one.py": "from pack import two\n",
            "python/pack/two.py": importing}
    code, output = check(tmp_path, GOOD | ring)
    assert code == 1
    assert "import cycle: python/pack/one.py -> python/pack/two.py -> python/pack/one.py" in output


def test_an_import_cycle_through_a_package(tmp_path: Path) -> None:
    ring = {"python/pack/__init__.py": "from pack.one import f\n", "python/pack/one.py": "import pack\n"}
    code, output = check(tmp_path, GOOD | ring)
    assert code == 1
    assert "import cycle: python/pack/__init__.py -> python/pack/one.py -> python/pack/__init__.py" in output


def test_a_package_may_take_from_its_modules(tmp_path: Path) -> None:
    files = {"python/pack/__init__.py": "from pack.one import f\n", "python/pack/one.py": "from pack import two\n",
             "python/pack/two.py": "import json\n"}
    code, output = check(tmp_path, GOOD | files)
    assert code == 0, output


def test_a_maximum_over_threads_is_free(tmp_path: Path) -> None:
    code, output = check(tmp_path, GOOD | {"lib/core/max.cpp": "#pragma omp parallel for reduction(max : m)\n"})
    assert code == 0, output


def test_build_and_result_folders_are_not_read(tmp_path: Path) -> None:
    code, output = check(tmp_path, GOOD | {"build/x.hpp": "/home/" "me", "results/a/x.py": "/home/" "me"})
    assert code == 0, output


def test_an_empty_tree_is_no_success(tmp_path: Path) -> None:
    assert check(tmp_path, {})[0] == 1


@pytest.mark.skipif(shutil.which("clang-format-19") is None, reason="clang-format-19 is not installed")
def test_a_badly_laid_out_file_is_found_and_repaired(tmp_path: Path) -> None:
    script = tmp_path / "tests/structure/format.sh"
    script.parent.mkdir(parents=True)
    shutil.copy(CHECK.with_name("format.sh"), script)
    shutil.copy(CHECK.parents[2] / ".clang-format", tmp_path)
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib/good.hpp").write_text("int f();\n")
    (tmp_path / "lib/bad.hpp").write_text("int f();\nint   g();\n")
    found = subprocess.run([script], capture_output=True, text=True)
    assert found.returncode == 1
    assert "lib/bad.hpp:2" in found.stdout and "good.hpp" not in found.stdout
    assert subprocess.run([script, "--write"]).returncode == 0
    assert subprocess.run([script]).returncode == 0
