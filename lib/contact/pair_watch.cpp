#include "contact/pair_watch.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "core/archive.hpp"
#include "core/parallel.hpp"

namespace pliant {
namespace {

constexpr double extra_skins = 4;
/// Share of the skin by which a body may change its shape before its ways are counted from another place.
constexpr double blurred = 0.25;
/// Share of the skin up to which a pair need not be searched when others are; of the broad phase's likewise. Few pairs
/// move by much more than the others (docs/defaults.md).
constexpr double kept = 0.75;
/// Rounding of ways that are kept, of some skins, over the skin, many times over.
constexpr double rounded = 1e-4;

constexpr double endless = 1e300;  ///< m
/// Before the broad phase has looked: all have come out of it.
constexpr Box empty{endless, -endless, endless, -endless};

std::vector<int> both_bodies(const std::vector<BodyPair>& pairs) {
  std::vector<int> bodies;
  bodies.reserve(2 * pairs.size());
  for (const BodyPair& pair : pairs) bodies.push_back(pair.first), bodies.push_back(pair.second);
  return bodies;
}

}  // namespace

PairWatch::PairWatch(const Model& model, double skin, double reach)
    : model_(model),
      skin_(skin),
      own_skin_(0.5 * (1 + extra_skins) * skin),
      margin_(reach + (1 + extra_skins) * skin),
      motion_(model.bodies.size()),
      pair_ways_(model) {
  forget();
}

void PairWatch::forget() {
  reference_ = {};
  pairs_.clear();
  use_.clear();
  excess_.clear();
  pair_ways_.set_bodies({});
  swept_at_.assign(model_.bodies.size(), empty);
}

void PairWatch::loaded() {
  pair_ways_.restore_bodies(both_bodies(pairs_));
  if (swept_at_.size() != motion_.size()) throw ArchiveError("bounding boxes are those of other bodies");
  if (excess_.size() != pairs_.size()) throw ArchiveError("ways are those of other pairs");
  use_.assign(pairs_.size(), all);
}

/// Finds motion_, and returns how far bounding boxes have come out of those that the broad phase saw, all of these
/// moved along with the middle of the bodies, m: only what bodies move against each other can bring pairs together that
/// it left out. A wall lies in wait along all x, whatever its own way in x.
double PairWatch::measure(const OutlineField& now) {
  const std::array<double, 4> out = parallel_max<4>(count_of_bodies(), -endless, [&](int b) {
    const auto [ways, box] = motion_boxes(model_, b, now, reference_);
    const Box& then = swept_at_[b];
    motion_[b] = ways;
    const bool wall = model_.bodies[b].wall;
    return std::array{wall ? -endless : then.x_min - box.x_min, wall ? -endless : box.x_max - then.x_max,
                      then.y_min - box.y_min, box.y_max - then.y_max};
  });
  return 0.5 * std::max(out[0] + out[1], out[2] + out[3]);
}

/// By the boxes of their nodes' ways: at little cost, but blurred.
double PairWatch::rough_way(int pair, const OutlineField& now) const {
  return relative_way(pair_ways_.rough_way(2 * pair, ways(now)), pair_ways_.rough_way(2 * pair + 1, ways(now)));
}

/// By each node's own way.
double PairWatch::way(int pair, const OutlineField& now) const {
  return relative_way(pair_ways_.way(2 * pair, ways(now)), pair_ways_.way(2 * pair + 1, ways(now)));
}

bool PairWatch::stays_within(int pair, double limit, const OutlineField& now) const {
  return rough_way(pair, now) < limit || way(pair, now) < (1 - rounded) * limit;
}

bool PairWatch::is_used_up(const OutlineField& now) {
  come_out_ = measure(now);
  use_.resize(pairs_.size());
  const bool some = parallel_any(count(), [&](int p) {
    // Below the skin by boxes a pair holds, and what is likely will do.
    const double rough = rough_way(p, now), likely = rough < skin_ ? rough - excess_[p] : way(p, now);
    use_[p] = likely < kept * skin_ ? little : likely < (1 - rounded) * skin_ ? much : all;
    return use_[p] == all;
  });
  return some || !(come_out_ < own_skin_);
}

/// A body that has changed its shape or turned since its reference would blur the ways of all its pairs.
void PairWatch::take_new_references(const OutlineField& here, const OutlineField& trial) {
  const auto is_due = [&](int b) { return change_of_shape(motion_[b]) >= blurred * skin_; };
  parallel_for(pair_ways_.count(), [&](int e) {
    if (is_due(pair_ways_.body(e))) pair_ways_.take_new_reference(e, ways(here));
  });
  parallel_for(count_of_bodies(), [&](int b) {
    if (!is_due(b)) return;
    const int first = model_.outline_offset[b], nodes = model_.outline_offset[b + 1] - first;
    std::copy_n(&here.x[first], nodes, &reference_.x[first]);
    std::copy_n(&here.y[first], nodes, &reference_.y[first]);
    motion_[b] = box_of_ways(model_, b, trial, reference_);
  });
}

bool PairWatch::update(const OutlineField& here, const OutlineField& trial) {
  const bool forgotten = reference_.x.empty();
  if (forgotten) {
    reference_ = here;
  } else {
    take_new_references(here, trial);
    if (come_out_ < kept * own_skin_) return false;
  }
  parallel_for(count_of_bodies(), [&](int b) { swept_at_[b] = bounding_box(model_, here, b); });
  follow(broad_phase(model_, swept_at_, margin_));
  is_used_up(trial);
  return true;
}

/// What is known of pairs that were watched before stays known.
void PairWatch::follow(std::vector<BodyPair> found) {
  const std::vector<BodyPair> before = std::exchange(pairs_, std::move(found));
  const std::vector<double> old_excess = std::exchange(excess_, std::vector<double>(pairs_.size(), 0.0));
  const NodeWays old_ways = std::exchange(pair_ways_, NodeWays(model_));
  pair_ways_.set_bodies(both_bodies(pairs_));
  std::size_t old = 0;
  for (int p = 0; p < count(); ++p) {
    while (old < before.size() && before[old] < pairs_[p]) ++old;
    if (old == before.size() || before[old] != pairs_[p]) continue;
    excess_[p] = old_excess[old];
    for (int side = 0; side < 2; ++side)
      pair_ways_.copy_entry(2 * p + side, old_ways, 2 * static_cast<int>(old) + side);
  }
}

std::vector<int> PairWatch::used_up(const OutlineField& here) {
  parallel_for(count(), [&](int p) {
    if (use_[p] != much) return;
    const double exact = way(p, here);
    excess_[p] = std::max(0.0, rough_way(p, here) - exact);
    if (exact < kept * skin_) use_[p] = little;
  });
  std::vector<int> result;
  for (int p = 0; p < count(); ++p)
    if (use_[p] != little) result.push_back(p);
  return result;
}

bool PairWatch::hold(const std::vector<int>& pairs, const OutlineField& trial) const {
  return come_out_ < own_skin_ && std::ranges::all_of(pairs, [&](int p) { return stays_within(p, skin_, trial); });
}

void PairWatch::searched(int pair, const OutlineField& now) {
  excess_[pair] = 0;
  for (int side = 0; side < 2; ++side) pair_ways_.look(2 * pair + side, ways(now));
}

void PairWatch::add(const BodyPair& pair, const OutlineField& now) {
  pairs_.push_back(pair);
  use_.push_back(little);
  excess_.push_back(0);
  for (int body : {pair.first, pair.second}) pair_ways_.append(body);
  searched(count() - 1, now);
}

}  // namespace pliant
