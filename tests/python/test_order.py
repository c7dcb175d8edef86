"""Neighbours, order and clusters of packings. EXACT but for the rounding of sums, or INDEPENDENT: all pairs tried."""

from __future__ import annotations

import numpy as np
import pytest

from pliant.order import bond_order, clusters, kept_fraction, like_fraction, like_fraction_at_random, neighbours

COLUMNS, ROWS = 8, 5
PERIOD = COLUMNS * np.sqrt(3) / 2


def hexagonal() -> np.ndarray:
    """Centres of touching discs of diameter 1 in columns, periodic in x."""
    return np.array([(i * np.sqrt(3) / 2, j + 0.5 * (i % 2)) for i in range(COLUMNS) for j in range(ROWS)])


def all_pairs(centres: np.ndarray, distance: float, period: float | None) -> set[tuple[int, int]]:
    found = set()
    for a, p in enumerate(centres):
        for b, q in enumerate(centres):
            dx, dy = q - p
            if period is not None:
                dx -= period * round(dx / period)
            if a != b and np.hypot(dx, dy) < distance:
                found.add((a, b))
    return found


@pytest.mark.parametrize("period", [None, 3.0])
def test_neighbours_are_all_pairs_that_are_near(period: float | None) -> None:
    centres = np.random.default_rng(1).uniform(-4, 4, (150, 2))
    centres[:4, 0] = [0.0, 3.0, -3.0, np.nextafter(0, -1)]  # at the edges of the period
    of = neighbours(centres, 0.7, period)
    assert set(zip(of.first.tolist(), of.second.tolist(), strict=True)) == all_pairs(centres, 0.7, period)
    assert np.linalg.norm(of.branch, axis=1).max() < 0.7 + 1e-12
    assert np.array_equal(of.counts(), np.bincount(of.first, minlength=150))


def test_neighbours_in_a_sheared_cell() -> None:
    """INDEPENDENT: all images of all pairs tried, of a cell that leans by several widths."""
    vectors = np.array([[3.0, 0.2], [7.4, 2.5]])
    centres = np.random.default_rng(2).uniform(-4, 4, (60, 2))
    images = np.array([(i, j) for i in range(-20, 21) for j in range(-20, 21)]) @ vectors
    expected = {}
    for a, p in enumerate(centres):
        for b, q in enumerate(centres):
            branches = q - p + images
            near = branches[np.hypot(*branches.T) < 0.6]
            if a != b and len(near):
                expected[a, b] = near[0]
    of = neighbours(centres, 0.6, vectors)
    assert sorted(expected) == list(zip(of.first.tolist(), of.second.tolist(), strict=True))
    np.testing.assert_allclose(of.branch, [expected[pair] for pair in sorted(expected)], atol=1e-12)


def test_too_large_a_distance_is_refused() -> None:
    with pytest.raises(ValueError, match="less than half"):
        neighbours(hexagonal(), PERIOD / 2, PERIOD)


def test_hexagonal_packing_is_in_order() -> None:
    of = neighbours(hexagonal(), 1.3, PERIOD)
    assert sorted(np.unique(of.counts())) == [3, 5, 6]  # at both ends of a column, and inside
    assert bond_order(of) == pytest.approx(1)
    assert kept_fraction(of, neighbours(hexagonal() + [0.4, 0], 1.3, PERIOD)) == 1


def test_turned_packing_has_the_same_order_and_a_square_one_has_none() -> None:
    turn = np.array([[np.cos(0.3), -np.sin(0.3)], [np.sin(0.3), np.cos(0.3)]])
    turned = bond_order(neighbours(hexagonal() @ turn.T, 1.3))
    assert turned[~np.isnan(turned)] == pytest.approx(1) and np.isnan(turned).sum() == 2  # two corners
    square = np.array([(i, j) for i in range(5) for j in range(5)], dtype=float)
    inside = bond_order(neighbours(square, 1.2)).reshape(5, 5)[1:-1, 1:-1]
    assert inside == pytest.approx(0, abs=1e-14)
    assert np.isnan(bond_order(neighbours(square[:2], 1.2))).all()


def test_columns_of_one_kind_are_clusters() -> None:
    """Two neighbouring columns, one alone, across the period the first and the last."""
    column = np.repeat(np.arange(COLUMNS), ROWS)
    of = neighbours(hexagonal(), 1.3, PERIOD)
    assert clusters(of, np.isin(column, [1, 2, 4])).tolist() == [2 * ROWS, ROWS]
    assert clusters(of, np.isin(column, [0, COLUMNS - 1])).tolist() == [2 * ROWS]
    assert clusters(of, np.zeros(len(column), dtype=bool)).tolist() == []


def test_like_neighbours() -> None:
    """Kinds by columns: pairs within a column are alike, 4 of 5 rows; each grain of a column has 9 links to the next in
    all, so 4 of 13 pairs are alike."""
    column = np.repeat(np.arange(COLUMNS), ROWS)
    of = neighbours(hexagonal(), 1.3, PERIOD)
    kind = column % 2
    assert like_fraction(of, kind) == pytest.approx(4 / 13)
    mean, deviation = like_fraction_at_random(of, kind)
    assert mean == pytest.approx((20 * 19) * 2 / (40 * 39)) and 0 < deviation < 0.2
