#pragma once

#include "discretisation/basis.hpp"

namespace pliant {

/// Row-sum lumped mass at density 1, [nodes]: integrals of the shape functions, with 6 Gauss points per triangle
/// whatever the integration points of the discretisation (docs/method.md 2). Throws InputError if one is not positive.
std::vector<double> lumped_mass(const FieldMesh& mesh, const Basis& basis);

/// Scaled mass M = D + L, rows of [nodes x nodes], sparse.
struct ScaledMass {
  ShapeRows reciprocal;  ///< C = M^-1 D
  ShapeRows relative;    ///< C^-1 = D^-1 M
};

/// Selective mass scaling (docs/method.md 2). L couples each outline node of mass m by (scaling - 1) m to the nearest
/// inner node across an edge of the mesh, if there is one. C has no negative entries, keeps translations and the
/// momentum, and its eigenvalues lie in (0, 1].
ScaledMass scaled_mass(const FieldMesh& mesh, const std::vector<double>& lumped, double scaling);

/// Rows of C = 2 I - D^-1 M, [nodes x nodes], sparse: M the consistent mass (6 Gauss points per triangle: exact for
/// linear triangles), D the lumped one. W = C D^-1 is the inverse mass of docs/method.md 2, exact to first order in
/// M - D.
ShapeRows corrected_reciprocal_mass(const FieldMesh& mesh, const Basis& basis, const std::vector<double>& lumped);

/// Bound on the largest eigenvalue of C, 2 - min eig(D^-1 M): computed for up to 1000 nodes, else 2, as M is positive
/// semidefinite.
double reciprocal_mass_bound(const ShapeRows& reciprocal_mass, const std::vector<double>& lumped);

/// Rotational inertia about the centroid over that of the polygon, which the consistent mass has. It follows from the
/// kinetic energy y.D C y / 2 of the y that moves nodes in a rotation (docs/method.md 2). `reciprocal_mass`: rows of C;
/// empty: C = I.
double inertia_ratio(const FieldMesh& mesh, const std::vector<double>& lumped, const ShapeRows& reciprocal_mass);

/// Kinetic energy of a uniform stretch that keeps areas, over that with C = I: the larger one of two directions.
double stretching_ratio(const FieldMesh& mesh, const std::vector<double>& lumped, const ShapeRows& reciprocal_mass);

}  // namespace pliant
