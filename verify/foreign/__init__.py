"""Bodies in contact at large strains in third-party solvers: independent solutions without expected numbers.

`meshes` of triangles with curved sides in plain numpy, `getfem_bodies` for GetFEM, `calculix_deck` for CalculiX.
Only `./pliant verify --full` installs their packages. One thread.
"""
