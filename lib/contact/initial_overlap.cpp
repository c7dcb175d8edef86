#include "contact/initial_overlap.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "contact/half_pass.hpp"

namespace pliant {
namespace {

/// Smaller depths, over the longest segment of the master window, are rounding of positions.
constexpr double least_depth_share = 1e-9;

/// Node below the other body's outline.
struct DeepNode {
  double depth, share, stored;  ///< m, -, J/m
  Vec2 normal;                  ///< unit, from the first body of the contact pair to the second
};

/// Energy of compression at a gap below 0, J/m2: without cohesion's share, which is present at gap 0 too.
template <class Law>
Lanes compression(const Law& law, Lanes gap) {
  return law(gap).energy - law(Lanes{}).energy;
}

std::vector<DeepNode> deep_nodes(const PairView& view) {
  std::vector<DeepNode> nodes;
  const auto add_nodes = [&](const auto& law, const HalfPass& pass, int side, int i, const Projection& p) {
    const LaneBits deep =
        first_lanes(pass.nodes.count - i) & p.hit & (p.gap < -least_depth_share * view.window.longest());
    const Lanes stored = 0.5 * load_slaves(pass, i).tributary_length * compression(law, p.gap);
    for (int lane = 0; lane < lane_count; ++lane)
      if (deep[lane])
        nodes.push_back({-p.gap[lane], -p.gap[lane] / view.window.longest(), stored[lane],
                         (side == 0 ? -1 : 1) * Vec2(p.normal_x[lane], p.normal_y[lane])});
  };
  const auto visit_law = [&](const auto& law) {
    for_each_projection(view, 0, [&](const auto&... found) { add_nodes(law, found...); });
  };
  std::visit(visit_law, view.contact_pair.law);
  return nodes;
}

const DeepNode& deepest_of(const std::vector<DeepNode>& nodes) {
  return *std::max_element(nodes.begin(), nodes.end(), [](const auto& a, const auto& b) { return a.depth < b.depth; });
}

/// Separation along the deepest node's normal. A node leaves a convex body through the line of its own segment. A node
/// beside a corner leaves it through the deepest node's face.
double separation_along(const Vec2& direction, const std::vector<DeepNode>& nodes) {
  constexpr double same_face = 0.5;  // cosine between the normals
  double separation = 0;
  for (const DeepNode& node : nodes)
    if (const double rise = node.normal.dot(direction); rise > same_face)
      separation = std::max(separation, node.depth / rise);
  return separation;
}

bool on_one_lattice(const Model& model, int first, int second) {
  const int set = model.bodies[first].grains;
  if (set < 0 || model.bodies[second].grains != set) return false;
  const PackingKind kind = model.scene.grains[set].packing.kind;
  return kind == PackingKind::hexagonal || kind == PackingKind::grid;
}

/// Factor on the pitch of a lattice: neighbours move apart in proportion to their distance.
double growth_of(const Model& model, const ContactPair& contact_pair, double separation, const Vec2& normal) {
  const Vec2 image = initial_lattice(model.scene).shift(contact_pair.images);
  const double distance =
      (model.bodies[contact_pair.second].centre + image - model.bodies[contact_pair.first].centre).dot(normal);
  return distance > separation ? 1 + separation / distance : 1;
}

/// Rounds up to two digits, so that the advice is on the safe side.
double rounded_up(double length) {
  const double digit = std::pow(10.0, std::floor(std::log10(length)) - 1);
  return std::ceil(length / digit) * digit;
}

}  // namespace

InitialOverlap initial_overlap(const Model& model, const ContactSystem& contact, const Outlines& outlines) {
  InitialOverlap overlap;
  std::pair<int, int> last{-1, -1};
  for (const ContactPair& contact_pair : contact.contact_pairs()) {
    const std::vector<DeepNode> nodes = deep_nodes({model, outlines, contact_pair, contact.skin(), thread_scratch()});
    if (nodes.empty()) continue;
    // contact pairs of one pair of bodies with several images are adjacent
    const std::pair<int, int> pair{contact_pair.first, contact_pair.second};
    overlap.pairs += pair != last;
    last = pair;
    const DeepNode& deepest = deepest_of(nodes);
    const double separation = separation_along(deepest.normal, nodes);
    if (on_one_lattice(model, contact_pair.first, contact_pair.second))
      overlap.growth = std::max(overlap.growth, growth_of(model, contact_pair, separation, deepest.normal));
    for (const DeepNode& node : nodes) overlap.stored += node.stored;
    if (deepest.depth <= overlap.depth) continue;
    overlap.first = contact_pair.first, overlap.second = contact_pair.second;
    overlap.depth = deepest.depth, overlap.share = deepest.share, overlap.separation = separation;
  }
  return overlap;
}

std::string remedy(const InitialOverlap& overlap, const Model& model) {
  if (on_one_lattice(model, overlap.first, overlap.second) && overlap.growth > 1)
    return fmt::format("take a pitch {:.6g} times as large", 1 + rounded_up(overlap.growth - 1));
  return fmt::format("move '{}' and '{}' apart by {:.2g} m", model.bodies[overlap.first].name,
                     model.bodies[overlap.second].name, rounded_up(overlap.separation));
}

std::string describe(const InitialOverlap& overlap, const Model& model) {
  if (overlap.pairs == 0) return {};
  return fmt::format(
      "{} of bodies, '{}' and '{}' deepest by {:.3g} m, {:.2g} of a segment; {:.3g} J/m stored, which will set them "
      "moving: {}, unless the scene is meant to start pressed together",
      overlap.pairs == 1 ? "1 pair" : fmt::format("{} pairs", overlap.pairs), model.bodies[overlap.first].name,
      model.bodies[overlap.second].name, overlap.depth, overlap.share, overlap.stored, remedy(overlap, model));
}

}  // namespace pliant
