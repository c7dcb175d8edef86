#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace pliant {

/// Nodes of a long outline sorted into strips across x, at least as wide as its longest segment. Queries near a point
/// visit only some of the nodes. Strips of a wall wrap around the period.
class NodeStrips {
 public:
  /// x [count + 1]: ends of the segments, m. period 0: not periodic.
  NodeStrips(const double* x, int count, double longest_segment, double period)
      : period_(period), x_min_(period > 0 ? 0.0 : *std::min_element(x, x + count)) {
    const double extent = period > 0 ? period : *std::max_element(x, x + count) - x_min_;
    const double most = longest_segment > 0 ? extent / longest_segment : 1.0;
    strips_ = most > 1 ? static_cast<int>(std::min(most, 1.0 * count)) : 1;
    width_ = extent / strips_;
    begin_.assign(static_cast<std::size_t>(strips_) + 1, 0);
    nodes_.resize(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) ++begin_[strip_of(x[i]) + 1];
    for (int s = 0; s < strips_; ++s) begin_[s + 1] += begin_[s];
    std::vector<int> next(begin_.begin(), begin_.end() - 1);
    for (int i = 0; i < count; ++i) nodes_[next[strip_of(x[i])]++] = i;
  }

  /// Visits nodes strip by strip from x on in both directions, until no further node, and no segment that begins at
  /// one, can be closer than limit(), m. The limit may decrease during the search.
  template <class Visit, class Limit>
  void from(double x, Visit&& visit, Limit&& limit) const {
    const int middle = strip_of(x);
    visit_strip(middle, visit);
    const int last = period_ > 0 ? strips_ / 2 : std::max(middle, strips_ - 1 - middle);
    // Nodes may be one strip width closer than their strip's number suggests, and segments reach back by another.
    for (int d = 1; d <= last && (d - 2) * width_ <= limit(); ++d) {
      if (period_ > 0 || middle - d >= 0) visit_strip(middle - d, visit);
      const bool same = period_ > 0 && 2 * d == strips_;
      if (!same && (period_ > 0 || middle + d < strips_)) visit_strip(middle + d, visit);
    }
  }

  /// Visits all nodes of the strips that cover [x_min, x_max].
  template <class Visit>
  void between(double x_min, double x_max, Visit&& visit) const {
    if (period_ > 0 && !(x_max - x_min < period_ - width_)) {
      for (int s = 0; s < strips_; ++s) visit_strip(s, visit);
      return;
    }
    const int first = strip_of(x_min), last = strip_of(x_max);
    for (int s = first; s <= (last < first ? last + strips_ : last); ++s) visit_strip(s, visit);
  }

 private:
  /// Strip in [0, strips), for any x.
  int strip_of(double x) const {
    const double off = period_ > 0 ? x - period_ * std::floor(x / period_) : x - x_min_;
    const double strip = off / width_;
    return strip >= 0 ? static_cast<int>(std::min(strip, strips_ - 1.0)) : 0;
  }
  template <class Visit>
  void visit_strip(int strip, Visit&& visit) const {
    const int s = (strip + strips_) % strips_;
    for (int i = begin_[s]; i < begin_[s + 1]; ++i) visit(nodes_[i]);
  }

  double period_, x_min_, width_ = 0;
  int strips_ = 1;
  std::vector<int> begin_;  ///< [strips + 1], in nodes_
  std::vector<int> nodes_;
};

}  // namespace pliant
