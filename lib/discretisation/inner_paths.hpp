#pragma once

#include "core/vec2.hpp"
#include "geometry/outline_search.hpp"

namespace pliant {

/// Shortest paths between points of a body that stay inside it. Its outline is one closed polygon; paths are straight
/// or bent at re-entrant corners. They are unique, and their lengths depend continuously on both ends, unlike a
/// visibility criterion. Method: the triangles of the outline's corners form a tree, from which the triangles between
/// both ends follow. In these the funnel algorithm (Lee and Preparata, Networks 14 (1984) 393, doi
/// 10.1002/net.3230140304) finds the path.
class InnerPaths {
 public:
  /// `outline`: counter-clockwise, in lengths of about its spacing. Corners of less than 1e-9 rad are ignored.
  explicit InnerPaths(const Points& outline);

  /// Whether all paths are straight.
  bool convex() const { return triangles_.empty(); }

  /// Distance of x to the outline, or `at_most` where it is larger: paths of at most that length are straight there.
  double room(const Vec2& x, double at_most) const { return search_.distance(x, at_most); }

  /// The triangle that contains x, or the closest one for a point outside.
  int triangle_at(const Vec2& x) const;

  /// Path from one point to another, each with its triangle, as a vector: in the direction of the first leg, with the
  /// length of all legs. `to - from` itself if the path is straight; else to 1e-12.
  Vec2 way(const Vec2& from, int first, const Vec2& to, int last) const;

 private:
  struct Portal {
    Vec2 left, right;  ///< as seen along the path
  };
  std::vector<Portal> portals(int first, int last) const;
  void hang_up();

  OutlineSearch search_;
  Points corners_;
  std::vector<Triangle> triangles_;  ///< none: convex
  /// [triangles] tree; the root is its own parent. Edge k from corner k to the next is the one to the parent.
  std::vector<int> parent_, edge_, depth_;
};

}  // namespace pliant
