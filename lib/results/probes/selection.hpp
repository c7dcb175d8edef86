#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bodies/model.hpp"

namespace pliant {

/// What a probe looks at.
struct Selection {
  std::vector<int> bodies;
  std::vector<bool> chosen, partners;  ///< [bodies of the model]; partners: whose contacts with the chosen count
  std::optional<int> node;             ///< of the only body
  std::vector<int> between;            ///< walls that bound the region: the lower, the upper; or none
  std::optional<ProbeBox> box;
};

/// Throws InputError for a node that the body does not have.
Selection select(const Model& model, const Probe& probe);

}  // namespace pliant
