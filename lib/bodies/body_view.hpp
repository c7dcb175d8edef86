#pragma once

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"

namespace pliant {

/// Indices of the degrees of freedom of one compliant body in Dofs::compliant, for any layout.
class BodyOffsets {
 public:
  BodyOffsets(const Model& model, const Body& body)
      : first_(model.batches[body.batch].offset * lane_count + static_cast<std::size_t>(body.lane)) {
    const Batch& batch = model.batches[body.batch];
    if (batch.layout == Layout::nodewise) offset_ = model.nodewise_shape_of(batch).offset.data();
  }
  /// Index of a node's x, counted in doubles; its y is lane_count further.
  std::size_t operator[](std::size_t node) const {
    return first_ + (offset_ ? static_cast<std::size_t>(offset_[node]) : 2 * lane_count * node);
  }

 private:
  std::size_t first_;
  const int* offset_ = nullptr;
};

/// One body's degrees of freedom in the units of storage, those of its scale.
class BodyView {
 public:
  BodyView(const Model& model, const Body& body, const Dofs& dofs)
      : offsets_(model, body), values_(reinterpret_cast<const double*>(dofs.compliant.data())) {}
  Vec2 operator[](std::size_t node) const {
    const double* x = values_ + offsets_[node];
    return {x[0], x[lane_count]};
  }

 private:
  BodyOffsets offsets_;
  const double* values_;
};

inline void set_node(const BodyOffsets& offsets, std::size_t node, const Vec2& value, Dofs& dofs) {
  double* x = reinterpret_cast<double*>(dofs.compliant.data()) + offsets[node];
  x[0] = value.x(), x[lane_count] = value.y();
}

}  // namespace pliant
