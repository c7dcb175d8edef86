#pragma once

#include <vector>

#include "bodies/model.hpp"

namespace pliant {

/// A disc that holds the ways of all nodes of a body, m: not a box, which would tell more along some axes than others.
struct WayDisc {
  double x, y, radius;
};

/// Where all outlines are, and how they came there from a reference.
struct WaysSoFar {
  const OutlineField &now, &reference;
  const std::vector<WayDisc>& discs;  ///< [bodies], of the ways of their nodes
};

/// Of which nothing is known.
constexpr WayDisc unknown_way{0, 0, 1e150};

/// Of the ways from a body's outline nodes in a reference to where they are now.
WayDisc disc_of_ways(const Model& model, int body, const OutlineField& now, const OutlineField& reference);
/// Ways from one motion to another of the same body.
WayDisc way_between(const WayDisc& from, const WayDisc& to);
/// How far nodes of a body have moved against each other, m.
double change_of_shape(const WayDisc& ways);
/// Bound on the relative way of any two nodes of two bodies, m.
double relative_way(const WayDisc& a, const WayDisc& b);

/// How far bodies have moved since each of these entries looked at one: bounds, node by node and in all. Of small ones
/// each node's way is kept: discs alone would add up what bodies shake and turn, from reference to reference.
class NodeWays {
 public:
  explicit NodeWays(const Model& model) : model_(&model) {}

  /// Entries for these bodies, of which nothing is known.
  void set_bodies(std::vector<int> bodies);
  /// The same for entries that are known, as read from a checkpoint.
  void restore_bodies(std::vector<int> bodies);
  void append(int body);
  void copy_entry(int entry, const NodeWays& from, int old_entry);

  int count() const { return static_cast<int>(body_.size()); }
  int body(int entry) const { return body_[entry]; }
  /// The entry looks at its body where it is now, whatever its disc.
  void look(int entry, const WaysSoFar& ways);
  /// Disc of the ways since then, by the discs alone: at little cost, but blurred.
  WayDisc rough_way(int entry, const WaysSoFar& ways) const;
  /// The same by each node, but for a share of 1e-4 of the skin; endless where nothing is known.
  WayDisc way(int entry, const WaysSoFar& ways) const;
  /// The body's reference becomes where it is now, whatever its disc.
  void take_new_reference(int entry, const WaysSoFar& ways);

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("start", start_), visitor("common", common_), visitor("x", x_), visitor("y", y_);
  }

 private:
  struct Common {
    double x, y;
  };
  Common way_of_first(int body, const WaysSoFar& ways) const;
  bool keeps_nodes(int entry) const;
  void lay_out(int first);

  const Model* model_;
  std::vector<int> body_;
  std::vector<WayDisc> start_;  ///< [entries], ways from the reference when it looked
  // The same node by node, of small bodies: of the first, and what others have moved more. However far all drift, that
  // is little, and floats hold it.
  std::vector<Common> common_;  ///< [entries], m
  std::vector<float> x_, y_;    ///< m
  std::vector<int> at_;         ///< [entries], of the first nodes
};

}  // namespace pliant
