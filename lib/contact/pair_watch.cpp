#include "contact/pair_watch.hpp"

#include <algorithm>
#include <cmath>

#include "core/lanes.hpp"
#include "core/parallel.hpp"

namespace pliant {
namespace {

constexpr double extra_skins = 4;
/// Share of the skin up to which a pair need not be searched when others are; of the broad phase's likewise. Few pairs
/// move by much more than the others (docs/defaults.md).
constexpr double kept = 0.5;

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

/// Bound on the relative motion of any two nodes of two bodies, m.
double relative_motion(const Box& a, const Box& b) {
  const double dx = std::max(a.x_max - b.x_min, b.x_max - a.x_min), dy = std::max(a.y_max - b.y_min, b.y_max - a.y_min);
  return std::sqrt(dx * dx + dy * dy);
}

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
  pairs_.clear();
  pair_moved_.clear();
  body_moved_.assign(model_.bodies.size(), unknown);
}

void PairWatch::measure(const OutlineField& from, const OutlineField& to) {
  parallel_for(static_cast<int>(model_.bodies.size()),
               [&](int b) { motion_[b] = motion_box(from, to, model_.outline_offset[b], model_.outline_of(b).count); });
}

double PairWatch::pair_motion(int pair) const {
  return pair_moved_[pair] + relative_motion(motion_[pairs_[pair].first], motion_[pairs_[pair].second]);
}

double PairWatch::own_motion(int body, const Vec2& common) const {
  Box own = motion_[body];
  if (model_.bodies[body].wall) own.x_min = own.x_max = common.x();
  return body_moved_[body] + relative_motion(own, Box{common.x(), common.x(), common.y(), common.y()});
}

/// Middle of all bodies' motions: only what they move against each other can bring pairs together that the broad phase
/// left out. A wall lies in wait along all x, whatever its own motion in x.
Vec2 PairWatch::common_motion() const {
  Box all{1e300, -1e300, 1e300, -1e300};
  for (std::size_t b = 0; b < motion_.size(); ++b) {
    const Box& m = motion_[b];
    all.y_min = std::min(all.y_min, m.y_min), all.y_max = std::max(all.y_max, m.y_max);
    if (model_.bodies[b].wall) continue;
    all.x_min = std::min(all.x_min, m.x_min), all.x_max = std::max(all.x_max, m.x_max);
  }
  return 0.5 * Vec2(all.x_min + all.x_max, all.y_min + all.y_max);
}

bool PairWatch::is_used_up(const OutlineField& from, const OutlineField& to) {
  measure(from, to);
  const Vec2 common = common_motion();
  const double largest_own =
      parallel_max(static_cast<int>(motion_.size()), 0, [&](int b) { return own_motion(b, common); });
  const double largest_pair = parallel_max(count(), 0, [&](int p) { return pair_motion(p); });
  return largest_pair >= skin_ || largest_own >= own_skin_;
}

/// Bounds of several ways add up to a bound of all.
void PairWatch::add_up(const OutlineField& from, const OutlineField& to) {
  measure(from, to);
  const Vec2 common = common_motion();
  for (int p = 0; p < count(); ++p) pair_moved_[p] = pair_motion(p);
  for (int b = 0; b < static_cast<int>(motion_.size()); ++b) body_moved_[b] = own_motion(b, common);
}

/// Pairs that were watched before keep the way that they have gone.
bool PairWatch::update(const std::vector<Box>& boxes) {
  if (std::ranges::none_of(body_moved_, [&](double moved) { return moved >= kept * own_skin_; })) return false;
  const std::vector<BodyPair> before = std::move(pairs_);
  const std::vector<double> moved = std::move(pair_moved_);
  pairs_ = broad_phase(model_, boxes, margin_);
  pair_moved_.assign(pairs_.size(), unknown);
  body_moved_.assign(model_.bodies.size(), 0.0);
  std::size_t old = 0;
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    while (old < before.size() && before[old] < pairs_[p]) ++old;
    if (old < before.size() && before[old] == pairs_[p]) pair_moved_[p] = moved[old];
  }
  return true;
}

bool PairWatch::may_keep(int pair) const { return pair_moved_[pair] < kept * skin_; }

}  // namespace pliant
