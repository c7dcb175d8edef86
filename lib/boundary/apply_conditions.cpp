#include "boundary/apply_conditions.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "bodies/auto_stiffness.hpp"
#include "bodies/initial_state.hpp"
#include "bodies/place_outlines.hpp"
#include "core/errors.hpp"
#include "core/located.hpp"

namespace pliant {
namespace {

/// Segment of an outline at the start.
struct Segment {
  Vec2 middle{0, 0};
  Vec2 normal{0, 0};  ///< outward, with the segment's length
};

std::vector<Segment> segments_of(const Model& model, const OutlineField& outlines, int body) {
  std::vector<Segment> result;
  for (int i = model.outline_offset[body]; i < model.outline_end(body); ++i) {
    const Vec2 a = outlines.at(i), b = outlines.at(i + 1);
    result.push_back({0.5 * (a + b), {(b - a).y(), -(b - a).x()}});
  }
  return result;
}

bool lies_between(double angle, double first, double second) {
  constexpr double turn = 2 * std::numbers::pi;
  if (second - first >= turn) return true;
  const auto wrap = [](double a) { return a - turn * std::floor(a / turn); };
  return wrap(angle - first) <= wrap(second - first);
}

bool contains(const OutlinePart& part, const Segment& segment, const Vec2& centre) {
  const Vec2& m = segment.middle;
  switch (part.kind) {
    case OutlinePart::Kind::angles:
      return lies_between(std::atan2(m.y() - centre.y(), m.x() - centre.x()), part.first, part.second);
    case OutlinePart::Kind::box:
      return (m.array() >= part.low.array()).all() && (m.array() <= part.high.array()).all();
    case OutlinePart::Kind::side:
      return segment.normal.normalized().dot(part.side) > std::numbers::sqrt2 / 2;
    case OutlinePart::Kind::all:
      break;
  }
  return true;
}

/// [outline nodes] whether the segment behind a node lies between two cells of one breakable grain. Both cells then
/// have a segment with the same middle, but for the rounding of their places, which is far below a millionth of a
/// segment.
std::vector<char> find_inner_segments(const Model& model, const OutlineField& outlines) {
  struct Side {
    Vec2 middle;
    int body, node;
  };
  std::vector<Side> sides;
  double tolerance = 0;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const Body& body = model.bodies[b];
    if (body.wall || model.scene.grains[body.grains].cells.empty()) continue;
    tolerance = std::max(tolerance, 1e-6 * model.outline_of(b).spacing);
    int node = model.outline_offset[b];
    for (const Segment& segment : segments_of(model, outlines, b)) sides.push_back({segment.middle, b, node++});
  }
  std::vector<char> inner(outlines.x.size(), 0);
  std::ranges::sort(sides, {}, [](const Side& side) { return std::pair(side.middle.x(), side.node); });
  for (auto a = sides.begin(); a != sides.end(); ++a)
    for (auto b = a + 1; b != sides.end() && b->middle.x() - a->middle.x() <= tolerance; ++b) {
      const Body &one = model.bodies[a->body], &other = model.bodies[b->body];
      const bool same_grain = one.grains == other.grains && one.grain == other.grain;
      if (same_grain && std::abs(b->middle.y() - a->middle.y()) <= tolerance) inner[a->node] = inner[b->node] = 1;
    }
  return inner;
}

/// One body with the part of its outline that a condition selects.
class Target {
 public:
  Target(const Model& model, const OutlineField& outlines, const std::vector<char>& inner,
         const BoundaryCondition& condition, int body)
      : outlines_(outlines),
        first_(model.outline_offset[body]),
        body_(body),
        segments_(segments_of(model, outlines, body)) {
    const Vec2 centre = model.bodies[body].centre - model.bodies[body].offset;  // of the whole grain
    for (int node = first_; const Segment& segment : segments_)
      chosen_.push_back(!inner[node++] && contains(condition.part, segment, centre));
    const int count = static_cast<int>(segments_.size());
    for (int k = 0; k < count; ++k) {
      const bool before = chosen_[(k + count - 1) % count], after = chosen_[k];
      if (before || after) nodes_.push_back({k, before, after});
    }
  }

  bool is_empty() const { return nodes_.empty(); }
  OutlinePressure pressure(const BoundaryCondition& condition) const {
    OutlinePressure result{body_, condition.window, condition.pressure, nodes_, {}};
    if (condition.following) return result;
    for (const PartNode& node : nodes_)
      result.dead_load.push_back(condition.direction ? Vec2(length(node) * *condition.direction) : -normal(node));
    return result;
  }

  OutlineSupport support(const BoundaryCondition& condition, double young) const {
    OutlineSupport result{body_, condition.window, {}, {}, 0, condition.damping, {}, {condition.x, condition.y}};
    for (const PartNode& node : nodes_) {
      result.nodes.push_back(node.node);
      result.length.push_back(length(node));
      result.start.push_back(outlines_.at(first_ + node.node));
    }
    result.stiffness = condition.stiffness.value_or(auto_stiffness(young, mean_spacing()));
    return result;
  }

 private:
  const Segment& before(const PartNode& node) const {
    return segments_[node.node == 0 ? segments_.size() - 1 : static_cast<std::size_t>(node.node) - 1];
  }
  const Segment& after(const PartNode& node) const { return segments_[node.node]; }
  Vec2 normal(const PartNode& node) const {
    return 0.5 * (node.before * before(node).normal + node.after * after(node).normal);
  }
  double length(const PartNode& node) const {
    return 0.5 * (node.before * before(node).normal.norm() + node.after * after(node).normal.norm());
  }
  double mean_spacing() const {
    double total = 0;
    for (const Segment& segment : segments_) total += segment.normal.norm();
    return total / static_cast<double>(segments_.size());
  }

  const OutlineField& outlines_;
  int first_, body_;
  std::vector<Segment> segments_;
  std::vector<bool> chosen_;  ///< [segments]
  std::vector<PartNode> nodes_;
};

void apply_axes(RigidBody& rigid, const BoundaryCondition& condition) {
  const AxisCondition* conditions[3] = {&condition.x, &condition.y, &condition.angle};
  for (int c = 0; c < 3; ++c)
    if (conditions[c]->mode != AxisCondition::Mode::free)
      apply_axis_condition(rigid.dof[c], *conditions[c], rigid.dof[c].mass, 0);
  rigid.driven = true;
}

/// `body`: one that the condition selects; without a number it stands for its grain.
[[noreturn]] void refuse_no_segment(const Model& model, const BoundaryCondition& condition, const Body& body) {
  const bool whole_grain = !condition.number && !model.scene.grains[body.grains].cells.empty();
  const Vec2 centre = whole_grain ? Vec2(body.centre - body.offset) : body.centre;
  throw InputError(
      fmt::format("no segment of the outline of '{}' lies in the part that [[boundary]] names; look at where its "
                  "outline stands at the start, centre ({}, {}) m",
                  whole_grain ? condition.grains : body.name, centre.x(), centre.y()));
}

/// Applies the condition to a body. Returns false if no segment of the outline lies in its part.
bool apply(Model& model, const OutlineField& outlines, const std::vector<char>& inner,
           const BoundaryCondition& condition, int index) {
  const Body& body = model.bodies[index];
  if (condition.kind == BoundaryCondition::Kind::axes) {
    apply_axes(model.rigid_bodies[body.rigid], condition);
    return true;
  }
  const Target target(model, outlines, inner, condition, index);
  if (target.is_empty()) return false;
  if (condition.kind == BoundaryCondition::Kind::pressure)
    model.pressures.push_back(target.pressure(condition));
  else
    model.supports.push_back(target.support(condition, model.scene.materials[body.material].young));
  return true;
}

void apply_scene_conditions(Model& model) {
  if (model.scene.boundary.empty()) return;
  const OutlineField outlines = placed_outlines(model, initial_positions(model));
  const std::vector<char> inner = find_inner_segments(model, outlines);
  for (const BoundaryCondition& condition : model.scene.boundary) {
    int number = 0;
    std::map<int, const Body*> missed;  // by grain: a body without a segment in the part
    std::set<int> met;                  // grains with one; one cell of a breakable grain will do
    for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
      const Body& body = model.bodies[b];
      if (body.wall || model.scene.grains[body.grains].name != condition.grains) continue;
      if (condition.number.value_or(number) == number)
        located(condition.where, [&] {
          if (apply(model, outlines, inner, condition, b))
            met.insert(body.grain);
          else
            missed.emplace(body.grain, &body);
        });
      ++number;
    }
    for (const auto& [grain, body] : missed)
      if (!met.contains(grain)) located(condition.where, [&] { refuse_no_segment(model, condition, *body); });
  }
}

/// Sets the damping of rigid grains; that of compliant bodies is in the lanes of their batches.
void damp_rigid_grains(Model& model) {
  for (RigidBody& rigid : model.rigid_bodies)
    if (const Body& body = model.bodies[rigid.body]; !body.wall)
      for (RigidDof& dof : rigid.dof) dof.mass_damping = model.scene.materials[body.material].mass_damping;
}

/// Times at which loads and imposed motions change their slope or jump: of all histories and windows of a scene.
class SwitchTimes {
 public:
  explicit SwitchTimes(const Scene& scene) {
    for (const Wall& wall : scene.walls) add(wall.x), add(wall.y);
    for (const History& gravity : scene.gravity_history) add(gravity);
    if (scene.cell)
      for (const auto& row : scene.cell->gradient)
        for (const History& component : row) add(component);
    if (scene.cell)
      for (const auto& row : scene.cell->stress)
        for (const std::optional<History>& component : row)
          if (component) add(*component);
    for (const BondRule& rule : scene.bonds) add(rule.from);
    for (const BoundaryCondition& condition : scene.boundary) {
      add(condition.window), add(condition.pressure);
      add(condition.x), add(condition.y), add(condition.angle);
    }
  }
  /// Times after the start, ascending.
  std::vector<double> sorted() && {
    std::sort(times_.begin(), times_.end());
    times_.erase(std::unique(times_.begin(), times_.end()), times_.end());
    return std::move(times_);
  }

 private:
  void add(double t) {
    if (t > 0 && std::isfinite(t)) times_.push_back(t);
  }
  void add(const Window& window) { add(window.from), add(window.until); }
  /// A history of one entry is constant.
  void add(const History& history) {
    if (history.time.size() > 1) std::for_each(history.time.begin(), history.time.end(), [&](double t) { add(t); });
  }
  void add(const AxisCondition& prescribed) { add(prescribed.window), add(prescribed.history); }

  std::vector<double> times_;
};

}  // namespace

void apply_axis_condition(RigidDof& dof, const AxisCondition& prescribed, double mass, double pressure_scale) {
  dof.mode = prescribed.mode;
  dof.history = prescribed.history;
  dof.window = prescribed.window;
  dof.force_scale = prescribed.mode == AxisCondition::Mode::pressure ? pressure_scale : 1;
  dof.damping = prescribed.damping * std::abs(dof.force_scale);
  dof.mass = mass;
  dof.inverse_mass = dof.imposed() && dof.window.always() ? 0 : 1 / mass;
}

void apply_conditions(Model& model) {
  apply_scene_conditions(model);
  for (int r = 0; r < static_cast<int>(model.rigid_bodies.size()); ++r)
    if (model.rigid_bodies[r].driven) model.driven.push_back(r);
  damp_rigid_grains(model);
  model.switch_times = SwitchTimes(model.scene).sorted();
  model.outline_rates = std::any_of(model.supports.begin(), model.supports.end(),
                                    [](const OutlineSupport& support) { return support.damping > 0; });
  model.rates =
      std::any_of(model.batches.begin(), model.batches.end(), [](const Batch& batch) { return batch.viscous; });
}

}  // namespace pliant
