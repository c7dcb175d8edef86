#pragma once

#include <vector>

#include "bodies/model.hpp"
#include "core/lanes.hpp"

namespace pliant {

/// Disc that contains the displacements of all nodes of a body, m. A box would be tighter along some axes than along
/// others.
struct DisplacementDisc {
  double x, y, radius;
};

/// Positions of all outlines, now and in a reference, with bounds of the displacements between them.
struct DisplacementsSoFar {
  const OutlineField &now, &reference;
  const std::vector<DisplacementDisc>& discs;  ///< [bodies] of their nodes' displacements
};

/// Disc of an unknown displacement.
constexpr DisplacementDisc unknown_displacement{0, 0, 1e150};

/// Disc of the displacements of a body's outline nodes from a reference to their present positions.
DisplacementDisc displacement_disc(const Model& model, int body, const OutlineField& now,
                                   const OutlineField& reference);
/// Disc of the displacements from one configuration to another of the same body.
DisplacementDisc displacement_between(const DisplacementDisc& from, const DisplacementDisc& to);
/// Bound on the relative displacement of any two nodes of a body, m.
double displacement_diameter(const DisplacementDisc& displacements);
/// Bound on the relative displacement of any two nodes of two bodies, m.
double relative_displacement(const DisplacementDisc& a, const DisplacementDisc& b);

/// Displacements of bodies since each entry was set: bounds for the whole body and values node by node. Of small bodies
/// each node's displacement is stored. Discs alone would accumulate vibration and rotation from reference to reference.
class NodeDisplacements {
 public:
  explicit NodeDisplacements(const Model& model) : model_(&model) {}

  /// Creates entries of unknown displacement for these bodies.
  void set_bodies(std::vector<int> bodies);
  /// Restores the bodies of entries that were read from a checkpoint.
  void restore_bodies(std::vector<int> bodies);
  void append(int body);
  void copy_entry(int entry, const NodeDisplacements& from, int old_entry);

  int count() const { return static_cast<int>(body_.size()); }
  int body(int entry) const { return body_[entry]; }
  /// Counts the entry's displacements from the body's present position on. The body's disc is not used.
  void set_reference(int entry, const DisplacementsSoFar& displacements);
  /// Disc of the displacements since set_reference(), from the discs alone: cheap, but an overestimate.
  DisplacementDisc displacement_bound(int entry, const DisplacementsSoFar& displacements) const;
  /// The same node by node, up to 1e-4 of the skin; unbounded if unknown. Large outlines have displacement_bound()
  /// only.
  DisplacementDisc displacement(int entry, const DisplacementsSoFar& displacements) const;
  /// Changes the body's reference to its present position. The body's disc is not used.
  void reset_reference(int entry, const DisplacementsSoFar& displacements);

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("start", start_), visitor("common", common_), visitor("x", x_), visitor("y", y_);
  }

 private:
  struct Common {
    double x, y;
  };
  Common displacement_of_first(int body, const DisplacementsSoFar& displacements) const;
  bool keeps_nodes(int entry) const;
  int room(int entry) const;
  std::size_t assign_places();

  const Model* model_;
  std::vector<int> body_;
  std::vector<DisplacementDisc> start_;  ///< [entries] displacements from the reference at set_reference()
  // The same node by node, for small bodies: that of the first node, and those of the others relative to it. These
  // remain small however far all nodes drift, so that floats suffice.
  std::vector<Common> common_;                      ///< [entries], m
  std::vector<float, LineAllocator<float>> x_, y_;  ///< m
  std::vector<int> at_;                             ///< [entries] index of the first nodes
};

}  // namespace pliant
