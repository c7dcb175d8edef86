#pragma once

#include <vector>

#include "contact/contact.hpp"

namespace pliant {

/// Outline node in contact with another body.
struct ContactPoint {
  int slave = 0, master = 0;  ///< bodies: owner of the node, and owner of the segment it touches
  int node = 0;               ///< index in the slave's outline
  double gap = 0;             ///< m, negative inside
  double slip = 0;            ///< elastic tangential displacement, m
  double pressure = 0;        ///< Pa, of the law, without dashpot and energy correction
  double shear = 0;           ///< Pa, on the slave along (-ny, nx)
  double length = 0;          ///< tributary length, m; each half pass carries half of the force
  Vec2 normal{0, 0};          ///< outward normal of the master
  int side = 0;               ///< side of the slave in the pair: 0 the first; tells a body from its own image
  Vec2 position{0, 0};        ///< of the node as seen from the pair's first body, m
};

/// Two bodies, a body and its own periodic image, or parts of one body, in contact.
struct TouchingPair {
  int first = 0, second = 0;  ///< bodies, first <= second
  Images images;              ///< of the second body as seen from the first
  std::vector<ContactPoint> points;
  bool of_itself() const { return first == second && images == Images{}; }  ///< self-contact: no pair of grains

  /// Mean unit normal of the contact from the first to the second body, weighted by length; zero when the normals
  /// cancel.
  Vec2 normal() const;
};

/// All active contact pairs at an accepted state, in the order of the contact pairs. Projection and laws are those of a
/// step, with the committed history. For outputs; never called in a step.
std::vector<TouchingPair> inspect_contacts(const Model& model, const ContactSystem& contact, const Outlines& outlines,
                                           const ContactHistory& history);

}  // namespace pliant
