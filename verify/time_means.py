"""Means over time, with an error that accounts for correlated samples."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.stats import t as students_t

FEWEST = 5  # blocks: with fewer, Student's factor accepts nearly every mean
CONFIDENCE = 0.999


@dataclass
class Mean:
    """Mean of blocks, each longer than the correlation time, from one or several runs."""

    blocks: np.ndarray

    def __post_init__(self) -> None:
        if len(self.blocks) < FEWEST:
            raise ValueError(f"{len(self.blocks)} blocks tell nothing of an error; take {FEWEST} or more")

    @property
    def value(self) -> float:
        return float(self.blocks.mean())

    @property
    def error(self) -> float:
        """Half of the confidence interval of the true mean."""
        count = len(self.blocks)
        factor = students_t.ppf((1 + CONFIDENCE) / 2, count - 1)
        return float(factor * self.blocks.std(ddof=1) / np.sqrt(count))

    def __str__(self) -> str:
        return f"{100 * CONFIDENCE:g} % by {len(self.blocks)} block means"


def block_means(values: np.ndarray, length: int) -> np.ndarray:
    """Means of consecutive blocks of that many samples; remaining samples at the end are not used."""
    count = len(values) // length
    return values[: count * length].reshape(count, length).mean(axis=1)


def correlation_time(values: np.ndarray) -> float:
    """In samples: the integral of the autocorrelation up to its first zero. Means of blocks several times as long are
    nearly independent."""
    rest = values - values.mean()
    correlation = np.correlate(rest, rest, "full")[len(rest) - 1 :] / (rest @ rest)
    last = int(np.argmax(correlation <= 0)) or len(correlation)
    return float(0.5 + correlation[1:last].sum())
