#include "contact/pair_watch.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
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

/// Of the ways of an outline's nodes, eight at once from node i on. The last lanes may reach into the cyclic copies,
/// which move as their originals.
template <class Ways>
Box box_of(int count, Ways&& ways) {
  Lanes x_min = broadcast(1e300), x_max = -x_min, y_min = x_min, y_max = x_max;
  for (int i = 0; i < count; i += lane_count) {
    const auto [dx, dy] = ways(i);
    x_min = min(x_min, dx), x_max = max(x_max, dx);
    y_min = min(y_min, dy), y_max = max(y_max, dy);
  }
  return {-largest(-x_min), largest(x_max), -largest(-y_min), largest(y_max)};
}

using Floats = float __attribute__((vector_size(4 * lane_count)));

Lanes load_ways(const float* from) {
  Floats value;
  std::memcpy(&value, from, sizeof value);
  return __builtin_convertvector(value, Lanes);
}

void store_ways(float* to, Lanes value) {
  const Floats rounded_ways = __builtin_convertvector(value, Floats);
  std::memcpy(to, &rounded_ways, sizeof rounded_ways);
}

/// Ways from one motion to another of the same body.
Box way(const Box& from, const Box& to) {
  return {to.x_min - from.x_max, to.x_max - from.x_min, to.y_min - from.y_max, to.y_max - from.y_min};
}

/// Outline nodes up to which bodies' ways are kept node by node, for each of their pairs.
constexpr int small_outline = 512;
/// Rounding of ways that are kept, of some skins, over the skin, many times over.
constexpr double rounded = 1e-4;

/// From where nothing is known of the way.
constexpr double far_off = 1e150;
constexpr Box unknown{-far_off, far_off, -far_off, far_off}, none{0, 0, 0, 0};
/// New references move a box that is not known by little.
bool is_known(const Box& box) { return box.x_min > 0.5 * unknown.x_min; }

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
  ways_x_.clear(), ways_y_.clear(), ways_at_.clear();
  body_start_.assign(model_.bodies.size(), unknown);
}

void PairWatch::measure(const OutlineField& now) {
  parallel_for(static_cast<int>(model_.bodies.size()), [&](int b) {
    motion_[b] = box_of(model_.outline_of(b).count, [&](int i) {
      const int node = model_.outline_offset[b] + i;
      return std::pair(load(&now.x[node]) - load(&reference_.x[node]), load(&now.y[node]) - load(&reference_.y[node]));
    });
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

/// Boxes tell at little cost that most pairs do; of others each node's own way counts.
bool PairWatch::stays_within(int pair, double limit, const OutlineField& now) const {
  if (pair_way(pair) < limit) return true;
  if (!is_known(pair_start_[pair][0])) return false;
  return relative_way(way_of_side(pair, 0, now), way_of_side(pair, 1, now)) < (1 - rounded) * limit;
}

bool PairWatch::keeps_ways(int pair, int side) const {
  return model_.outline_of(body(pair, side)).count <= small_outline;
}

/// Of a body's nodes since the pair was searched.
Box PairWatch::way_of_side(int pair, int side, const OutlineField& now) const {
  const int b = body(pair, side);
  if (!keeps_ways(pair, side)) return way(pair_start_[pair][side], motion_[b]);
  return box_of(model_.outline_of(b).count, [&](int i) {
    const int node = model_.outline_offset[b] + i, kept_at = ways_at_[pair][side] + i;
    return std::pair(load(&now.x[node]) - load(&reference_.x[node]) - load_ways(&ways_x_[kept_at]),
                     load(&now.y[node]) - load(&reference_.y[node]) - load_ways(&ways_y_[kept_at]));
  });
}

bool PairWatch::is_used_up(const OutlineField& now) {
  measure(now);
  const Box common = common_way();
  const double largest_own =
      parallel_max(static_cast<int>(motion_.size()), 0, [&](int b) { return own_way(b, common); });
  if (largest_own >= own_skin_) return true;
  return parallel_max(count(), 0, [&](int p) { return stays_within(p, skin_, now) ? 0.0 : 1.0; }) > 0;
}

/// The body has a new reference, where it is now: ways from the old one become ways from there.
void PairWatch::shift(int pair, int side, const OutlineField& now) {
  Box& start = pair_start_[pair][side];
  const int b = body(pair, side);
  if (!is_known(start)) return;
  if (!keeps_ways(pair, side)) {
    start = way(motion_[b], start);
    return;
  }
  start = box_of(model_.outline_of(b).count, [&](int i) {
    const int node = model_.outline_offset[b] + i, kept_at = ways_at_[pair][side] + i;
    const Lanes x = load_ways(&ways_x_[kept_at]) - (load(&now.x[node]) - load(&reference_.x[node])),
                y = load_ways(&ways_y_[kept_at]) - (load(&now.y[node]) - load(&reference_.y[node]));
    store_ways(&ways_x_[kept_at], x), store_ways(&ways_y_[kept_at], y);
    return std::pair(x, y);
  });
}

/// A body that has changed its shape or turned since its reference would blur the ways of all its pairs.
void PairWatch::take_new_references(const OutlineField& now) {
  const auto is_due = [&](int b) { return change_of_shape(motion_[b]) >= blurred * skin_; };
  parallel_for(count(), [&](int p) {
    for (int side = 0; side < 2; ++side)
      if (is_due(body(p, side))) shift(p, side, now);
  });
  parallel_for(static_cast<int>(motion_.size()), [&](int b) {
    if (!is_due(b)) return;
    const int first = model_.outline_offset[b], nodes = model_.outline_offset[b + 1] - first;
    std::copy_n(&now.x[first], nodes, &reference_.x[first]);
    std::copy_n(&now.y[first], nodes, &reference_.y[first]);
    body_start_[b] = way(motion_[b], body_start_[b]);
    motion_[b] = none;
  });
}

/// Room for the ways of all pairs from one on.
void PairWatch::lay_out(std::size_t first) {
  ways_at_.resize(pairs_.size());
  std::size_t at = first == 0 ? 0 : ways_x_.size();
  for (std::size_t p = first; p < pairs_.size(); ++p)
    for (int side = 0; side < 2; ++side) {
      ways_at_[p][side] = static_cast<int>(at);
      const int pair = static_cast<int>(p);
      if (keeps_ways(pair, side)) at += static_cast<std::size_t>(padded(model_.outline_of(body(pair, side)).count));
    }
  ways_x_.resize(at), ways_y_.resize(at);
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
  follow(broad_phase(model_, boxes, margin_));
  return true;
}

/// What is known of pairs that were watched before stays known.
void PairWatch::follow(std::vector<BodyPair> found) {
  const std::vector<BodyPair> before = std::exchange(pairs_, std::move(found));
  const auto start = std::exchange(pair_start_, std::vector(pairs_.size(), std::array<Box, 2>{unknown, unknown}));
  const std::vector<float> x = std::exchange(ways_x_, {}), y = std::exchange(ways_y_, {});
  const std::vector<std::array<int, 2>> at = std::exchange(ways_at_, {});
  lay_out(0);
  std::size_t old = 0;
  for (int p = 0; p < count(); ++p) {
    while (old < before.size() && before[old] < pairs_[p]) ++old;
    if (old == before.size() || before[old] != pairs_[p]) continue;
    pair_start_[p] = start[old];
    for (int side = 0; side < 2; ++side) {
      if (!keeps_ways(p, side)) continue;
      const int nodes = padded(model_.outline_of(body(p, side)).count);
      std::copy_n(&x[at[old][side]], nodes, &ways_x_[ways_at_[p][side]]);
      std::copy_n(&y[at[old][side]], nodes, &ways_y_[ways_at_[p][side]]);
    }
  }
}

std::vector<int> PairWatch::used_up(const OutlineField& now) const {
  std::vector<char> stays(pairs_.size());
  parallel_for(count(), [&](int p) { stays[p] = stays_within(p, kept * skin_, now); });
  std::vector<int> result;
  for (int p = 0; p < count(); ++p)
    if (!stays[p]) result.push_back(p);
  return result;
}

void PairWatch::searched(int pair, const OutlineField& now) {
  for (int side = 0; side < 2; ++side) {
    const int b = body(pair, side);
    pair_start_[pair][side] = motion_[b];
    if (!keeps_ways(pair, side)) continue;
    for (int i = 0; i < model_.outline_of(b).count; i += lane_count) {
      const int node = model_.outline_offset[b] + i, kept_at = ways_at_[pair][side] + i;
      store_ways(&ways_x_[kept_at], load(&now.x[node]) - load(&reference_.x[node]));
      store_ways(&ways_y_[kept_at], load(&now.y[node]) - load(&reference_.y[node]));
    }
  }
}

void PairWatch::add(const BodyPair& pair, const OutlineField& now) {
  pairs_.push_back(pair);
  pair_start_.push_back({unknown, unknown});
  lay_out(pairs_.size() - 1);
  searched(count() - 1, now);
}

}  // namespace pliant
