#pragma once

#include <vector>

#include "geometry/mesh.hpp"
#include "results/point_states.hpp"
#include "results/snapshot.hpp"
#include "scene/quantities.hpp"

namespace pliant {

/// One body while a frame is written.
class FramedBody {
 public:
  FramedBody(const Snapshot& snapshot, int index, const FieldMesh& mesh)
      : snapshot(snapshot), index(index), body(snapshot.model().bodies[index]), mesh(mesh) {}
  /// Integration points of a compliant body, found when first asked for.
  const std::vector<PointState>& points();

  const Snapshot& snapshot;
  int index;
  const Body& body;
  const FieldMesh& mesh;  ///< of the body's shape

 private:
  std::vector<PointState> points_;
};

/// A value that stays with a body.
using ConstantField = float (*)(const Body& body);
/// Appends one body's values of a field on the grid of the bodies: [nodes x components] or [triangles].
using BodyField = void (*)(FramedBody& frame, std::vector<float>& values);
/// Values at all outline nodes, [nodes and copies] as in OutlineField.
using OutlineFunction = std::vector<double> (*)(const Snapshot& snapshot);

/// The functions of scene/quantities.hpp's fields. Throw std::logic_error for a field without one.
ConstantField constant_field(const std::string& name);
BodyField body_field(const std::string& name);
OutlineFunction outline_field(const std::string& name);

}  // namespace pliant
