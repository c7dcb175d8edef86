#include "contact/pair_watch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/lanes.hpp"
#include "core/parallel.hpp"

namespace pliant {
namespace {

constexpr double extra_skins = 4;
/// Share of the skin by which a body may change its shape before its ways are counted from another place.
constexpr double blurred = 0.25;
/// Share of the skin up to which a pair need not be searched when others are; of the broad phase's likewise. Few pairs
/// move by much more than the others (docs/defaults.md).
constexpr double kept = 0.75;

Box motion_box(const OutlineField& before, const OutlineField& now, int offset, int count) {
  Lanes x_min = broadcast(1e300), x_max = -x_min, y_min = x_min, y_max = x_max;
  // The last lanes may reach into the cyclic copies, which move as their originals.
  for (int i = offset; i < offset + count; i += lane_count) {
    const Lanes dx = load(&now.x[i]) - load(&before.x[i]), dy = load(&now.y[i]) - load(&before.y[i]);
    x_min = min(x_min, dx), x_max = max(x_max, dx);
    y_min = min(y_min, dy), y_max = max(y_max, dy);
  }
  return {-largest(-x_min), largest(x_max), -largest(-y_min), largest(y_max)};
}

/// Ways from one motion to another of the same body.
Box way(const Box& from, const Box& to) {
  return {to.x_min - from.x_max, to.x_max - from.x_min, to.y_min - from.y_max, to.y_max - from.y_min};
}

/// From where nothing is known of the way.
constexpr double far_off = 1e150;
constexpr Box unknown{-far_off, far_off, -far_off, far_off}, none{0, 0, 0, 0};

/// Bound on the relative way of any two nodes of two bodies, m.
double relative_way(const Box& a, const Box& b) {
  const double dx = std::max(a.x_max - b.x_min, b.x_max - a.x_min), dy = std::max(a.y_max - b.y_min, b.y_max - a.y_min);
  return std::sqrt(dx * dx + dy * dy);
}

/// How far nodes of a body have moved against each other, m.
double change_of_shape(const Box& motion) { return std::max(motion.x_max - motion.x_min, motion.y_max - motion.y_min); }

}  // namespace

PairWatch::PairWatch(const Model& model, double skin, double reach)
    : model_(model),
      skin_(skin),
      own_skin_(0.5 * (1 + extra_skins) * skin),
      margin_(reach + (1 + extra_skins) * skin),
      motion_(model.bodies.size()) {
  forget();
}

void PairWatch::forget() {
  reference_ = {};
  pairs_.clear();
  pair_start_.clear();
  body_start_.assign(model_.bodies.size(), unknown);
}

void PairWatch::measure(const OutlineField& now) {
  parallel_for(static_cast<int>(model_.bodies.size()), [&](int b) {
    motion_[b] = motion_box(reference_, now, model_.outline_offset[b], model_.outline_of(b).count);
  });
}

double PairWatch::pair_way(int pair) const {
  const auto& [first, second] = pair_start_[pair];
  return relative_way(way(first, motion_[pairs_[pair].first]), way(second, motion_[pairs_[pair].second]));
}

double PairWatch::own_way(int body, const Box& common) const {
  Box own = way(body_start_[body], motion_[body]);
  if (model_.bodies[body].wall) own.x_min = common.x_min, own.x_max = common.x_max;
  return relative_way(own, common);
}

/// Middle of all bodies' ways: only what they move against each other can bring pairs together that the broad phase
/// left out. A wall lies in wait along all x, whatever its own way in x.
Box PairWatch::common_way() const {
  Box all{far_off, -far_off, far_off, -far_off};
  for (std::size_t b = 0; b < motion_.size(); ++b) {
    const Box own = way(body_start_[b], motion_[b]);
    all.y_min = std::min(all.y_min, own.y_min), all.y_max = std::max(all.y_max, own.y_max);
    if (model_.bodies[b].wall) continue;
    all.x_min = std::min(all.x_min, own.x_min), all.x_max = std::max(all.x_max, own.x_max);
  }
  const double x = 0.5 * (all.x_min + all.x_max), y = 0.5 * (all.y_min + all.y_max);
  return {x, x, y, y};
}

bool PairWatch::is_used_up(const OutlineField& now) {
  measure(now);
  const Box common = common_way();
  const double largest_own =
      parallel_max(static_cast<int>(motion_.size()), 0, [&](int b) { return own_way(b, common); });
  const double largest_pair = parallel_max(count(), 0, [&](int p) { return pair_way(p); });
  return largest_pair >= skin_ || largest_own >= own_skin_;
}

/// A body that has changed its shape or turned since its reference would blur the ways of all its pairs.
void PairWatch::take_new_references(const OutlineField& now) {
  std::vector<Box> gone(motion_.size(), none);  // by those with a new reference, from the old one
  for (int b = 0; b < static_cast<int>(motion_.size()); ++b) {
    if (change_of_shape(motion_[b]) < blurred * skin_) continue;
    gone[b] = motion_[b];
    for (int i = model_.outline_offset[b]; i < model_.outline_offset[b + 1]; ++i)
      reference_.x[i] = now.x[i], reference_.y[i] = now.y[i];
    body_start_[b] = way(gone[b], body_start_[b]);
    motion_[b] = none;
  }
  for (int p = 0; p < count(); ++p) {
    auto& [first, second] = pair_start_[p];
    first = way(gone[pairs_[p].first], first), second = way(gone[pairs_[p].second], second);
  }
}

bool PairWatch::update(const OutlineField& now) {
  if (reference_.x.empty()) reference_ = now;
  measure(now);
  take_new_references(now);
  const Box common = common_way();
  bool due = false;
  for (int b = 0; b < static_cast<int>(motion_.size()); ++b) due |= !(own_way(b, common) < kept * own_skin_);
  if (!due) return false;
  body_start_ = motion_;
  std::vector<Box> boxes(motion_.size());
  parallel_for(static_cast<int>(boxes.size()), [&](int b) { boxes[b] = bounding_box(model_, now, b); });
  const std::vector<BodyPair> before = std::exchange(pairs_, broad_phase(model_, boxes, margin_));
  const std::vector<std::array<Box, 2>> start = std::exchange(pair_start_, {});
  for (std::size_t old = 0; const BodyPair& pair : pairs_) {
    while (old < before.size() && before[old] < pair) ++old;
    const bool watched = old < before.size() && before[old] == pair;
    pair_start_.push_back(watched ? start[old] : std::array<Box, 2>{unknown, unknown});
  }
  return true;
}

bool PairWatch::may_keep(int pair) const { return pair_way(pair) < kept * skin_; }

void PairWatch::searched(int pair) { pair_start_[pair] = {motion_[pairs_[pair].first], motion_[pairs_[pair].second]}; }

void PairWatch::add(const BodyPair& pair) {
  pairs_.push_back(pair);
  pair_start_.push_back({motion_[pair.first], motion_[pair.second]});
}

}  // namespace pliant
