"""The site of docs/: it builds without a warning, its links lead somewhere, it asks no other server, its search works,
and `./pliant docs` overwrites nothing but a site. All EXACT."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import threading
from collections.abc import Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from importlib.util import find_spec
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from links import Html, problems_of_markdown, problems_of_paths, problems_of_site, tracked

ROOT = Path(__file__).resolve().parents[2]
BROWSER = next(filter(None, map(shutil.which, ["chromium-headless-shell", "chromium"])), None)
pytestmark = pytest.mark.skipif(find_spec("mkdocs") is None, reason="mkdocs is not installed")
HOST = "site.test"  # which no name server knows

CHECK = {"label": "EXACT", "case": "sliding", "name": "way | stop", "value": 1.25, "expected": 1.0, "tolerance": 0.5,
         "source": "Coulomb's law", "green": True, "test": "a", "seconds": 3.0, "commit": "1" * 12, "stale": False}
FOUND = {"commit": "1" * 12, "written": "then", "totals": {"EXACT": 1, "RATE": 1, "INDEPENDENT": 0, "FROZEN": 0},
         "red": 2, "stale": 0,
         "checks": [CHECK, CHECK | {"label": "RATE", "name": "order", "green": False, "test": "b"}],
         "failures": [{"case": "hertz", "test": "c", "message": "x", "commit": "", "stale": False}]}


def build(root: Path, out: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-B", root / "scripts/docs.py", "--out", out]
    return subprocess.run(command, env=os.environ | environment, capture_output=True, text=True, timeout=300)


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("site")
    (folder / "checks.json").write_text(json.dumps(FOUND))
    result = build(ROOT, folder / "docs", PLIANT_VERIFY_OUT=str(folder))
    assert result.returncode == 0 and "WARNING" not in result.stderr, result.stderr
    assert result.stdout == f"{folder}/docs/index.html\n"
    return folder / "docs"


def test_links_of_the_site_lead_somewhere_and_nothing_is_loaded_from_elsewhere(site: Path) -> None:
    assert list(problems_of_site(site)) == []


def test_links_of_markdown_lead_somewhere() -> None:
    assert list(problems_of_markdown(ROOT, tracked(ROOT, ".md"))) == []


def test_files_that_are_named_are_there() -> None:
    assert list(problems_of_paths(ROOT, tracked(ROOT, ".md"))) == []


def test_every_page_is_in_the_menu(site: Path) -> None:
    menu = set(re.findall(r": ([\w/]+\.md)$", (ROOT / "mkdocs.yml").read_text(), re.MULTILINE))
    assert menu == {str(page.relative_to(ROOT / "docs")) for page in (ROOT / "docs").rglob("*.md")}


def test_linked_files_are_listed(site: Path) -> None:
    assert "restitution" in (site / "studies/restitution.toml.html").read_text()
    listed = Html((site / "verify/foreign/index.html").read_text()).links
    assert any("stored.py" in link for link in listed)


def test_what_was_verified_is_shown(site: Path) -> None:
    cells = [re.sub(r"<[^>]*>", "", cell) for page in ("verification", "verify/sliding/index", "verify/hertz/index")
             for cell in re.findall(r"<t[dh][^>]*>(.*?)</t[dh]>|<li>(.*?)</li>", (site / f"{page}.html").read_text())
             for cell in cell]
    row = cells.index("sliding")
    assert [cell for cell in cells[row + 2:row + 14] if cell] == ["1", "1", "1", "6"], "EXACT, RATE, red, seconds"
    assert {"way | stop", "1.25", "0.5", "red: c ended before it wrote a check down"} <= set(cells)


def test_pages_with_formulas_load_what_typesets_them(site: Path) -> None:
    page = (site / "method.html").read_text()
    assert page.count('class="arithmatex"') > 100 and "$" not in re.sub(r"<script.*?</script>", "", page, flags=re.DOTALL)
    assert any(link == "katex/katex.min.js" for link in Html(page).loaded)
    assert "../katex/katex.min.js" in Html((site / "notes/method.html").read_text()).loaded
    assert not any("katex" in link for link in Html((site / "index.html").read_text()).loaded)
    fonts = re.findall(r"url\(([^)]*\.woff2)\)", (site / "katex/katex.min.css").read_text())
    assert fonts and all((site / "katex" / font).is_file() for font in fonts)


@pytest.mark.skipif(BROWSER is None, reason="chromium is not installed")
@pytest.mark.parametrize("name", ["method", "contact_laws", "notes/method"])
def test_a_browser_typesets_all_formulas(site: Path, name: str) -> None:
    command = [BROWSER, "--headless", "--no-sandbox", "--disable-gpu", "--timeout=60000", "--dump-dom",
               (site / f"{name}.html").as_uri()]
    shown = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert shown.returncode == 0, shown.stderr
    assert "katex-error" not in shown.stdout
    assert shown.stdout.count('class="katex"') == shown.stdout.count('class="arithmatex"') > 0


def test_equations_are_numbered_in_their_order() -> None:
    numbers = re.findall(r"\\tag\{(\d+)\}", (ROOT / "docs/method.md").read_text())
    assert numbers == [str(number) for number in range(1, len(numbers) + 1)]


def test_checks_of_links_can_fail(tmp_path: Path) -> None:
    (tmp_path / "a.html").write_text('<a href="b.html#there">1</a><a href="b.html#not">2</a><a href="c.html">3</a>'
                                     '<a href="https://x.org/">4</a><script src="https://x.org/y.js"></script>')
    (tmp_path / "b.html").write_text('<p id="there"><img src="d.png">')
    assert list(problems_of_site(tmp_path)) == [
        "a.html: loads https://x.org/y.js", "a.html: b.html#not has no such anchor", "a.html: c.html is not there",
        "b.html: d.png is not there"]
    page = tmp_path / "a.md"
    page.write_text("# One `b`, two\n[1](#one-b-two) [2](#one) [3](c.md) `[4](d.md)`\n"
                    "```\n[5](e.md)\n```\n[6](http://x)\n")
    assert list(problems_of_markdown(tmp_path, [page])) == ["a.md: #one has no such anchor", "a.md: c.md is not there"]
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib/a.cpp").touch()
    page.write_text("`lib/a.cpp`, `lib/b.cpp`, `other/c.cpp`")
    subprocess.run(["git", "init", "-q", tmp_path], check=True)
    assert list(problems_of_paths(tmp_path, [page])) == ["a.md: lib/b.cpp is not there"]


def test_a_bad_link_keeps_the_earlier_site(tmp_path: Path) -> None:
    for name in ("docs", "scripts"):
        shutil.copytree(ROOT / name, tmp_path / name)
    shutil.copy(ROOT / "mkdocs.yml", tmp_path)
    (tmp_path / "verify").mkdir()
    out = tmp_path / "out"
    out.mkdir()
    (out / "sitemap.xml").touch()
    with (tmp_path / "docs/limits.md").open("a") as page:
        page.write("\n[x](nowhere.md)\n")
    result = build(tmp_path, out)
    assert result.returncode == 1 and "nowhere.md" in result.stderr
    assert [file.name for file in out.iterdir()] == ["sitemap.xml"]
    assert not list(tmp_path.glob(".out*"))


def test_only_a_site_is_overwritten(tmp_path: Path) -> None:
    (tmp_path / "letters.txt").touch()
    for out in (tmp_path, tmp_path / "letters.txt"):
        result = build(ROOT, out)
        assert result.returncode == 2 and "no earlier site" in result.stderr
    assert [file.name for file in tmp_path.iterdir()] == ["letters.txt"]
    result = build(ROOT, Path("/proc/nowhere/docs"))
    assert result.returncode == 4 and "cannot be written" in result.stderr


# Shows the site in a frame, as one who searches it sees it, and is loaded only when results are there: then a browser
# that dumps a page does so.
SEARCH = """<iframe id="site" src="/?q=restitution"></iframe><img src="/wait"><pre id="found"></pre><script>
const look = setInterval(() => {
  const titles = document.getElementById("site").contentDocument.querySelectorAll(".md-search-result__item h1");
  if (titles.length) {
    document.getElementById("found").textContent = [...titles].map(title => title.textContent).join(", ");
    clearInterval(look);
    fetch("/found");
  }
}, 50);</script>"""


class Server(SimpleHTTPRequestHandler):
    """Of the site, and a proxy through which a browser asks for everything."""

    asked: list[str] = []
    found = threading.Event()

    def do_GET(self) -> None:
        address = urlsplit(self.path)
        self.asked.append(self.path)
        if address.netloc != HOST or address.path in ("/found", "/wait"):
            self.found.set() if address.path == "/found" else self.found.wait(60)
            self.send_error(404)
        elif address.path == "/search.html":
            self.send_response(200)
            self.end_headers()
            self.wfile.write(SEARCH.encode())
        else:
            self.path = address.path
            super().do_GET()

    def do_CONNECT(self) -> None:
        self.asked.append(f"https://{self.path}")
        self.send_error(403)

    def log_message(self, *_: object) -> None:
        pass


@pytest.fixture
def port(site: Path) -> Iterator[int]:
    with ThreadingHTTPServer(("127.0.0.1", 0), partial(Server, directory=str(site))) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield server.server_port
        server.shutdown()


@pytest.mark.skipif(BROWSER is None, reason="chromium is not installed")
def test_a_browser_asks_nobody_else_and_finds_words(port: int) -> None:
    command = [BROWSER, "--headless", "--no-sandbox", "--disable-gpu", f"--proxy-server=127.0.0.1:{port}",
               "--disable-background-networking", "--disable-component-update", "--timeout=60000", "--dump-dom",
               f"http://{HOST}/search.html"]
    shown = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert shown.returncode == 0, shown.stderr
    assert any("search_index.json" in address for address in Server.asked)
    assert {urlsplit(address).netloc for address in Server.asked} == {HOST}, Server.asked
    assert re.search(r'<pre id="found">\S', shown.stdout), shown.stdout
