#include "dynamics/forces.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "bodies/internal_forces.hpp"
#include "bodies/update_outlines.hpp"
#include "boundary/loads.hpp"
#include "core/errors.hpp"
#include "core/parallel.hpp"

namespace pliant {
namespace {

/// Penetration over segment length: contacts are dropped a skin beyond 1; warned about when half of that is used.
constexpr double deep_penetration = 0.5, lost_penetration = 1;

/// Padding lanes repeat a body, so that they need no masking here.
double least_of(Lanes jacobian) { return -largest(-jacobian); }

}  // namespace

Forces::Forces(const Model& model)
    : model_(model), outlines_(make_outlines(model)), contact_(model), least_jacobian_(model.batches.size(), 1e300) {}

Evaluation Forces::evaluate(const Dofs& position, double time, ContactHistory& committed, ContactHistory& trial,
                            Dofs& force, const Dofs* accepted) {
  Evaluation result;
  update_outlines(model_, position, outlines_);
  if (contact_.refresh_needed(outlines_)) {
    if (accepted) update_outlines(model_, *accepted, outlines_);
    contact_.refresh(outlines_, committed);
    if (accepted) update_outlines(model_, position, outlines_);
    result.refreshed = true;
    result.sound = !contact_.refresh_needed(outlines_);
  }
  result.contact = contact_.forces(outlines_, committed, trial);
  parallel_for(static_cast<int>(model_.batches.size()), [&](int b) {
    const Batch& batch = model_.batches[b];
    Lanes* f = &force.compliant[batch.offset];
    std::fill_n(f, 2 * model_.shape_of(batch).nodes(), Lanes{});
    add_outline_forces(model_, batch, outlines_, f);
    add_gravity(model_, batch, f);
    least_jacobian_[b] = least_of(add_internal_forces(model_, batch, &position.compliant[batch.offset], f));
  });
  parallel_for(static_cast<int>(model_.rigid_bodies.size()), [&](int r) {
    const RigidBody& rigid = model_.rigid_bodies[r];
    outline_force_resultant(model_, rigid, outlines_, &position.rigid[3 * r], &force.rigid[3 * r]);
    add_rigid_loads(model_, rigid, time, &force.rigid[3 * r]);
  });
  for (double j : least_jacobian_) result.least_jacobian = std::min(result.least_jacobian, j);
  result.sound &= result.least_jacobian > 0 && result.contact.deepest <= lost_penetration;
  return result;
}

void Forces::check(const Evaluation& evaluation, double time) {
  if (!(evaluation.least_jacobian > 0)) {
    const auto worst = std::min_element(least_jacobian_.begin(), least_jacobian_.end()) - least_jacobian_.begin();
    const Batch& batch = model_.batches[worst];
    throw PhysicsError(
        fmt::format("J = {:.3g} <= 0 in one of the bodies '{}' to '{}' at t = {:.6g} s: a grain is turned inside out; "
                    "reduce the load, the tolerance or the time step's safety factor",
                    evaluation.least_jacobian, model_.bodies[model_.groups[batch.group].bodies[batch.first]].name,
                    model_.bodies[model_.groups[batch.group].bodies[batch.first + batch.count - 1]].name, time));
  }
  if (evaluation.contact.deepest > lost_penetration)
    throw PhysicsError(
        fmt::format("penetration reaches {:.2f} of a segment length at t = {:.6g} s and contacts are lost at {:.1f}; "
                    "raise the contact stiffness",
                    evaluation.contact.deepest, time, lost_penetration));
  if (evaluation.contact.deepest > deep_penetration && !warned_deep_) {
    warned_deep_ = true;
    spdlog::warn(
        "penetration reaches {:.2f} of a segment length at t = {:.6g} s (contacts are lost at {:.1f}); consider a "
        "higher contact stiffness",
        evaluation.contact.deepest, time, lost_penetration);
  }
}

}  // namespace pliant
