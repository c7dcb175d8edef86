#pragma once

#include <initializer_list>
#include <vector>

#include "scene/scene.hpp"

namespace pliant {

/// Values of a quantity over what it is reduced over: bodies, points or contacts.
class Samples {
 public:
  explicit Samples(std::size_t columns) : columns_(columns) {}
  void add(double weight, std::initializer_list<double> values) {
    weight_.push_back(weight);
    values_.insert(values_.end(), values);
  }
  /// [columns]. The mean is weighted, the sum is not. Without samples the sum is 0, all else NaN; a NaN spreads.
  std::vector<double> reduced(Reduction reduction) const;

 private:
  double column(std::size_t c, Reduction reduction) const;

  std::size_t columns_;
  std::vector<double> weight_, values_;
};

}  // namespace pliant
