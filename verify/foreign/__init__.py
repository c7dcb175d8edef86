"""Bodies in contact at large strains by solvers from elsewhere: an independent opinion without expected numbers.

`meshes` of triangles with curved sides in plain numpy, `getfem_bodies` for GetFEM, `calculix_deck` for CalculiX.
`./pliant verify --full` alone installs their packages. One thread.
"""
