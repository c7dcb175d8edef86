#include <algorithm>
#include <cmath>
#include <span>

#include "contact/contact.hpp"
#include "contact/master_window.hpp"
#include "contact/pair_queries.hpp"
#include "core/parallel.hpp"

namespace pliant {

/// Simultaneous contacts act together: N contacts of the same ratio z on one body have a ratio z sqrt(N) of their
/// common frequency. A lever can raise the square of a contact's share by 1 + m R^2 / I.
std::vector<double> ContactSystem::damping_ratios() const {
  std::vector<double> ratio(model_.bodies.size(), 0.0);
  if (!laws_.damps()) return ratio;
  std::vector<int> contacts(model_.bodies.size(), 0);
  for (const ContactPair& contact_pair : contact_pairs())
    if (!contact_pair.is_empty()) ++contacts[contact_pair.first], ++contacts[contact_pair.second];
  for (std::size_t b = 0; b < ratio.size(); ++b) {
    if (model_.bodies[b].rigid < 0) continue;
    const RigidBody& body = model_.rigid_bodies[model_.bodies[b].rigid];
    const double lever = body.dof[0].mass * body.dof[2].inverse_mass * body.max_radius * body.max_radius;
    ratio[b] = laws_.largest_damping_ratio(static_cast<int>(b)) * std::sqrt(std::max(1, contacts[b]) * (1 + lever));
  }
  return ratio;
}

std::vector<double> ContactSystem::least_internal_variable(const ContactHistory& history, std::string_view name,
                                                           double none) const {
  std::vector<double> least(static_cast<std::size_t>(model_.outline_offset.back()), none);
  for (const ContactPair& contact_pair : contact_pairs()) {
    const std::span<const InternalVariable> all = internal_variables_of(contact_pair.law);
    const auto found = std::find_if(all.begin(), all.end(), [&](const InternalVariable& r) { return r.name == name; });
    if (found == all.end()) continue;
    const int column = ContactHistory::first_of_law + static_cast<int>(found - all.begin());
    for (int side = 0; side < 2; ++side) {
      const int body = side == 0 ? contact_pair.first : contact_pair.second, n = model_.outline_of(body).count;
      for (int i = 0; i < contact_pair.nodes[side].count; ++i) {
        const int node = contact_pair.nodes[side].begin + i;
        double& value = least[model_.outline_offset[body] + node - turn_of(node, n) * n];
        value = std::min(value, history.number(contact_pair.record[side] + i, column));
      }
    }
  }
  return least;
}

}  // namespace pliant
