#pragma once

#include <vector>

#include "bodies/model.hpp"
#include "bodies/outline.hpp"
#include "contact/broad_phase.hpp"
#include "contact/contact.hpp"

namespace pliant {

/// An outline node inside another body, or inside another part of its own.
struct DeepestNode {
  int slave = 0, master = 0;  ///< bodies
  int node = 0;               ///< of the slave's outline
  Vec2 position{0, 0};        ///< m
  double depth = 0;           ///< below the master's nearest segment, m
  double segment_length = 1;  ///< of that segment, m
  double squeeze = 1;         ///< that over what it was at first
  bool of_itself = false;     ///< parts of one body; master is the slave then, as with its own periodic image
};

/// The node that is deepest over the length of the segment above it, of all nodes of each pair of bodies; depth 0 when
/// none is inside. For messages.
DeepestNode deepest_node(const Model& model, const OutlineField& outlines, const std::vector<BodyPair>& pairs);

/// The same of all pairs whose candidates the contacts have, and of bodies that touch themselves: of these where
/// contact sees a node inside, as the far side of a limb is not to be told from an overlap.
DeepestNode deepest_contact(const Model& model, const Outlines& outlines, const ContactSystem& contact);

/// Throws InputError when a body starts deeper inside another than contact can see, a segment length of that other: it
/// would be let through without a force.
void refuse_deep_overlap(const Model& model, const OutlineField& outlines);

}  // namespace pliant
