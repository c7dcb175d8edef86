#include "reference/contact/reference_outline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pliant::reference {
namespace {

constexpr double corner_turn = 35 * std::numbers::pi / 180;

}  // namespace

ReferenceOutline::ReferenceOutline(const ContactOutline& outline) {
  const int n = outline.count;
  const auto edge = [&](int i) {
    const int to = (i + 1) % n;
    return Vec2(outline.reference[to] + Vec2(to == 0 ? outline.turn_shift : 0, 0) - outline.reference[i]);
  };
  for (int i = 0; i < n; ++i) {
    const Vec2 before = edge((i + n - 1) % n), after = edge(i);
    has_corners_ |= std::atan2(pliant::cross(before, after), before.dot(after)) > corner_turn;
    length_.push_back(after.norm());
  }
  longest_ = *std::max_element(length_.begin(), length_.end());
}

double ReferenceOutline::length(int segment) const {
  const int n = static_cast<int>(length_.size());
  return length_[static_cast<std::size_t>(((segment % n) + n) % n)];
}

}  // namespace pliant::reference
