#include "contact/facing.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "contact/faces.hpp"

namespace pliant {

SlaveNode slave_node(const Pass& pass, int index) {
  const OutlineShape& shape = *pass.slave;
  const auto place = [&](int at) {
    const int turn = turn_of(at, shape.count), node = at - turn * shape.count;
    return Vec2(pass.slave_x[node] + pass.slave_shift + turn * shape.turn_shift, pass.slave_y[node]);
  };
  const int n = shape.count, node = index - turn_of(index, n) * n;
  SlaveNode result{place(index), {place(index - 1), place(index + 1)}, {}, {}, {}, false, {false, false}};
  for (int side = 0; side < 2; ++side) {
    const Vec2 along = side == 0 ? Vec2(result.at - result.neighbour[0]) : Vec2(result.neighbour[1] - result.at);
    result.present[side] = along.norm();
    result.direction[side] = along / result.present[side];
    result.length[side] =
        pass.present_lengths ? result.present[side] : shape.segment_length[side == 0 ? (node + n - 1) % n : node];
  }
  if (!shape.has_corners()) return result;
  result.corner = shape.corner[node];
  result.beside_corner[0] = shape.corner[(node + n - 1) % n];
  result.beside_corner[1] = shape.corner[(node + 1) % n];
  return result;
}

/// Of a segment: what a node may stand for more than its own, at a sixth of a segment more than one from a corner.
constexpr double most_of_share = 0.5 + 17.0 / 216;

void Footholds::may_touch(int row, double xi) {
  for (const Share& carries : {Share{row, 1 - xi}, Share{row + 1, xi}}) {
    const auto known = std::ranges::find(shares, carries.row, &Share::row);
    if (known == shares.end())
      shares.push_back(carries);
    else
      known->share = std::max(known->share, carries.share);
  }
}

Footholds possible_footholds(const Pass& pass, const MasterWindow& window, const Projection& p, int lane, int i,
                             double outward) {
  Footholds result;
  if (!p.hit[lane]) return result;
  const int row = static_cast<int>(p.row[lane]);
  result.may_touch(row, p.xi[lane]);
  if (!pass.master->has_corners()) return result;
  const Faces faces(pass, window);
  const SlaveNode node = slave_node(pass, pass.nodes.begin + i + lane);
  const double more = most_of_share * 2 * std::max(node.length[0], node.length[1]) / (node.length[0] + node.length[1]);
  for (const int way : {-1, 1}) {
    // A corner that may come between the node and its neighbour leaves it the rest of the segment.
    if (!node.corner && faces.end_of_face(node, row, way, 2 * std::max(node.present[0], node.present[1]) + outward))
      result.factor += more;
    if (const int other = faces.beyond(node, row, way, outward); other >= 0) {
      const MasterSegment s = window[other];
      const double along = (node.at - start(s)).dot(tangent(s));
      result.may_touch(other, std::clamp(along / s.length, 0.0, 1.0));
      if (!node.corner) result.factor = std::max(result.factor, 1 + more);
    }
  }
  return result;
}

void attend_to_corners(const Pass& pass, const MasterWindow& window, int i, double outward, Facing& facing) {
  const Faces faces(pass, window);
  const unsigned active = bits(facing.p.hit & first_lanes(pass.nodes.count - i));
  const Lanes nearest = facing.p.row;
  Lanes rows = nearest;
  // Who is no longer beside a face has passed its end, where lengths have come to nothing.
  if (pass.master->has_corners()) facing.length = select(facing.p.hit, facing.length, Lanes{});
  for (unsigned left = active; left != 0; left &= left - 1) {
    const int lane = std::countr_zero(left), row = static_cast<int>(nearest[lane]);
    const SlaveNode node = slave_node(pass, pass.nodes.begin + i + lane);
    const auto [chosen, length] = foothold(node, window, faces, row, outward);
    // A face other than the nearest one was chosen from inside, within a blunt corner also past its beginning.
    rows[lane] = chosen == row && faces.beyond_corner(node, chosen) ? -1 : chosen;
    facing.length[lane] = rows[lane] < 0 ? 0 : length.value;
    if (!length.varies) continue;
    facing.varying |= 1U << lane;
    std::copy(length.gradient.begin(), length.gradient.end(), std::begin(facing.gradient[lane]));
    std::copy(std::begin(length.corner_row), std::end(length.corner_row), std::begin(facing.corner_row[lane]));
  }
  if (!any(facing.p.hit & (rows != nearest))) return;
  const SlaveNodes nodes = load_slaves(pass, i);
  const LaneBits hit = facing.p.hit;
  facing.p = beside(window, nodes.x, nodes.y, rows, outward);
  facing.p.hit = facing.p.hit & hit;
}

}  // namespace pliant
