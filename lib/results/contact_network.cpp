#include "results/contact_network.hpp"

namespace pliant {
namespace {

/// Both sides of a pair, of which each carries half.
struct PairSums {
  Vec2 force{0, 0};                                  ///< N/m, on the second body
  double length = 0, weight = 0;                     ///< m; N/m
  Vec2 point_by_length{0, 0}, point_by_force{0, 0};  ///< m^2; N

  void add(const ContactPoint& point) {
    const Vec2 tangent(-point.normal.y(), point.normal.x());
    const Vec2 on_slave = 0.5 * point.length * (point.pressure * point.normal + point.shear * tangent);
    force += point.side == 0 ? -on_slave : on_slave;
    length += 0.5 * point.length, weight += on_slave.norm();
    point_by_length += 0.5 * point.length * point.position;
    point_by_force += on_slave.norm() * point.position;
  }
  Vec2 point() const { return weight > 0 ? Vec2(point_by_force / weight) : Vec2(point_by_length / length); }
};

}  // namespace

FrameTable contact_network(const Snapshot& snapshot) {
  std::vector<float> bodies, images, points, forces, lengths;
  const bool in_cell = snapshot.model().scene.cell.has_value();
  for (const TouchingPair& pair : snapshot.contacts()) {
    PairSums sums;
    for (const ContactPoint& point : pair.points) sums.add(point);
    append(Vec2(pair.first, pair.second), bodies);
    images.push_back(static_cast<float>(pair.images.x));
    if (in_cell) images.push_back(static_cast<float>(pair.images.y));
    append(sums.point(), points);
    append(sums.force, forces);
    lengths.push_back(static_cast<float>(sums.length));
  }
  return {contact_network_name,
          {{"bodies", 2, std::move(bodies)},
           {"images", in_cell ? 2 : 1, std::move(images)},
           {"point", 2, std::move(points)},
           {"force", 2, std::move(forces)},
           {"length", 1, std::move(lengths)}}};
}

}  // namespace pliant
