#include <algorithm>
#include <cmath>

#include "contact/contact.hpp"
#include "contact/patch_survey.hpp"
#include "core/parallel.hpp"

namespace pliant {

std::vector<double> ContactSystem::stiffness_bound(Outlines& outlines, const std::vector<double>& compliance) {
  measure_lengths(outlines);
  parallel_for(static_cast<int>(patches_.size()), [&](int p) {
    const Patch& patch = patches_[p];
    const double a = compliance[patch.first], b = compliance[patch.second];
    // (u - v)^2 <= (1 + s) u^2 + (1 + 1/s) v^2; s = b/a gives either body the same bound a + b.
    const double factor[2] = {a > 0 ? 1 + b / a : 0, b > 0 ? 1 + a / b : 0};
    compute_patch_stiffness(model_, outlines, patch, stiffness_of(patch.law), skin_, reach_of(patch.law) + skin_,
                            factor, forces_, thread_scratch());
  });
  std::vector<double> result(outlines.x.size(), 0.0);
  parallel_for(static_cast<int>(model_.bodies.size()), [&](int b) {
    double* stiffness = &result[outlines.offset[b]];
    for_each_force(b, model_.outlines[outlines.shape[b]].count,
                   [&](int node, int entry) { stiffness[node] += forces_.x[entry]; });
  });
  return result;
}

/// Several contacts at once act together: N of the same ratio z on one body are a ratio z sqrt(N) of their common frequency, and a lever can raise
/// the square of a contact's share by 1 + m R^2 / I.
std::vector<double> ContactSystem::damping_ratios() const {
  std::vector<double> ratio(model_.bodies.size(), 0.0);
  if (!laws_.damps()) return ratio;
  std::vector<int> contacts(model_.bodies.size(), 0);
  for (const Patch& patch : patches_) ++contacts[patch.first], ++contacts[patch.second];
  for (std::size_t b = 0; b < ratio.size(); ++b) {
    if (model_.bodies[b].rigid < 0) continue;
    const RigidBody& body = model_.rigid_bodies[model_.bodies[b].rigid];
    const double lever = body.dof[0].mass * body.dof[2].inverse_mass * body.max_radius * body.max_radius;
    ratio[b] = laws_.largest_damping_ratio(static_cast<int>(b)) * std::sqrt(std::max(1, contacts[b]) * (1 + lever));
  }
  return ratio;
}

std::vector<double> ContactSystem::nodal_damage(const Outlines& outlines, const ContactHistory& history) const {
  std::vector<double> damage(outlines.x.size(), 1.0);
  if (history.damage.empty()) return damage;
  for (const Patch& patch : patches_)
    for (int side = 0; side < 2; ++side) {
      const int body = side == 0 ? patch.first : patch.second, n = model_.outlines[outlines.shape[body]].count;
      for (int i = 0; i < patch.nodes[side].count; ++i) {
        const int node = patch.nodes[side].begin + i;
        double& least = damage[outlines.offset[body] + node - turn_of(node, n) * n];
        least = std::min(least, history.damage[patch.record[side] + i]);
      }
    }
  return damage;
}

/// Half of the two segments beside each node, as they are now.
void ContactSystem::measure_lengths(Outlines& outlines) const {
  if (model_.scene.contact.length == ContactLength::reference) return;
  outlines.tributary_length.resize(outlines.x.size());
  parallel_for(static_cast<int>(model_.bodies.size()), [&](int b) {
    const int offset = outlines.offset[b], n = model_.outlines[outlines.shape[b]].count;
    const double *x = &outlines.x[offset], *y = &outlines.y[offset];
    double* length = &outlines.tributary_length[offset];
    double before = std::hypot(x[n] - x[n - 1], y[n] - y[n - 1]);
    for (int i = 0; i < n; ++i) {
      const double after = std::hypot(x[i + 1] - x[i], y[i + 1] - y[i]);
      length[i] = 0.5 * (before + after);
      before = after;
    }
    for (int i = 0; i < lane_count; ++i) length[n + i] = length[i % n];
  });
}

}  // namespace pliant
