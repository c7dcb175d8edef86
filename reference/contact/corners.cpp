#include "reference/contact/corners.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace pliant::reference {
namespace {

using Length = Jet<2 * NodeLength::nodes>;
struct Arrow {
  Length x, y;
};
Arrow operator+(const Arrow& a, const Arrow& b) { return {a.x + b.x, a.y + b.y}; }
Arrow operator-(const Arrow& a, const Arrow& b) { return {a.x - b.x, a.y - b.y}; }
Arrow operator*(const Length& factor, const Arrow& a) { return {factor * a.x, factor * a.y}; }
Length dot(const Arrow& a, const Arrow& b) { return a.x * b.x + a.y * b.y; }
Length norm(const Arrow& a) { return sqrt(dot(a, a)); }
Arrow unit(const Arrow& a) { return 1 / norm(a) * a; }

constexpr double square = 0.95;    ///< cosine of the angle by which opposed normals may differ, squarely
constexpr double oblique = 0.81;   ///< likewise: from which on a node does not oppose a face at all
constexpr double takeover = 0.1;   ///< of a sight: past the master's corner, from the slave's neighbour to it
constexpr double shallow = 0.005;  ///< of a sight: no deeper do corners touch a face when a flank is nearer
constexpr double lesser = 0.18;    ///< difference of such cosines from which a corner's other segment is idle

double turn(const Vec2& before, const Vec2& after) {
  return std::atan2(pliant::cross(before, after), before.dot(after));
}

double along(const Face& master, int segment, const SlaveNode& node) {
  return (node.at - master.outline.node(segment)).dot(master.outline.tangent(segment));
}

double height(const Face& master, int segment, const SlaveNode& node) {
  return pliant::cross(master.outline.tangent(segment), master.outline.node(segment) - node.at);
}

/// The corner that ends a segment's face on a way (-1 or 1), if it is no further than `limit` from beside the node.
std::optional<int> face_end(const Face& master, int segment, const SlaveNode& node, int way, double limit) {
  const double length = master.outline.length(segment), foot = std::clamp(along(master, segment, node), 0.0, length);
  double distance = way < 0 ? foot : length - foot;
  int end = way < 0 ? segment : segment + 1;
  for (; distance <= limit && !master.corners.at(end); end += way)
    distance += master.outline.length(way < 0 ? end - 1 : end);
  return distance <= limit ? std::optional(end) : std::nullopt;
}

/// Whether a point lies past a corner, seen from the face that ends there on that way.
bool is_past(const Face& master, int corner, int way, const Vec2& point) {
  const int segment = way < 0 ? corner : corner - 1;
  return way * (point - master.outline.node(corner)).dot(master.outline.tangent(segment)) >
         tie * master.outline.length(segment);
}

bool is_beyond(const Face& master, int segment, const SlaveNode& node) {
  return (master.corners.at(segment) && is_past(master, segment, -1, node.at)) ||
         (master.corners.at(segment + 1) && is_past(master, segment + 1, 1, node.at));
}

/// The segment of the face beyond a corner that the node stands beside. One that is a corner itself may also stand
/// inside a blunt corner, past the beginning of that face.
std::optional<int> beside_face(const Face& master, int corner, int way, const SlaveNode& node, double outward) {
  int segment = way < 0 ? corner - 1 : corner;
  if (is_past(master, corner, -way, node.at))
    return node.corner && height(master, segment, node) < 0 ? std::optional(segment) : std::nullopt;
  for (int next = segment + (way < 0 ? 0 : 1); !master.corners.at(next); next += way, segment += way) {
    const Vec2 halving = master.outline.tangent(next - 1) + master.outline.tangent(next);
    if (((node.at - master.outline.node(next)).dot(halving) < 0) != (way < 0)) break;
  }
  if (is_beyond(master, segment, node) || height(master, segment, node) > outward) return {};
  return segment;
}

/// Whether the side of a node that opposes a segment better leads from it onwards on that way.
bool goes_along(const Face& master, int segment, int way, const SlaveNode& node) {
  const Vec2 t = master.outline.tangent(segment), back = node.before - node.at, on = node.after - node.at;
  return way * (back.normalized().dot(t) > -on.normalized().dot(t) ? back : on).dot(t) > 0;
}

/// From 0 at `low` to 1 at `high`, with slope 0 there.
Length ramp(const Length& x, double low, double high) {
  const Length u = (x - low) / (high - low);
  if (u.value <= 0) return 0;
  return u.value < 1 ? u * u * (3 - 2 * u) : Length(1);
}

/// Its nearest segment, one beyond a corner from there, or one that begins at the corner on which the node lies.
enum class Place { nearest, beyond, on_corner };

/// A node beside a segment, with all that its length depends on as variables.
class Stand {
 public:
  Stand(const Face& master, int segment, const SlaveNode& node)
      : master_(master),
        segment_(segment),
        node_(node),
        own_{arrow(node.before, 0), arrow(node.at, 1), arrow(node.after, 2)} {
    const Arrow first = on_master(0), second = on_master(1);
    chord_ = second - first;
    const Length squared = dot(chord_, chord_), part = dot(own_[1] - first, chord_) / squared;
    if (part.value <= 0)
      foot_ = first;
    else if (part.value >= 1)
      foot_ = second;
    else
      foot_ = {first.x + part * chord_.x, first.y + part * chord_.y};
  }

  /// From the segment; negative inside, m.
  double gap() const { return std::copysign(norm(own_[1] - foot_).value, height(master_, segment_, node_)); }

  NodeLength length(Place place) {
    Length sum = side(0) + side(2);
    if (!node_.corner) sum *= opposed_part(place == Place::nearest);
    if (place == Place::beyond)
      sum *= vicinity(safe_norm(own_[1] - foot_), master_.sight * (node_.corner ? shallow : 0.5));
    if (node_.corner && place != Place::nearest) sum *= flatness();
    result_.value = sum.value > 0 ? sum : Length(0);  // not positive beside a face shorter than the node's own segments
    return result_;
  }

 private:
  static Arrow arrow(const Vec2& place, int number) { return {{place.x(), 2 * number}, {place.y(), 2 * number + 1}}; }

  /// The segment's first node (0) and second (1), or the next before (-1) and after them (2).
  Arrow on_master(int number) const {
    constexpr int place[4] = {5, 3, 4, 6};
    return arrow(master_.outline.node(segment_ + number), place[number + 1]);
  }
  /// Which way the outline leads where the node stands: on either bisector as the two segments there do in the mean,
  /// but at a corner as this one, and in between by the node's ways from both. So it does not jump from one segment to
  /// the next.
  Arrow outline_direction() const {
    const auto at_end = [&](int end) {
      if (master_.corners.at(segment_ + end)) return 2 * unit(chord_);
      return unit(chord_) + (end == 0 ? unit(on_master(0) - on_master(-1)) : unit(on_master(2) - on_master(1)));
    };
    const Arrow first = at_end(0), second = at_end(1);
    const Length from_first = dot(own_[1] - on_master(0), first), to_second = dot(on_master(1) - own_[1], second);
    if (from_first.value <= 0 && to_second.value <= 0) return first + second;
    if (from_first.value <= 0) return first;
    if (to_second.value <= 0) return second;
    return to_second * first + from_first * second;
  }

  Arrow edge(int neighbour) const { return neighbour == 0 ? own_[0] - own_[1] : own_[1] - own_[2]; }
  /// Between the turned normal of the node's segment towards that neighbour and the normal of a face along `to`.
  Length cosine(int neighbour, const Arrow& to) const {
    return dot(edge(neighbour), to) / (norm(edge(neighbour)) * norm(to));
  }
  /// From the foot to the corner that ends the face on a way.
  Arrow to_corner(int end, int way) {
    const int number = way < 0 ? 0 : 1;
    result_.corner[number] = end;
    return arrow(master_.outline.node(end), 7 + number) - foot_;
  }
  static Length safe_norm(const Arrow& a) { return a.x.value == 0 && a.y.value == 0 ? Length(0) : norm(a); }
  /// 1 up to half of the limit, 0 from the limit on.
  static Length vicinity(const Length& distance, double limit) { return 1 - ramp(distance, limit / 2, limit); }

  /// What the segment towards a neighbour stands for.
  Length side(int neighbour) {
    const double full = neighbour == 0 ? node_.length_before : node_.length_after;
    if (node_.corner) {
      const Arrow on = outline_direction();
      return 0.5 * full * (1 - ramp(cosine(2 - neighbour, on) - cosine(neighbour, on), 0, lesser));
    }
    const Arrow onward = neighbour == 0 ? edge(0) : -1 * edge(2);
    const int way = dot(onward, chord_).value < 0 ? -1 : 1;
    const auto end = face_end(master_, segment_, node_, way, 2 * norm(onward).value);
    if (!end) return 0.5 * full;
    const NodeLength before = result_;
    const Arrow corner = to_corner(*end, way);
    const Length squared = dot(corner, corner), part = dot(onward, corner);
    const Length r = squared.value == 0 ? Length(0) : part.value > 0 ? squared / part : Length(2);
    const bool own_corner = (neighbour == 0 ? node_.corner_before : node_.corner_after) && r.value > 1 - tie;
    const Length rest = own_corner ? norm(corner) * (1 - 1 / r) : Length(0);  // from that corner to the master's
    const double width = takeover * master_.sight;
    const bool above = height(master_, segment_, node_) >= 0;
    if (r.value >= 2 || (own_corner && (r.value < 1 + tie || rest.value >= width || above))) {
      result_ = before;
      return 0.5 * full;
    }
    const Length opposed = opposition(corner, way);
    if (own_corner) {
      const Length deep = 1 - vicinity(safe_norm(own_[1] - foot_), shallow * master_.sight);
      return full * (0.5 + 0.5 * opposed * deep * (1 - ramp(rest, 0, width)));
    }
    if (r.value < 1) return full * (last_share(r) * (2 + opposed) / 3 - 0.5);
    return full * (0.5 + opposed * (r - 0.5 - last_share(r - 1)));
  }

  /// Of the last node before a corner, in segments, and with it of the one before that: both share 3/2 and what lies
  /// between the last one and the corner.
  static Length last_share(const Length& r) { return r * r * (3.5 - 2 * r); }

  /// How far a node that is no corner opposes the face towards the corner there.
  Length opposition(const Arrow& corner, int way) const {
    if (safe_norm(corner).value == 0) return 0;
    const Arrow across = own_[0] - own_[2];  // along a face that the node opposes
    return ramp(dot(across, corner) * way / (norm(across) * norm(corner)), oblique, square);
  }

  /// How far the flatter side of a corner goes along with the segment.
  Length flatness() const {
    const Length first = cosine(0, chord_), second = cosine(2, chord_);
    return ramp(first > second ? first : second, oblique, square);
  }

  /// Near a corner a node that is none itself touches the faces that it opposes; those beyond the corner in no other
  /// way, however far off the corner is.
  Length opposed_part(bool its_own) {
    Length part = 1;
    for (const int way : {-1, 1}) {
      const auto end = face_end(master_, segment_, node_, way, (its_own ? 2 : 4) * master_.sight);
      if (!end) continue;
      const NodeLength before = result_;
      const Arrow corner = to_corner(*end, way);
      const Length distance = safe_norm(corner);
      const Length opposed = opposition(corner, way);
      if ((its_own && distance.value >= master_.sight) || opposed.value == 1)
        result_ = before;
      else
        part *= 1 - (1 - opposed) * (its_own ? vicinity(distance, master_.sight) : Length(1));
    }
    return part;
  }

  const Face& master_;
  int segment_;
  const SlaveNode& node_;
  Arrow own_[3], chord_, foot_;
  NodeLength result_;
};

}  // namespace

Corners::Corners(const ContactOutline& outline) {
  const int n = outline.count;
  const auto edge = [&](int i) {
    const int from = ((i % n) + n) % n, to = (from + 1) % n;
    return Vec2(outline.reference[to] + Vec2(to == 0 ? outline.turn_shift : 0, 0) - outline.reference[from]);
  };
  for (int i = 0; i < n; ++i) {
    corner_.push_back(turn(edge(i - 1), edge(i)) > corner_turn);
    length_.push_back(edge(i).norm());
  }
  any_ = std::count(corner_.begin(), corner_.end(), true) > 0;
  longest_ = *std::max_element(length_.begin(), length_.end());
}

std::optional<Footing> footing(const Face& master, int segment, const SlaveNode& node, double outward) {
  Stand nearest(master, segment, node);
  Footing best{segment, nearest.length(Place::nearest)};
  if (!master.corners.any()) return best;
  const double own_height = height(master, segment, node), rounding = tie * master.outline.length(segment);
  const auto energy = [](const NodeLength& length, double gap) { return length.value.value * gap * gap; };
  if (own_height < (node.corner ? rounding : 0)) {
    const bool on_corner = node.corner && own_height > -rounding;
    double stored = energy(best.length, std::min(nearest.gap(), 0.0));
    const auto compare = [&](Place place, auto&& better) {
      for (const int way : {-1, 1}) {
        const auto end = face_end(master, segment, node, way, 2 * master.sight + outward);
        const auto other = end ? beside_face(master, *end, way, node, outward) : std::nullopt;
        if (!other || height(master, *other, node) >= 0) continue;
        if (node.corner && place != Place::nearest &&
            (is_beyond(master, *other, node) || !goes_along(master, *other, way, node)))
          continue;
        Stand there(master, *other, node);
        const NodeLength length = there.length(place);
        if (const double e = energy(length, there.gap()); better(e, stored)) stored = e, best = {*other, length};
      }
    };
    if (node.corner && !on_corner) compare(Place::nearest, std::less<>());
    compare(on_corner ? Place::on_corner : Place::beyond, std::greater<>());
  }
  return best.segment == segment && is_beyond(master, segment, node) ? std::nullopt : std::optional(best);
}

}  // namespace pliant::reference
