"""Links of the built site and of the repository's Markdown that lead nowhere."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Iterator
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Html(HTMLParser):
    """What a page links to, what it loads, and the anchors that it has."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.links: list[str] = []
        self.loaded: list[str] = []
        self.anchors: set[str] = set()
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        of = {name: value or "" for name, value in attributes}
        self.anchors |= {of[name] for name in ("id", "name") if name in of}
        if "href" in of:
            (self.links if tag == "a" else self.loaded).append(of["href"])
        if "src" in of:
            self.loaded.append(of["src"])


@cache
def html(file: Path) -> Html:
    return Html(file.read_text())


def is_external(link: str) -> bool:
    address = urlsplit(link)
    return bool(address.scheme and address.scheme != "data") or bool(address.netloc)


def resolved(link: str, page: Path, root: Path) -> Path:
    path = unquote(urlsplit(link).path)
    target = root / path.lstrip("/") if path.startswith("/") else page.parent / path if path else page
    return target / "index.html" if target.is_dir() else target


def problems_of_site(site: Path) -> Iterator[str]:
    """Links and anchors that are not there, and what pages load from elsewhere."""
    for page in sorted(site.rglob("*.html")):
        name = page.relative_to(site)
        yield from (f"{name}: loads {link}" for link in html(page).loaded if is_external(link))
        for link in html(page).links + html(page).loaded:
            if is_external(link) or link.startswith("data:"):
                continue
            target, anchor = resolved(link, page, site), unquote(urlsplit(link).fragment)
            if not target.is_file():
                yield f"{name}: {link} is not there"
            elif anchor and target.suffix == ".html" and anchor not in html(target).anchors:
                yield f"{name}: {link} has no such anchor"


CODE = re.compile(r"^(`{3,}).*?^\1`*\s*?$|`[^`\n]+`", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\(([^)\s]+)\)")
HEADING = re.compile(r"^#+ (.*)$", re.MULTILINE)


def anchors_of_markdown(text: str) -> set[str]:
    """Of its headings, as forges make them."""
    plain = (re.sub(r"\[([^]]*)\]\([^)]*\)|`", r"\1", heading) for heading in HEADING.findall(text))
    return {re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-") for heading in plain}


def problems_of_markdown(root: Path, files: list[Path]) -> Iterator[str]:
    for page in files:
        for link in LINK.findall(CODE.sub("", page.read_text())):
            address = urlsplit(link)
            if is_external(link):
                continue
            target = page.parent / unquote(address.path) if address.path else page
            if not target.exists():
                yield f"{page.relative_to(root)}: {link} is not there"
            elif address.fragment and address.fragment not in anchors_of_markdown(target.read_text()):
                yield f"{page.relative_to(root)}: {link} has no such anchor"


def problems_of_paths(root: Path, files: list[Path]) -> Iterator[str]:
    """Files that are named and not there, by paths from folders of the repository."""
    folders = {name.split("/")[0] for name in listed(root, "*/*")}
    for page in files:
        for path in re.findall(rf"`((?:{'|'.join(sorted(folders))})/[\w./-]+)`", page.read_text()):
            if not (root / path).exists():
                yield f"{page.relative_to(root)}: {path} is not there"


def listed(root: Path, pattern: str) -> list[str]:
    """Files of the repository, also those that are not committed yet."""
    command = ["git", "-C", root, "ls-files", "-co", "--exclude-standard", pattern]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()


def tracked(root: Path, suffix: str) -> list[Path]:
    return [root / name for name in listed(root, f"*{suffix}") if (root / name).exists()]
