#include "contact/own_arcs.hpp"

#include <algorithm>

#include "core/parallel.hpp"
#include "discretisation/inner_paths.hpp"

namespace pliant {
namespace {

constexpr double least_steepness = 0.25, depths = 6;

/// Sight through a body's material in its reference shape, in mean segments.
class Inside {
 public:
  explicit Inside(const OutlineShape& shape) : points_(shape.points), paths_(scaled(points_, shape.spacing)) {
    for (std::size_t k = 0; k < points_.size(); ++k) middle_.push_back(0.5 * (points_[k] + points_[next(k)]));
    if (paths_.convex()) return;
    for (const Vec2& x : points_) of_node_.push_back(paths_.triangle_at(x));
    for (const Vec2& x : middle_) of_middle_.push_back(paths_.triangle_at(x));
  }

  /// Whether a node sees a segment's middle from inside, at most so far off and steeply.
  bool sees(int node, int segment, double reach) const {
    const Vec2 sight = middle_[segment] - points_[node];
    const double distance = sight.norm();
    if (distance > reach) return false;
    const Vec2 along = (points_[next(segment)] - points_[segment]).normalized();
    if (cross(sight, along) < least_steepness * distance) return false;
    if (paths_.convex()) return true;
    const Vec2 way = paths_.way(points_[node], of_node_[node], middle_[segment], of_middle_[segment]);
    constexpr double rounding = 1e-9;
    return way.norm() <= (1 + rounding) * distance;
  }

 private:
  std::size_t next(std::size_t k) const { return (k + 1) % points_.size(); }
  static Points& scaled(Points& points, double unit) {
    for (Vec2& x : points) x /= unit;
    return points;
  }

  Points points_;
  InnerPaths paths_;
  Points middle_;                         ///< [segments]
  std::vector<int> of_node_, of_middle_;  ///< triangles of paths_; empty: convex
};

/// Runs of segments within `all` that none of the nodes sees.
std::vector<Arc> arcs_beyond(const Inside& inside, const Arc& nodes, const Arc& all, int count, double reach) {
  std::vector<Arc> arcs;
  bool open = false;
  for (int segment = all.begin; segment < all.end(); ++segment) {
    bool seen = false;
    for (int node = nodes.begin; node < nodes.end(); ++node) seen |= inside.sees(node, segment % count, reach);
    if (!seen && !open) arcs.push_back({segment, 0});
    if (!seen) ++arcs.back().count;
    open = !seen;
  }
  return arcs;
}

}  // namespace

OwnArcs::OwnArcs(const Model& model, double skin) {
  if (!model.scene.contact.self_contact) return;
  arcs_.resize(model.outlines.size());
  std::vector<char> wanted(model.outlines.size());
  for (const Body& body : model.bodies) wanted[body.outline] |= body.kind == BodyKind::compliant;
  parallel_for_uneven(static_cast<int>(model.outlines.size()), 1, [&](int o) {
    if (!wanted[o]) return;
    const OutlineShape& shape = model.outlines[o];
    const Inside inside(shape);
    const double reach = depths * (shape.longest + skin) / shape.spacing;
    for (int begin = 0; begin < shape.count; begin += together) {
      const Arc nodes{begin, std::min(together, shape.count - begin)};
      const Arc all{nodes.end() + unseen, shape.count - nodes.count - 1 - 2 * unseen};
      arcs_[o].push_back(arcs_beyond(inside, nodes, all, shape.count, reach));
    }
  });
}

}  // namespace pliant
