// Contact integrated over segments: forces are minus the gradient of one energy, which is the integral it should be.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "contact/segment_parts.hpp"
#include "support/contact_rig.hpp"

namespace pliant {
namespace {

using namespace testing;

Scene integrated_scene(const ContactRule& rule) {
  Scene scene = bare_scene();
  scene.contact.quadrature = ContactQuadrature::segments;
  scene.contacts = {rule};
  return scene;
}

Scene random_pair(Random& random, const ContactRule& rule) {
  Scene scene = integrated_scene(rule);
  add_random_body(scene, random, random.below(5));
  add_random_body(scene, random, random.below(5));
  return scene;
}

/// Energy with one coordinate of an outline node moved, and its cyclic copy.
class Energy {
 public:
  explicit Energy(ContactRig& rig) : rig_(rig), moved_(rig.outlines), trial_(rig.trial) {}

  double moved(int body, int node, int axis, double by) {
    const int first = rig_.model.outline_offset[body];
    std::vector<double>& places = axis == 0 ? moved_.position.x : moved_.position.y;
    const std::vector<double> before = places;
    for (int i = first + node; i < rig_.model.outline_offset[body + 1]; i += rig_.count(body)) places[i] += by;
    const double stored = rig_.contact.forces(moved_, rig_.committed, trial_, forces_).stored;
    places = before;
    return stored;
  }
  double derivative(int body, int node, int axis, double step) {
    return (moved(body, node, axis, step) - moved(body, node, axis, -step)) / (2 * step);
  }

 private:
  ContactRig& rig_;
  Outlines moved_;
  ContactHistory trial_;
  OutlineField forces_;
};

/// The largest difference of a force from minus the derivative of the energy, and the largest force.
std::pair<double, double> worst_gradient(ContactRig& rig, double step) {
  double worst = 0, size = 0;
  Energy energy(rig);
  for (int body = 0; body < 2; ++body)
    for (int node = 0; node < rig.count(body); ++node)
      for (int axis = 0; axis < 2; ++axis) {
        const double force = rig.force(body, node)[axis];
        size = std::max(size, std::abs(force));
        worst = std::max(worst, std::abs(force + energy.derivative(body, node, axis, step)));
      }
  return {worst, size};
}

/// Of many random pairs: by how much forces on nodes differ from minus the gradient of the energy, over the largest.
struct GradientErrors {
  std::vector<double> errors;
  int beyond = 0;  ///< what differences of the energy can be off by
};

/// Differences over a step h are off by h/2 times the jump of the energy's second derivative, k times a segment at
/// most, and by the rounding of places, 1e-16, over h.
GradientErrors gradient_errors(const ContactRule& rule, double least_depth, double most_depth) {
  constexpr double step = 1e-7, segment = 0.15, rounding = 4e-16;
  GradientErrors result;
  for (int sample = 0; sample < 100; ++sample) {
    Random random(sample + 1);
    ContactRig rig(random_pair(random, rule));
    press_together(rig, random, random.uniform(least_depth, most_depth));
    rig.step();
    if (rig.totals.contacts == 0) continue;
    const auto [error, size] = worst_gradient(rig, step);
    result.errors.push_back(error / size);
    result.beyond += error > 0.5 * step * kn * segment + size * rounding / step;
  }
  std::ranges::sort(result.errors);
  return result;
}

// EXACT: forces on all nodes of random concave bodies are minus the gradient of the energy, of every law, also in the
// fans outside corners.
TEST(SegmentQuadrature, ForcesAreTheGradientOfTheEnergy) {
  const auto check = [](const ContactRule& rule, double least_depth, double most_depth) {
    const GradientErrors found = gradient_errors(rule, least_depth, most_depth);
    EXPECT_GT(found.errors.size(), 90u);
    EXPECT_EQ(found.beyond, 0);
    EXPECT_LT(found.errors[found.errors.size() * 9 / 10], 1e-8);
  };
  check(frictionless(kn), 0.005, 0.06);
  check(smoothed(frictionless(kn), 0.1), 0.005, 0.06);
  check(mohr_coulomb(kn, 0, 0, 1), -0.01, 0.03);
  check(cohesive(kn, 0.5, 0.02, 0), -0.01, 0.03);
}

bool has_inside(const Points& outline, const Vec2& point) {
  bool inside = false;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 &a = outline[i], &b = outline[(i + 1) % outline.size()];
    if ((a.y() > point.y()) != (b.y() > point.y()) &&
        point.x() < a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
      inside = !inside;
  }
  return inside;
}

double distance_to_edges(const Points& outline, const Vec2& point) {
  double least = 1e300;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 a = outline[i], along = outline[(i + 1) % outline.size()] - a;
    const double s = std::clamp((point - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (point - a - s * along).norm());
  }
  return least;
}

/// kn/4 times the integral of the squared depth of one outline in another, by the middles of many parts.
double integral(const Points& slave, const Points& master, int parts) {
  double sum = 0;
  for (std::size_t i = 0; i < slave.size(); ++i) {
    const Vec2 a = slave[i], along = slave[(i + 1) % slave.size()] - a;
    for (int k = 0; k < parts; ++k) {
      const Vec2 point = a + (k + 0.5) / parts * along;
      if (!has_inside(master, point)) continue;
      sum += std::pow(distance_to_edges(master, point), 2) * along.norm() / parts;
    }
  }
  return kn / 4 * sum;
}

// INDEPENDENT: the energy is kn/4 times the integral of the squared distance of each outline inside the other to that,
// for concave and thin ones too. Middles of parts of length l are off by kn/4 l^2/12 a length in touch, of half a unit
// at most, and kn/4 l^3 at each end of it.
TEST(SegmentQuadrature, EnergyIsTheIntegralOfTheSquaredDepth) {
  for (int sample = 0; sample < 40; ++sample) {
    SCOPED_TRACE(sample);
    Random random(sample + 1);
    ContactRig rig(random_pair(random, frictionless(kn)));
    press_together(rig, random, random.uniform(0.005, 0.06));
    rig.step();
    constexpr int parts = 4000;
    const double length = std::max(rig.model.outline_of(0).longest, rig.model.outline_of(1).longest) / parts;
    const double expected =
        integral(rig.outline(0), rig.outline(1), parts) + integral(rig.outline(1), rig.outline(0), parts);
    EXPECT_NEAR(rig.totals.stored, expected, kn / 4 * length * length * (0.5 / 12 + 8 * length));
  }
}

/// A block of unit width over a longer bar, face to face and `deep` inside.
constexpr double deep = 0.004;
Scene integrated_block_on_bar(const ContactRule& rule, int segments, double spacing, double shift) {
  Scene scene = integrated_scene(rule);
  add_body(scene, outline_shape("bar", rectangle(2.4, 0.5, spacing)), BodyKind::rigid, {0, 0});
  add_body(scene, outline_shape("block", rectangle(1, 0.5, 1.0 / segments)), BodyKind::rigid, {shift, 0.5 - deep});
  return scene;
}

// EXACT: a block presses over the length that it shares with a bar, wherever nodes are, and nothing holds it back along
// it. At each end the bar's face is nearer to the block's flank over a length of the depth, which takes kn/2 deep^2,
// and the flank's own length in the bar gives half of that back.
TEST(SegmentQuadrature, FlatFacesNeitherLockNorCog) {
  for (const int segments : {1, 4, 7})
    for (const double spacing : {0.25, 0.1, 0.037})
      for (const double shift : {0.0, 0.1, 0.0317, -0.25}) {
        SCOPED_TRACE(fmt::format("{} segments, spacing {}, shift {}", segments, spacing, shift));
        ContactRig rig(integrated_block_on_bar(frictionless(kn), segments, spacing, shift));
        rig.step();
        const double ends = kn * deep * deep / 2;
        EXPECT_NEAR(rig.force(1).y(), kn * deep - ends, 1e-12);
        EXPECT_NEAR(rig.force(1).x(), 0, 1e-13);
      }
}

/// Largest change of the force in steps along a way of a corner past a corner, over the largest force.
double largest_jump(ContactQuadrature quadrature, std::uint64_t seed, int steps) {
  Random random(seed);
  Scene scene = integrated_scene(frictionless(kn));
  scene.contact.quadrature = quadrature;
  add_body(scene, outline_shape("square", rectangle(1, 1, 0.2)), BodyKind::rigid, {0, 0});
  add_body(scene, outline_shape("tip", refined({{0, 0}, {0.4, 0.8}, {-0.4, 0.8}}, 0.2)), BodyKind::rigid, {0, 0},
           random.uniform(-0.7, 0.7));
  ContactRig rig(scene);
  const Vec2 start(random.uniform(0.42, 0.48), 0.48), end(0.56, random.uniform(0.44, 0.48));
  rig.move(1, start - rig.node(1, 0));
  Vec2 before(0, 0);
  double jump = 0, size = 1e-300;
  for (int k = 0; k <= steps; ++k) {
    rig.step();
    if (k > 0) jump = std::max(jump, (rig.force(1) - before).norm());
    before = rig.force(1);
    size = std::max(size, before.norm());
    rig.move(1, (end - start) / steps);
  }
  return jump / size;
}

// RATE: forces are continuous as corners pass corners: with a tenth of the steps' way their changes are a tenth, but
// for what is of second order in it. At nodes they jump.
TEST(SegmentQuadrature, ForcesDoNotJumpAtCorners) {
  int jumps = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    EXPECT_LT(largest_jump(ContactQuadrature::segments, seed, 20000),
              0.13 * largest_jump(ContactQuadrature::segments, seed, 2000));
    jumps +=
        largest_jump(ContactQuadrature::nodes, seed, 4000) > 0.5 * largest_jump(ContactQuadrature::nodes, seed, 400);
  }
  EXPECT_GT(jumps, 6);
}

/// EXACT: many parts cut from one segment leave as much as they do not take, in as many parts as there are gaps.
TEST(SegmentParts, none_is_dropped_however_many_there_are) {
  constexpr int removed = 100;
  std::vector<Span8> memory;
  Spans8 spans(Span8{}, memory);
  for (int i = 0; i < removed; ++i) {
    const double begin = (i + 0.25) / removed;
    spans.remove({broadcast(begin), broadcast(begin + 0.5 / removed)});
  }
  PackedParts parts;
  for (const Span8& span : spans) parts.put(span.some(), span, {-1, 0});
  Lanes left{};
  int count = 0;
  for (const PackedParts::Eight& part : parts) {
    left += select(part.hit, part.span.high - part.span.low, Lanes{});
    count += any(part.hit);
  }
  for (int lane = 0; lane < lane_count; ++lane) EXPECT_NEAR(left[lane], 0.5, 1e-14);
  EXPECT_EQ(count, removed + 1);
}

}  // namespace
}  // namespace pliant
