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

/// The same with two periods, of bodies without walls. `lattice`: of their positions. The sweep visits the bodies in a
/// cell of shortest vectors and those of their images that are near it.
std::vector<BodyPair> broad_phase_in_cell(const std::vector<Box>& boxes, double margin, const Lattice& lattice);

/// That of the model's domain.
inline std::vector<BodyPair> broad_phase(const Model& model, const std::vector<Box>& boxes, double margin,
                                         const Lattice& lattice) {
  return model.scene.cell ? broad_phase_in_cell(boxes, margin, lattice) : broad_phase(model, boxes, margin);
}

}  // namespace pliant
