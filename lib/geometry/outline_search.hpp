#pragma once

#include "core/vec2.hpp"

namespace pliant {

/// is_inside and distance_to_outline of one polygon for many points: the same values without a test of every edge.
class OutlineSearch {
 public:
  explicit OutlineSearch(const Points& polygon);

  bool is_inside(const Vec2& x) const;
  /// Distance to the outline, or `at_most` if it is larger: the search far from the outline then ends at once.
  double distance(const Vec2& x, double at_most = 1e150) const;

 private:
  /// Bounds of the edges [first, last): the halves of node n are nodes 2n + 1 and 2n + 2.
  struct Box {
    Vec2 low, high;
  };
  int strip_of(double y) const;
  void bound(std::size_t box, std::size_t first, std::size_t last);
  void search(std::size_t box, std::size_t first, std::size_t last, const Vec2& x, double& least) const;

  Points polygon_;
  double bottom_ = 0, strips_per_length_ = 0;
  std::vector<std::vector<int>> strips_;  ///< edges that extend into each strip of y
  std::vector<Box> boxes_;
};

}  // namespace pliant
