#pragma once

#include <vector>

#include "bodies/model.hpp"
#include "bodies/outline_fields.hpp"
#include "contact/broad_phase.hpp"
#include "contact/contact.hpp"

namespace pliant {

/// Outline node inside another body, or inside another part of its own body.
struct DeepestNode {
  int slave = 0, master = 0;  ///< bodies
  int node = 0;               ///< index in the slave's outline
  Vec2 position{0, 0};        ///< m
  double depth = 0;           ///< below the master's nearest segment, m
  double segment_length = 1;  ///< of that segment, m
  double squeeze = 1;         ///< current over reference length of that segment
  bool of_itself = false;     ///< self-contact; master equals slave then, as for the body's own periodic image
};

/// Node with the largest depth over the length of its nearest segment, among all nodes of each pair of bodies; depth 0
/// if none is inside. For messages.
DeepestNode deepest_node(const Model& model, const OutlineField& outlines, const std::vector<BodyPair>& pairs);

/// Deepest node of all contact pairs, self-contact included. For self-contact only nodes count that the projection
/// finds inside, because the far side of a limb looks like an overlap.
DeepestNode deepest_contact(const Model& model, const Outlines& outlines, const ContactSystem& contact);

/// Throws InputError if a body starts deeper inside another than contact detects, a segment length of that other body.
/// Such a body would pass through without a force.
void refuse_deep_overlap(const Model& model, const OutlineField& outlines);

}  // namespace pliant
