#include "dynamics/failure.hpp"

#include <cmath>

#include <fmt/format.h>

#include "bodies/body_view.hpp"
#include "bodies/internal_forces.hpp"

namespace pliant {
namespace {

constexpr double least_share = 1e-9;  ///< of the largest time step; smaller steps cannot follow the motion

std::string name_of(const Model& model, int body) { return fmt::format("body {} '{}'", body, model.bodies[body].name); }

std::string place(const Vec2& x) { return fmt::format("({:.6g}, {:.6g}) m", x.x(), x.y()); }

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

/// Centre of the background triangles that an integration point represents, with nodes of the mesh or at present.
template <class Nodes>
Vec2 middle(const Discretisation& space, int point, const Nodes& nodes) {
  Vec2 sum(0, 0);
  int corners = 0;
  for (const int cell : space.table.cells[point])
    for (const int corner : space.mesh.triangles[cell]) sum += nodes[corner], ++corners;
  return sum / corners;
}

Failure inversion(const Model& model, const Dofs& position) {
  const LeastJacobian least = least_jacobian(model, position);
  const Body& body = model.bodies[least.body];
  const Discretisation& space = model.shape_of(body).space;
  Failure failure;
  failure.words = fmt::format(
      "{} is turned inside out: J = {:.3g} <= 0 at integration point {} of {}, about {} of its reference shape; reduce "
      "the load, the tolerance or the time step's safety factor",
      name_of(model, least.body), least.value, least.point, space.table.weight.size(),
      place(body.scale * middle(space, least.point, space.mesh.nodes)));
  failure.cause = Failure::Cause::inverted;
  failure.bodies = {least.body};
  failure.place = middle(space, least.point, BodyView(model, body, position));
  return failure;
}

/// Describes the first value that is not finite; node: field node of a compliant body.
std::string describe_nan(const Model& model, int body, const Dofs& dofs, std::optional<int>& node) {
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
    if (!std::isfinite(values[i].sum())) {
      node = static_cast<int>(i);
      return fmt::format("node {}, {} in its reference shape,", i, place(b.scale * nodes[i]));
    }
  return {};
}

/// Failure by the first position, else the first force, that is not finite, if any.
std::optional<Failure> number_that_is_none(const Model& model, const Dofs& position, const Dofs& force) {
  for (const auto& [dofs, what] : {std::pair(&position, "position"), std::pair(&force, "force")})
    for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
      Failure failure;
      const std::string where = describe_nan(model, b, *dofs, failure.node);
      if (where.empty()) continue;
      failure.words =
          fmt::format("the {} at {} of {} is not a number (NaN) or infinite; look at its loads and its contacts", what,
                      where, name_of(model, b));
      failure.cause = Failure::Cause::not_finite;
      failure.bodies = {b};
      return failure;
    }
  return {};
}

DeepestNode deepest_contact(const Forces& forces, const Outlines& outlines) {
  return deepest_contact(forces.model(), outlines, forces.contact());
}

/// "contact between" two bodies, or within one.
std::string contact_of(const Model& model, const DeepestNode& deepest) {
  const std::string slave = name_of(model, deepest.slave);
  if (deepest.of_itself) return fmt::format("contact of {} with itself", slave);
  if (deepest.slave == deepest.master) return fmt::format("contact of {} with its own periodic image", slave);
  return fmt::format("contact between {} and {}", slave, name_of(model, deepest.master));
}

/// Advice for a lost contact. The detection depth is a segment length, which is soon exceeded where segments are
/// compressed.
std::string advice(const DeepestNode& deepest) {
  constexpr double squeezed = 0.5;
  if (deepest.squeeze >= squeezed)
    return deepest.of_itself
               ? "where its limb there is hardly thicker than contact sees, a segment and a skin, give the shape "
                 "a finer outline; else raise the contact stiffness or press less"
               : "raise the contact stiffness or remove initial overlaps";
  return fmt::format(
      "that segment is squeezed to {:.2f} of its length: its surface creases, and stiffer contact hardly "
      "helps; give the shape more nodes, or press less",
      deepest.squeeze);
}

Failure lost_contact(const Forces& forces, const Outlines& outlines) {
  const Model& model = forces.model();
  const DeepestNode deepest = deepest_contact(forces, outlines);
  Failure failure;
  failure.cause = Failure::Cause::contact_lost;
  if (!(deepest.depth > 0)) {
    failure.words =
        "a contact is lost in the trial step, though no outline node is inside another body there: the step is too "
        "long, or a contact acts beyond its gap; lower [time] safety";
    return failure;
  }
  failure.words =
      fmt::format("{} is lost: outline node {}{}, at {}, has a penetration of {:.3g} m, {:.2f} of a segment length; {}",
                  contact_of(model, deepest), deepest.node, deepest.slave == deepest.master ? "" : " of the first",
                  place(deepest.position), deepest.depth, deepest.depth / deepest.segment_length, advice(deepest));
  failure.bodies = {deepest.slave, deepest.master};
  failure.node = deepest.node;
  failure.place = deepest.position;
  return failure;
}

/// Failure that an evaluation found in a trial or a state, if any.
template <class Tried>
std::optional<Failure> found(const Evaluation& evaluation, const Tried& tried, const Forces& forces) {
  if (!(evaluation.least_jacobian > 0)) return inversion(forces.model(), tried.position);
  if (std::optional<Failure> nan = number_that_is_none(forces.model(), tried.position, tried.force)) return nan;
  if (evaluation.contact_lost) return lost_contact(forces, tried.outlines);
  return {};
}

}  // namespace

void check_time_step(const FailedStep& step, const State& accepted, const Forces& forces) {
  if (step.next_dt >= least_share * step.largest_dt) return;
  Failure failure = found(step.report.evaluation, step.trial, forces).value_or(Failure{});
  if (failure.words.empty() && !step.report.evaluation.valid)
    failure.words = "bodies move further than the contact skin in the shortest step; look at their velocities";
  else if (failure.words.empty())
    failure.words = fmt::format(
        "the motion cannot be followed: the error estimate is still {:.3g}; look at the frames before, and at loads, "
        "initial overlaps and stiffness",
        step.report.error);
  failure.time = step.trial.time, failure.dt = step.report.dt, failure.error = step.report.error;
  failure.largest_dt = step.largest_dt, failure.governed_by = step.governed_by;
  failure.least_jacobian = least_jacobian(forces.model(), accepted.position);
  failure.deepest = deepest_contact(forces, accepted.outlines);
  const std::string message = fmt::format(
      "{}; at t = {:.6g} s, time step {:.3g} s (at most {:.3g} s: {}; trials rejected: {}); last good state: step {}, "
      "t = {:.6g} s",
      failure.words, step.trial.time, step.report.dt, step.largest_dt, step.governed_by, step.report.rejections,
      accepted.steps, accepted.time);
  throw StepFailure(message, std::move(failure));
}

void check_start(const Evaluation& evaluation, const State& start, const Forces& forces) {
  if (const std::optional<Failure> failure = found(evaluation, start, forces))
    throw PhysicsError(fmt::format("{}; at the start, t = {:.6g} s", failure->words, start.time));
}

}  // namespace pliant
