#include "reference/loads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "core/errors.hpp"
#include "reference/cell_motion.hpp"

namespace pliant::reference {
namespace {

using Kind = BoundaryCondition::Kind;
using Mode = AxisCondition::Mode;

Vec2 outward(const Vec2& from, const Vec2& to) { return {(to - from).y(), -(to - from).x()}; }

bool in_part(const OutlinePart& part, const Vec2& a, const Vec2& b, const Vec2& centre) {
  const Vec2 middle = 0.5 * (a + b), arm = middle - centre;
  const double turn = 2 * std::numbers::pi, direction = std::atan2(arm.y(), arm.x());
  switch (part.kind) {
    case OutlinePart::Kind::all:
      return true;
    case OutlinePart::Kind::angles: {
      const double range = part.second - part.first, from_first = direction - part.first;
      return range >= turn ||
             from_first - turn * std::floor(from_first / turn) <= range - turn * std::floor(range / turn);
    }
    case OutlinePart::Kind::box:
      return middle.x() >= part.low.x() && middle.x() <= part.high.x() && middle.y() >= part.low.y() &&
             middle.y() <= part.high.y();
    case OutlinePart::Kind::side:
      return outward(a, b).dot(part.side) > (b - a).norm() / std::numbers::sqrt2;
  }
  return true;
}

/// Displacement of a support's target along one axis. A velocity history is integrated from `from` on, when the window
/// begins.
double target(const AxisCondition& prescribed, double time, double from) {
  if (prescribed.mode == Mode::displacement) return prescribed.history.at(time);
  return prescribed.mode == Mode::velocity ? prescribed.history.integral(from, time) : 0.0;
}

double target_velocity(const AxisCondition& prescribed, const Instant& at) {
  if (prescribed.mode == Mode::displacement) return slope(prescribed.history, at);
  return prescribed.mode == Mode::velocity ? prescribed.history.at(at.time) : 0.0;
}

bool acts(const OutlineLoad& load, const Instant& at) { return contains(load.condition.window, at); }
const AxisCondition& axis_of(const OutlineLoad& support, int axis) {
  return axis == 0 ? support.condition.x : support.condition.y;
}
bool holds(const OutlineLoad& support, int axis) { return axis_of(support, axis).mode != Mode::free; }

Vec2 moved(const OutlineLoad& support, double time) {
  const double from = std::max(0.0, support.condition.window.from);
  return {target(support.condition.x, time, from), target(support.condition.y, time, from)};
}

/// Force per pressure on a node, m.
Vec2 pressed(const OutlineLoad& load, const LoadedNode& node, const Points& x) {
  const BoundaryCondition& condition = load.condition;
  if (!condition.following) return condition.direction ? Vec2(node.length * *condition.direction) : Vec2(-node.normal);
  Vec2 normal(0, 0);
  if (node.before >= 0) normal += 0.5 * outward(x[node.before], x[node.node]);
  if (node.after >= 0) normal += 0.5 * outward(x[node.node], x[node.after]);
  return -normal;
}

Vec2 stretch(const OutlineLoad& support, const LoadedNode& node, const Points& x, double time) {
  Vec2 result = x[node.node] - node.start - moved(support, time);
  for (int c = 0; c < 2; ++c)
    if (!holds(support, c)) result[c] = 0;
  return result;
}

/// Tangent of minus p/2 (outward(before, node) + outward(node, after)), independent of the node if both segments count.
void add_following_tangent(const LoadedNode& node, double pressure, Triplets& tangent) {
  const auto add = [&](int by, double sign) {  // residual = +p/2 outward(...): outward of e is (e_y, -e_x)
    tangent.emplace_back(2 * node.node, 2 * by + 1, sign * 0.5 * pressure);
    tangent.emplace_back(2 * node.node + 1, 2 * by, -sign * 0.5 * pressure);
  };
  if (node.before >= 0) add(node.node, 1), add(node.before, -1);
  if (node.after >= 0) add(node.after, 1), add(node.node, -1);
}

}  // namespace

Loads::Loads(const Bodies& bodies) : bodies_(bodies) {
  const Scene& scene = bodies.scene();
  const Vector mass = bodies.lumped_mass();
  heavy_mass_ = mass_damping_ = Vector::Zero(bodies.dofs());
  for (const Body& body : bodies.all())
    for (int i = 0; i < body.dofs; ++i) {
      const int dof = body.first_dof + i;
      if (body.compliant() || i < 2) heavy_mass_[dof] = mass[dof];
      if (!body.placed.wall) mass_damping_[dof] = bodies.material_of(body).mass_damping;
    }
  add_walls();
  for (const BoundaryCondition& condition : scene.boundary) {
    int number = 0;
    std::map<int, std::string> missed;  // grains with no segment in the part, by one of their bodies
    std::set<int> met;
    for (const Body& body : bodies.all()) {
      if (body.placed.wall || scene.grains[body.placed.grains].name != condition.grains) continue;
      if (condition.number.value_or(number) == number) {
        if (add_condition(condition, body))
          met.insert(body.placed.grain);
        else
          missed.emplace(body.placed.grain, body.placed.name);
      }
      ++number;
    }
    for (const auto& [grain, name] : missed)
      if (!met.contains(grain))
        throw InputError(fmt::format("{}: no segment of the outline of '{}' lies in the part that [[boundary]] names",
                                     scene.file.string(), name));
  }
  load_of_dof_.assign(static_cast<std::size_t>(bodies.dofs()), -1);
  for (std::size_t i = 0; i < rigid_.size(); ++i)  // scenes have at most one per axis
    load_of_dof_[static_cast<std::size_t>(rigid_[i].dof)] = static_cast<int>(i);
}

void Loads::add_walls() {
  for (const Body& body : bodies_.all()) {
    if (!body.placed.wall) continue;
    const Wall& wall = bodies_.scene().walls[body.placed.number_of_wall];
    rigid_.push_back({body.first_dof, wall.x, 1});
    rigid_.push_back({body.first_dof + 1, wall.y, wall.y.mode == Mode::pressure ? -body.turn_shift : 1});
    rigid_.push_back({body.first_dof + 2, AxisCondition{}, 1});
  }
}

bool Loads::add_condition(const BoundaryCondition& condition, const Body& body) {
  if (condition.kind != Kind::axes) {
    const OutlineLoad load = outline_load(condition, body);
    if (!load.nodes.empty()) outline_.push_back(load);
    return !load.nodes.empty();
  }
  const AxisCondition* conditions[3] = {&condition.x, &condition.y, &condition.angle};
  for (int c = 0; c < 3; ++c)
    if (conditions[c]->mode != Mode::free) rigid_.push_back({body.first_dof + c, *conditions[c], 1});
  return true;
}

/// Whether another cell of the same grain has the segment from node a to b, in the other direction.
bool Loads::is_within_a_grain(const Body& body, const Points& x, int a, int b) const {
  const double near = 1e-6 * (x[b] - x[a]).norm();
  for (const Body& other : bodies_.all()) {
    if (other.placed.wall || other.placed.grains != body.placed.grains || other.placed.grain != body.placed.grain ||
        &other == &body)
      continue;
    const int n = static_cast<int>(other.outline.size()), first = other.first_outline;
    for (int k = 0; k < n; ++k)
      if ((x[first + k] - x[b]).norm() < near && (x[first + (k + 1) % n] - x[a]).norm() < near) return true;
  }
  return false;
}

OutlineLoad Loads::outline_load(const BoundaryCondition& condition, const Body& body) const {
  const Points x = bodies_.outline_positions(bodies_.initial_positions());
  const int n = static_cast<int>(body.outline.size());
  const auto at = [&](int k) { return body.first_outline + (k + n) % n; };
  const Vec2 centre = body.placed.centre - body.placed.offset;  // of a whole grain, if it consists of cells
  const auto chosen = [&](int k) {
    return in_part(condition.part, x[at(k)], x[at(k + 1)], centre) && !is_within_a_grain(body, x, at(k), at(k + 1));
  };
  OutlineLoad load{.condition = condition, .nodes = {}};
  for (int k = 0; k < n; ++k) {
    LoadedNode node{.node = at(k), .start = x[at(k)]};
    const auto count = [&](int a, int b) {
      node.normal += 0.5 * outward(x[a], x[b]);
      node.length += 0.5 * (x[b] - x[a]).norm();
    };
    if (chosen(k - 1)) node.before = at(k - 1), count(node.before, node.node);
    if (chosen(k)) node.after = at(k + 1), count(node.node, node.after);
    if (node.length > 0) load.nodes.push_back(node);
  }
  load.stiffness = condition.stiffness.value_or(8 * bodies_.material_of(body).young / mean_spacing(body.outline, 0));
  return load;
}

const RigidLoad* Loads::of(int dof) const {
  const int load = load_of_dof_[static_cast<std::size_t>(dof)];
  return load < 0 ? nullptr : &rigid_[static_cast<std::size_t>(load)];
}

Vector Loads::gravity(double time) const {
  const Vec2 g = bodies_.scene().gravity_at(time);
  Vector force = heavy_mass_;
  for (const Body& body : bodies_.all())
    for (int i = 0; i < body.dofs; ++i) force[body.first_dof + i] *= g[i % 2];
  return force;
}

Vector Loads::applied(const Instant& at) const {
  Vector force = Vector::Zero(bodies_.dofs());
  const Vector weight = gravity(at.time);
  for (const RigidLoad& load : rigid_)
    if (const double borne = load.prescribed.mode == Mode::pressure ? weight[load.dof] : 0; load.loaded(at))
      force[load.dof] += load.factor * load.prescribed.history.at(at.time) - borne;
  return force;
}

OutlineResidual Loads::outlines(const Points& x, const Instant& at) const {
  OutlineResidual result{.residual = Vector::Zero(2 * static_cast<int>(x.size())), .tangent = {}};
  for (const OutlineLoad& load : outline_) {
    if (!acts(load, at)) continue;
    for (const LoadedNode& node : load.nodes) {
      auto residual = result.residual.segment<2>(2 * node.node);
      if (load.condition.kind == Kind::pressure) {
        const double pressure = load.condition.pressure.at(at.time);
        const Vec2 force = pressure * pressed(load, node, x);
        residual -= force;
        result.potential -= force.dot(x[node.node]);
        if (load.condition.following) add_following_tangent(node, pressure, result.tangent), result.symmetric = false;
        continue;
      }
      const Vec2 spring = stretch(load, node, x, at.time);
      const double stiffness = load.stiffness * node.length;
      residual += stiffness * spring;
      result.stored += 0.5 * stiffness * spring.squaredNorm();
      for (int c = 0; c < 2; ++c)
        if (holds(load, c)) result.tangent.emplace_back(2 * node.node + c, 2 * node.node + c, stiffness);
    }
  }
  return result;
}

double Loads::outline_work(const Points& x0, double t0, const Points& x1, const Instant& t1) const {
  double work = 0;
  for (const OutlineLoad& load : outline_) {
    const bool before = acts(load, {t0}), after = acts(load, t1);
    for (const LoadedNode& node : load.nodes) {
      if (load.condition.kind == Kind::pressure) {
        Vec2 force(0, 0);
        if (before) force += load.condition.pressure.at(t0) * pressed(load, node, x0);
        if (after) force += load.condition.pressure.at(t1.time) * pressed(load, node, x1);
        work += 0.5 * force.dot(x1[node.node] - x0[node.node]);
        continue;
      }
      const double stiffness = load.stiffness * node.length;
      const Vec2 first = stretch(load, node, x0, t0), last = stretch(load, node, x1, t1.time);
      // A moving target stretches its spring; a support that begins or ends adds or removes the spring's energy.
      if (before) work -= 0.5 * stiffness * (first + last).dot(moved(load, t1.time) - moved(load, t0));
      if (before != after) work += (after ? 0.5 : -0.5) * stiffness * last.squaredNorm();
    }
  }
  return work;
}

Vector Loads::load_dashpots(const Instant& at) const {
  Vector damping = Vector::Zero(bodies_.dofs());
  for (const RigidLoad& load : rigid_)
    if (load.loaded(at)) damping[load.dof] += load.prescribed.damping * std::abs(load.factor);
  return damping;
}

Dashpots Loads::dashpots(const Instant& at) const {
  Dashpots result{Vector::Zero(2 * bodies_.outline_nodes()), Vector::Zero(2 * bodies_.outline_nodes())};
  for (const OutlineLoad& load : outline_) {
    if (load.condition.kind != Kind::support || !acts(load, at)) continue;
    for (const LoadedNode& node : load.nodes)
      for (int c = 0; c < 2; ++c) {
        if (!holds(load, c)) continue;
        const double coefficient = load.condition.damping * node.length;
        result.coefficient[2 * node.node + c] += coefficient;
        result.pull[2 * node.node + c] += coefficient * target_velocity(axis_of(load, c), at);
      }
  }
  return result;
}

double Loads::dashpot_work(const Vector& v0, double t0, const Vector& v1, const Instant& t1) const {
  double work = 0;
  for (const OutlineLoad& load : outline_) {
    if (load.condition.kind != Kind::support || !acts(load, {t0})) continue;
    const Vec2 motion = moved(load, t1.time) - moved(load, t0);
    for (const LoadedNode& node : load.nodes)
      for (int c = 0; c < 2; ++c) {
        if (!holds(load, c)) continue;
        double slip = target_velocity(axis_of(load, c), {t0}) - v0[2 * node.node + c];
        if (acts(load, t1)) slip += target_velocity(axis_of(load, c), t1) - v1[2 * node.node + c];
        work += 0.5 * load.condition.damping * node.length * slip * motion[c];
      }
  }
  return work;
}

bool Loads::imposed(int dof, double time) const {
  const RigidLoad* load = of(dof);
  return load && load->imposed(time);
}

double Loads::imposed_position(int dof, double q0, double t0, double t1) const {
  const AxisCondition& prescribed = of(dof)->prescribed;
  return prescribed.mode == Mode::velocity ? q0 + prescribed.history.integral(t0, t1) : q0;
}

double Loads::imposed_velocity(int dof, double time) const {
  const AxisCondition& prescribed = of(dof)->prescribed;
  return prescribed.mode == Mode::velocity ? prescribed.history.at(time) : 0.0;
}

std::vector<double> Loads::switch_times() const {
  std::set<double> times;
  const auto window = [&](const Window& one) { times.insert({one.from, one.until}); };
  const auto history = [&](const History& one) {
    if (one.time.size() > 1) times.insert(one.time.begin(), one.time.end());
  };
  const auto prescribed = [&](const AxisCondition& one) { window(one.window), history(one.history); };
  for (const History& gravity : bodies_.scene().gravity_history) history(gravity);
  for (const double time : history_times_of_cell(bodies_.scene())) times.insert(time);
  for (const RigidLoad& load : rigid_) prescribed(load.prescribed);
  for (const OutlineLoad& load : outline_) {
    const BoundaryCondition& condition = load.condition;
    window(condition.window), history(condition.pressure), prescribed(condition.x), prescribed(condition.y);
  }
  const auto ahead = times.upper_bound(0.0), never = times.lower_bound(std::numeric_limits<double>::infinity());
  return {ahead, never};
}

}  // namespace pliant::reference
