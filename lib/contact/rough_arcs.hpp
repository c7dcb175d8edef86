#pragma once

#include <vector>

#include "contact/contact_pair.hpp"

namespace pliant {

/// One body of a pair, as the search for contacts with the other sees it.
struct ContactSide {
  const OutlineShape* shape;
  const double* x;
  const double* y;
  double shift;               ///< added to x
  int first_turn, last_turn;  ///< turns of the outline to search: 0 to 0 for a closed one
  double longest_segment;

  Vec2 point(int turn, int i) const { return {x[i] + shift + turn * shape->turn_shift, y[i]}; }
};

ContactSide make_side(const Model& model, const OutlineField& outlines, int body, double shift);

/// Arcs that contain everything within the margin, by boxes and by planes across the line of centres that bound the
/// bodies.
void find_rough_arcs(const Model& model, const ContactSide& a, ContactSide& b, Box box_a, Box box_b,
                     const ContactPair& pair, double margin, Arc (&arcs)[2]);

/// Shortest cyclic arc that contains all flagged nodes of a closed outline.
Arc covering_arc(const std::vector<char>& flags);

}  // namespace pliant
