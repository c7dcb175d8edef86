#include "results/probes/samples.hpp"

#include <cmath>
#include <limits>

namespace pliant {

std::vector<double> Samples::reduced(Reduction reduction) const {
  std::vector<double> row;
  for (std::size_t c = 0; c < columns_; ++c) row.push_back(column(c, reduction));
  return row;
}

double Samples::column(std::size_t c, Reduction reduction) const {
  double weighted = 0, weights = 0, sum = 0;
  double least = std::numeric_limits<double>::infinity(), largest = -least;
  for (std::size_t i = 0; i < weight_.size(); ++i) {
    const double value = values_[i * columns_ + c];
    if (std::isnan(value)) return value;  // whatever is asked for, and not to be compared
    weighted += weight_[i] * value;
    weights += weight_[i];
    sum += value;
    least = value < least ? value : least;
    largest = value > largest ? value : largest;
  }
  if (reduction == Reduction::sum) return sum;
  if (weight_.empty()) return std::numeric_limits<double>::quiet_NaN();
  return reduction == Reduction::mean ? weighted / weights : reduction == Reduction::min ? least : largest;
}

}  // namespace pliant
