#pragma once

#include "geometry/mesh.hpp"

namespace pliant {

/// Moves the interior nodes to a smooth, isotropic distribution and sets the triangles; the outline stays.
/// Deterministic. The node distance is that of the outline at the rim and grows linearly with depth, as fast as the
/// number of nodes demands. A jump there instead (fine outline, coarse interior) gives outline nodes supports that are
/// much wider than their distance, and alternating motions of the rim then move hardly any material. With 168 nodes, 48
/// on the outline, and a support of 9, such modes are among the first ten elastic ones. Method: optimal Delaunay
/// triangulation; each node moves to the mean of its triangles' circumcentres, weighted by area and density (L. Chen,
/// J. Xu, J. Comput. Math. 22, 2004), and the nodes are triangulated again.
void relax_interior(FieldMesh& mesh);

}  // namespace pliant
