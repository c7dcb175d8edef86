#include "contact/node_ways.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/archive.hpp"
#include "core/lanes.hpp"

namespace pliant {
namespace {

/// Outline nodes up to which ways are kept node by node.
constexpr int small_outline = 512;

/// A box that grows by eight points at once.
class GrowingBox {
 public:
  void add(Lanes x, Lanes y) {
    x_min_ = min(x_min_, x), x_max_ = max(x_max_, x);
    y_min_ = min(y_min_, y), y_max_ = max(y_max_, y);
  }
  Box box() const { return {-largest(-x_min_), largest(x_max_), -largest(-y_min_), largest(y_max_)}; }

 private:
  Lanes x_min_ = broadcast(1e300), x_max_ = -x_min_, y_min_ = x_min_, y_max_ = x_max_;
};

/// Of the ways of an outline's nodes, eight at once from node i on. The last lanes may reach into the cyclic copies,
/// which move as their originals.
template <class Ways>
Box box_of(int count, Ways&& ways) {
  GrowingBox result;
  for (int i = 0; i < count; i += lane_count) {
    const auto [dx, dy] = ways(i);
    result.add(dx, dy);
  }
  return result.box();
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

/// Of eight nodes.
std::pair<Lanes, Lanes> ways_at(const OutlineField& now, const OutlineField& reference, int node) {
  return {load(&now.x[node]) - load(&reference.x[node]), load(&now.y[node]) - load(&reference.y[node])};
}

/// Ways from one motion to another of the same body.
Box between(const Box& from, const Box& to) {
  return {to.x_min - from.x_max, to.x_max - from.x_min, to.y_min - from.y_max, to.y_max - from.y_min};
}

/// From where nothing is known of the way.
constexpr double far_off = 1e150;
constexpr Box unknown{-far_off, far_off, -far_off, far_off};
/// New references move a box that is not known by little.
bool is_known(const Box& box) { return box.x_min > 0.5 * unknown.x_min; }

}  // namespace

Box box_of_ways(const Model& model, int body, const OutlineField& now, const OutlineField& reference) {
  return box_of(model.outline_of(body).count,
                [&](int i) { return ways_at(now, reference, model.outline_offset[body] + i); });
}

MotionBoxes motion_boxes(const Model& model, int body, const OutlineField& now, const OutlineField& reference) {
  GrowingBox ways, place;
  const int begin = model.outline_offset[body], end = model.outline_end(body);
  for (int i = begin; i < end; i += lane_count) {
    const Lanes x = load(&now.x[i]), y = load(&now.y[i]);
    ways.add(x - load(&reference.x[i]), y - load(&reference.y[i]));
    place.add(x, y);
  }
  return {ways.box(), place.box()};
}

double change_of_shape(const Box& ways) { return std::max(ways.x_max - ways.x_min, ways.y_max - ways.y_min); }

double relative_way(const Box& a, const Box& b) {
  const double dx = std::max(a.x_max - b.x_min, b.x_max - a.x_min), dy = std::max(a.y_max - b.y_min, b.y_max - a.y_min);
  return std::sqrt(dx * dx + dy * dy);
}

NodeWays::Common NodeWays::way_of_first(int body, const WaysSoFar& ways) const {
  const int node = model_->outline_offset[body];
  return {ways.now.x[node] - ways.reference.x[node], ways.now.y[node] - ways.reference.y[node]};
}

bool NodeWays::keeps_nodes(int entry) const { return model_->outline_of(body_[entry]).count <= small_outline; }

/// Room for the nodes of all entries from one on.
void NodeWays::lay_out(int first) {
  at_.resize(body_.size());
  common_.resize(body_.size());
  std::size_t at = first == 0 ? 0 : x_.size();
  for (int e = first; e < count(); ++e) {
    at_[e] = static_cast<int>(at);
    if (keeps_nodes(e)) at += static_cast<std::size_t>(padded(model_->outline_of(body_[e]).count));
  }
  x_.resize(at), y_.resize(at);
}

void NodeWays::set_bodies(std::vector<int> bodies) {
  body_ = std::move(bodies);
  start_.assign(body_.size(), unknown);
  lay_out(0);
}

void NodeWays::restore_bodies(std::vector<int> bodies) {
  body_ = std::move(bodies);
  const int all = static_cast<int>(model_->bodies.size());
  const bool fits =
      start_.size() == body_.size() && std::ranges::all_of(body_, [&](int body) { return body >= 0 && body < all; });
  if (!fits) throw ArchiveError("ways are those of other bodies");
  lay_out(0);
}

void NodeWays::append(int body) {
  body_.push_back(body);
  start_.push_back(unknown);
  lay_out(count() - 1);
}

void NodeWays::copy_entry(int entry, const NodeWays& from, int old_entry) {
  start_[entry] = from.start_[old_entry];
  common_[entry] = from.common_[old_entry];
  if (!keeps_nodes(entry)) return;
  const int nodes = padded(model_->outline_of(body_[entry]).count);
  std::copy_n(&from.x_[from.at_[old_entry]], nodes, &x_[at_[entry]]);
  std::copy_n(&from.y_[from.at_[old_entry]], nodes, &y_[at_[entry]]);
}

void NodeWays::look(int entry, const WaysSoFar& ways) {
  const int b = body_[entry];
  const Common common = common_[entry] = way_of_first(b, ways);
  const bool keeps = keeps_nodes(entry);
  start_[entry] = box_of(model_->outline_of(b).count, [&](int i) {
    const auto [x, y] = ways_at(ways.now, ways.reference, model_->outline_offset[b] + i);
    if (keeps) store_ways(&x_[at_[entry] + i], x - common.x), store_ways(&y_[at_[entry] + i], y - common.y);
    return std::pair(x, y);
  });
}

Box NodeWays::rough_way(int entry, const WaysSoFar& ways) const {
  return between(start_[entry], ways.boxes[body_[entry]]);
}

Box NodeWays::way(int entry, const WaysSoFar& ways) const {
  if (!is_known(start_[entry]) || !keeps_nodes(entry)) return rough_way(entry, ways);
  const int b = body_[entry];
  const Common common = common_[entry];
  return box_of(model_->outline_of(b).count, [&](int i) {
    const auto [x, y] = ways_at(ways.now, ways.reference, model_->outline_offset[b] + i);
    return std::pair(x - common.x - load_ways(&x_[at_[entry] + i]), y - common.y - load_ways(&y_[at_[entry] + i]));
  });
}

void NodeWays::take_new_reference(int entry, const WaysSoFar& ways) {
  Box& start = start_[entry];
  const int b = body_[entry];
  if (!is_known(start)) return;
  if (!keeps_nodes(entry)) {
    start = between(box_of_ways(*model_, b, ways.now, ways.reference), start);
    return;
  }
  const Common back = way_of_first(b, ways);
  Common& common = common_[entry];
  start = box_of(model_->outline_of(b).count, [&](int i) {
    const auto [dx, dy] = ways_at(ways.now, ways.reference, model_->outline_offset[b] + i);
    const Lanes back_x = load_ways(&x_[at_[entry] + i]) - (dx - back.x),
                back_y = load_ways(&y_[at_[entry] + i]) - (dy - back.y);
    store_ways(&x_[at_[entry] + i], back_x), store_ways(&y_[at_[entry] + i], back_y);
    return std::pair(common.x - back.x + back_x, common.y - back.y + back_y);
  });
  common = {common.x - back.x, common.y - back.y};
}

}  // namespace pliant
