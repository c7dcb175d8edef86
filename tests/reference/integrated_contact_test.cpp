// Contact of the reference solver as an integral over segments: forces against the energy's differences, tangents
// against those of forces, both against sums over many points and closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "reference/contact_pair.hpp"

namespace pliant {
namespace {

using namespace testing;
using reference::ContactResult;

Scene integrated(const ContactRule& rule) {
  Scene scene = bare_scene();
  scene.contact.quadrature = ContactQuadrature::segments;
  scene.contacts = {rule};
  return scene;
}

/// Two bodies as the reference solver's contacts see them.
struct Pair {
  explicit Pair(const Scene& scene) : rig(scene), contacts(scene, reference_outlines(rig.model)) { show(); }
  void show() {
    rig.show();
    x = outline_points(rig);
  }

  ContactResult evaluate() { return contacts.evaluate(x); }
  Eigen::VectorXd residual() {
    const Points force = forces_on_nodes(evaluate(), x.size());
    Eigen::VectorXd result(2 * static_cast<Eigen::Index>(x.size()));
    for (std::size_t i = 0; i < x.size(); ++i) result.segment<2>(2 * static_cast<Eigen::Index>(i)) = -force[i];
    return result;
  }
  Eigen::MatrixXd tangent() {
    const Eigen::Index size = 2 * static_cast<Eigen::Index>(x.size());
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(size, size);
    for (const reference::ContactPatch& patch : evaluate().patches) {
      const auto place = [&](Eigen::Index i) { return 2 * patch.node[static_cast<std::size_t>(i / 2)] + i % 2; };
      for (Eigen::Index i = 0; i < patch.force.size(); ++i)
        for (Eigen::Index j = 0; j < patch.force.size(); ++j) sum(place(i), place(j)) += patch.tangent(i, j);
    }
    return sum;
  }
  /// Of a function of x by one coordinate, by central differences.
  template <class Function>
  auto derivative(Eigen::Index coordinate, double step, Function&& function) -> decltype(function()) {
    double& at = x[static_cast<std::size_t>(coordinate / 2)][coordinate % 2];
    const double before = at;
    at = before + step;
    const auto above = function();
    at = before - step;
    const auto below = function();
    at = before;
    return (above - below) / (2 * step);
  }
  Vec2 force(int body) {
    const Points forces = forces_on_nodes(evaluate(), x.size());
    const auto first = forces.begin() + (body == 0 ? 0 : rig.count(0));
    return std::accumulate(first, first + rig.count(body), Vec2(0, 0));
  }

  ContactRig rig;
  reference::Contacts contacts;
  Points x;
};

Scene random_pair(Random& random, const ContactRule& rule) {
  Scene scene = integrated(rule);
  add_random_body(scene, random, random.below(5));
  add_random_body(scene, random, random.below(5));
  return scene;
}

std::vector<ContactRule> normal_laws() {
  return {frictionless(kn), smoothed(frictionless(kn), 0.1), mohr_coulomb(kn, 0, 0, 1), cohesive(kn, 0.5, 0.02, 0)};
}

// INDEPENDENT: forces are minus the differences of the energy. Over a step h these are off by h/2 times the jump of its
// second derivative, kn times a segment at most, and by the rounding of places, 1e-16, over h.
TEST(ReferenceIntegratedContact, ForcesAreTheGradientOfTheEnergy) {
  constexpr double step = 1e-7, segment = 0.15, rounding = 4e-16;
  for (const ContactRule& rule : normal_laws()) {
    int touching = 0;
    for (int sample = 0; sample < 20; ++sample) {
      Random random(sample + 1);
      Pair pair(random_pair(random, rule));
      press_together(pair.rig, random, random.uniform(0, 0.04));
      pair.show();
      const Eigen::VectorXd residual = pair.residual();
      const double allowed =
          0.5 * step * kn * segment + rounding / step * std::max(residual.lpNorm<Eigen::Infinity>(), 0.1);
      touching += !residual.isZero(0);
      for (Eigen::Index i = 0; i < residual.size(); ++i)
        EXPECT_NEAR(pair.derivative(i, step, [&] { return pair.evaluate().stored; }), residual[i], allowed);
    }
    EXPECT_GT(touching, 15);
  }
}

// EXACT up to differences: of forces f over a step h they are off by the rounding of places, 1e-16 kn over h, and by
// h^2 times third derivatives, over the square of a part's length: 1e-14/1e-6. Kinks are further away than h.
TEST(ReferenceIntegratedContact, TangentIsTheDerivativeOfForces) {
  int touching = 0;
  for (const ContactRule& rule :
       {frictionless(kn), smoothed(frictionless(kn), 0.1), mohr_coulomb(kn, 0, 0, 1), mohr_coulomb(kn, 0.2),
        mohr_coulomb(kn, 30, 10), cohesive(kn, 0.5, 0.02, 0.02), cohesive(kn, 0.5, 0.02, 0.4)})
    for (const ContactLength length : {ContactLength::reference, ContactLength::current})
      for (int sample = 0; sample < 4; ++sample) {
        Random random(sample + 1);
        Scene scene = random_pair(random, rule);
        scene.contact.length = length;
        Pair pair(scene);
        press_together(pair.rig, random, random.uniform(0, 0.03));
        pair.show();
        pair.evaluate();
        pair.contacts.accept();
        for (Vec2& p : pair.x) p += Vec2{random.uniform(-1e-3, 1e-3), random.uniform(-1e-3, 1e-3)};
        const Eigen::MatrixXd tangent = pair.tangent();
        touching += !tangent.isZero(0);
        for (Eigen::Index i = 0; i < tangent.cols(); ++i)
          EXPECT_LE((pair.derivative(i, 1e-7, [&] { return pair.residual(); }) - tangent.col(i)).norm(),
                    3e-8 * tangent.norm());
      }
  EXPECT_GT(touching, 45);
}

/// Pressure of a cohesive law, and forces on all nodes of two outlines by the middles of many parts.
struct ManyPoints {
  double strength, range;
  int parts;

  Points forces(const ContactRig& rig) const {
    const Points outlines[] = {rig.outline(0), rig.outline(1)};
    Points sum(outlines[0].size() + outlines[1].size(), Vec2(0, 0));
    Vec2 *first = sum.data(), *second = first + outlines[0].size();
    add_pass(outlines[0], outlines[1], first, second);
    add_pass(outlines[1], outlines[0], second, first);
    return sum;
  }

 private:
  double pressure(double gap) const {
    const double critical = strength / kn;
    return gap <= critical ? -kn * gap : -strength * (range - gap) / (range - critical);
  }
  void add_pass(const Points& slave, const Points& master, Vec2* on_slave, Vec2* on_master) const {
    for (std::size_t i = 0; i < slave.size(); ++i) {
      const std::size_t after = (i + 1) % slave.size();
      const Vec2 along = slave[after] - slave[i];
      for (int k = 0; k < parts; ++k) {
        const double s = (k + 0.5) / parts;
        const Vec2 point = slave[i] + s * along;
        Vec2 from(1e300, 0);
        std::size_t nearest = 0;
        double share = 0;
        bool inside = false;
        for (std::size_t j = 0; j < master.size(); ++j) {
          const Vec2 &c = master[j], &d = master[(j + 1) % master.size()];
          const double xi = std::clamp((point - c).dot(d - c) / (d - c).squaredNorm(), 0.0, 1.0);
          const Vec2 way = point - c - xi * (d - c);
          if (way.squaredNorm() < from.squaredNorm()) from = way, nearest = j, share = xi;
          if ((c.y() > point.y()) != (d.y() > point.y()) &&
              point.x() < c.x() + (point.y() - c.y()) / (d.y() - c.y()) * (d.x() - c.x()))
            inside = !inside;
        }
        const double gap = inside ? -from.norm() : from.norm();
        if (gap >= range || gap == 0) continue;
        const Vec2 force = 0.5 * along.norm() / parts * pressure(gap) / gap * from;
        on_slave[i] += (1 - s) * force, on_slave[after] += s * force;
        on_master[nearest] -= (1 - share) * force, on_master[(nearest + 1) % master.size()] -= share * force;
      }
    }
  }
};

// INDEPENDENT: a third program. Where the nearest segment changes between two middles, at four places a node or fewer,
// its force goes to the wrong one: the pressure over half a part's length, in one of two passes.
TEST(ReferenceIntegratedContact, ForcesAreSumsOverManyPoints) {
  const ManyPoints many{0.5, 0.02, 3000};
  for (int sample = 0; sample < 20; ++sample) {
    SCOPED_TRACE(sample);
    Random random(sample + 1);
    Pair pair(random_pair(random, cohesive(kn, many.strength, many.range, 0)));
    constexpr double depth = 0.03;
    press_together(pair.rig, random, random.uniform(0, depth));
    pair.show();
    const Points forces = forces_on_nodes(pair.evaluate(), pair.x.size());
    const Points expected = many.forces(pair.rig);
    const double part =
        std::max(pair.rig.model.outline_of(0).longest, pair.rig.model.outline_of(1).longest) / many.parts;
    for (std::size_t i = 0; i < forces.size(); ++i)
      EXPECT_LE((forces[i] - expected[i]).norm(), 4 * kn * depth * part / 4) << i;
  }
}

// INDEPENDENT: the same third program. Faces that are parallel and nodes on each other's normals, where distances are
// equal along whole parts or nowhere, as of blocks in lattices.
TEST(ReferenceIntegratedContact, FacesThatAreParallel) {
  constexpr double deep = 0.02, segment = 3;
  const ManyPoints many{0, 1e-3, 20000};
  const Points corner{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};  // re-entrant at (1, 1)
  for (const double turned : {0.0, 0.37})
    for (const double width : {0.05, 1.0, 2.0 + deep})
      for (const double beside : {-deep, 0.0, 0.5}) {
        SCOPED_TRACE(std::to_string(turned) + " " + std::to_string(width) + " " + std::to_string(beside));
        Scene scene = integrated(frictionless(kn));
        add_body(scene, outline_shape("corner", corner), BodyKind::rigid, {0, 0}, turned);
        const Points block{{0, 0}, {width, 0}, {width, 1.5}, {0, 1.5}};
        add_body(scene, outline_shape("block", block), BodyKind::rigid, {0, 0}, turned);
        Pair pair(scene);
        const Vec2 along = (pair.rig.node(0, 1) - pair.rig.node(0, 0)) / 3, up(-along.y(), along.x());
        pair.rig.move(1, pair.rig.node(0, 3) + beside * along - deep * up - pair.rig.node(1, 0));
        pair.show();
        const Points forces = forces_on_nodes(pair.evaluate(), pair.x.size());
        const Points expected = many.forces(pair.rig);
        for (std::size_t i = 0; i < forces.size(); ++i)
          EXPECT_LE((forces[i] - expected[i]).norm(), 4 * kn * segment * segment / many.parts / 4) << i;
      }
}

// EXACT: a block of unit width presses on a longer bar over the length that they share; at each end the bar's face is
// nearer to the block's flank over a length of the depth, which takes kn/2 depth^2, half of which the flank gives back.
TEST(ReferenceIntegratedContact, BlockOnABar) {
  constexpr double deep = 0.004;
  for (const int segments : {1, 4, 7})
    for (const double shift : {0.0, 0.0317}) {
      Scene scene = integrated(frictionless(kn));
      add_body(scene, outline_shape("bar", rectangle(2.4, 0.5, 0.1)), BodyKind::rigid, {0, 0});
      add_body(scene, outline_shape("block", rectangle(1, 0.5, 1.0 / segments)), BodyKind::rigid, {shift, 0.5 - deep});
      Pair pair(scene);
      EXPECT_NEAR(pair.force(1).y(), kn * deep - kn * deep * deep / 2, 1e-12);
      EXPECT_NEAR(pair.force(1).x(), 0, 1e-12);
    }
}

// EXACT: a right-angled tip d deep in a flat face. Its two sides of length sqrt(2) d are d/2 deep on average, along the
// face's normal; the face's 2 d are d/(2 sqrt(2)) deep, along the sides' normals, at 45 degrees: in half passes
// (1/sqrt(2) + 1/4) kn d^2.
TEST(ReferenceIntegratedContact, TipInAFace) {
  for (const double deep : {0.01, 0.03, 0.1}) {
    Scene scene = integrated(frictionless(kn));
    add_body(scene, outline_shape("bar", rectangle(2.4, 1, 0.3)), BodyKind::rigid, {0, 0});
    add_body(scene, outline_shape("tip", Points{{0, 0}, {0.5, 0.5}, {-0.5, 0.5}}), BodyKind::rigid, {0, 0});
    Pair pair(scene);
    pair.rig.move(1, Vec2(0.07, 0.5 - deep) - pair.rig.node(1, 0));
    pair.show();
    EXPECT_NEAR(pair.force(1).y(), (1 / std::sqrt(2.0) + 0.25) * kn * deep * deep, 1e-13);
  }
}

}  // namespace
}  // namespace pliant
