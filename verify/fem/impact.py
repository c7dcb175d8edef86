"""A disc hits a rigid frictionless wall with a penalty."""

from __future__ import annotations

import numpy as np
from dolfinx.fem import Constant, assemble_scalar

from fem.compiled import compile_form
from fem.dynamics import Explicit
from fem.meshes import disc
from fem.solid import Material, Solid


def velocities(rings: int, penalty: float, speed: float, start: float, period: float, samples: int) -> np.ndarray:
    """[samples + 1] velocity of the centre of mass, which starts at this height over the wall; quadratic triangles,
    with half of the stable step for contact of all nodes."""
    solid = Solid(disc(rings), Material())
    height, stiffness = Constant(solid.domain, 10.0), Constant(solid.domain, penalty)
    motion = Explicit(solid, solid.strain_energy() + solid.plate_energy(height, stiffness, -1))
    steps = int(np.ceil(period * motion.largest_frequency()))
    height.value = -start
    motion.v.interpolate(lambda x: np.stack([0 * x[0], 0 * x[0] - speed]))
    motion.start()
    momentum = compile_form(motion.v[1] * solid.dx)
    values = [assemble_scalar(momentum)]
    for _ in range(samples):
        for _ in range(steps):
            motion.step(period / steps)
        values.append(assemble_scalar(momentum))
    return -speed * np.array(values) / values[0]
