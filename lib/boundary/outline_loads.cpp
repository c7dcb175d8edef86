#include "boundary/outline_loads.hpp"

#include <algorithm>
#include <utility>

#include "bodies/body_view.hpp"

namespace pliant {
namespace {

/// Load on a node per unit of a following pressure. `at`: position of node k of the outline.
template <class At>
Vec2 following_load(const PartNode& node, int count, At&& at) {
  Vec2 along(0, 0);  // sum of the segments of the part
  if (node.before) along += at(node.node) - at((node.node + count - 1) % count);
  if (node.after) along += at((node.node + 1) % count) - at(node.node);
  return 0.5 * Vec2(-along.y(), along.x());
}

double pressure_of(const OutlinePressure& load, const Instant& at) {
  return contains(load.window, at) ? load.pressure.at(at.time) : 0.0;
}

/// Calls action(node, force) for each node under a pressure.
template <class At, class Action>
void for_each_load(const OutlinePressure& load, int count, double pressure, At&& at, Action&& action) {
  if (pressure == 0) return;
  for (std::size_t i = 0; i < load.nodes.size(); ++i)
    action(load.nodes[i].node,
           pressure * (load.dead_load.empty() ? following_load(load.nodes[i], count, at) : load.dead_load[i]));
}

/// Displacement of the far ends of a support's springs by its history, m, and its rate.
struct TargetMotion {
  Vec2 moved{0, 0}, velocity{0, 0};

  TargetMotion(const OutlineSupport& support, const Instant& at) {
    for (int c = 0; c < 2; ++c) {
      const AxisCondition& prescribed = support.prescribed[c];
      if (prescribed.mode == AxisCondition::Mode::displacement) {
        moved[c] = prescribed.history.at(at.time);
        velocity[c] = slope(prescribed.history, at);
      } else if (prescribed.mode == AxisCondition::Mode::velocity) {
        moved[c] = prescribed.history.integral(std::max(0.0, support.window.from), at.time);
        velocity[c] = prescribed.history.at(at.time);
      }
    }
  }
};

/// Sets a vector to zero along the free axes.
Vec2 held(const OutlineSupport& support, Vec2 value) {
  for (int c = 0; c < 2; ++c)
    if (support.prescribed[c].mode == AxisCondition::Mode::free) value[c] = 0;
  return value;
}

/// Elongation of the spring of a node at this position.
Vec2 stretch(const OutlineSupport& support, std::size_t i, const TargetMotion& target, const Vec2& place) {
  return held(support, place - support.start[i] - target.moved);
}

/// Traction of springs and dashpots of a support on one node of its part, N/m2, and dissipation of the dashpots, W/m2.
struct Pull {
  Vec2 force{0, 0};
  double power = 0;
};

Pull pull_on(const OutlineSupport& support, std::size_t i, const TargetMotion& target, const Vec2& place,
             const Vec2& velocity) {
  const Vec2 slip = held(support, velocity - target.velocity);
  return {-support.stiffness * stretch(support, i, target, place) - support.damping * slip,
          support.damping * slip.squaredNorm()};
}

/// Calls action(i, place, velocity) for each node of a support's part.
template <class Action>
void for_each_node(const Model& model, const OutlineSupport& support, const Outlines& outlines, Action&& action) {
  const int first = model.outline_offset[support.body];
  for (std::size_t i = 0; i < support.nodes.size(); ++i) {
    const int k = first + support.nodes[i];
    action(i, outlines.position.at(k), support.damping > 0 ? outlines.velocity.at(k) : Vec2(0, 0));
  }
}

/// Total force of a support on its body.
Vec2 support_resultant(const Model& model, const OutlineSupport& support, const Outlines& outlines, const Instant& at) {
  const TargetMotion target(support, at);
  Vec2 total(0, 0);
  for_each_node(model, support, outlines, [&](std::size_t i, const Vec2& place, const Vec2& velocity) {
    total += support.length[i] * pull_on(support, i, target, place, velocity).force;
  });
  return total;
}

double spring_energy(const Model& model, const OutlineSupport& support, const OutlineField& position, double time) {
  const int first = model.outline_offset[support.body];
  const TargetMotion target(support, Instant{time});
  double energy = 0;
  for (std::size_t i = 0; i < support.nodes.size(); ++i)
    energy += 0.5 * support.stiffness * support.length[i] *
              stretch(support, i, target, position.at(first + support.nodes[i])).squaredNorm();
  return energy;
}

/// Calls action(node, force) for each outline node of the body under a pressure, at these positions.
template <class Action>
void for_each_load(const Model& model, const OutlinePressure& load, const OutlineField& position, double pressure,
                   Action&& action) {
  const int first = model.outline_offset[load.body];
  for_each_load(
      load, model.outline_of(load.body).count, pressure, [&](int k) { return position.at(first + k); },
      std::forward<Action>(action));
}

double pressure_work(const Model& model, const OutlinePressure& load, const OutlineField& before, const Instant& from,
                     const OutlineField& after, const Instant& to) {
  const int first = model.outline_offset[load.body];
  double work = 0;
  const auto add = [&](int k, const Vec2& force) {
    work += 0.5 * force.dot(after.at(first + k) - before.at(first + k));
  };
  for_each_load(model, load, before, pressure_of(load, from), add);
  for_each_load(model, load, after, pressure_of(load, to), add);
  return work;
}

/// Work of a support in a step. Steps end where windows do, so a support acts during a whole step or not at all.
double support_work(const Model& model, const OutlineSupport& support, const Outlines& before, const Instant& from,
                    const Outlines& after, const Instant& to) {
  if (!contains(support.window, from)) return 0;
  const Vec2 moved = TargetMotion(support, to).moved - TargetMotion(support, from).moved;
  if (moved.isZero(0)) return 0;
  const Vec2 pull = support_resultant(model, support, before, from) + support_resultant(model, support, after, to);
  return 0.5 * pull.dot(moved);
}

/// Transfers forces on outline nodes of one body to its degrees of freedom.
class OutlineForces {
 public:
  OutlineForces(const Model& model, const Body& body, const Motion& motion, Dofs& force)
      : model_(model), body_(body), motion_(motion), force_(force) {}

  void add(int node, const Vec2& place, const Vec2& f) {
    if (body_.kind == BodyKind::compliant) return add_to_field(node, f / body_.scale);
    const std::size_t r = 3 * static_cast<std::size_t>(body_.rigid);
    const Vec2 arm = place - Vec2(motion_.position.rigid[r], motion_.position.rigid[r + 1]);
    force_.rigid[r] += f.x();
    force_.rigid[r + 1] += f.y();
    force_.rigid[r + 2] += arm.x() * f.y() - arm.y() * f.x();
  }

 private:
  void add_to_field(int node, const Vec2& f) {
    const ShapeRows& rows = model_.shape_of(body_).space.outline_rows;
    const BodyOffsets offsets(model_, body_);
    double* values = reinterpret_cast<double*>(force_.compliant.data());
    for (int e = rows.start[node]; e < rows.start[node + 1]; ++e) {
      double* at = values + offsets[static_cast<std::size_t>(rows.node[e])];
      at[0] += rows.value[e] * f.x();
      at[lane_count] += rows.value[e] * f.y();
    }
  }

  const Model& model_;
  const Body& body_;
  const Motion& motion_;
  Dofs& force_;
};

void add_pressure_change(const Model& model, const OutlinePressure& load, const Motion& at,
                         const OutlineField& position, const Instant& to, Dofs& force) {
  const int first = model.outline_offset[load.body];
  OutlineForces outline(model, model.bodies[load.body], at, force);
  for_each_load(model, load, position, pressure_of(load, to) - pressure_of(load, at.instant()),
                [&](int k, const Vec2& f) { outline.add(k, position.at(first + k), f); });
}

double add_support_change(const Model& model, const OutlineSupport& support, const Motion& at, const Outlines& outlines,
                          const Instant& to, Dofs& force) {
  OutlineForces outline(model, model.bodies[support.body], at, force);
  double growth = 0;
  const auto add = [&](const Instant& instant, double sign) {
    if (!contains(support.window, instant)) return;
    const TargetMotion target(support, instant);
    for_each_node(model, support, outlines, [&](std::size_t i, const Vec2& place, const Vec2& velocity) {
      const Pull pull = pull_on(support, i, target, place, velocity);
      outline.add(support.nodes[i], place, sign * support.length[i] * pull.force);
      growth += sign * support.length[i] * pull.power;
    });
  };
  add(at.instant(), -1);
  add(to, 1);
  return growth;
}

}  // namespace

bool has_outline_loads(const Model& model) { return !model.pressures.empty() || !model.supports.empty(); }

double add_outline_loads(const Model& model, const Instant& at, const Outlines& outlines, OutlineField& force) {
  const auto add = [&](int index, const Vec2& f) { force.x[index] += f.x(), force.y[index] += f.y(); };
  for (const OutlinePressure& load : model.pressures) {
    const int first = model.outline_offset[load.body];
    for_each_load(model, load, outlines.position, pressure_of(load, at),
                  [&](int k, const Vec2& f) { add(first + k, f); });
  }
  double damping_power = 0;
  for (const OutlineSupport& support : model.supports) {
    if (!contains(support.window, at)) continue;
    const int first = model.outline_offset[support.body];
    const TargetMotion target(support, at);
    for_each_node(model, support, outlines, [&](std::size_t i, const Vec2& place, const Vec2& velocity) {
      const Pull pull = pull_on(support, i, target, place, velocity);
      damping_power += support.length[i] * pull.power;
      add(first + support.nodes[i], support.length[i] * pull.force);
    });
  }
  return damping_power;
}

Vec2 outline_load(const Model& model, int body, const Outlines& outlines, const Instant& at) {
  Vec2 total(0, 0);
  for (const OutlinePressure& load : model.pressures)
    if (load.body == body)
      for_each_load(model, load, outlines.position, pressure_of(load, at),
                    [&](int, const Vec2& force) { total += force; });
  for (const OutlineSupport& support : model.supports)
    if (support.body == body && contains(support.window, at)) total += support_resultant(model, support, outlines, at);
  return total;
}

double support_energy(const Model& model, const OutlineField& position, const Instant& at) {
  double energy = 0;
  for (const OutlineSupport& support : model.supports)
    if (contains(support.window, at)) energy += spring_energy(model, support, position, at.time);
  return energy;
}

double add_outline_load_change(const Model& model, const Motion& at, const Outlines& outlines, const Instant& to,
                               Dofs& force) {
  for (const OutlinePressure& load : model.pressures)
    add_pressure_change(model, load, at, outlines.position, to, force);
  double power = 0;
  for (const OutlineSupport& support : model.supports)
    power += add_support_change(model, support, at, outlines, to, force);
  return power;
}

double outline_work(const Model& model, const Outlines& before, const Instant& from, const Outlines& after,
                    const Instant& to) {
  double work = 0;
  for (const OutlinePressure& load : model.pressures)
    work += pressure_work(model, load, before.position, from, after.position, to);
  for (const OutlineSupport& support : model.supports) work += support_work(model, support, before, from, after, to);
  return work;
}

}  // namespace pliant
