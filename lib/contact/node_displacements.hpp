#pragma once

#include <vector>

#include "bodies/model.hpp"

namespace pliant {

/// A disc that holds the displacements of all nodes of a body, m: not a box, which would tell more along some axes than
/// others.
struct DisplacementDisc {
  double x, y, radius;
};

/// Where all outlines are, and how they came there from a reference.
struct DisplacementsSoFar {
  const OutlineField &now, &reference;
  const std::vector<DisplacementDisc>& discs;  ///< [bodies], of the displacements of their nodes
};

/// Of which nothing is known.
constexpr DisplacementDisc unknown_displacement{0, 0, 1e150};

/// Of the displacements from a body's outline nodes in a reference to where they are now.
DisplacementDisc displacement_disc(const Model& model, int body, const OutlineField& now,
                                   const OutlineField& reference);
/// Displacements from one motion to another of the same body.
DisplacementDisc displacement_between(const DisplacementDisc& from, const DisplacementDisc& to);
/// How far nodes of a body have moved against each other, m.
double displacement_spread(const DisplacementDisc& displacements);
/// Bound on the relative displacement of any two nodes of two bodies, m.
double relative_displacement(const DisplacementDisc& a, const DisplacementDisc& b);

/// How far bodies have moved since each of these entries looked at one: bounds, node by node and in all. Of small ones
/// each node's displacement is kept: discs alone would add up what bodies shake and turn, from reference to reference.
class NodeDisplacements {
 public:
  explicit NodeDisplacements(const Model& model) : model_(&model) {}

  /// Entries for these bodies, of which nothing is known.
  void set_bodies(std::vector<int> bodies);
  /// The same for entries that are known, as read from a checkpoint.
  void restore_bodies(std::vector<int> bodies);
  void append(int body);
  void copy_entry(int entry, const NodeDisplacements& from, int old_entry);

  int count() const { return static_cast<int>(body_.size()); }
  int body(int entry) const { return body_[entry]; }
  /// The entry looks at its body where it is now, whatever its disc.
  void look(int entry, const DisplacementsSoFar& displacements);
  /// Disc of the displacements since then, by the discs alone: at little cost, but blurred.
  DisplacementDisc displacement_bound(int entry, const DisplacementsSoFar& displacements) const;
  /// The same by each node, but for a share of 1e-4 of the skin; endless where nothing is known.
  DisplacementDisc displacement(int entry, const DisplacementsSoFar& displacements) const;
  /// The body's reference becomes where it is now, whatever its disc.
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
  void lay_out(int first);

  const Model* model_;
  std::vector<int> body_;
  std::vector<DisplacementDisc> start_;  ///< [entries], displacements from the reference when it looked
  // The same node by node, of small bodies: of the first, and what others have moved more. However far all drift, that
  // is little, and floats hold it.
  std::vector<Common> common_;  ///< [entries], m
  std::vector<float> x_, y_;    ///< m
  std::vector<int> at_;         ///< [entries], of the first nodes
};

}  // namespace pliant
