#pragma once

#include <array>
#include <utility>
#include <vector>

#include "reference/contact/law.hpp"
#include "reference/contact/nearest_parts.hpp"

namespace pliant::reference {

using FourNodes = std::array<int, 4>;  ///< slave's first and second, master's first and second: in the list of all

/// A point of a slave's segment against its place on the master.
struct ContactSample {
  FourNodes node;
  double s = 0;       ///< along the slave's segment, in [0, 1]
  double weight = 0;  ///< share of the slave's segment; of a limit +1 or -1
  Nearby nearby;
  Projection at;
  /// Of a limit: derivatives of its s by places of nodes, 1/m; sums.
  std::vector<std::pair<int, Vec2>> moves;

  /// The six coordinates of point and segment by those of the four nodes.
  Eigen::Matrix<double, 6, 8> spread() const;
};

/// What integrals over one stretch are made of: integral f ds = sum of weight x f over `points`. Its derivative has,
/// beside theirs, the sum over `limits` of weight x f x derivative of s: of those at which an integrand jumps.
struct ContactSamples {
  std::vector<ContactSample> points, limits;
};

/// `levels`: gaps at which the law has kinks, m. Nothing from `reach` on.
struct Sampling {
  const PresentOutline& slave;
  const PresentOutline& master;
  Vec2 shift;        ///< of the master against its own nodes, m
  int first, count;  ///< segments of the master that are looked at
  std::vector<double> levels;
  double reach;
};
ContactSamples sample_contact(const Sampling& of, int segment);

}  // namespace pliant::reference
