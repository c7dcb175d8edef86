#pragma once

#include "geometry/mesh.hpp"

namespace pliant {

/// Moves the interior nodes to an even, isotropic distribution and fills in the triangles; the outline stays.
/// Deterministic. Optimal Delaunay triangulation: each node goes to the mean of its triangles' circumcentres, weighted
/// by their areas (L. Chen, J. Xu, J. Comput. Math. 22, 2004), and the nodes are triangulated anew.
void relax_interior(FieldMesh& mesh);

}  // namespace pliant
