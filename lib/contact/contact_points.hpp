#pragma once

#include <vector>

#include "contact/contact.hpp"

namespace pliant {

/// An outline node in touch with another body.
struct ContactPoint {
  int slave = 0, master = 0;  ///< bodies: whose node it is, and whose segment it touches
  int node = 0;               ///< of the slave's outline
  double gap = 0;             ///< m, negative inside
  double slip = 0;            ///< elastic tangential displacement, m
  double pressure = 0;        ///< Pa, of the law, without its dashpot and what is repaid
  double shear = 0;           ///< Pa, on the slave along (-ny, nx)
  double damage = 0;          ///< 0 whole to 1 torn; NaN for a law without
  double length = 0;          ///< tributary length, m; each of the two passes carries half of the force
  Vec2 normal{0, 0};          ///< of the master, outward
  int side = 0;               ///< of the pair that the slave is: 0 the first; of a body and its image only this tells
  Vec2 position{0, 0};        ///< of the node where the pair's first body sees it, m
};

/// Two bodies, a body and its own periodic image, or parts of one body, in touch.
struct TouchingPair {
  int first = 0, second = 0;  ///< bodies, first <= second
  int images = 0;             ///< periods to add to x of the second to see it from the first
  std::vector<ContactPoint> points;
  bool of_itself() const { return first == second && images == 0; }  ///< parts of one body: no pair of grains

  /// Mean unit normal of the contact from the first to the second, weighted by length; zero when the normals cancel.
  Vec2 normal() const;
};

/// All pairs in touch at an accepted state, in the order of the contact pairs: the same projection and laws as in a
/// step, with the committed history. For outputs; never called in a step.
std::vector<TouchingPair> inspect_contacts(const Model& model, const ContactSystem& contact, const Outlines& outlines,
                                           const ContactHistory& history);

}  // namespace pliant
