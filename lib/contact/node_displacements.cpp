#include "contact/node_displacements.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/archive.hpp"
#include "core/parallel.hpp"

namespace pliant {
namespace {

/// Largest number of outline nodes for which displacements are stored node by node.
constexpr int small_outline = 512;

/// Mean of the displacements, displacement(node), of four nodes: it rotates with the axes.
template <class Displacement>
DisplacementDisc about_four(int count, Displacement&& displacement) {
  DisplacementDisc disc{0, 0, 0};
  for (int quarter = 0; quarter < 4; ++quarter) {
    const auto [x, y] = displacement(quarter * count / 4);
    disc.x += 0.25 * x, disc.y += 0.25 * y;
  }
  return disc;
}

/// Widens a disc so that it contains the displacements of an outline's nodes; displacements(i): eight at once from node
/// i on. The last lanes may reach into the cyclic copies, which move as their originals.
template <class Displacements>
DisplacementDisc widened(DisplacementDisc disc, int count, Displacements&& displacements) {
  Lanes square{};
  for (int i = 0; i < count; i += lane_count) {
    const auto [x, y] = displacements(i);
    square = max(square, (x - disc.x) * (x - disc.x) + (y - disc.y) * (y - disc.y));
  }
  disc.radius = std::sqrt(largest(square));
  return disc;
}

using Floats = float __attribute__((vector_size(4 * lane_count)));

Lanes load_displacements(const float* from) {
  Floats value;
  std::memcpy(&value, from, sizeof value);
  return __builtin_convertvector(value, Lanes);
}

void store_displacements(float* to, Lanes value) {
  const Floats rounded = __builtin_convertvector(value, Floats);
  std::memcpy(to, &rounded, sizeof rounded);
}

/// Displacement of one node.
std::pair<double, double> displacement_at(const OutlineField& now, const OutlineField& reference, int node) {
  return {now.x[node] - reference.x[node], now.y[node] - reference.y[node]};
}

/// Displacements of eight nodes.
std::pair<Lanes, Lanes> node_displacements_at(const OutlineField& now, const OutlineField& reference, int node) {
  return {load(&now.x[node]) - load(&reference.x[node]), load(&now.y[node]) - load(&reference.y[node])};
}

/// Whether a displacement is known. New references hardly change the disc of an unknown one.
bool is_known(const DisplacementDisc& disc) { return disc.radius < 0.5 * unknown_displacement.radius; }

}  // namespace

DisplacementDisc displacement_disc(const Model& model, int body, const OutlineField& now,
                                   const OutlineField& reference) {
  const int first = model.outline_offset[body], count = model.outline_of(body).count;
  const DisplacementDisc middle = about_four(count, [&](int i) { return displacement_at(now, reference, first + i); });
  return widened(middle, count, [&](int i) { return node_displacements_at(now, reference, first + i); });
}

DisplacementDisc displacement_between(const DisplacementDisc& from, const DisplacementDisc& to) {
  return {to.x - from.x, to.y - from.y, from.radius + to.radius};
}

double displacement_diameter(const DisplacementDisc& displacements) { return 2 * displacements.radius; }

double relative_displacement(const DisplacementDisc& a, const DisplacementDisc& b) {
  const double dx = a.x - b.x, dy = a.y - b.y;
  return std::sqrt(dx * dx + dy * dy) + a.radius + b.radius;
}

NodeDisplacements::Common NodeDisplacements::displacement_of_first(int body,
                                                                   const DisplacementsSoFar& displacements) const {
  const int node = model_->outline_offset[body];
  return {displacements.now.x[node] - displacements.reference.x[node],
          displacements.now.y[node] - displacements.reference.y[node]};
}

bool NodeDisplacements::keeps_nodes(int entry) const { return model_->outline_of(body_[entry]).count <= small_outline; }

/// Numbers that are stored of each component of an entry.
int NodeDisplacements::room(int entry) const {
  return keeps_nodes(entry) ? padded(model_->outline_of(body_[entry]).count) : 0;
}

/// Sets the places of all entries. Returns how many numbers they have.
std::size_t NodeDisplacements::assign_places() {
  at_.resize(body_.size());
  parallel_for(count(), [&](int e) { at_[e] = room(e); });
  std::size_t at = 0;
  for (int& place : at_) place = static_cast<int>(std::exchange(at, at + static_cast<std::size_t>(place)));
  return at;
}

void NodeDisplacements::set_bodies(std::vector<int> bodies) {
  body_ = std::move(bodies);
  start_.resize(body_.size()), common_.resize(body_.size());
  parallel_for(count(), [&](int e) { start_[e] = unknown_displacement; });
  const std::size_t numbers = assign_places();
  for (auto* of_nodes : {&x_, &y_}) of_nodes->clear(), of_nodes->resize(numbers);
}

void NodeDisplacements::restore_bodies(std::vector<int> bodies) {
  body_ = std::move(bodies);
  const int all = static_cast<int>(model_->bodies.size());
  const bool known = std::ranges::all_of(body_, [&](int body) { return body >= 0 && body < all; });
  const std::size_t numbers = known ? assign_places() : 0;
  const bool fits = known && start_.size() == body_.size() && common_.size() == body_.size() && x_.size() == numbers &&
                    y_.size() == numbers;
  if (!fits) throw ArchiveError("displacements are those of other bodies");
}

void NodeDisplacements::append(int body) {
  body_.push_back(body);
  start_.push_back(unknown_displacement), common_.push_back({0, 0});
  at_.push_back(static_cast<int>(x_.size()));
  const std::size_t numbers = x_.size() + static_cast<std::size_t>(room(count() - 1));
  x_.resize(numbers), y_.resize(numbers);
}

void NodeDisplacements::copy_entry(int entry, const NodeDisplacements& from, int old_entry) {
  start_[entry] = from.start_[old_entry];
  common_[entry] = from.common_[old_entry];
  if (!keeps_nodes(entry)) return;
  const int nodes = padded(model_->outline_of(body_[entry]).count);
  std::copy_n(&from.x_[from.at_[old_entry]], nodes, &x_[at_[entry]]);
  std::copy_n(&from.y_[from.at_[old_entry]], nodes, &y_[at_[entry]]);
}

void NodeDisplacements::set_reference(int entry, const DisplacementsSoFar& displacements) {
  const int b = body_[entry], first = model_->outline_offset[b], count = model_->outline_of(b).count;
  const Common common = common_[entry] = displacement_of_first(b, displacements);
  const bool keeps = keeps_nodes(entry);
  const DisplacementDisc middle =
      about_four(count, [&](int i) { return displacement_at(displacements.now, displacements.reference, first + i); });
  start_[entry] = widened(middle, count, [&](int i) {
    const auto [x, y] = node_displacements_at(displacements.now, displacements.reference, first + i);
    if (keeps)
      store_displacements(&x_[at_[entry] + i], x - common.x), store_displacements(&y_[at_[entry] + i], y - common.y);
    return std::pair(x, y);
  });
}

DisplacementDisc NodeDisplacements::displacement_bound(int entry, const DisplacementsSoFar& displacements) const {
  return displacement_between(start_[entry], displacements.discs[body_[entry]]);
}

DisplacementDisc NodeDisplacements::displacement(int entry, const DisplacementsSoFar& displacements) const {
  if (!is_known(start_[entry]) || !keeps_nodes(entry)) return displacement_bound(entry, displacements);
  const int b = body_[entry], first = model_->outline_offset[b], count = model_->outline_of(b).count;
  const Common common = common_[entry];
  const float *x_then = &x_[at_[entry]], *y_then = &y_[at_[entry]];
  const DisplacementDisc middle = about_four(count, [&](int i) {
    const auto [x, y] = displacement_at(displacements.now, displacements.reference, first + i);
    return std::pair(x - common.x - x_then[i], y - common.y - y_then[i]);
  });
  return widened(middle, count, [&](int i) {
    const auto [x, y] = node_displacements_at(displacements.now, displacements.reference, first + i);
    return std::pair(x - common.x - load_displacements(x_then + i), y - common.y - load_displacements(y_then + i));
  });
}

void NodeDisplacements::reset_reference(int entry, const DisplacementsSoFar& displacements) {
  DisplacementDisc& start = start_[entry];
  const int b = body_[entry], first = model_->outline_offset[b], count = model_->outline_of(b).count;
  if (!is_known(start)) return;
  if (!keeps_nodes(entry)) {
    start = displacement_between(displacement_disc(*model_, b, displacements.now, displacements.reference), start);
    return;
  }
  const Common back = displacement_of_first(b, displacements);
  Common& common = common_[entry];
  float *x_then = &x_[at_[entry]], *y_then = &y_[at_[entry]];
  const DisplacementDisc middle = about_four(count, [&](int i) {
    const auto [dx, dy] = displacement_at(displacements.now, displacements.reference, first + i);
    return std::pair(common.x - back.x + (x_then[i] - (dx - back.x)), common.y - back.y + (y_then[i] - (dy - back.y)));
  });
  start = widened(middle, count, [&](int i) {
    const auto [dx, dy] = node_displacements_at(displacements.now, displacements.reference, first + i);
    const Lanes back_x = load_displacements(x_then + i) - (dx - back.x),
                back_y = load_displacements(y_then + i) - (dy - back.y);
    store_displacements(x_then + i, back_x), store_displacements(y_then + i, back_y);
    return std::pair(common.x - back.x + back_x, common.y - back.y + back_y);
  });
  common = {common.x - back.x, common.y - back.y};
}

}  // namespace pliant
