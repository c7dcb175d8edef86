#include "contact/broad_phase.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/parallel.hpp"

namespace pliant {
namespace {

/// Box moved into the first period, and the number of periods.
struct SweepEntry {
  double x_min, x_max;
  int body, turn;
};

bool overlap_in_y(const Box& a, const Box& b, double margin) {
  return a.y_min <= b.y_max + margin && b.y_min <= a.y_max + margin;
}

BodyPair ordered(int a, int b, const Images& images) {
  return a <= b ? BodyPair{a, b, images} : BodyPair{b, a, -images};
}

std::vector<SweepEntry> sweep_entries(const Model& model, const std::vector<Box>& boxes) {
  std::vector<SweepEntry> entries;
  for (int i = 0; i < static_cast<int>(boxes.size()); ++i) {
    if (model.bodies[i].wall) continue;
    const double period = model.scene.period.value_or(0);
    const int turn = period > 0 ? static_cast<int>(std::floor(boxes[i].x_min / period)) : 0;
    entries.push_back({boxes[i].x_min - turn * period, boxes[i].x_max - turn * period, i, turn});
  }
  std::sort(entries.begin(), entries.end(), [](const SweepEntry& a, const SweepEntry& b) { return a.x_min < b.x_min; });
  return entries;
}

/// Adds pairs of entry i with the entries after it in x, around the period as far as it extends. An entry meets itself
/// one period further on.
void sweep_from(const std::vector<SweepEntry>& entries, const std::vector<Box>& boxes, int i, double period,
                double margin, std::vector<BodyPair>& pairs) {
  const SweepEntry& a = entries[i];
  for (std::size_t step = 1;; ++step) {
    const std::size_t wrapped = static_cast<std::size_t>(i) + step;
    const int lap = static_cast<int>(wrapped / entries.size());
    if (lap > 0 && period == 0) return;
    const SweepEntry& b = entries[wrapped % entries.size()];
    if (!(b.x_min + lap * period <= a.x_max + margin)) return;  // so that NaN ends it too
    if (overlap_in_y(boxes[a.body], boxes[b.body], margin))
      pairs.push_back(ordered(a.body, b.body, {a.turn - b.turn + lap, 0}));
  }
}

/// Sorts pairs: first in one pass by their first bodies, then those of each body.
void sort_by_bodies(std::vector<BodyPair>& pairs, std::size_t bodies) {
  std::vector<std::size_t> begin(bodies + 1, 0);
  for (const BodyPair& pair : pairs) ++begin[pair.first + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<BodyPair> sorted(pairs.size());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for (const BodyPair& pair : pairs) sorted[next[pair.first]++] = pair;
  parallel_for(static_cast<int>(bodies), [&](int b) {
    const auto first = sorted.begin();
    std::sort(first + static_cast<std::ptrdiff_t>(begin[b]), first + static_cast<std::ptrdiff_t>(begin[b + 1]));
  });
  pairs = std::move(sorted);
}

}  // namespace

Box bounding_box(const Model& model, const OutlineField& position, int body) {
  const OutlineShape& shape = model.outline_of(body);
  const int begin = model.outline_offset[body], end = begin + shape.count;
  Lanes x_min = broadcast(1e300), x_max = -x_min, y_min = x_min, y_max = x_max;
  for (int i = begin; i < end; i += lane_count) {
    // The last lanes may reach into the cyclic copies, which on a wall are those of the next period.
    const LaneBits own = first_lanes(end - i);
    const Lanes x = load(&position.x[i]), y = load(&position.y[i]);
    x_min = select(own, min(x_min, x), x_min), x_max = select(own, max(x_max, x), x_max);
    y_min = select(own, min(y_min, y), y_min), y_max = select(own, max(y_max, y), y_max);
  }
  return {-largest(-x_min), largest(x_max), -largest(-y_min), largest(y_max)};
}

std::vector<BodyPair> broad_phase(const Model& model, const std::vector<Box>& boxes, double margin) {
  const double period = model.scene.period.value_or(0);
  const std::vector<SweepEntry> entries = sweep_entries(model, boxes);
  const Blocks blocks{static_cast<int>(entries.size()), 64};
  std::vector<std::vector<BodyPair>> of_block(static_cast<std::size_t>(blocks.count()));
  parallel_for(blocks.count(), [&](int b) {
    blocks.for_each_in(b, [&](int i) { sweep_from(entries, boxes, i, period, margin, of_block[b]); });
  });
  std::vector<BodyPair> pairs;
  for (const std::vector<BodyPair>& found : of_block) pairs.insert(pairs.end(), found.begin(), found.end());
  for (int wall = 0; wall < static_cast<int>(boxes.size()); ++wall) {
    if (!model.bodies[wall].wall) continue;
    for (int other = 0; other < static_cast<int>(boxes.size()); ++other)
      if ((!model.bodies[other].wall || other < wall) && overlap_in_y(boxes[wall], boxes[other], margin))
        pairs.push_back(ordered(other, wall, {}));
  }
  sort_by_bodies(pairs, boxes.size());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

}  // namespace pliant
