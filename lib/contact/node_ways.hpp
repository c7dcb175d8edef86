#pragma once

#include <vector>

#include "bodies/model.hpp"
#include "contact/broad_phase.hpp"

namespace pliant {

/// Where all outlines are, and how they came there from a reference.
struct WaysSoFar {
  const OutlineField &now, &reference;
  const std::vector<Box>& boxes;  ///< [bodies], of the ways of their nodes
};

/// Of the ways from a body's outline nodes in a reference to where they are now.
Box box_of_ways(const Model& model, int body, const OutlineField& now, const OutlineField& reference);
/// That, and the box of the nodes where they are; of a wall its y alone: copies of nodes are looked at too.
struct MotionBoxes {
  Box ways, place;
};
MotionBoxes motion_boxes(const Model& model, int body, const OutlineField& now, const OutlineField& reference);
/// How far nodes of a body have moved against each other, m.
double change_of_shape(const Box& ways);
/// Bound on the relative way of any two nodes of two bodies, m.
double relative_way(const Box& a, const Box& b);

/// How far bodies have moved since each of these entries looked at one: bounds, node by node and in all. Of small ones
/// each node's way is kept: boxes alone would add up what bodies shake and turn, from reference to reference.
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
  /// The entry looks at its body where it is now, whatever its box.
  void look(int entry, const WaysSoFar& ways);
  /// Box of the ways since then, by the boxes alone: at little cost, but blurred.
  Box rough_way(int entry, const WaysSoFar& ways) const;
  /// The same by each node, but for a share of 1e-4 of the skin; endless where nothing is known.
  Box way(int entry, const WaysSoFar& ways) const;
  /// The body's reference becomes where it is now, whatever its box.
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
  std::vector<Box> start_;  ///< [entries], ways from the reference when it looked
  // The same node by node, of small bodies: of the first, and what others have moved more. However far all drift, that
  // is little, and floats hold it.
  std::vector<Common> common_;  ///< [entries], m
  std::vector<float> x_, y_;    ///< m
  std::vector<int> at_;         ///< [entries], of the first nodes
};

}  // namespace pliant
