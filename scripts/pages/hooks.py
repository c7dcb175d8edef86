"""Hooks of mkdocs. Pages link to files of the whole repository, as they must to be read there: what stands outside of
docs/ and is linked becomes a page of the site too, Markdown as it is, other files as listings. Pages of verification
get what `./pliant verify` found last, pages with formulas what typesets them."""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path

from mkdocs.config.base import Config
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from pages import formulas, verification

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
PATH = re.compile(r"(?<=<code>)[^<>\n]*/[^<>\n]*(?=</code>)")
TARGET = re.compile(r"(?<=\]\()([^)\s#:]+)(?=(?:#[^)\s]*)?\))")  # of a link within the repository


def linked(text: str, folder: Path) -> dict[str, Path]:
    """What a page in this folder links to outside of docs/, by the link."""
    targets = {link: Path(os.path.normpath(folder / link)) for link in TARGET.findall(text)}
    return {link: target for link, target in targets.items()
            if target.exists() and target.is_relative_to(ROOT) and not target.is_relative_to(DOCS)}


def readable(target: Path) -> Path:
    """A folder is read by its README."""
    return target / "README.md" if (target / "README.md").is_file() else target


def place(target: Path) -> str:
    """Where a file or folder of the repository stands among the sources of the site."""
    path = target.relative_to(DOCS if target.is_relative_to(DOCS) else ROOT).as_posix()
    return f"{path}/index.md" if target.is_dir() else path if target.suffix in (".md", ".png") else f"{path}.md"


def listing(target: Path) -> str:
    """A page that shows a file, or what a folder has in it."""
    title = f"# {target.relative_to(ROOT)}\n\n"
    if target.is_dir():
        names = sorted(entry.name for entry in target.iterdir() if entry.is_file())
        return title + "\n".join(f"* [{name}]({name})" for name in names) + "\n"
    language = {".toml": "toml", ".py": "python", ".cpp": "cpp", ".hpp": "cpp"}.get(target.suffix, "text")
    return f"{title}`````{language}\n{target.read_text()}\n`````\n"


def source_of(target: Path) -> str:
    return target.read_text() if target.suffix == ".md" else listing(target)


def on_files(files: Files, config: Config) -> Files:
    """Adds what is linked, and what that links to."""
    waiting = [Path(file.abs_src_path) for file in files.documentation_pages()]
    known = set(waiting)
    while waiting:
        page = waiting.pop()
        folder = page if page.is_dir() else page.parent
        if page.suffix != ".md" and not page.is_dir():
            continue
        for target in map(readable, linked(source_of(page), folder).values()):
            if target not in known:
                file = File(place(target), str(ROOT), config["site_dir"], config["use_directory_urls"])
                file.abs_src_path = str(target)
                files.append(file)
                known.add(target)
                waiting.append(target)
    return files


def on_page_read_source(page: Page, config: Config) -> str:
    return source_of(Path(page.file.abs_src_path))


def on_page_markdown(markdown: str, page: Page, config: Config, files: Files) -> str:
    source = Path(page.file.abs_src_path)
    folder = source if source.is_dir() else source.parent
    here = Path(page.file.src_uri).parent

    def moved(match: re.Match[str]) -> str:
        target = Path(os.path.normpath(folder / match[0]))
        if not target.exists() or not target.is_relative_to(ROOT):
            return match[0]  # mkdocs warns of it
        return os.path.relpath(place(readable(target)), here)

    return verification.complete(TARGET.sub(moved, markdown), source)


def on_page_content(html: str, page: Page, config: Config, files: Files) -> str:
    """Paths may break at their slashes, or columns of tables would be as wide as they are."""
    return PATH.sub(lambda match: match[0].replace("/", "/<wbr>"), html)


def on_post_page(output: str, page: Page, config: Config) -> str:
    return formulas.complete(output, page.url)


def on_post_build(config: Config) -> None:
    formulas.copy_typesetter(Path(config["site_dir"]))
