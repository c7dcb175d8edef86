#include "reference/bonds/bond.hpp"

namespace pliant::reference {
namespace {

struct Place {
  BondJet x, y;
  Place(BondJet x_at, BondJet y_at) : x(std::move(x_at)), y(std::move(y_at)) {}
  /// Point number 0 to 3 of the four.
  Place(const Vec2& at, int number) : x(at.x(), 2 * number), y(at.y(), 2 * number + 1) {}
  friend Place operator+(const Place& a, const Place& b) { return {a.x + b.x, a.y + b.y}; }
  friend Place operator-(const Place& a, const Place& b) { return {a.x - b.x, a.y - b.y}; }
};

}  // namespace

BondPoints points_of(const Bond& bond, const PresentOutline& slave, const PresentOutline& master, const Vec2& shift) {
  const auto beside = [&](const MasterPoint& point) {
    const Vec2 first = master.node(point.segment), second = master.node(point.segment + 1);
    return Vec2((1 - point.xi) * first + point.xi * second + shift);
  };
  return {slave.node(bond.segment), slave.node(bond.segment + 1), beside(bond.points[0]), beside(bond.points[1])};
}

BondDistances distances_of(const BondPoints& points) {
  const Place a1(points[0], 0), a2(points[1], 1), p1(points[2], 2), p2(points[3], 3);
  // The two middles' distance has the direction of the middle line.
  const Place line = (a2 + p2) - (a1 + p1);
  const BondJet length = sqrt(line.x * line.x + line.y * line.y);
  const Place along(line.x / length, line.y / length);
  BondDistances distances;
  const Place apart[2] = {p1 - a1, p2 - a2};
  for (std::size_t end = 0; end < 2; ++end) {
    distances.gap[end] = along.y * apart[end].x - along.x * apart[end].y;
    distances.slip[end] = along.x * apart[end].x + along.y * apart[end].y;
  }
  return distances;
}

}  // namespace pliant::reference
