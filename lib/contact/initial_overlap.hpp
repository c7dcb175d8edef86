#pragma once

#include <string>

#include "contact/contact.hpp"

namespace pliant {

/// How far bodies reach into each other at the start of a run: only penetration counts, not cohesion at a gap.
struct InitialOverlap {
  int pairs = 0;              ///< of bodies that overlap
  int first = 0, second = 0;  ///< the pair with the largest depth
  double depth = 0;           ///< of a node below the other outline, m
  double share = 0;           ///< the depth over the longest segment near, as PairTotals::deepest
  double stored = 0;          ///< energy of compression in all overlapping contacts, J/m
  double separation = 0;      ///< by which the deepest pair must move apart to be free of overlap, m
  double growth = 1;          ///< of the pitch of lattices, by which their own grains are free of overlap
};

/// Of the contact pairs at these outlines.
InitialOverlap initial_overlap(const Model& model, const ContactSystem& contact, const Outlines& outlines);

/// What undoes it, in words.
std::string remedy(const InitialOverlap& overlap, const Model& model);

/// How much of it there is and what to do, in words; empty without any.
std::string describe(const InitialOverlap& overlap, const Model& model);

}  // namespace pliant
