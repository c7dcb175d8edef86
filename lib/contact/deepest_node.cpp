#include "contact/deepest_node.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include <fmt/format.h>

#include "contact/half_pass.hpp"
#include "contact/node_strips.hpp"
#include "core/errors.hpp"
#include "core/parallel.hpp"

namespace pliant {
namespace {

/// Position of a point relative to the nearest segment of an outline.
struct Nearest {
  double distance = 1e300, depth = 0, length = 1;
  int number = 0;
};

/// Vector from a segment's first node, by the nearest image in a period.
Vec2 lever(const Vec2& point, const Vec2& node, double period) {
  Vec2 r = point - node;
  if (period > 0) r.x() -= period * std::round(r.x() / period);
  return r;
}

/// A body's outline, prepared for queries of its distance.
class OutlineView {
 public:
  OutlineView(const Model& model, const OutlineField& outlines, int body)
      : shape_(model.outline_of(body)),
        x_(&outlines.x[model.outline_offset[body]]),
        y_(&outlines.y[model.outline_offset[body]]),
        box_(bounding_box(model, outlines, body)) {}

  int count() const { return shape_.count; }
  /// Node k in [0, count()]: after the last node comes the copy of the first.
  Vec2 node(int k) const { return {x_[k], y_[k]}; }
  const OutlineShape& shape() const { return shape_; }
  const Box& box() const { return box_; }
  /// Sorts the nodes into strips, for an outline with many queries. Lengths are current.
  void sort_nodes() {
    double square = 0;
    for (int s = 0; s < count(); ++s) square = std::max(square, (node(s + 1) - node(s)).squaredNorm());
    strips_ = std::make_shared<NodeStrips>(x_, count(), std::sqrt(square), std::abs(shape_.turn_shift));
  }

  /// `period`: of the nearest image; 0: of the outline as it is.
  Nearest nearest_segment(const Vec2& point, double period = 0) const {
    Nearest nearest;
    const auto measure = [&](int s) {
      const Vec2 along_segment = node(s + 1) - node(s);
      const double length = along_segment.norm();
      const Vec2 r = lever(point, node(s), period), tangent = along_segment / length;
      const double along = std::clamp(r.dot(tangent), 0.0, length), distance = (r - along * tangent).norm();
      const double depth = r.y() * tangent.x() - r.x() * tangent.y();
      // At a corner two segments are equally near; the one seen more steeply tells inside from outside.
      const bool same = std::abs(distance - nearest.distance) <= 1e-9 * length;
      if (same ? std::abs(depth) > std::abs(nearest.depth) : distance < nearest.distance)
        nearest = {distance, depth, length, s};
    };
    if (strips_ && fits(period))
      strips_->from(point.x(), measure, [&] { return nearest.distance; });
    else
      for (int s = 0; s < count(); ++s) measure(s);
    return nearest;
  }

  /// Calls visit(node) for all nodes that may lie in [x_min, x_max], and maybe others.
  template <class Visit>
  void for_each_between(double x_min, double x_max, double period, Visit&& visit) const {
    if (strips_ && fits(period))
      strips_->between(x_min, x_max, visit);
    else
      for (int k = 0; k < count(); ++k) visit(k);
  }

  /// Whether a point is certainly outside: outside the bounding box or, for a wall, beyond its whole surface.
  bool is_clear_of(const Vec2& point, double period) const {
    if (shape_.turn_shift != 0) return shape_.turn_shift < 0 ? point.y() > box_.y_max : point.y() < box_.y_min;
    const Vec2 middle(0.5 * (box_.x_min + box_.x_max), 0.5 * (box_.y_min + box_.y_max));
    const Vec2 from_middle = lever(point, middle, period);
    return std::abs(from_middle.x()) > 0.5 * (box_.x_max - box_.x_min) ||
           std::abs(from_middle.y()) > 0.5 * (box_.y_max - box_.y_min);
  }

 private:
  bool fits(double period) const { return (period > 0) == (shape_.turn_shift != 0); }

  const OutlineShape& shape_;
  const double *x_, *y_;
  Box box_;
  std::shared_ptr<const NodeStrips> strips_;  ///< shared by copies; null: not sorted
};

/// All outlines at one time; long ones are sorted once.
class OutlineViews {
 public:
  OutlineViews(const Model& model, const OutlineField& outlines) : model_(model), outlines_(outlines) {
    constexpr int long_outline = 256;
    for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
      if (model.outline_of(b).count > long_outline)
        sorted_.emplace(b, OutlineView(model, outlines, b)).first->second.sort_nodes();
  }
  OutlineView operator[](int body) const {
    const auto known = sorted_.find(body);
    return known == sorted_.end() ? OutlineView(model_, outlines_, body) : known->second;
  }

 private:
  const Model& model_;
  const OutlineField& outlines_;
  std::map<int, OutlineView> sorted_;
};

/// Slave and master of a query. The master is shifted by `shift` or, if one of them is a wall, taken at its nearest
/// image in a period.
struct Sight {
  int slave, master;
  Vec2 shift{0, 0};
  double period = 0;
  Sight back() const { return {master, slave, -shift, period}; }
};

Sight sight_of(const Model& model, const Lattice& lattice, const BodyPair& pair) {
  if (model.bodies[pair.first].wall || model.bodies[pair.second].wall)
    return {pair.first, pair.second, {0, 0}, model.scene.period.value_or(0)};
  return {pair.first, pair.second, lattice.shift(pair.images)};
}

bool is_deeper(const DeepestNode& a, const DeepestNode& b) {
  return a.depth * b.segment_length > b.depth * a.segment_length;
}

void find_deepest(const OutlineViews& views, const Sight& sight, DeepestNode& deepest) {
  const OutlineView slave = views[sight.slave], master = views[sight.master];
  const Box& box = master.box();
  slave.for_each_between(box.x_min + sight.shift.x(), box.x_max + sight.shift.x(), sight.period, [&](int node) {
    const Vec2 position = slave.node(node), seen = position - sight.shift;
    if (master.is_clear_of(seen, sight.period)) return;
    const Nearest nearest = master.nearest_segment(seen, sight.period);
    const double reference = master.shape().segment_length[nearest.number];
    const DeepestNode found{
        sight.slave, sight.master, node, position, nearest.depth, nearest.length, nearest.length / reference};
    if (is_deeper(found, deepest)) deepest = found;
  });
}

/// Deepest node of a contact pair of a body with itself, by the projection of contact.
void find_self_penetration(const PairView& view, DeepestNode& deepest) {
  const int body = view.contact_pair.first;
  const OutlineShape& shape = view.model.outline_of(body);
  for_each_projection(view, 0, [&](const HalfPass& pass, int, int i, const Projection& p) {
    for (int lane = 0; lane < std::min(lane_count, pass.nodes.count - i); ++lane) {
      if (!p.hit[lane] || !(p.gap[lane] < 0)) continue;
      const int index = pass.nodes.begin + i + lane, node = index - turn_of(index, shape.count) * shape.count;
      const double length = p.length[lane], reference = shape.segment_length[static_cast<int>(p.number[lane])];
      const Vec2 position = view.outlines.position.at(view.model.outline_offset[body] + node);
      const DeepestNode found{body, body, node, position, -p.gap[lane], length, length / reference, true};
      if (is_deeper(found, deepest)) deepest = found;
    }
  });
}

/// Whether two bodies are at nearly the same place. Their nodes are not deep then, but their centres are.
bool share_a_middle(const Model& model, const Lattice& lattice, const OutlineViews& views, const BodyPair& pair) {
  if (model.bodies[pair.first].wall || model.bodies[pair.second].wall) return false;
  const OutlineView first = views[pair.first], second = views[pair.second];
  Vec2 sum(0, 0);
  for (int node = 0; node < first.count(); ++node) sum += first.node(node);
  const Vec2 middle = sum / first.count(), seen = middle - sight_of(model, lattice, pair).shift;
  const Nearest own = first.nearest_segment(middle), other = second.nearest_segment(seen);
  return own.depth > own.length && other.depth > other.length;
}

/// Pairs whose boxes overlap, and walls with every body that is not wholly on their open side: all that is behind a
/// wall's surface is inside the wall.
std::vector<BodyPair> pairs_that_may_overlap(const Model& model, const OutlineField& outlines) {
  const int bodies = static_cast<int>(model.bodies.size());
  std::vector<Box> boxes(model.bodies.size());
  parallel_for(bodies, [&](int b) { boxes[b] = bounding_box(model, outlines, b); });
  std::vector<BodyPair> pairs;
  for (const BodyPair& p : broad_phase(model, boxes, 0, outlines.lattice))
    if (!model.bodies[p.first].wall && !model.bodies[p.second].wall) pairs.push_back(p);
  for (int wall = 0; wall < bodies; ++wall) {
    if (!model.bodies[wall].wall) continue;
    const bool above = model.outline_of(wall).turn_shift < 0;  // the open side
    for (int body = 0; body < bodies; ++body) {
      const bool clear = above ? boxes[body].y_min > boxes[wall].y_max : boxes[body].y_max < boxes[wall].y_min;
      if (!clear && (!model.bodies[body].wall || body < wall)) pairs.push_back({body, wall, {}});
    }
  }
  return pairs;
}

}  // namespace

DeepestNode deepest_node(const Model& model, const OutlineField& outlines, const std::vector<BodyPair>& pairs) {
  const OutlineViews views(model, outlines);
  constexpr std::size_t block = 64;
  std::vector<DeepestNode> of_block((pairs.size() + block - 1) / block);
  parallel_for_uneven(static_cast<int>(of_block.size()), 1, [&](int b) {
    const std::size_t begin = block * static_cast<std::size_t>(b);
    for (std::size_t p = begin; p < std::min(begin + block, pairs.size()); ++p) {
      const Sight sight = sight_of(model, outlines.lattice, pairs[p]);
      find_deepest(views, sight, of_block[b]);
      find_deepest(views, sight.back(), of_block[b]);
    }
  });
  DeepestNode deepest;
  for (const DeepestNode& found : of_block)
    if (is_deeper(found, deepest)) deepest = found;
  return deepest;
}

DeepestNode deepest_contact(const Model& model, const Outlines& outlines, const ContactSystem& contact) {
  std::vector<BodyPair> pairs;
  DeepestNode of_itself;
  for (const ContactPair& contact_pair : contact.contact_pairs())
    if (contact_pair.of_itself())
      find_self_penetration({model, outlines, contact_pair, contact.skin(), thread_scratch()}, of_itself);
    else
      pairs.push_back(contact_pair.pair());
  const DeepestNode of_two = deepest_node(model, outlines.position, pairs);
  return is_deeper(of_itself, of_two) ? of_itself : of_two;
}

void refuse_deep_overlap(const Model& model, const OutlineField& outlines) {
  const auto refuse = [&](int a, int b, const std::string& how) {
    const std::string other = a == b ? "its own periodic image" : fmt::format("'{}'", model.bodies[b].name);
    throw InputError(fmt::format("'{}' and {} overlap at the start {}; move them apart or make them smaller",
                                 model.bodies[a].name, other, how));
  };
  const std::vector<BodyPair> pairs = pairs_that_may_overlap(model, outlines);
  std::vector<char> alike(pairs.size());
  const OutlineViews views(model, outlines);
  parallel_for(static_cast<int>(pairs.size()),
               [&](int p) { alike[p] = share_a_middle(model, outlines.lattice, views, pairs[p]); });
  if (const auto found = std::ranges::find(alike, 1); found != alike.end()) {
    const BodyPair& pair = pairs[found - alike.begin()];
    refuse(pair.first, pair.second, "nearly wholly");
  }
  const DeepestNode deepest = deepest_node(model, outlines, pairs);
  if (deepest.depth > deepest.segment_length)
    refuse(deepest.slave, deepest.master,
           fmt::format("by {:.3g} m, {:.2f} segment lengths of the outline; at most 1 is allowed, deeper contacts "
                       "cannot be seen",
                       deepest.depth, deepest.depth / deepest.segment_length));
}

}  // namespace pliant
