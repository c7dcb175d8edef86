"""Statistics of the contacts of one frame: how forces are spread, and which way contacts point."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from pliant import units
from pliant.network import Network, of_frame
from pliant.results import Run
from plots.curves import COLOURS

BINS, SECTORS = 24, 36
FEWEST = 50  # contacts that a distribution needs


def network(run: Run, indices: list[int]) -> Figure | None:
    """At the last of the times: density of forces by their mean, with the exponential of the same mean; roses of
    normals, each contact once and by its force."""
    index = indices[-1]
    if run.frames.contacts(index) is None:
        return None
    found = of_frame(run.frames, index)
    if len(found.magnitude) < FEWEST or found.magnitude.mean() == 0:
        return None
    figure = plt.figure(figsize=(11, 4.8), layout="constrained")
    figure.suptitle(f"{run.title}: {len(found.magnitude)} contacts at t = {units.readable(run.frames.times[index], 's')}")
    _draw_density(figure, found)
    _draw_rose(figure, found)
    return figure


def _draw_density(figure: Figure, found: Network) -> None:
    axes = figure.add_subplot(1, 2, 1)
    mean = found.magnitude.mean()
    share = found.magnitude / mean
    density, edges = np.histogram(share, BINS, (0, share.max()), density=True)
    axes.step(edges, np.append(density, density[-1]), where="post", color=COLOURS[0],
              label=f"force; {100 * found.strong_share():.0f} % above the mean")
    axes.plot(edges, np.exp(-edges), "--", color=COLOURS[1], label="exponential; 37 %")
    axes.set_yscale("log")
    axes.set_ylim(0.3 * density[density > 0].min(), 3 * max(1.0, density.max()))
    axes.set_xlabel(f"force over its mean, {units.readable(mean, 'N/m')}")
    axes.set_ylabel("probability density")
    axes.legend(frameon=False)


def _draw_rose(figure: Figure, found: Network) -> None:
    """Normals have no sense: each counts both ways. Radius: density, 1 where there is no preferred direction."""
    axes = figure.add_subplot(1, 2, 2, projection="polar")
    angles = np.arctan2(found.normals[:, 1], found.normals[:, 0])
    both = np.concatenate([angles, angles + np.pi]) % (2 * np.pi)
    edges = np.linspace(0, 2 * np.pi, SECTORS + 1)
    for weights, name, colour in ((np.ones(len(angles)), "contacts", COLOURS[0]),
                                  (found.magnitude, "weighted by force", COLOURS[1])):
        counts, _ = np.histogram(both, edges, weights=np.tile(weights, 2))
        radius = counts / counts.mean()
        axes.plot(np.append(edges[:-1], edges[-1]) + np.pi / SECTORS, np.append(radius, radius[0]), color=colour,
                  label=name)
    axes.set_rlabel_position(180 / SECTORS)
    axes.yaxis.set_major_locator(MaxNLocator(3))
    axes.legend(loc="lower left", bbox_to_anchor=(0.95, 0.9), frameon=False)
    axes.set_title("directions of the lines of centres", fontsize=10)
