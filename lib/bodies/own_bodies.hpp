#pragma once

#include <numeric>

#include "bodies/model.hpp"

namespace pliant {

/// All bodies of a model.
inline OwnBodies all_bodies(const Model& model) {
  const auto numbers = [](std::size_t count) {
    std::vector<int> all(count);
    std::iota(all.begin(), all.end(), 0);
    return all;
  };
  return {numbers(model.batches.size()), model.lane_batches, numbers(model.regions.size()),
          numbers(model.rigid_bodies.size()), numbers(model.bodies.size())};
}

}  // namespace pliant
