#include "cli/thin_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include <fmt/format.h>

namespace pliant {
namespace {

constexpr std::array<int, 6> measured_segments{1, 2, 3, 4, 6, 8};

struct BendingErrors {
  DiscretisationMethod method;
  std::array<double, 6> error;
};

// FROZEN: by tests/cli/bending_errors_test.cpp, which measures them anew on strips under moments at both ends, nu =
// 0.4, against beam theory. The outline's spacing is given, all else is by default.
constexpr BendingErrors measured[] = {
    {DiscretisationMethod::mls, {1.146, 0.201, 0.073, 0.025, 0.007, 0.003}},
    {DiscretisationMethod::mls_gauss, {-0.303, -0.020, -0.024, -0.007, 0.000, 0.002}},
    {DiscretisationMethod::t3, {-0.748, -0.422, -0.244, -0.154, -0.064, -0.032}},
    {DiscretisationMethod::es_t3, {-0.430, -0.087, -0.020, -0.009, -0.001, 0.000}},
    {DiscretisationMethod::rpim, {0.053, -0.155, -0.013, -0.001, 0.008, 0.007}},
};

// Faces across from each other are that nearly antiparallel (cosine), their distance changes by less than that factor
// along a limb, and a limb is longer by that factor than thick, and so many segments: a tip's last is not.
constexpr double across = -0.7, similar = 1.25, slender = 2;
constexpr int fewest_segments = 3;

/// A closed outline's segments, and how thick the body is below each.
class Faces {
 public:
  explicit Faces(const Points& outline) : outline_(outline) {
    for (int k = 0; k < count(); ++k) thickness_.push_back(below(k));
  }

  int count() const { return static_cast<int>(outline_.size()); }
  double thickness(int k) const { return thickness_[cyclic(k)]; }
  Vec2 middle(int k) const { return 0.5 * (begin(k) + begin(k + 1)); }
  double length(int k) const { return along(k).norm(); }

  /// Whether the faces about segment k keep their distance from it on.
  bool is_similar(int k, int other) const {
    return thickness(other) < similar * thickness(k) && thickness(other) * similar > thickness(k);
  }

 private:
  std::size_t cyclic(int k) const { return static_cast<std::size_t>((k % count() + count()) % count()); }
  Vec2 begin(int k) const { return outline_[cyclic(k)]; }
  Vec2 along(int k) const { return begin(k + 1) - begin(k); }

  /// From the middle of a segment straight into the body to the next face; infinite where that is not across.
  double below(int k) const {
    const Vec2 from = middle(k), tangent = along(k).normalized(), inward(-tangent.y(), tangent.x());
    double nearest = std::numeric_limits<double>::infinity();
    bool faces = false;
    for (int j = 0; j < count(); ++j) {
      const Vec2 edge = along(j), r = begin(j) - from;
      const double rate = cross(inward, edge);
      if (j == k || rate == 0) continue;
      const double share = cross(inward, -r) / rate, way = cross(r, edge) / rate;
      if (share < 0 || share > 1 || way <= 0 || way >= nearest) continue;
      nearest = way;
      faces = tangent.dot(edge) < across * edge.norm();
    }
    return faces ? nearest : std::numeric_limits<double>::infinity();
  }

  const Points& outline_;
  std::vector<double> thickness_;  ///< [segments], m
};

/// The limb to which segment k belongs, if it is one.
std::optional<ThinPart> limb_at(const Faces& faces, int k) {
  int first = k, last = k;
  while (last - first + 1 < faces.count() && faces.is_similar(k, last + 1)) ++last;
  while (last - first + 1 < faces.count() && faces.is_similar(k, first - 1)) --first;
  double extent = 0, length = 0;
  for (int j = first; j <= last; ++j) {
    extent = std::max(extent, (faces.middle(j) - faces.middle(first)).norm());
    length += faces.length(j);
  }
  const double segment = length / (last - first + 1), thickness = faces.thickness(k);
  if (extent + segment < slender * thickness || last - first + 1 < fewest_segments) return {};
  return ThinPart{thickness, thickness / segment, faces.middle((first + last) / 2)};
}

}  // namespace

std::optional<ThinPart> thinnest_part(const Points& outline) {
  const Faces faces(outline);
  std::optional<ThinPart> thinnest;
  for (int k = 0; k < faces.count(); ++k) {
    if (!std::isfinite(faces.thickness(k))) continue;
    const std::optional<ThinPart> limb = limb_at(faces, k);
    if (limb && (!thinnest || limb->segments_across < thinnest->segments_across)) thinnest = limb;
  }
  return thinnest;
}

std::optional<double> bending_error(DiscretisationMethod method, double segments_across) {
  const auto known = std::ranges::find(measured, method, &BendingErrors::method);
  if (known == std::end(measured)) return {};
  const auto inverse_square = [](double n) { return 1 / (n * n); };
  if (segments_across <= measured_segments.front()) return known->error.front();
  if (segments_across >= measured_segments.back())
    return known->error.back() * inverse_square(segments_across) / inverse_square(measured_segments.back());
  const auto above = std::ranges::upper_bound(measured_segments, segments_across);
  const auto next = static_cast<std::size_t>(above - measured_segments.begin());
  const double coarse = inverse_square(measured_segments[next - 1]), fine = inverse_square(measured_segments[next]);
  const double share = (coarse - inverse_square(segments_across)) / (coarse - fine);
  return known->error[next - 1] + share * (known->error[next] - known->error[next - 1]);
}

namespace {

/// From here on bending is right to worth_a_warning.
int enough_across(DiscretisationMethod method) {
  int enough = measured_segments.back() + 1;
  while (enough > 1 && std::abs(*bending_error(method, enough - 1)) < worth_a_warning) --enough;
  return enough;
}

}  // namespace

std::string describe_bending(const Model& model) {
  const DiscretisationMethod method = model.scene.discretisation.method;
  std::set<int> seen;
  std::optional<ThinPart> worst;
  double error = worth_a_warning;
  std::string shape;
  for (const Body& body : model.bodies) {
    if (body.kind != BodyKind::compliant || !seen.insert(body.outline).second) continue;
    const std::optional<ThinPart> limb = thinnest_part(model.outlines[body.outline].points);
    if (!limb) continue;
    const double found = bending_error(method, limb->segments_across).value_or(0);
    if (std::abs(found) < std::abs(error)) continue;
    worst = limb, error = found, shape = model.scene.shapes[body.shape].name;
  }
  if (!worst) return {};
  const std::string across = fmt::format("{:.2g}", worst->segments_across);
  const int enough = enough_across(method);
  // Rounded down to two digits, so that it suffices.
  double spacing = worst->thickness / enough;
  const double digit = std::pow(10, std::floor(std::log10(spacing)) - 1);
  spacing = std::floor(spacing / digit * (1 + 1e-9)) * digit;
  const double scale = spacing >= 0.1 ? 1 : spacing >= 1e-4 ? 1e-3 : 1e-6;
  return fmt::format(
      "'{}' is {} across, {:.3g} m, about ({:.3g}, {:.3g}) m from its centre: strips of as many bent "
      "{:.0f} "
      "% too {}; from {} across on, as with spacing = \"{:.2g} {}\", by less than {:.0f} % (docs/defaults.md, "
      "\"Thin shapes\")",
      shape, across == "1" ? "1 segment" : across + " segments", worst->thickness, worst->position.x(),
      worst->position.y(), 100 * std::abs(error), error > 0 ? "far" : "little", enough, spacing / scale,
      scale == 1      ? "m"
      : scale == 1e-3 ? "mm"
                      : "um",
      100 * worth_a_warning);
}

}  // namespace pliant
