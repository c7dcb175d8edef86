"""Orders of convergence, and means over replicas. All EXACT."""

from __future__ import annotations

import pytest

from pliant.study.convergence import analyse, observed_order
from pliant.study.table import means_of_replicas


@pytest.mark.parametrize("order", [0.5, 1, 2, 3.7])
def test_order_of_a_power(order: float) -> None:
    """EXACT: f = 3 + 2 h^p, whatever the ratios of sizes."""
    h = (0.1, 0.13, 0.3)
    found = observed_order(h, tuple(3 + 2 * size**order for size in h))
    assert found == pytest.approx(order, abs=1e-9)
    sizes = [0.4, 0.1, 0.13, 0.3]
    result = analyse(sizes, [3 + 2 * size**order for size in sizes])
    assert result.limit == pytest.approx(3, abs=1e-9) and result.asymptotic
    assert result.index == pytest.approx(1.25 * 2 * 0.1**order, rel=1e-6)


def test_means_over_replicas() -> None:
    """EXACT: a failed replica counts in nothing, one that lacks a quantity in the others."""
    def row(size: int, seed: int, **outputs: float) -> dict:
        return {"inputs": {"size": size, "seed": seed},
                "outputs": {name: {"value": value, "error": None, "unit": "N"} for name, value in outputs.items()}}

    rows = [row(1, 1, f=1.0, g=4.0), row(1, 2, f=3.0), row(1, 3), row(2, 1, f=5.0)]
    first, second = means_of_replicas(rows, ["f", "g"], ["size"])
    assert first["inputs"] == {"size": 1} and second["inputs"] == {"size": 2}
    assert (first["outputs"]["f"]["value"], first["outputs"]["f"]["error"], first["outputs"]["f"]["count"]) == (2, 1, 2)
    assert (first["outputs"]["g"]["value"], first["outputs"]["g"]["error"], first["outputs"]["g"]["count"]) == (4, None, 1)
    assert second["outputs"]["f"]["value"] == 5 and "g" not in second["outputs"]


def test_no_order_is_said() -> None:
    scattered = analyse([1, 2, 4], [-1, -2, -1])
    assert scattered.order is None and scattered.words().endswith("in order; the three finest differ by 50 %")
    mixed = analyse([1, 2, 4, 8], [1 + 0.01 * h + 0.1 * h**4 for h in (1, 2, 4, 8)])
    assert mixed.asymptotic, "one order rules"
    apart = analyse([1, 2, 4, 8], [1 + h + 0.02 * h**4 for h in (1, 2, 4, 8)])
    assert apart.asymptotic is False
    assert apart.words().startswith("not in the asymptotic range") and "the three finest alone: order" in apart.words()
    equal = analyse([1, 2, 4], [3, 3, 3])
    assert equal.order is None and "equal" in equal.note
    assert "equal" in analyse([1, 2, 4], [0, 0, 0]).note
    assert analyse([1, 2, 4], [3, float("nan"), 3]).order is None
    assert analyse([0, 2, 4], [3, 4, 5]).order is None
