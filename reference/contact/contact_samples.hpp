#pragma once

#include <array>
#include <utility>
#include <vector>

#include "reference/contact/law.hpp"
#include "reference/contact/nearest_parts.hpp"

namespace pliant::reference {

using FourNodes =
    std::array<int, 4>;  ///< slave's first and second, master's first and second, in the list of all nodes

/// Point of a slave segment with its projection onto the master.
struct ContactSample {
  FourNodes node;
  double s = 0;       ///< along the slave's segment, in [0, 1]
  double weight = 0;  ///< share of the slave's segment; for a limit +1 or -1
  Nearby nearby;
  Projection at;
  /// For a limit: derivatives of its s by positions of nodes, 1/m; entries add up.
  std::vector<std::pair<int, Vec2>> moves;

  /// Derivatives of the six coordinates of point and segment by those of the four nodes.
  Eigen::Matrix<double, 6, 8> spread() const;
};

/// Samples of integrals over one slave segment: integral f ds = sum of weight x f over `points`. Its derivative
/// contains theirs and the sum over `limits` of weight x f x derivative of s, for limits at which an integrand jumps.
struct ContactSamples {
  std::vector<ContactSample> points, limits;
};

/// `levels`: gaps at which the law has kinks, m. The law is zero from `reach` on.
struct Sampling {
  const PresentOutline& slave;
  const PresentOutline& master;
  Vec2 shift;        ///< of the master relative to its own nodes, m
  int first, count;  ///< segments of the master to be searched
  std::vector<double> levels;
  double reach;
};
ContactSamples sample_contact(const Sampling& of, int segment);

}  // namespace pliant::reference
