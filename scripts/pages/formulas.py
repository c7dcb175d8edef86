"""Formulas of the site: Markdown has them as $...$ and $$...$$, which forges typeset by themselves. Here KaTeX does so in
the reader's browser. Its script, style and fonts are copied from Debian's package when the site is built: pages ask no
server."""

from __future__ import annotations

import shutil
from pathlib import Path

from mkdocs.exceptions import PluginError
from mkdocs.utils import get_relative_url

KATEX = Path("/usr/share/javascript/katex")  # of the package libjs-katex
FOLDER = "katex"  # of the site
FORMULA = 'class="arithmatex"'  # the mark of the Markdown extension arithmatex
TYPESET = r"""<script>
for (const formula of document.querySelectorAll(".arithmatex")) {
  const text = formula.textContent.trim();  // between \( and \), or \[ and \]
  katex.render(text.slice(2, -2), formula, {displayMode: text.startsWith("\\["), throwOnError: false});
}
</script>"""


def complete(html: str, url: str) -> str:
    """A page of the site, which typesets its formulas if it has some."""
    if FORMULA not in html:
        return html
    style, script = (get_relative_url(f"{FOLDER}/{name}", url) for name in ("katex.min.css", "katex.min.js"))
    html = html.replace("</head>", f'<link rel="stylesheet" href="{style}">\n</head>', 1)
    return html.replace("</body>", f'<script src="{script}"></script>\n{TYPESET}\n</body>', 1)


def copy_typesetter(site: Path) -> None:
    if not KATEX.is_dir():
        raise PluginError(f"{KATEX} is not there: install the Debian package libjs-katex")
    (site / FOLDER / "fonts").mkdir(parents=True, exist_ok=True)
    for name in ("katex.min.css", "katex.min.js"):
        shutil.copyfile(KATEX / name, site / FOLDER / name)
    for font in (KATEX / "fonts").glob("*.woff2"):
        shutil.copyfile(font, site / FOLDER / "fonts" / font.name)
