#pragma once

#include <cstddef>
#include <vector>

#include "reference/contact/contacts.hpp"

namespace pliant::reference {

/// Outline in its reference shape. Segments are numbered on over all turns.
class ReferenceOutline {
 public:
  explicit ReferenceOutline(const ContactOutline& outline);

  double length(int segment) const;                  ///< m
  double longest() const { return longest_; }        ///< longest segment, m
  bool has_corners() const { return has_corners_; }  ///< whether it turns left by more than 35 degrees at a node

 private:
  std::vector<double> length_;
  double longest_ = 0;
  bool has_corners_ = false;
};

}  // namespace pliant::reference
