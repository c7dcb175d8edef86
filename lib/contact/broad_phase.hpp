#pragma once

#include <optional>
#include <vector>

#include "bodies/model.hpp"
#include "bodies/outline_fields.hpp"

namespace pliant {

struct Box {
  double x_min, x_max, y_min, y_max;
};

/// Two bodies, or a body and its own periodic image, whose bounding boxes are closer than the margin.
struct BodyPair {
  int first, second;  ///< first <= second
  Images
      images;  ///< of the second as seen from the first; the first one that is not 0 is positive for a body's own image
  auto operator<=>(const BodyPair&) const = default;
};

Box bounding_box(const Model& model, const OutlineField& position, int body);

/// Sweep and prune on x, then y, periodic in x (docs/method.md 4, stage 1). Returns sorted pairs. Walls span all x and
/// do not meet their own images.
std::vector<BodyPair> broad_phase(const Model& model, const std::vector<Box>& boxes, double margin);

}  // namespace pliant
