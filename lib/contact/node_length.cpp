#include <algorithm>

#include "contact/varying_length.hpp"

namespace pliant {
namespace {

/// Cosines of the angle between a node's normal, turned round, and that of a face: from where on it opposes the face in
/// full, 18 degrees, and to where not at all, 36 degrees. Less than half of a right angle: no node opposes both faces
/// at a square corner.
constexpr double square = 0.95, oblique = 0.81;
/// Difference of such cosines at which the lesser of a corner's two segments no longer counts: 35 degrees, as of the
/// least corner that lies flat.
constexpr double lesser = 0.18;

/// Of the shorter of both outlines' longest segments: the way beyond a corner of the master over which a corner of the
/// slave takes over from its neighbour.
constexpr double takeover = 0.1;
/// Of the same: so deep corners of the slave no longer touch the face that they go along with when the flank is nearer;
/// half of it they do in full. So corners that lie on each other but for little touch both at any offset.
constexpr double shallow = 0.005;

/// 0 up to 0, 1 from 1 on, with slope 0 at both.
Varying smooth_step(Varying u) {
  if (u.value <= 0) return {0};
  if (u.value >= 1) return {1};
  const double slope = 6 * u.value * (1 - u.value), value = u.value * u.value * (3 - 2 * u.value);
  Varying v{value};
  for (int i = 0; i < Facing::nodes; ++i) v.gradient[i] = slope * u.gradient[i];
  return v;
}

Varying scaled(double factor, const Varying& of, double shift = 0) {
  Varying v{shift};
  return v.add(factor, of);
}

Varying product(const Varying& a, const Varying& b) {
  Varying v = scaled(b.value, a);
  for (int i = 0; i < Facing::nodes; ++i) v.gradient[i] += a.value * b.gradient[i];
  return v;
}

/// How far a cosine between opposing normals says that they oppose: 0 to 1.
Varying opposed(const Varying& cosine) {
  return smooth_step(scaled(1 / (square - oblique), cosine, -oblique / (square - oblique)));
}

/// What the last two nodes before a corner of the master stand for, r of their segments from it, in segments, the half
/// behind each included. Two in line, s and 1 + s from the corner, share the 1.5 + s that they have.
Varying share_before_corner(const Varying& r) {
  const double s = r.value < 1 ? r.value : r.value - 1, last = s * s * (3.5 - 2 * s), slope = s * (7 - 6 * s);
  Varying v = scaled(r.value < 1 ? slope : 1 - slope, r);
  v.value = r.value < 1 ? last : 1.5 + s - last;
  return v;
}

/// Of a distance: 1 up to half of the limit, 0 from the limit on.
Varying nearness(const Varying& distance, double limit) {
  return scaled(-1, smooth_step(scaled(2 / limit, distance, -1)), 1);
}

/// What the neighbour of a slave's corner stands for while that comes onto the face past the master's corner, r steps
/// from the neighbour: half a segment more goes over to the corner. Where both are hardly below the face, the corner
/// has it at once.
Varying share_beside_corner(const Beside& at, const Vec2& corner, int way, const Varying& r, double sight) {
  const Varying distance = at.distance(corner, way);
  Varying past = scaled(distance.value / (r.value * r.value), r, -distance.value / r.value);
  past.add(1 - 1 / r.value, distance);
  const Varying left = scaled(-1, smooth_step(scaled(1 / (takeover * sight), past)), 1),
                deep = scaled(-1, nearness(at.depth(), shallow * sight), 1);
  return scaled(0.5, product(left, deep), 1);
}

/// What the segment on one side of the node stands for: half of its length, but near the end of the master's face. The
/// last two nodes before the corner share what of the face lies there, as far as they oppose it; each length goes with
/// the node's place without a jump, to nothing at the corner, where other faces come near. A corner of the slave keeps
/// its own: nobody else could stand in for it.
Varying length_of_side(const Beside& at, const Faces& faces, int row, int side, NodeLength& whole) {
  const double length = at.node.length[side];
  if (at.node.corner) return {0.5 * length};
  const int way = (at.node.neighbour[side] - at.node.at).dot(at.t) < 0 ? -1 : 1;
  const std::optional<FaceEnd> end = faces.end_of_face(at.node, row, way, 2 * at.node.present[side]);
  if (!end) return {0.5 * length};
  const Vec2 corner = faces.corner_place(*end);
  const Varying r = at.steps_to(corner, way, side);
  const bool own_corner = at.node.beside_corner[side] && r.value > 1 - tie;  // is on the face too
  if (r.value >= 2 || (own_corner && r.value < 1 + tie)) return {0.5 * length};
  const Varying share = own_corner ? share_beside_corner(at, corner, way, r, faces.sight()) : share_before_corner(r);
  if (own_corner && (share.value <= 1 || at.height >= 0)) return {0.5 * length};
  whole.varies = true;
  whole.corner_row[way < 0 ? 0 : 1] = end->corner;
  const Varying part = opposed(at.opposition_towards(corner, way));
  return r.value < 1 ? scaled(length, product(share, scaled(1.0 / 3, part, 2.0 / 3)), -0.5 * length)
                     : scaled(length, product(part, scaled(1, share, -1)), 0.5 * length);
}

/// The lesser opposing segment of a corner counts by this factor.
Varying factor_of_lesser(const OutlineDirection& master, int side, NodeLength& whole) {
  Varying behind;
  behind.add(1 / lesser, master.opposition(1 - side)).add(-1 / lesser, master.opposition(side));
  whole.varies |= behind.value > 0 && behind.value < 1;
  return scaled(-1, smooth_step(behind), 1);
}

/// Near a corner of the master, a node that is none itself touches the faces that it opposes. One beyond the corner it
/// must oppose wherever it stands: a tip is so thin that a node beside its one face is not deep below the other.
Varying opposed_part(const Beside& at, const Faces& faces, int row, RowKind kind, NodeLength& whole) {
  const double sight = faces.sight();
  const bool nearest = kind == RowKind::nearest;
  Varying part{1};
  for (const int way : {-1, 1}) {
    const std::optional<FaceEnd> end = faces.end_of_face(at.node, row, way, (nearest ? 2 : 4) * sight);
    if (!end) continue;
    const Vec2 corner = faces.corner_place(*end);
    const Varying distance = at.distance(corner, way);
    if (nearest && distance.value >= sight) continue;
    const Varying across = scaled(-1, opposed(at.opposition_towards(corner, way)), 1);
    if (across.value == 0) continue;
    whole.varies = true;
    whole.corner_row[way < 0 ? 0 : 1] = end->corner;
    part = product(part, scaled(-1, nearest ? product(across, nearness(distance, sight)) : across, 1));
  }
  if (nearest) return part;
  whole.varies = true;
  return product(part, nearness(at.depth(), 0.5 * sight));
}

/// Whether the side of a corner that opposes a face goes from there along it, not past its beginning.
bool lies_along(const SlaveNode& node, int way, const Vec2& face) {
  return way * (node.neighbour[node.opposing_side(face)] - node.at).dot(face) > 0;
}

/// What a node stores under a linear penalty beside a segment, but for a factor that all faces share.
double energy(const NodeLength& length, const Beside& at) {
  return at.height < 0 ? length.value * (at.node.at - at.foot).squaredNorm() : 0;
}

}  // namespace

NodeLength node_length(const SlaveNode& node, const MasterWindow& window, const Faces& faces, int row, RowKind kind) {
  const Beside at{node, window[row]};
  NodeLength whole;
  Varying total;
  for (int side = 0; side < 2; ++side) {
    const Varying length = length_of_side(at, faces, row, side, whole);
    total.add(1, node.corner ? product(factor_of_lesser({at, window, faces, row}, side, whole), length) : length);
  }
  if (!node.corner) total = product(opposed_part(at, faces, row, kind, whole), total);
  if (node.corner && kind != RowKind::nearest) {
    whole.varies = true;
    total = product(opposed(at.opposition(node.opposing_side(at.t))), total);
    if (kind == RowKind::beyond_corner) total = product(nearness(at.depth(), shallow * faces.sight()), total);
  }
  if (total.value <= 0) total = {};  // beside a face shorter than the node's own segments
  whole.value = total.value;
  whole.gradient = total.gradient;
  return whole;
}

Foothold foothold(const SlaveNode& node, const MasterWindow& window, const Faces& faces, int row, double outward) {
  Foothold result{row, node_length(node, window, faces, row, RowKind::nearest)};
  const double height = faces.height(node, row), rounding = tie * window[row].length;
  if (height >= (node.corner ? rounding : 0)) return result;
  double stored = energy(result.length, Beside{node, window[row]});
  const auto try_face = [&](int way, RowKind kind, bool less) {
    const int other = faces.beyond(node, row, way, outward);
    if (other < 0 || faces.height(node, other) >= 0) return;
    if (node.corner && !less && (faces.beyond_corner(node, other) || !lies_along(node, way, tangent(window[other]))))
      return;
    const NodeLength length = node_length(node, window, faces, other, kind);
    const double there = energy(length, Beside{node, window[other]});
    if (less ? there < stored : there > stored) stored = there, result = {other, length};
  };
  const bool at_corner = node.corner && height > -rounding;
  if (node.corner && !at_corner)
    for (const int way : {-1, 1}) try_face(way, RowKind::nearest, true);
  for (const int way : {-1, 1}) try_face(way, at_corner ? RowKind::at_corner : RowKind::beyond_corner, false);
  return result;
}

}  // namespace pliant
