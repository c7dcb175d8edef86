"""Builds the site of docs/, to be read without a network.

    ./pliant docs               results/docs/index.html
    ./pliant docs --serve       on this machine, anew whenever a page changes

Exit codes: 0 built, 1 a page has a fault, 2 the folder holds something else than a site, 4 it cannot be written.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

BUILT, COMPLAINED, BAD_INPUT, NOT_WRITTEN = 0, 1, 2, 4
ROOT = Path(__file__).resolve().parents[1]
CONFIG = ROOT / "mkdocs.yml"
OF_A_SITE = "sitemap.xml"  # mkdocs writes it into each


def mkdocs(*arguments: str | Path) -> list[str]:
    command = [sys.executable, "-B", "-m", "mkdocs", *arguments, "--config-file", CONFIG, "--strict"]
    return list(map(str, command))


def complaints(said: str) -> str:
    """Of all that mkdocs says, with what it is about; all of it where it ended otherwise."""
    plain = re.sub(r"\x1b\[\d*m", "", said)
    return "\n".join(re.findall(r"^(?:WARNING|ERROR) .*", plain, re.MULTILINE)) or plain


def is_replaceable(folder: Path) -> bool:
    return not folder.exists() or folder.is_dir() and (not any(folder.iterdir()) or (folder / OF_A_SITE).exists())


def build(out: Path) -> int:
    """Whole or not at all: built under another name first."""
    try:
        if not is_replaceable(out):
            print(f"error: {out}: is no earlier site, and would be overwritten: give another folder", file=sys.stderr)
            return BAD_INPUT
        out.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=out.parent, prefix=f".{out.name}.") as scratch:
            site = Path(scratch) / "site"
            command = mkdocs("build", "--site-dir", site)
            result = subprocess.run(command, capture_output=True, text=True, check=False)
            if result.returncode != 0:
                print(complaints(result.stderr), file=sys.stderr)
                return COMPLAINED
            if out.exists():
                shutil.rmtree(out)
            site.replace(out)
    except OSError as error:
        print(f"error: {out}: cannot be written: {error.strerror or error}", file=sys.stderr)
        return NOT_WRITTEN
    print(out / "index.html")
    return BUILT


def parse_arguments(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="pliant docs", description="Builds the site of docs/.",
                                     epilog="example: ./pliant docs --serve")
    how = parser.add_mutually_exclusive_group()
    how.add_argument("--serve", action="store_true", help="at http://127.0.0.1:8000, until Ctrl-C")
    how.add_argument("--out", type=Path, metavar="DIR", default=ROOT / "results/docs", help="default: results/docs")
    return parser.parse_args(arguments)


def main(arguments: list[str]) -> int:
    options = parse_arguments(arguments)
    if options.serve:
        os.execv(sys.executable, mkdocs("serve"))
    return build(options.out.absolute())


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
