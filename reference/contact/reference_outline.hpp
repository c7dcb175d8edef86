#pragma once

#include <cstddef>
#include <vector>

#include "reference/contact/contacts.hpp"

namespace pliant::reference {

/// An outline in its reference shape. Segments are numbered on and on, turn after turn.
class ReferenceOutline {
 public:
  explicit ReferenceOutline(const ContactOutline& outline);

  double length(int segment) const;                  ///< m
  double longest() const { return longest_; }        ///< segment, m
  bool has_corners() const { return has_corners_; }  ///< it turns to the left by more than 35 degrees at a node

 private:
  std::vector<double> length_;
  double longest_ = 0;
  bool has_corners_ = false;
};

}  // namespace pliant::reference
