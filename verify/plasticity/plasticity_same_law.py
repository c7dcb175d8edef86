"""GetFEM's expressions of the law at one point, against the table of paths: made by other formulas, in scipy."""

from __future__ import annotations

import numpy as np

from plasticity_getfem import COMPONENTS, IN_PLANE, KEPT, LIMIT, NEW_METRIC, PLANE, Q, VOLUME, Body, quadrilaterals
from plasticity_law import LAW, paths

SAME = 1e-13
PIOLA = f"Reshape((bulk*{VOLUME}*Id(2)+2*mu*{IN_PLANE}:{KEPT})*Inv({PLANE})',4)"


def largest_difference() -> float:
    """Of P, of the metric and of the yield condition's residual, with a of the table."""
    square = np.stack(np.meshgrid([0.0, 0.5, 1.0], [0.0, 0.5, 1.0]), axis=2)
    table, worst = paths(), 0.0
    for path in np.unique(table[:, 0]):
        body = Body(LAW, quadrilaterals([square]))
        model, places, a = body.model, body.field.basic_dof_nodes()[:, ::2], 0.0
        for row in table[table[:, 0] == path]:
            body.model.set_variable("u", ((row[2:6].reshape(2, 2) - np.eye(2)) @ places).T.ravel())
            model.set_variable("da", 0 * model.variable("da") + row[14] - a)
            piola = model.interpolation(PIOLA, body.metrics).reshape(-1, 2, 2).transpose(0, 2, 1).reshape(-1, 4)
            metric = model.interpolation(f"{COMPONENTS}:{NEW_METRIC}", body.metrics).reshape(-1, 4)[:, [0, 3, 1]]
            residual = model.interpolation(f"3*mu*da-pos_part({Q}-{LIMIT})", body.scalars)
            worst = max(worst, np.abs(piola - row[6:10]).max(), np.abs(metric - row[11:14]).max(),
                        np.abs(residual).max())
            body.accept(model.variable("u"), 1.0)
            a = row[14]
    return worst


def check() -> None:
    worst = largest_difference()
    if worst > SAME:
        raise ArithmeticError(f"GetFEM's law differs from the table of paths by {worst}")
    print(f"GetFEM's law differs from the table of paths by {worst:.1e} at most", flush=True)
