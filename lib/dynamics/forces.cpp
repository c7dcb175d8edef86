#include "dynamics/forces.hpp"

#include <algorithm>
#include <utility>

#include <spdlog/spdlog.h>

#include "bodies/internal_forces.hpp"
#include "bodies/update_outlines.hpp"
#include "boundary/loads.hpp"
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

Evaluation Forces::evaluate(const Motion& motion, ContactHistory& committed, ContactHistory& trial, Dofs& force,
                            State* accepted, const BatchWork& afterwards) {
  const Dofs& position = motion.position;
  Evaluation result;
  update_outlines(model_, position, outlines_);
  if (contact_.refresh_needed(outlines_)) {
    if (accepted) update_outlines(model_, accepted->position, outlines_);
    contact_.refresh(outlines_, accepted ? accepted->history : committed);
    if (accepted) update_outlines(model_, position, outlines_);
    result.refreshed = true;
    result.sound = !contact_.refresh_needed(outlines_);
    if (accepted && &accepted->history != &committed) {
      result.sound = false;
      return result;
    }
  }
  update_outline_velocities(model_, motion, outlines_);
  result.contact = contact_.forces(outlines_, committed, trial);
  parallel_for(static_cast<int>(model_.batches.size()), [&](int b) {
    const Batch& batch = model_.batches[b];
    Lanes* f = &force.compliant[batch.offset];
    std::fill_n(f, 2 * model_.shape_of(batch).nodes(), Lanes{});
    add_outline_forces(model_, batch, outlines_, f);
    add_gravity(model_, batch, f);
    least_jacobian_[b] = least_of(add_internal_forces(model_, batch, &position.compliant[batch.offset], f));
    if (afterwards) afterwards(b);
  });
  parallel_for(static_cast<int>(model_.rigid_bodies.size()), [&](int r) {
    const RigidBody& rigid = model_.rigid_bodies[r];
    outline_force_resultant(model_, rigid, outlines_, &position.rigid[3 * r], &force.rigid[3 * r]);
    add_rigid_loads(model_, rigid, motion.time, &force.rigid[3 * r]);
  });
  for (double j : least_jacobian_) result.least_jacobian = std::min(result.least_jacobian, j);
  result.sound &= result.least_jacobian > 0 && result.contact.deepest <= lost_penetration;
  return result;
}

void Forces::warn_of_depth(const Evaluation& evaluation, double time) {
  if (evaluation.contact.deepest <= deep_penetration || warned_deep_) return;
  warned_deep_ = true;
  spdlog::warn(
      "penetration reaches {:.2f} of a segment length at t = {:.6g} s (contacts are lost at {:.1f}); consider a "
      "higher contact stiffness",
      evaluation.contact.deepest, time, lost_penetration);
}

std::vector<double> Forces::stiffness_bound(const std::vector<double>& compliance) {
  const auto swap_places = [&] {
    std::swap(outlines_.x, outlines_.x_refresh);
    std::swap(outlines_.y, outlines_.y_refresh);
  };
  swap_places();
  std::vector<double> result = contact_.stiffness_bound(outlines_, compliance);
  swap_places();
  return result;
}

}  // namespace pliant
