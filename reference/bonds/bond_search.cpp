#include "reference/bonds/bond_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "reference/contact/pair_laws.hpp"
#include "reference/contact/reference_outline.hpp"

namespace pliant::reference {
namespace {

constexpr double common_node_rounding = 1e-6;  ///< rounding of common nodes, over the mean segment of the slave
constexpr double furthest_node = 0.5;          ///< of a master, over the same
/// Share of a segment that the master's points span at least along it. Else both are at one place, such as a corner.
constexpr double least_span = 0.5;

bool names(const std::string& side, const ContactOutline& outline) {
  return side == "all" || side == outline.material || side == outline.name;
}

bool joins(const BondRule& rule, const ContactOutline& a, const ContactOutline& b) {
  return (names(rule.first, a) && names(rule.second, b)) || (names(rule.first, b) && names(rule.second, a));
}

struct Found {
  MasterPoint point;
  double distance = std::numeric_limits<double>::infinity();
};

/// Nearest point of a master. All turns of a wall that can be nearest are tried.
Found nearest(const PresentOutline& master, const Vec2& to) {
  int first = 0, count = master.count();
  if (!master.closed()) {
    first = count * (static_cast<int>(std::lround((to.x() - master.node(0).x()) / master.turn_shift())) - 2);
    count *= 4;
  }
  Found best;
  for (int segment = first; segment < first + count; ++segment) {
    const Vec2 from = master.node(segment), edge = master.node(segment + 1) - from;
    const double xi = std::clamp((to - from).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    const double distance = (to - from - xi * edge).norm();
    if (distance < best.distance) best = {{segment, xi}, distance};
  }
  return best;
}

/// Box around an outline.
struct OutlineBox {
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity()), high = -low;
  explicit OutlineBox(const PresentOutline& outline) {
    for (int i = 0; i < outline.count(); ++i)
      low = low.cwiseMin(outline.node(i)), high = high.cwiseMax(outline.node(i));
  }
};

class Search {
 public:
  Search(const std::vector<ContactOutline>& outlines, const Points& x, const Periods& periods, double gap)
      : outlines_(outlines), x_(x), periods_(periods), gap_(gap) {}

  /// Bonds of two bodies, a before b in the list.
  void join(int a, int b) {
    const bool swaps = !outlines_[static_cast<std::size_t>(b)].wall && mean_spacing(of(b)) < mean_spacing(of(a));
    const int slave = swaps ? b : a, master = swaps ? a : b;
    if (of(master).wall) return join_image(slave, master, {});
    const OutlineBox ours(PresentOutline(of(slave), x_)), theirs(PresentOutline(of(master), x_));
    const Vec2 around = Vec2::Constant(std::max(gap_, mean_spacing(of(slave))));
    for (const Image& image : periods_.between(ours.low - theirs.high - around, ours.high - theirs.low + around))
      join_image(slave, master, image);
  }

  std::vector<Bond> bonds;

 private:
  const ContactOutline& of(int body) const { return outlines_[static_cast<std::size_t>(body)]; }

  void join_image(int slave, int master, const Image& image) {
    const PresentOutline ours(of(slave), x_), theirs(of(master), x_);
    const Vec2 shift = periods_.shift(image);
    for (int segment = 0; segment < ours.count(); ++segment) {
      const std::array<Found, 2> found{nearest(theirs, ours.node(segment) - shift),
                                       nearest(theirs, ours.node(segment + 1) - shift)};
      Bond bond;
      bond.slave = slave, bond.master = master, bond.segment = segment, bond.image = image;
      bond.points = {found[0].point, found[1].point};
      bond.length = ReferenceOutline(of(slave)).length(segment);
      if (holds(bond, found, points_of(bond, ours, theirs, shift))) bonds.push_back(bond);
    }
  }

  /// Sets the distances at rest. Returns whether the segment is bonded.
  bool holds(Bond& bond, const std::array<Found, 2>& found, const BondPoints& points) const {
    const double spacing = mean_spacing(of(bond.slave));
    const double across = std::max(gap_, common_node_rounding * spacing),
                 away = std::max(across, furthest_node * spacing);
    if (found[0].distance > away || found[1].distance > away) return false;
    const Vec2 edge = points[1] - points[0];
    if ((points[3] - points[2]).dot(edge) < least_span * edge.squaredNorm()) return false;
    const BondDistances rest = distances_of(points);
    for (std::size_t end = 0; end < 2; ++end) {
      bond.rest_gap[end] = rest.gap[end].value, bond.rest_slip[end] = rest.slip[end].value;
      if (bond.rest_gap[end] > across) return false;
    }
    return true;
  }

  const std::vector<ContactOutline>& outlines_;
  const Points& x_;
  const Periods& periods_;
  double gap_;
};

}  // namespace

std::vector<Bond> find_bonds(const Scene& scene, const std::vector<ContactOutline>& outlines, const Points& x,
                             const Periods& periods, int rule) {
  const BondRule& wanted = scene.bonds[static_cast<std::size_t>(rule)];
  Search search(outlines, x, periods, wanted.gap);
  const int count = static_cast<int>(outlines.size());
  for (int a = 0; a < count; ++a)
    for (int b = a + 1; b < count; ++b) {
      const ContactOutline &one = outlines[static_cast<std::size_t>(a)], &other = outlines[static_cast<std::size_t>(b)];
      if (!one.wall && joins(wanted, one, other)) search.join(a, b);
    }
  for (Bond& bond : search.bonds) bond.rule = rule;
  return std::move(search.bonds);
}

}  // namespace pliant::reference
