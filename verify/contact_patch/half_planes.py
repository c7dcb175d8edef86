"""Nodal pressures between two half-planes whose nodes do not match, pressed together by the mean pressure 1.

Contact has two passes. Half-planes deform under each wave of nodal pressures as under a sine.
"""

from __future__ import annotations

import numpy as np


def compliance(nodes: int, spacing: float, modulus: float) -> np.ndarray:
    """[nodes x nodes] displacement by nodal forces, periodic: 2 / (E' k) times the traction for the wave number k, zero
    for the mean."""
    k = 2 * np.pi * np.fft.fftfreq(nodes, spacing)
    by_wave = np.divide(2 / modulus, np.abs(k), out=np.zeros(nodes), where=k != 0) / spacing
    first = np.fft.ifft(by_wave).real
    return np.array([np.roll(first, i) for i in range(nodes)]).T


def on_segments(places: np.ndarray, nodes: int) -> np.ndarray:
    """[places x nodes] shares of the two nodes of the segment at each place, in units of a spacing, periodic."""
    start = np.floor(places + 1e-9).astype(int)
    shares = np.zeros((len(places), nodes))
    rows = np.arange(len(places))
    np.add.at(shares, (rows, start % nodes), 1 - (places - start))
    np.add.at(shares, (rows, (start + 1) % nodes), places - start)
    return shares


def pressures(fine: int, coarse: int, stiffness: float, modulus: float) -> np.ndarray:
    """[fine] pressures on the nodes of the finer face. A period has `fine` of its spacings, 1 each, and `coarse` of the
    other's.

    Each pass has half of the stiffness. The force on a node is its tributary length times stiffness and depth; it is
    distributed to the nodes of the opposite segment. modulus: E' = E / (1 - nu^2).
    """
    ratio = fine / coarse
    # Gaps: depth of each node less the displacement of the opposite face there.
    of_fine = np.hstack([np.eye(fine), on_segments(np.arange(fine) / ratio, coarse)])
    of_coarse = np.hstack([on_segments(ratio * np.arange(coarse), fine), np.eye(coarse)])
    # Forces by the inward displacements of all nodes.
    work = 0.5 * stiffness * (of_fine.T @ of_fine + ratio * of_coarse.T @ of_coarse)
    gives = np.zeros_like(work)
    gives[:fine, :fine] = compliance(fine, 1, modulus)
    gives[fine:, fine:] = compliance(coarse, ratio, modulus)
    # The approach of 1 is reduced by the displacements of both faces under the forces.
    together = np.concatenate([np.full(fine, 0.5), np.full(coarse, 0.5)])
    ways = np.linalg.solve(np.eye(fine + coarse) + gives @ work, together)
    forces = (work @ ways)[:fine]
    return forces / forces.mean()
