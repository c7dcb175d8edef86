#pragma once

#include <memory>

#include "core/errors.hpp"
#include "core/vec2.hpp"
#include "discretisation/basis.hpp"
#include "discretisation/inner_paths.hpp"
#include "discretisation/node_grid.hpp"

namespace pliant {

/// Error for a mesh whose nodes are too far apart for their supports. Callers that know the mesh add advice to the
/// message.
struct TooFewNeighbours : InputError {
  using InputError::InputError;
};

/// Nodes with the radii of their supports: the data that moving least squares need of a mesh.
struct MlsNodes {
  Points position;                                 ///< [nodes]
  std::vector<double> radius;                      ///< [nodes]
  double reach = 0;                                ///< largest radius, if there is a grid
  std::shared_ptr<const NodeGrid> grid = nullptr;  ///< finds the nodes near a point; null: all nodes are tested
  /// Paths inside a concave body, along which distances are measured. Null: distances are straight.
  std::shared_ptr<const InnerPaths> paths = nullptr;
  std::vector<int> triangle = {};  ///< [nodes] in `paths`

  /// Numbers of nodes, ascending, among them all whose support contains x.
  std::vector<int> near(const Vec2& x) const;
};

/// Vectors from one point to nodes at most `reach` away: with the length of the path through the body, in the direction
/// in which it begins.
class WaysToNodes {
 public:
  /// `nodes` must outlive it.
  WaysToNodes(const MlsNodes& nodes, const Vec2& x, double reach)
      : nodes_(nodes), x_(x), bends_(nodes.paths && nodes.paths->room(x, reach) < reach) {
    if (bends_) triangle_ = nodes.paths->triangle_at(x);
  }

  Vec2 operator()(int i) const {
    if (!bends_) return nodes_.position[i] - x_;
    return nodes_.paths->way(x_, triangle_, nodes_.position[i], nodes_.triangle[i]);
  }

 private:
  const MlsNodes& nodes_;
  Vec2 x_;
  bool bends_;
  int triangle_ = 0;
};

/// Nodes whose radius is the distance to the support-th nearest other node, through the body (docs/method.md 2). Throws
/// InputError if there are not that many nodes. The mesh is in lengths of about one node distance.
MlsNodes make_mls_nodes(const FieldMesh& mesh, int support);

/// The same for nodes in a convex body.
MlsNodes make_mls_nodes(const Points& nodes, int support);

/// Moving least squares at x: linear basis centred at x, cubic spline weight; the gradients are the full derivatives.
/// Lengths should be of the order of one node distance for good conditioning. Throws TooFewNeighbours if x does not
/// have three neighbours that are not collinear.
ShapeFunctions evaluate_mls(const MlsNodes& nodes, const Vec2& x);

/// evaluate_mls as the basis of a mesh.
Basis moving_least_squares(const MlsNodes& nodes);

}  // namespace pliant
