#pragma once

#include <vector>

namespace pliant {

/// Contact history, one record a slave node and other body (METHOD 4): committed on accepted steps only.
struct ContactHistory {
  std::vector<double>
      place;  ///< on the master's outline at the last accepted step, see slip.hpp; NaN when not beside it
  std::vector<double> slip;     ///< elastic tangential displacement then, m
  std::vector<double> damage;   ///< of the bond, 1: none is left; empty when no law damages
  std::vector<double> opening;  ///< max(gap, 0) of the bond then, m; empty likewise

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("place", place), visitor("slip", slip);
    visitor("damage", damage), visitor("opening", opening);
  }

  struct Array {
    std::vector<double> ContactHistory::* values;
    double of_strangers;  ///< of nodes that were not near before
  };
  static const Array arrays[4];
};

}  // namespace pliant
