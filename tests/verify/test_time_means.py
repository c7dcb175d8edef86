"""The error of a mean over time is that of a motion that remembers itself."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import lfilter

from time_means import Mean, block_means, correlation_time

MEMORY = 0.9  # of a sample in the next one
CORRELATION = 0.5 * (1 + MEMORY) / (1 - MEMORY)  # samples, in closed form
TRIALS = 1000


def remembering(seed: int, count: int) -> np.ndarray:
    """Of mean 0, each sample MEMORY times the one before plus a number of its own."""
    return lfilter([1], [1, -MEMORY], np.random.default_rng(seed).normal(size=count + 200))[200:]


def test_blocks() -> None:
    """EXACT."""
    assert block_means(np.arange(11.0), 3).tolist() == [1, 4, 7]
    assert Mean(np.full(6, 2.5)).value == 2.5
    with pytest.raises(ValueError, match="4 blocks"):
        Mean(np.arange(4.0))


def test_the_correlation_time_is_that_of_the_process() -> None:
    """INDEPENDENT: its closed form; three standard errors of a sum of some 50 correlations over 10,000 samples."""
    assert abs(correlation_time(remembering(1, 10_000)) - CORRELATION) < 3 * CORRELATION * np.sqrt(2 * 50 / 10_000)


@pytest.mark.parametrize("blocks", [7, 20])
def test_errors_hold_as_often_as_they_say(blocks: int) -> None:
    """INDEPENDENT: blocks of six correlation times still know of each other. The variance of their mean is 1/(1 - 1/6) of
    that of others, so that 99.73 % hold instead of 99.9; three standard deviations of the trials."""
    length = round(6 * CORRELATION)
    means = [Mean(block_means(remembering(seed, blocks * length), length)) for seed in range(TRIALS)]
    held = np.mean([abs(mean.value) <= mean.error for mean in means])
    assert abs(held - 0.9973) <= 3 * np.sqrt(0.9973 * 0.0027 / TRIALS)


def test_samples_are_not_independent() -> None:
    """INDEPENDENT: three standard errors of samples as if independent are 3/sqrt(2 * 9.5) of a true one, and hold half of
    the time; three standard deviations of the trials."""
    series = [remembering(seed, 500) for seed in range(TRIALS)]
    held = np.mean([abs(samples.mean()) <= 3 * samples.std() / np.sqrt(500) for samples in series])
    assert abs(held - 0.509) <= 3 * np.sqrt(0.25 / TRIALS)
