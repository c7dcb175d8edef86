#pragma once

#include <algorithm>
#include <vector>

#include "bodies/model.hpp"

namespace pliant {

/// Positions relative to the body's first node: rounding then depends on a body's size, not on its displacement.
inline std::vector<Lanes> from_first_node(const Batch& batch, const Lanes* position) {
  std::vector<Lanes> result(position, position + 2 * static_cast<std::size_t>(batch.slots));
  for (std::size_t c = 0; c < 2; ++c) {
    const Lanes first = batch.layout == Layout::nodewise ? broadcast(position[c][0]) : position[c];
    for (std::size_t i = c; i < result.size(); i += 2) result[i] -= first;
  }
  return result;
}

/// Corotational frame of each body of a batch: its x axis points from the body's first node to the one that is farthest
/// from it in the reference shape. Power iterations keep their vectors in it, because two iterations per update would
/// not follow a spinning body.
struct BodyFrame {
  Lanes cosine, sine;

  BodyFrame(const Model& model, const Batch& batch, const Lanes* position) {
    const Points& reference = model.shape_of(batch).space.mesh.nodes;
    const auto farthest = std::max_element(reference.begin(), reference.end(), [&](const Vec2& a, const Vec2& b) {
      return (a - reference[0]).squaredNorm() < (b - reference[0]).squaredNorm();
    });
    const auto node = static_cast<std::size_t>(farthest - reference.begin());
    Lanes x, y;
    if (batch.layout == Layout::nodewise) {
      const auto& offset = model.nodewise_shape_of(batch).offset;
      const auto* entries = reinterpret_cast<const double*>(position);
      const auto along = [&](int c) {
        return broadcast(entries[offset[node] + c * lane_count] - entries[offset[0] + c * lane_count]);
      };
      x = along(0), y = along(1);
    } else {
      x = position[2 * node] - position[0], y = position[2 * node + 1] - position[1];
    }
    const Lanes length = sqrt(x * x + y * y);
    cosine = x / length, sine = y / length;
  }

  void into_space(const Batch& batch, Lanes* u) const { turn(batch, u, sine); }
  void into_body(const Batch& batch, Lanes* u) const { turn(batch, u, -sine); }

 private:
  void turn(const Batch& batch, Lanes* u, Lanes s) const {
    for (int i = 0; i < batch.slots; ++i) {
      const Lanes x = u[2 * i], y = u[2 * i + 1];
      u[2 * i] = cosine * x - s * y, u[2 * i + 1] = s * x + cosine * y;
    }
  }
};

}  // namespace pliant
