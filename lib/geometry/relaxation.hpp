#pragma once

#include "geometry/mesh.hpp"

namespace pliant {

/// Moves the interior nodes to a smooth, isotropic distribution and fills in the triangles; the outline stays.
/// Deterministic. The node distance is the outline's at the rim and grows linearly with depth, as fast as the number of
/// nodes demands. A jump there instead (fine outline, coarse interior) gives outline nodes supports so much wider than
/// their distance that alternating motions of the rim move hardly any material: with 168 nodes, 48 on the outline, and
/// a support of 9, such modes then lie among the first ten elastic ones.
/// Method: optimal Delaunay triangulation; each node goes to the mean of its triangles' circumcentres, weighted by area
/// and density (L. Chen, J. Xu, J. Comput. Math. 22, 2004), and the nodes are triangulated anew.
void relax_interior(FieldMesh& mesh);

}  // namespace pliant
