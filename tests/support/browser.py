"""Headless Chromium, which shows pages to tests as to a reader."""

import shutil
import subprocess
from pathlib import Path

BROWSER = next(filter(None, map(shutil.which, ["chromium-headless-shell", "chromium"])), None)


def _run(url: str, *options: str) -> str:
    command = [BROWSER, "--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=20000", *options, url]
    result = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert result.returncode == 0, result.stderr
    return result.stdout


def dumped(url: str, size: tuple[int, int] = (1280, 800)) -> str:
    """The page's elements once its scripts have run."""
    return _run(url, f"--window-size={size[0]},{size[1]}", "--dump-dom")


def pictured(url: str, file: Path, size: tuple[int, int] = (1280, 800)) -> None:
    """A PNG of the page."""
    _run(url, f"--window-size={size[0]},{size[1]}", "--hide-scrollbars", f"--screenshot={file}")
