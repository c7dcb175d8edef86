#include "dynamics/failure.hpp"

#include <cmath>

#include <fmt/format.h>

#include "bodies/body_view.hpp"
#include "bodies/internal_forces.hpp"
#include "contact/deepest_node.hpp"
#include "core/errors.hpp"

namespace pliant {
namespace {

constexpr double least_share = 1e-9;  ///< of the largest time step: below, the motion cannot be followed

std::string name_of(const Model& model, int body) { return fmt::format("body {} '{}'", body, model.bodies[body].name); }

std::string place(const Vec2& x) { return fmt::format("({:.6g}, {:.6g}) m", x.x(), x.y()); }

struct LeastJacobian {
  double value = 1e300;
  int body = 0, point = 0;
};

LeastJacobian least_jacobian(const Model& model, const Dofs& position) {
  LeastJacobian least;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (body.kind != BodyKind::compliant) continue;
    const auto F = deformation_gradients(model, body, position);
    for (std::size_t g = 0; g < F.size(); ++g)
      if (const double J = determinant(F[g]); J < least.value) least = {J, static_cast<int>(b), static_cast<int>(g)};
  }
  return least;
}

/// Middle of the background triangles that an integration point stands for.
Vec2 reference_position(const Discretisation& space, int point) {
  Vec2 sum(0, 0);
  for (const int cell : space.table.cells[point])
    for (const int corner : space.mesh.triangles[cell]) sum += space.mesh.nodes[corner];
  return sum / 6;
}

std::string describe_inversion(const Model& model, const Dofs& position) {
  const LeastJacobian least = least_jacobian(model, position);
  const Body& body = model.bodies[least.body];
  const Discretisation& space = model.shape_of(body).space;
  return fmt::format(
      "{} is turned inside out: J = {:.3g} <= 0 at integration point {} of {}, about {} of its reference shape; reduce "
      "the load, the tolerance or the time step's safety factor",
      name_of(model, least.body), least.value, least.point, space.table.weight.size(),
      place(body.scale * reference_position(space, least.point)));
}

std::string describe_nan(const Model& model, int body, const Dofs& dofs) {
  const Body& b = model.bodies[body];
  if (b.kind == BodyKind::rigid) {
    constexpr const char* names[] = {"x", "y", "the angle"};
    for (std::size_t c = 0; c < 3; ++c)
      if (!std::isfinite(dofs.rigid[3 * static_cast<std::size_t>(b.rigid) + c])) return names[c];
    return {};
  }
  const Points& nodes = model.shape_of(b).space.mesh.nodes;
  const BodyView values(model, b, dofs);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (!std::isfinite(values[i].sum()))
      return fmt::format("node {}, {} in its reference shape,", i, place(b.scale * nodes[i]));
  return {};
}

/// The first position, else the first force, that is not finite; empty when all are.
std::string describe_nan(const Model& model, const Dofs& position, const Dofs& force) {
  for (const auto& [dofs, what] : {std::pair(&position, "position"), std::pair(&force, "force")})
    for (std::size_t b = 0; b < model.bodies.size(); ++b)
      if (const std::string where = describe_nan(model, static_cast<int>(b), *dofs); !where.empty())
        return fmt::format("the {} at {} of {} is not a number (NaN) or infinite; look at its loads and its contacts",
                           what, where, name_of(model, static_cast<int>(b)));
  return {};
}

std::string describe_lost_contact(const Forces& forces, const OutlineField& place_of_nodes) {
  const Model& model = forces.model();
  std::vector<BodyPair> pairs;
  for (const Patch& patch : forces.contact().patches()) pairs.push_back({patch.first, patch.second, patch.images});
  const DeepestNode deepest = deepest_node(model, place_of_nodes, pairs);
  return fmt::format(
      "contact between {} and {} is lost: outline node {} of the first, at {}, has a penetration of {:.3g} m, {:.2f} "
      "of a segment length; raise the contact stiffness or remove initial overlaps",
      name_of(model, deepest.slave), name_of(model, deepest.master), deepest.node, place(deepest.position),
      deepest.depth, deepest.depth / deepest.segment_length);
}

/// What an evaluation found wrong with a trial or a state; empty when nothing is.
template <class Tried>
std::string describe(const Evaluation& evaluation, const Tried& tried, const Forces& forces) {
  if (!(evaluation.least_jacobian > 0)) return describe_inversion(forces.model(), tried.position);
  const std::string nan = describe_nan(forces.model(), tried.position, tried.force);
  return !nan.empty() || evaluation.sound ? nan : describe_lost_contact(forces, tried.outlines.position);
}

}  // namespace

void check_time_step(const FailedStep& step, const State& accepted, const Forces& forces) {
  if (step.next_dt >= least_share * step.largest_dt) return;
  std::string cause = describe(step.report.evaluation, step.trial, forces);
  if (cause.empty())
    cause = fmt::format(
        "the motion cannot be followed: the error estimate is still {:.3g}; look at the frames before, and at loads, "
        "initial overlaps and stiffness",
        step.report.error);
  throw PhysicsError(fmt::format(
      "{}; at t = {:.6g} s, time step {:.3g} s (at most {:.3g} s: {}; trials rejected: {}); last good state: step {}, "
      "t = {:.6g} s",
      cause, step.trial.time, step.report.dt, step.largest_dt, step.governed_by, step.report.rejections, accepted.steps,
      accepted.time));
}

void check_start(const Evaluation& evaluation, const State& start, const Forces& forces) {
  const std::string cause = describe(evaluation, start, forces);
  if (!cause.empty()) throw PhysicsError(fmt::format("{}; at the start, t = {:.6g} s", cause, start.time));
}

}  // namespace pliant
