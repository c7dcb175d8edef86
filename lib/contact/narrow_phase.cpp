#include "contact/narrow_phase.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "contact/half_pass.hpp"
#include "core/lanes.hpp"

namespace pliant {
namespace {

/// One body of a pair, as the search for contacts with the other sees it.
struct ContactSide {
  const OutlineShape* shape;
  const double* x;
  const double* y;
  Vec2 shift;  ///< to the image
  Box box;     ///< of the image
  double longest_segment;
  int first_turn = 0, last_turn = 0;  ///< turns of the outline to search: 0 to 0 for a closed one

  Vec2 point(int turn, int i) const { return {x[i] + shift.x() + turn * shape->turn_shift, y[i] + shift.y()}; }
};

double longest_segment(const OutlineShape& shape, const double* x, const double* y) {
  double square = 0;
  for (int i = 0; i < shape.count; ++i) {
    const double dx = x[i + 1] - x[i], dy = y[i + 1] - y[i];
    square = std::max(square, dx * dx + dy * dy);
  }
  return std::sqrt(square);
}

Box inflated(Box box, double by) { return {box.x_min - by, box.x_max + by, box.y_min - by, box.y_max + by}; }

bool inside(const Box& box, const Vec2& p) {
  return p.x() >= box.x_min && p.x() <= box.x_max && p.y() >= box.y_min && p.y() <= box.y_max;
}

/// Finds the turns of a wall's outline that cover [x_min, x_max] of the target.
void find_turns(ContactSide& side, const Box& target) {
  if (side.shape->turn_shift == 0) return;
  const double period = std::abs(side.shape->turn_shift);
  const int low = static_cast<int>(std::floor((target.x_min - side.box.x_max) / period));
  const int high = static_cast<int>(std::ceil((target.x_max - side.box.x_min) / period));
  const bool reversed = side.shape->turn_shift < 0;
  side.first_turn = reversed ? -high : low;
  side.last_turn = reversed ? -low : high;
}

/// Least and largest coordinate along d of the side's nodes inside a box; empty: least > largest.
std::pair<double, double> extent(const ContactSide& side, const Box& box, const Vec2& d) {
  std::pair<double, double> result{1e300, -1e300};
  for (int turn = side.first_turn; turn <= side.last_turn; ++turn)
    for (int i = 0; i < side.shape->count; ++i)
      if (const Vec2 p = side.point(turn, i); inside(box, p)) {
        result.first = std::min(result.first, p.dot(d));
        result.second = std::max(result.second, p.dot(d));
      }
  return result;
}

/// Shortest cyclic arc that contains all flagged nodes of a closed outline.
Arc covering_arc(const std::vector<char>& flags) {
  const int n = static_cast<int>(flags.size());
  int best_gap = 0, best_end = 0, gap = 0;
  for (int i = 0; i < 2 * n; ++i) {
    gap = flags[i < n ? i : i - n] ? 0 : gap + 1;
    if (gap > best_gap) best_gap = gap, best_end = i + 1;
  }
  if (best_gap >= n) return {};
  return {best_end % n, n - best_gap};
}

/// Nodes inside the box with a coordinate along d of at least `least`, as one arc.
Arc select_arc(const ContactSide& side, const Box& box, const Vec2& d, double least) {
  const int n = side.shape->count;
  if (side.shape->turn_shift == 0) {
    thread_local std::vector<char> flags;  // so that memory is allocated once
    flags.resize(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) {
      const double x = side.x[i] + side.shift.x(), y = side.y[i] + side.shift.y();
      flags[i] =
          (x >= box.x_min) & (x <= box.x_max) & (y >= box.y_min) & (y <= box.y_max) & (x * d.x() + y * d.y() >= least);
    }
    return covering_arc(flags);
  }
  int begin = 0, end = -1;
  for (int turn = side.first_turn; turn <= side.last_turn; ++turn)
    for (int i = 0; i < n; ++i) {
      const Vec2 p = side.point(turn, i);
      if (!inside(box, p) || p.dot(d) < least) continue;
      if (end < begin) begin = turn * n + i;
      end = turn * n + i;
    }
  return {begin, end - begin + 1};
}

Vec2 direction(const Model& model, const ContactPair& pair, const Box& a, const Box& b) {
  const double dy = b.y_min + b.y_max - a.y_min - a.y_max;
  if (model.bodies[pair.second].wall || model.bodies[pair.first].wall) return {0, dy > 0 ? 1.0 : -1.0};
  const Vec2 d(b.x_min + b.x_max - a.x_min - a.x_max, dy);
  return d.norm() > 0 ? d.normalized() : Vec2(1, 0);
}

ContactSide make_side(const Model& model, const OutlineField& outlines, int body, const Vec2& shift) {
  const OutlineShape& shape = model.outline_of(body);
  const double *x = &outlines.x[model.outline_offset[body]], *y = &outlines.y[model.outline_offset[body]];
  Box box = bounding_box(model, outlines, body);
  box.x_min += shift.x(), box.x_max += shift.x(), box.y_min += shift.y(), box.y_max += shift.y();
  return {&shape, x, y, shift, box, longest_segment(shape, x, y)};
}

/// Arcs that contain everything within the margin, by boxes and by planes across the line of centres that bound the
/// bodies.
std::array<Arc, 2> find_rough_arcs(const Model& model, const ContactSide& a, ContactSide& b, const ContactPair& pair,
                                   double margin) {
  // One more segment, because that end of a touched segment which is beyond the plane may be the far one.
  const double reach_a = margin + a.longest_segment, reach_b = margin + b.longest_segment;
  const Box region_b = inflated(a.box, reach_b);
  find_turns(b, region_b);
  Box region_a = inflated(b.box, reach_a);
  if (model.bodies[pair.second].wall) region_a.x_min = -1e300, region_a.x_max = 1e300;
  const Vec2 d = direction(model, pair, a.box, b.box);
  const Box everywhere{-1e300, 1e300, -1e300, 1e300};
  const auto extent_a = extent(a, everywhere, d);
  const auto extent_b =
      extent(b, model.bodies[pair.second].wall ? inflated(region_b, b.longest_segment) : everywhere, d);
  if (extent_b.first > extent_b.second) return {};
  return {select_arc(a, region_a, d, extent_b.first - margin),
          select_arc(b, region_b, -d, -(extent_a.second + margin))};
}

/// Shortest arc of the entries marked so far.
struct Span {
  int begin = 1 << 30, end = -(1 << 30);
  void add(int i) { begin = std::min(begin, i), end = std::max(end, i + 1); }
  Arc arc() const { return end < begin ? Arc{} : Arc{begin, end - begin}; }
};

/// Distance of eight nodes to a segment, negative below its line.
Lanes signed_distance(const MasterSegment& segment, Lanes px, Lanes py) {
  const Lanes rx = px - segment.x, ry = py - segment.y;
  const Lanes along = rx * segment.tangent_x + ry * segment.tangent_y,
              height = rx * segment.tangent_y - ry * segment.tangent_x;
  const Lanes over = along - min(max(along, Lanes{}), broadcast(segment.length));
  const Lanes distance = sqrt(over * over + height * height);
  return select(height < 0.0, -distance, distance);
}

/// Search distances, m.
struct Margins {
  double reach;  ///< reach of the law and a skin
  double skin;
  double depth;  ///< detection depth below the master's segments
};

/// Nodes or segments of an outline that are near, and the arc that contains them. On a closed outline it is the
/// shortest arc, which does not depend on the arc that boxes let in. In self-contact it stays within the arc that is
/// searched.
class Near {
 public:
  Near(const OutlineShape& shape, bool itself, std::vector<char>& flags)
      : closed_(shape.turn_shift == 0 && !itself), flags_(flags) {
    if (closed_) flags_.assign(static_cast<std::size_t>(shape.count), 0);
  }
  void add(int i) {
    if (closed_) {
      const int n = static_cast<int>(flags_.size());
      flags_[static_cast<std::size_t>(i - turn_of(i, n) * n)] = 1;
    } else {
      span_.add(i);
    }
  }
  Arc arc() const { return closed_ ? covering_arc(flags_) : span_.arc(); }

 private:
  bool closed_;
  std::vector<char>& flags_;
  Span span_;
};

/// Nodes of a side and segments of the other that can touch.
struct Touchable {
  Arc nodes, segments;
  double distance;  ///< least one between a node and a segment, m
};

/// Narrows one side's nodes, and the other's segments, given as `window`, to those that can touch. A node outside can
/// move to a depth of the skin, one inside a skin deeper. To find the nearest face then, all segments within two skins
/// of the present reach must be known.
Touchable narrow(const ContactSide& slave, const ContactSide& master, const Arc& candidates, const MasterWindow& window,
                 int first_segment, const Margins& margins) {
  thread_local std::vector<char> node_flags, segment_flags;  // so that memory is allocated once
  const bool itself = &slave == &master;
  Near near_nodes(*slave.shape, itself, node_flags), near_segments(*master.shape, itself, segment_flags);
  const int n = slave.shape->count;
  Lanes least = broadcast(1e300);
  for (int i = 0; i < candidates.count; i += lane_count) {
    const int index = candidates.begin + i, turn = turn_of(index, n), node = index - turn * n;
    const Lanes px = load(slave.x + node) + (slave.shift.x() + turn * slave.shape->turn_shift),
                py = load(slave.y + node) + slave.shift.y();
    Lanes nearest = broadcast(1e300);
    for (int row = 0; row < window.count(); ++row) {
      const Lanes distance = signed_distance(window[row], px, py);
      nearest = select(abs(distance) <= abs(nearest), distance, nearest);
    }
    const Lanes limit = select(nearest < 0.0, broadcast(std::max(margins.reach, margins.depth + margins.skin)),
                               broadcast(margins.reach));
    const LaneBits active = first_lanes(candidates.count - i), chosen = active & (abs(nearest) <= limit);
    least = select(active, min(least, abs(nearest)), least);
    if (!any(chosen)) continue;
    for (int lane = 0; lane < lane_count; ++lane)
      if (chosen[lane]) near_nodes.add(candidates.begin + i + lane);
    const Lanes reach = max(-nearest, broadcast(margins.reach)) + 2 * margins.skin;
    for (int row = 0; row < window.count(); ++row)
      if (any(chosen & (abs(signed_distance(window[row], px, py)) <= reach))) near_segments.add(first_segment + row);
  }
  return {near_nodes.arc(), near_segments.arc(), -largest(-least)};
}

/// Segments at the nodes of an arc. A wall against a wall is searched some way beyond the end of the period, so that
/// the result is the same on both sides of it.
Arc segments_at(const ContactSide& side, const Arc& nodes, bool two_walls) {
  const int more = two_walls ? lane_count : 0;
  const Arc all{nodes.begin - 1 - more, nodes.count + 1 + 2 * more};
  return side.shape->turn_shift == 0 && all.count > side.shape->count ? Arc{nodes.begin, side.shape->count} : all;
}

/// The arc with the medial neighbours of all its segments and nodes.
Arc with_medial_neighbours(const OutlineShape& shape, const Arc& segments) {
  const int n = shape.count;
  if (segments.count == 0 || (shape.turn_shift == 0 && segments.count >= n)) return segments;
  Arc result = segments;
  thread_local std::vector<char> flags;  // so that its memory is found once
  if (shape.turn_shift == 0) flags.assign(static_cast<std::size_t>(n), 0);
  const auto within = [&](int i) { return i - turn_of(i, n) * n; };
  const auto add = [&](int i) {
    if (shape.turn_shift == 0)
      flags[within(i)] = 1;
    else
      result = hull(result, {i, 1});
  };
  for (int i = segments.begin; i <= segments.end(); ++i) {
    if (i < segments.end()) {
      add(i);
      for (const int offset : shape.medial.of(within(i))) add(i + offset);
    }
    for (const int offset : shape.node_medial.of(within(i))) add(i + offset);
  }
  if (shape.turn_shift != 0) return result;
  result = covering_arc(flags);
  if (result.count == n) return {segments.begin, n};
  while (result.begin > segments.begin) result.begin -= n;
  while (result.end() < segments.end()) result.begin += n;
  return result;
}

/// Shifts the numbers of a closed outline's segments by a turn if segments and nodes then make a shorter arc.
void bring_together(const OutlineShape& shape, const Arc& nodes, Arc& segments) {
  if (shape.turn_shift != 0 || nodes.count == 0 || segments.count == 0) return;
  const Arc here = segments;
  for (const int turn : {-1, 1})
    if (const Arc there{here.begin + turn * shape.count, here.count};
        hull(nodes, there).count < hull(nodes, segments).count)
      segments = there;
}

/// Segments of a side that can touch: those with a node near the other outline, or near a node of it. Each slave
/// segment occurs once.
void widen_to_segments(const OutlineShape& shape, bool two_walls, int side, ContactPair& contact_pair) {
  Arc &nodes = contact_pair.nodes[side], &segments = contact_pair.segments[side];
  if (nodes.count > 0) {
    const Arc adjacent{nodes.begin - 1, nodes.count + 1};
    segments = segments.count == 0 ? adjacent : hull(adjacent, segments);
  }
  if (shape.turn_shift == 0 && segments.count > shape.count) segments.count = shape.count;
  const int slaves = two_walls ? std::min(segments.count, shape.count) : segments.count;
  const bool whole = slaves == shape.count && (two_walls || shape.turn_shift == 0);
  nodes = {segments.begin, slaves == 0 ? 0 : whole ? slaves : slaves + 1};
  contact_pair.slave_segments[side] = slaves;
  contact_pair.window[side] = with_medial_neighbours(shape, segments);
}

}  // namespace

double find_arcs(const Model& model, const OutlineField& outlines, ContactPair& contact_pair, double margin,
                 double skin, MasterWindow& scratch, double distance) {
  const Vec2 shift = outlines.lattice.shift(contact_pair.images);
  ContactSide sides[2] = {make_side(model, outlines, contact_pair.first, {0, 0}),
                          make_side(model, outlines, contact_pair.second, shift)};
  const double longest = std::max(sides[0].longest_segment, sides[1].longest_segment);
  double gap =
      std::max({distance, margin + 2 * skin, longest + 4 * skin});  // lower bound for all that is not in rough arcs
  const std::array<Arc, 2> rough = find_rough_arcs(model, sides[0], sides[1], contact_pair, gap);
  if (rough[0].count == 0 || rough[1].count == 0) return gap;
  const bool two_walls = model.bodies[contact_pair.first].wall && model.bodies[contact_pair.second].wall;
  for (int slave = 0; slave < 2; ++slave) {
    const ContactSide& master = sides[1 - slave];
    const Arc segments = segments_at(master, rough[1 - slave], two_walls);
    scratch.fill(*master.shape, master.x, master.y, segments, master.shift, skin);
    // The depth follows from the whole outline: the part that boxes let in depends on the axes.
    const Margins margins{margin, skin, master.longest_segment + skin};
    const Touchable found = narrow(sides[slave], master, rough[slave], scratch, segments.begin, margins);
    contact_pair.nodes[slave] = found.nodes, contact_pair.segments[1 - slave] = found.segments;
    gap = std::min(gap, found.distance);
    // Walls meet along the whole period: one image of each node suffices. A body as wide as the period may touch two
    // images.
    if (two_walls)
      contact_pair.nodes[slave].count = std::min(contact_pair.nodes[slave].count, sides[slave].shape->count);
  }
  for (int side = 0; side < 2; ++side)
    bring_together(*sides[side].shape, contact_pair.nodes[side], contact_pair.segments[side]);
  for (int side = 0; side < 2; ++side) contact_pair.window[side] = contact_pair.segments[side];
  if (contact_pair.integrated)
    for (int side = 0; side < 2; ++side) widen_to_segments(*sides[side].shape, two_walls, side, contact_pair);
  return gap;
}

void find_self_pairs(const Model& model, const OutlineField& outlines, const ContactPair& of_body, double margin,
                     double skin, std::vector<ContactPair>& contact_pairs, MasterWindow& scratch) {
  const ContactSide side = make_side(model, outlines, of_body.first, {0, 0});
  const int n = side.shape->count;
  constexpr int together = 2, unseen = 2;
  for (int begin = 0; begin < n; begin += together) {
    const Arc nodes{begin, std::min(together, n - begin) + of_body.integrated};
    const Arc segments{nodes.end() + unseen, n - nodes.count - 1 - 2 * unseen};
    if (segments.count <= 0) continue;
    scratch.fill(*side.shape, side.x, side.y, segments, {0, 0}, skin);
    ContactPair contact_pair = of_body;
    contact_pair.part = begin;
    const Margins margins{margin, skin, scratch.depth()};
    const Touchable found = narrow(side, side, nodes, scratch, segments.begin, margins);
    contact_pair.nodes[0] = found.nodes, contact_pair.segments[1] = contact_pair.window[1] = found.segments;
    if (contact_pair.nodes[0].count == 0) continue;
    if (contact_pair.integrated) {
      contact_pair.nodes[0] = nodes, contact_pair.slave_segments[0] = nodes.count - 1;
      contact_pair.window[1] = with_medial_neighbours(*side.shape, contact_pair.segments[1]);
    }
    contact_pairs.push_back(contact_pair);
  }
}

}  // namespace pliant
