#include "bonds/bond_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "contact/broad_phase.hpp"
#include "core/parallel.hpp"

namespace pliant {
namespace {

/// Common nodes of two cells differ by rounding: over the spacing of the finer outline.
constexpr double same_place = 1e-6;
/// Deepest overlap of surfaces that are bonded, over the same spacing: where contact warns of its depth.
constexpr double deepest = 0.5;
/// Least distance of the masters of a segment's ends, over its length. Nearer ones are no surface along the segment.
constexpr double least_facing_share = 0.5;

bool is_named(const Model& model, int body, const std::string& name) {
  const Body& b = model.bodies[body];
  return name == "all" || name == model.scene.materials[b.material].name ||
         name == (b.wall ? b.name : model.scene.grains[b.grains].name);
}

bool applies(const Model& model, const BondRule& rule, int a, int b) {
  return (is_named(model, a, rule.first) && is_named(model, b, rule.second)) ||
         (is_named(model, b, rule.first) && is_named(model, a, rule.second));
}

/// The slave and its master, with the master's images.
struct Sides {
  int slave, master;
  Images images;
};

Sides sides_of(const Model& model, const BodyPair& pair) {
  const bool swapped =
      !model.bodies[pair.second].wall && model.outline_of(pair.second).spacing < model.outline_of(pair.first).spacing;
  return swapped ? Sides{pair.second, pair.first, -pair.images} : Sides{pair.first, pair.second, pair.images};
}

/// Point of the master's outline that is nearest to a node.
struct NearestPoint {
  double distance = std::numeric_limits<double>::infinity();
  int segment = 0;
  double xi = 0;
  Images images;
};

class Master {
 public:
  Master(const Model& model, const OutlineField& position, const Sides& sides)
      : shape_(model.outline_of(sides.master)),
        position_(position),
        first_(model.outline_offset[sides.master]),
        images_(sides.images) {}

  /// The first of equally near ones counts.
  NearestPoint nearest(const Vec2& x) const {
    NearestPoint best;
    // A wall has images of its own, along x. Both it and the grain may be periods away from where they began.
    const double turned = shape_.turn_shift == 0 ? 0 : (x.x() - position_.at(first_).x()) / shape_.turn_shift;
    const int nearby = static_cast<int>(std::lround(turned)), turns = shape_.turn_shift == 0 ? 0 : 2;
    for (int turn = nearby - turns; turn <= nearby + turns; ++turn) {
      const Images images = images_ + Images{shape_.turn_shift < 0 ? -turn : turn, 0};
      const Vec2 at = x - position_.lattice.shift(images);
      for (int k = 0; k < shape_.count; ++k) consider(k, at, images, best);
    }
    return best;
  }

 private:
  void consider(int k, const Vec2& x, const Images& images, NearestPoint& best) const {
    const Vec2 a = position_.at(first_ + k), edge = position_.at(first_ + k + 1) - a;
    double xi = (x - a).dot(edge) / edge.squaredNorm();
    xi = xi < same_place ? 0 : xi > 1 - same_place ? 1 : xi;
    const double distance = (x - a - xi * edge).norm();
    if (distance >= best.distance) return;
    best = {distance, k, xi, images};
    if (xi < 1) return;
    // the end of a segment is the beginning of the next; that of a wall's last one is in its next image
    best.segment = (k + 1) % shape_.count, best.xi = 0;
    if (k + 1 == shape_.count && shape_.turn_shift != 0)
      best.images = images + Images{shape_.turn_shift < 0 ? -1 : 1, 0};
  }

  const OutlineShape& shape_;
  const OutlineField& position_;
  int first_;
  Images images_;
};

Vec2 place_of(const Model& model, const OutlineField& position, int body, int segment, double xi,
              const Images& images) {
  const int first = model.outline_offset[body] + segment;
  return (1 - xi) * position.at(first) + xi * position.at(first + 1) + position.lattice.shift(images);
}

std::optional<Bond> bond_of(const Model& model, const OutlineField& position, const Sides& sides, int segment,
                            const NearestPoint (&masters)[2], double gap) {
  const OutlineShape& shape = model.outline_of(sides.slave);
  const double near = std::max(gap, same_place * shape.spacing), far = std::max(near, deepest * shape.spacing);
  if (masters[0].distance > far || masters[1].distance > far) return {};
  Bond bond;
  bond.slave = sides.slave, bond.master = sides.master, bond.images = masters[0].images;
  bond.segment = segment;
  for (int end = 0; end < 2; ++end) bond.master_segment[end] = masters[end].segment, bond.xi[end] = masters[end].xi;
  // The ends of a segment at the border of a wall's period may have masters in two turns of the wall. The nodes behind
  // the last one are copies of those of the next turn, so the later master is counted on from the earlier turn.
  if (masters[0].images != masters[1].images) {
    const OutlineShape& wall = model.outline_of(sides.master);
    const int on = (masters[1].images.x - masters[0].images.x) * (wall.turn_shift < 0 ? -1 : 1);
    if (wall.turn_shift == 0 || std::abs(on) != 1) return {};
    const int later = on > 0 ? 1 : 0;
    bond.images = masters[1 - later].images;
    bond.master_segment[later] += wall.count;
    if (bond.master_segment[later] + 1 >= wall.count + lane_count) return {};
  }
  bond.length = shape.segment_length[segment];
  const BondGeometry at = geometry_of(model, position, bond);
  const int first = model.outline_offset[sides.slave] + segment;
  const Vec2 edge = position.at(first + 1) - position.at(first);
  if ((edge + at.apart[1] - at.apart[0]).dot(edge) < least_facing_share * edge.squaredNorm()) return {};
  for (int end = 0; end < 2; ++end) {
    bond.rest_gap[end] = at.normal.dot(at.apart[end]), bond.rest_slip[end] = at.tangent.dot(at.apart[end]);
    if (bond.rest_gap[end] > near) return {};
  }
  return bond;
}

std::vector<Bond> bonds_of_pair(const Model& model, const OutlineField& position, const Sides& sides, double gap) {
  const OutlineShape& shape = model.outline_of(sides.slave);
  const Master master(model, position, sides);
  std::vector<NearestPoint> nearest;
  for (int i = 0; i < shape.count; ++i)
    nearest.push_back(master.nearest(position.at(model.outline_offset[sides.slave] + i)));
  std::vector<Bond> found;
  for (int i = 0; i < shape.count; ++i) {
    const NearestPoint ends[2] = {nearest[i], nearest[(i + 1) % shape.count]};
    if (const std::optional<Bond> bond = bond_of(model, position, sides, i, ends, gap)) found.push_back(*bond);
  }
  return found;
}

}  // namespace

BondGeometry geometry_of(const Model& model, const OutlineField& position, const Bond& bond) {
  const int first = model.outline_offset[bond.slave] + bond.segment;
  BondGeometry geometry;
  for (int end = 0; end < 2; ++end)
    geometry.apart[end] = place_of(model, position, bond.master, bond.master_segment[end], bond.xi[end], bond.images) -
                          position.at(first + end);
  const Vec2 middle = position.at(first + 1) - position.at(first) + 0.5 * (geometry.apart[1] - geometry.apart[0]);
  geometry.length = middle.norm();
  geometry.tangent = middle / geometry.length;
  geometry.normal = {geometry.tangent.y(), -geometry.tangent.x()};
  return geometry;
}

std::vector<Bond> find_bonds(const Model& model, const OutlineField& position, int rule) {
  const BondRule& bonds = model.scene.bonds[rule];
  std::vector<Box> boxes;
  double finest = std::numeric_limits<double>::infinity();
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    boxes.push_back(bounding_box(model, position, b));
    finest = std::min(finest, model.outline_of(b).spacing);
  }
  std::vector<BodyPair> pairs = broad_phase(model, boxes, std::max(bonds.gap, same_place * finest), position.lattice);
  std::erase_if(pairs, [&](const BodyPair& pair) {
    return pair.first == pair.second || model.bodies[pair.first].wall ||
           !applies(model, bonds, pair.first, pair.second);
  });
  std::vector<std::vector<Bond>> found(pairs.size());
  parallel_for_uneven(static_cast<int>(pairs.size()), 1,
                      [&](int p) { found[p] = bonds_of_pair(model, position, sides_of(model, pairs[p]), bonds.gap); });
  std::vector<Bond> all;
  for (const std::vector<Bond>& of_pair : found) all.insert(all.end(), of_pair.begin(), of_pair.end());
  for (Bond& bond : all) bond.rule = rule;
  return all;
}

}  // namespace pliant
