#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "reference/contact/law.hpp"

namespace pliant::reference {

/// Contact laws between bodies, with all values that the scene leaves open (docs/method.md 4).
class PairLaws {
 public:
  /// Throws like Contacts.
  PairLaws(const Scene& scene, const std::vector<ContactOutline>& outlines);

  /// Law between two bodies; of a body with itself: with its periodic images.
  const std::optional<Law>& between(int a, int b) const { return laws_[a * bodies_ + b]; }

 private:
  int bodies_ = 0;
  std::vector<std::optional<Law>> laws_;  ///< [bodies x bodies]
};

/// Half of the two segments at each node of the reference outline, m.
std::vector<double> tributary_lengths(const ContactOutline& outline);
/// Mean length of the reference outline's segments, m.
double mean_spacing(const ContactOutline& outline);

}  // namespace pliant::reference
