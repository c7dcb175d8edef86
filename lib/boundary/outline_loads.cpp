#include "boundary/outline_loads.hpp"

#include <algorithm>

#include <Eigen/Geometry>

#include "bodies/nodal.hpp"

namespace pliant {
namespace {

/// Node k of an outline, from wherever it is kept.
template <class At>
Vec2 following_load(const PartNode& node, int count, At&& at) {
  Vec2 along(0, 0);  // of the segments of the part
  if (node.before) along += at(node.node) - at((node.node + count - 1) % count);
  if (node.after) along += at((node.node + 1) % count) - at(node.node);
  return 0.5 * Vec2(-along.y(), along.x());
}

/// Calls action(node, force) for each node under a pressure.
template <class At, class Action>
void for_each_load(const OutlinePressure& load, int count, double time, At&& at, Action&& action) {
  if (!load.window.contains(time)) return;
  const double pressure = load.pressure.at(time);
  for (std::size_t i = 0; i < load.nodes.size(); ++i)
    action(load.nodes[i].node,
           pressure * (load.dead_load.empty() ? following_load(load.nodes[i], count, at) : load.dead_load[i]));
}

/// Where a support's history has moved its far ends, m, and how fast.
struct TargetMotion {
  Vec2 moved{0, 0}, velocity{0, 0};

  TargetMotion(const OutlineSupport& support, double time) {
    for (int c = 0; c < 2; ++c) {
      const Drive& drive = support.drive[c];
      if (drive.mode == Drive::Mode::displacement) {
        moved[c] = drive.history.at(time);
        velocity[c] = drive.history.slope(time);
      } else if (drive.mode == Drive::Mode::velocity) {
        moved[c] = drive.history.integral(std::max(0.0, support.window.from), time);
        velocity[c] = drive.history.at(time);
      }
    }
  }
};

/// Zero along the axes that are free.
Vec2 held(const OutlineSupport& support, Vec2 value) {
  for (int c = 0; c < 2; ++c)
    if (support.drive[c].mode == Drive::Mode::free) value[c] = 0;
  return value;
}

/// What a node of the part at this place does to its spring.
Vec2 stretch(const OutlineSupport& support, std::size_t i, const TargetMotion& target, const Vec2& place) {
  return held(support, place - support.start[i] - target.moved);
}

/// Forces of the supports of one motion on their body, together.
Vec2 support_resultant(const Model& model, const OutlineSupport& support, const Motion& motion) {
  const Body& body = model.bodies[support.body];
  const Points position = outline_values(model, body, motion.position);
  const Points velocity = support.damping > 0 ? outline_values(model, body, motion.velocity) : Points{};
  const TargetMotion target(support, motion.time);
  Vec2 total(0, 0);
  for (std::size_t i = 0; i < support.nodes.size(); ++i) {
    const std::size_t k = static_cast<std::size_t>(support.nodes[i]);
    Vec2 pull = support.stiffness * stretch(support, i, target, body.centre + position[k]);
    if (support.damping > 0) pull += support.damping * held(support, velocity[k] - target.velocity);
    total -= support.length[i] * pull;
  }
  return total;
}

double spring_energy(const Model& model, const OutlineSupport& support, const Dofs& position, double time) {
  const Body& body = model.bodies[support.body];
  const Points at = outline_values(model, body, position);
  const TargetMotion target(support, time);
  double energy = 0;
  for (std::size_t i = 0; i < support.nodes.size(); ++i) {
    const Vec2 place = body.centre + at[static_cast<std::size_t>(support.nodes[i])];
    energy += 0.5 * support.stiffness * support.length[i] * stretch(support, i, target, place).squaredNorm();
  }
  return energy;
}

/// Outline of a body in motion, [outline nodes], m.
Points outline_positions(const Model& model, const Body& body, const Dofs& position) {
  if (body.kind == BodyKind::compliant) {
    Points points = outline_values(model, body, position);
    for (Vec2& p : points) p += body.centre;
    return points;
  }
  const double* at = &position.rigid[3 * static_cast<std::size_t>(body.rigid)];
  Points points = model.outlines[body.outline].points;
  for (Vec2& p : points) p = Eigen::Rotation2Dd(at[2]) * p + Vec2(at[0], at[1]);
  return points;
}

double pressure_work(const Model& model, const OutlinePressure& load, const Motion& before, const Motion& after) {
  const Body& body = model.bodies[load.body];
  const Points start = outline_positions(model, body, before.position);
  const Points end = outline_positions(model, body, after.position);
  const int count = static_cast<int>(start.size());
  double work = 0;
  const auto add = [&](const Points& at, double time) {
    for_each_load(
        load, count, time, [&](int k) { return at[static_cast<std::size_t>(k)]; },
        [&](int k, const Vec2& force) {
          work += 0.5 * force.dot(end[static_cast<std::size_t>(k)] - start[static_cast<std::size_t>(k)]);
        });
  };
  add(start, before.time);
  add(end, after.time);
  return work;
}

/// Work of a support's springs at one end of a step over half of it, as the integrator does it.
double half_work(const Model& model, const OutlineSupport& support, const Motion& at, const Motion& before,
                 const Motion& after) {
  const Body& body = model.bodies[support.body];
  const Points start = outline_values(model, body, before.position), end = outline_values(model, body, after.position),
               position = outline_values(model, body, at.position);
  const TargetMotion target(support, at.time);
  double work = 0;
  for (std::size_t i = 0; i < support.nodes.size(); ++i) {
    const std::size_t k = static_cast<std::size_t>(support.nodes[i]);
    const Vec2 pull = support.stiffness * stretch(support, i, target, body.centre + position[k]);
    work -= 0.5 * support.length[i] * pull.dot(end[k] - start[k]);
  }
  return work;
}

/// A support that sets in or ends acts at one end of the step only: what it does there, and the energy that its springs have then.
double switch_work(const Model& model, const OutlineSupport& support, const Motion& before, const Motion& after) {
  const bool ends = support.window.contains(before.time);
  const Motion& at = ends ? before : after;
  const double energy = spring_energy(model, support, at.position, at.time);
  return half_work(model, support, at, before, after) + (ends ? -energy : energy);
}

double support_work(const Model& model, const OutlineSupport& support, const Motion& before, const Motion& after) {
  const bool active = support.window.contains(before.time);
  if (active != support.window.contains(after.time)) return switch_work(model, support, before, after);
  const Vec2 moved = TargetMotion(support, after.time).moved - TargetMotion(support, before.time).moved;
  if (!active || moved.isZero(0)) return 0;
  const Vec2 pull = support_resultant(model, support, before) + support_resultant(model, support, after);
  return 0.5 * pull.dot(moved);
}

}  // namespace

OutlineLoads::OutlineLoads(const Model& model, double time, Outlines& outlines) : outlines_(outlines) {
  for (const OutlinePressure& load : model.pressures) {
    const int first = outlines.offset[load.body], count = model.outlines[outlines.shape[load.body]].count;
    for_each_load(
        load, count, time, [&](int k) { return Vec2(outlines.x[first + k], outlines.y[first + k]); },
        [&](int k, const Vec2& force) { add(first + k, force); });
  }
  for (const OutlineSupport& support : model.supports)
    if (support.window.contains(time)) add(support, time);
}

void OutlineLoads::add(const OutlineSupport& support, double time) {
  const TargetMotion target(support, time);
  for (std::size_t i = 0; i < support.nodes.size(); ++i) {
    const int k = outlines_.offset[support.body] + support.nodes[i];
    Vec2 pull = support.stiffness * stretch(support, i, target, {outlines_.x[k], outlines_.y[k]});
    if (support.damping > 0) {
      const Vec2 slip = held(support, Vec2(outlines_.velocity_x[k], outlines_.velocity_y[k]) - target.velocity);
      pull += support.damping * slip;
      damping_power_ += support.damping * support.length[i] * slip.squaredNorm();
    }
    add(k, -support.length[i] * pull);
  }
}

OutlineLoads::~OutlineLoads() {
  for (auto entry = before_.rbegin(); entry != before_.rend(); ++entry) {
    outlines_.force_x[entry->first] = entry->second.x();
    outlines_.force_y[entry->first] = entry->second.y();
  }
}

void OutlineLoads::add(int index, const Vec2& force) {
  double &x = outlines_.force_x[index], &y = outlines_.force_y[index];
  before_.emplace_back(index, Vec2(x, y));
  x += force.x();
  y += force.y();
}

Vec2 outline_load(const Model& model, int body, const Motion& motion) {
  Vec2 total(0, 0);
  for (const OutlinePressure& load : model.pressures) {
    if (load.body != body) continue;
    const Points at = outline_positions(model, model.bodies[body], motion.position);
    for_each_load(
        load, static_cast<int>(at.size()), motion.time, [&](int k) { return at[static_cast<std::size_t>(k)]; },
        [&](int, const Vec2& force) { total += force; });
  }
  for (const OutlineSupport& support : model.supports)
    if (support.body == body && support.window.contains(motion.time))
      total += support_resultant(model, support, motion);
  return total;
}

double support_energy(const Model& model, const Dofs& position, double time) {
  double energy = 0;
  for (const OutlineSupport& support : model.supports)
    if (support.window.contains(time)) energy += spring_energy(model, support, position, time);
  return energy;
}

double outline_work(const Model& model, const Motion& before, const Motion& after) {
  double work = 0;
  for (const OutlinePressure& load : model.pressures) work += pressure_work(model, load, before, after);
  for (const OutlineSupport& support : model.supports) work += support_work(model, support, before, after);
  return work;
}

}  // namespace pliant
