#include "benchmarks/halo/partition.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "contact/broad_phase.hpp"
#include "core/errors.hpp"

namespace pliant::halo {
namespace {

/// Bodies that have one owner: those of a batch, or a rigid grain.
struct Unit {
  std::vector<int> bodies;
  Vec2 centre{0, 0};  ///< mean of the centres of the bodies' boxes, m
  int nodes = 0;      ///< field nodes of compliant bodies and outline nodes of rigid ones
};

std::vector<Unit> make_units(const Model& model, const OutlineField& outlines) {
  std::vector<Unit> units(model.batches.size());
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const Body& body = model.bodies[b];
    if (body.wall) continue;
    Unit& unit = body.batch >= 0 ? units[body.batch] : units.emplace_back();
    const Box box = bounding_box(model, outlines, b);
    unit.bodies.push_back(b);
    unit.centre += 0.5 * Vec2(box.x_min + box.x_max, box.y_min + box.y_max);
    unit.nodes += body.batch >= 0 ? model.shape_of(body).nodes() : model.outline_of(b).count;
  }
  for (Unit& unit : units) unit.centre /= static_cast<double>(unit.bodies.size());
  return units;
}

/// Axis along which the centres are further apart; x if they are equally far.
int longer_axis(std::span<const Unit> units) {
  const auto extent = [&](int axis) {
    const auto [least, most] = std::ranges::minmax(units, {}, [&](const Unit& unit) { return unit.centre[axis]; });
    return most.centre[axis] - least.centre[axis];
  };
  return extent(1) > extent(0) ? 1 : 0;
}

/// Number of units in the first of two parts for `left` of `processes`: neither part has fewer units than processes.
std::size_t cut(std::span<const Unit> units, int left, int processes) {
  double all = 0, sum = 0, least = 1e300;
  for (const Unit& unit : units) all += unit.nodes;
  const std::size_t most = units.size() - static_cast<std::size_t>(processes - left);
  std::size_t best = static_cast<std::size_t>(left);
  for (std::size_t count = 1; count <= most; ++count) {
    sum += units[count - 1].nodes;
    const double excess = std::abs(sum - all * left / processes);
    if (count >= static_cast<std::size_t>(left) && excess < least) least = excess, best = count;
  }
  return best;
}

void bisect(std::span<Unit> units, int first, int processes, std::vector<int>& owner) {
  if (processes == 1) {
    for (const Unit& unit : units)
      for (const int b : unit.bodies) owner[b] = first;
    return;
  }
  const int axis = longer_axis(units), left = processes / 2;
  std::ranges::sort(units, {}, [&](const Unit& unit) { return std::pair(unit.centre[axis], unit.bodies[0]); });
  const std::size_t count = cut(units, left, processes);
  bisect(units.first(count), first, left, owner);
  bisect(units.subspan(count), first + left, processes - left, owner);
}

}  // namespace

std::vector<int> find_owners(const Model& model, const OutlineField& outlines, int processes) {
  std::vector<Unit> units = make_units(model, outlines);
  if (units.size() < static_cast<std::size_t>(processes))
    throw InputError(
        fmt::format("the scene has {} batches and rigid grains for {} processes; take at most as many processes",
                    units.size(), processes));
  std::vector<int> owner(model.bodies.size(), every_process);
  bisect(units, 0, processes, owner);
  return owner;
}

OwnBodies own_bodies(const Model& model, const std::vector<int>& owner, int process) {
  const auto is_own = [&](int body) { return owner[body] == process || owner[body] == every_process; };
  OwnBodies own;
  for (int b = 0; b < static_cast<int>(model.batches.size()); ++b) {
    const Batch& batch = model.batches[b];
    if (!is_own(model.groups[batch.group].bodies[batch.first])) continue;
    own.batches.push_back(b);
    if (b < model.lane_batches) ++own.lane_batches;
    for (int r = batch.first_region; r < batch.first_region + batch.regions; ++r) own.regions.push_back(r);
  }
  for (int r = 0; r < static_cast<int>(model.rigid_bodies.size()); ++r)
    if (is_own(model.rigid_bodies[r].body)) own.rigid_bodies.push_back(r);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
    if (is_own(b)) own.bodies.push_back(b);
  return own;
}

}  // namespace pliant::halo
