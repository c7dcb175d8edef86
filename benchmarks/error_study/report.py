"""The report: data as JSON, plots as SVG in a page, and one picture of all scenes as PNG."""

from __future__ import annotations

import io
import json
import textwrap
from pathlib import Path

import jinja2
import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
from matplotlib.axes import Axes

from error_study import judge
from error_study.choices import PAPER, Choice
from error_study.measure import Measured
from error_study.scenes import Scene
from pliant.study.folder import replace
from plots.curves import COLOURS

HERE = Path(__file__).resolve().parent
DRAWN = {**judge.NAMED, "t3": Choice(method="t3"), "the paper's way": PAPER}
MARKERS = ["o", "s", "D", "v", "^", "x"]


def write(folder: Path, scenes: list[Scene], rows: list[Measured], about: dict) -> list[Path]:
    """`about`: commit, processor and the like. Returns the files."""
    data, page, picture = write_data(folder, rows, about), folder / "error.html", folder / "error.png"
    page.write_text(_page(scenes, rows, about))
    _draw_all(picture, scenes, rows)
    return [data, page, picture]


def write_data(folder: Path, rows: list[Measured], about: dict) -> Path:
    file = folder / "error.json"
    replace(file, json.dumps({"about": about, **judge.as_json(rows)}, indent=1) + "\n")
    return file


def read(folder: Path, about: dict) -> list[Measured]:
    """What write_data() stored; nothing where there is no file. ValueError if it is about something else."""
    file = folder / "error.json"
    if not file.exists():
        return []
    stored = json.loads(file.read_text())
    for name, value in about.items():
        if stored["about"].get(name) != value:
            raise ValueError(f"{file}: {name} was {stored['about'].get(name)}, now {value}; leave out --resume, or choose another --out")
    return judge.from_json(stored["measured"])


def _page(scenes: list[Scene], rows: list[Measured], about: dict) -> str:
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE), autoescape=True, trim_blocks=True,
                                     lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    environment.filters["figure"] = lambda value: "-" if value is None else f"{value:.3g}"
    parts = [{"scene": scene, "plot": _svg(scene, rows), "front": judge.front_of(rows, scene.name),
              "paper": judge.paper_against_others(rows, scene.name),
              "failed": [row for row in rows if row.scene == scene.name and row.message]} for scene in scenes]
    return environment.get_template("report.html.j2").render(parts=parts, about=about, names=list(judge.NAMED))


def _svg(scene: Scene, rows: list[Measured]) -> str:
    figure, axes = plt.subplots(1, 2, figsize=(12, 4.6), sharey=True, layout="constrained")
    for panel, cost in zip(axes, ("seconds", "evaluations")):
        draw(panel, scene, rows, cost)
    axes[0].set_ylabel("error")
    axes[0].legend(fontsize=8, frameon=False)
    text = io.StringIO()
    figure.savefig(text, format="svg")
    plt.close(figure)
    return text.getvalue()


def _draw_all(file: Path, scenes: list[Scene], rows: list[Measured]) -> None:
    figure, axes = plt.subplots(1, len(scenes), figsize=(4.2 * len(scenes), 4.4), layout="constrained", squeeze=False)
    for panel, scene in zip(axes[0], scenes):
        draw(panel, scene, rows, "seconds")
        panel.set_title(textwrap.fill(scene.title, 46), fontsize=9, loc="left")
    axes[0][0].set_ylabel("error")
    axes[0][0].legend(fontsize=8, frameon=False)
    figure.savefig(file, dpi=110)
    plt.close(figure)


def draw(axes: Axes, scene: Scene, rows: list[Measured], cost: str) -> None:
    """All runs as dots, the named families as curves over the number of nodes, the front as steps."""
    finished = judge.finished(rows, scene.name)
    engine = [row for row in finished if row.choice.step is None]
    axes.loglog([getattr(row, cost) for row in engine], [row.error for row in engine], ".", color="0.75", markersize=4,
                label="all choices")
    for (name, choice), colour, marker in zip(DRAWN.items(), COLOURS, MARKERS):
        curve = judge.curve(rows, scene.name, choice)
        axes.loglog([getattr(row, cost) for row in curve], [row.error for row in curve], marker=marker, markersize=4,
                    linewidth=1.1, color=colour, label=name)
    reference = [row for row in finished if row.choice.step is not None]
    if reference and cost == "seconds":
        axes.loglog([row.seconds for row in reference], [row.error for row in reference], "k+", label="reference solver")
    best = judge.front_of(rows, scene.name, cost)
    axes.step([getattr(row, cost) for row in best], [row.error for row in best], where="post", color="0.2",
              linewidth=0.8, linestyle="--", label="best of all")
    axes.axhline(scene.known, color="0.6", linewidth=0.8, linestyle=":")
    axes.set_xlabel({"seconds": "seconds of one core", "evaluations": "evaluations of forces"}[cost])
    axes.grid(alpha=0.3)
