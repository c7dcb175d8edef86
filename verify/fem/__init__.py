"""Finite elements (dolfinx 0.5.2) as an independent solver.

They share nothing with engine or reference solver, and contain no expected numbers. Plane strain, per unit thickness.
`meshes` of triangles with curved edges, `solid` the material and its forms, `statics` Newton's method on a potential,
`dynamics` explicit steps, `eigen` natural frequencies, `plates` the disc between two rigid plates,
`free_disc` its large oscillation. `compiled` keeps compiled forms in results/verify/.fenics. One thread: several
cases may run at once.
"""

import os

os.environ["OMP_NUM_THREADS"] = "1"
os.environ["OPENBLAS_NUM_THREADS"] = "1"
