// Contact as an integral over segments: the engine against the reference solver.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "reference/contact_crowd.hpp"
#include "support/figures.hpp"

namespace pliant {
namespace {

using namespace testing;

Scene pair_of_outlines(Random& random, const ContactRule& rule, int sample) {
  Scene scene = bare_scene();
  scene.contact.quadrature = ContactQuadrature::segments;
  scene.contact.energy_consistent = false;
  scene.skin = 1;
  scene.contacts = {rule};
  add_random_body(scene, random, sample % 5);
  add_random_body(scene, random, sample / 5 % 5);
  return scene;
}

/// The largest difference of forces on nodes, the largest force, and the difference of stored energies.
struct Difference {
  double force = 0, largest = 0, stored = 0;
};

Difference difference(const ContactRig& rig, const reference::ContactResult& result) {
  const Points forces = forces_on_nodes(result, outline_points(rig).size());
  Difference found;
  std::size_t node = 0;
  for (int body = 0; body < static_cast<int>(rig.model.bodies.size()); ++body)
    for (int k = 0; k < rig.count(body); ++k, ++node) {
      found.largest = std::max(found.largest, forces[node].norm());
      found.force = std::max(found.force, (rig.force(body, k) - forces[node]).norm());
    }
  found.stored = rig.totals.stored - result.stored;
  return found;
}

TEST(IntegratedContact, Slip) {
  const auto check = [](const char* name, const ContactRule& rule, double h, double turn) {
    std::vector<double> errors[4];
    double books = 0, dissipated = 0;
    int out = 0;
    for (int sample = 0; sample < 200; ++sample) {
      Random random(sample + 1);
      ContactRig rig(pair_of_outlines(random, rule, sample));
      press_together(rig, random, random.uniform(0.005, 0.03));
      reference::Contacts contacts(rig.model.scene, reference_outlines(rig.model));
      rig.refresh();
      rig.evaluate();
      rig.commit();
      contacts.evaluate(outline_points(rig));
      contacts.accept();
      const Vec2 way(random.uniform(-1, 1), random.uniform(-1, 1));
      for (int step = 0; step < 4; ++step) {
        const OutlineField before = rig.outlines.position;
        rig.move(1, h * way);
        rig.turn(1, turn * h * random.uniform(-1, 1));
        rig.show();
        if (!rig.contact.candidates_hold(rig.outlines.position)) printf("search\n");
        const StepStart start{before, 1};
        rig.totals = rig.contact.forces(rig.outlines, rig.committed, rig.trial, rig.forces, &start);
        const auto result = contacts.evaluate(outline_points(rig));
        const Difference d = difference(rig, result);
        if (d.largest > 0) errors[step].push_back(d.force / d.largest);
        if (d.largest > 0 && d.force / d.largest > 1e-3 && out++ < 3)
          printf("   sample %d step %d: %g, stored %g of %g\n", sample, step, d.force / d.largest, d.stored, rig.totals.stored);
        books = std::max(books, std::abs(rig.totals.dissipated - result.dissipated));
        dissipated = std::max(dissipated, result.dissipated);
        rig.commit();
        contacts.accept();
      }
    }
    printf("%s %g:", name, h);
    for (auto& e : errors) {
      std::ranges::sort(e);
      printf("  median %.2g 90%% %.2g max %.2g,", e[e.size() / 2], e[e.size() * 9 / 10], e.back());
    }
    printf(" books %g of %g\n", books, dissipated);
  };
  for (double turn : {0.0, 1.0})
    for (double h : {1e-3, 1e-4, 1e-5}) {
      check("mc 0.3", mohr_coulomb(100, 0.3), h, turn);
      check("mc sticks", mohr_coulomb(100, 30, 10), h, turn);
      check("mc tension", mohr_coulomb(100, 0.3, 0.05, 0.2), h, turn);
      check("cohesive", cohesive(100, 0.5, 0.02, 0.4), h, turn);
    }
}


struct Both {
  explicit Both(const Scene& scene) : rig(scene), contacts(scene, reference_outlines(rig.model)) {
    rig.refresh();
    rig.evaluate();
    result = contacts.evaluate(outline_points(rig));
    accept();
  }
  void accept() {
    rig.commit();
    rig.refresh();
    before = rig.outlines.position;
    contacts.accept();
  }
  void evaluate() {
    rig.show();
    if (!rig.contact.candidates_hold(rig.outlines.position)) printf("search\n");
    const StepStart start{before, 1};
    rig.totals = rig.contact.forces(rig.outlines, rig.committed, rig.trial, rig.forces, &start);
    result = contacts.evaluate(outline_points(rig));
  }
  ContactRig rig;
  reference::Contacts contacts;
  reference::ContactResult result;
  OutlineField before;
};

void report(const char* name, std::vector<double> e, double books, double dissipated) {
  std::ranges::sort(e);
  printf("%s: %zu median %.2g 90%% %.2g max %.2g, books %g of %g\n", name, e.size(), e[e.size() / 2], e[e.size() * 9 / 10],
         e.back(), books, dissipated);
}

std::vector<std::pair<const char*, ContactRule>> laws() {
  return {{"frictionless", frictionless(100)},
          {"smoothed", smoothed(frictionless(100), 0.1)},
          {"mc", mohr_coulomb(100, 0.3)},
          {"mc smoothed", smoothed(mohr_coulomb(100, 0.3, 0.05), 0.1)},
          {"mc tension", mohr_coulomb(100, 0.3, 0.05, 0.2)},
          {"cohesive", cohesive(100, 0.5, 0.02, 0.4)}};
}

TEST(IntegratedContact, One) {
  for (int sample : {9, 18}) {
    Random random(sample + 1000);
    Scene scene = crowd(random, {mohr_coulomb(100, 0.3)}, sample % 2 == 0);
    scene.contact.quadrature = ContactQuadrature::segments;
    scene.contact.energy_consistent = false;
    Both both(scene);
    for (int st = 0; st < 3; ++st) {
    stir(both.rig, random, 0.003);
    both.evaluate();
    if (st < 2) both.accept();
    }
    const Points f = forces_on_nodes(both.result, outline_points(both.rig).size());
    for (const auto& patch : both.result.patches)
      printf("patch %d %d deepest %g depth %g\n", patch.body[0], patch.body[1], patch.deepest, patch.depth);
    std::size_t node = 0;
    for (int body = 0; body < static_cast<int>(both.rig.model.bodies.size()); ++body)
      for (int k = 0; k < both.rig.count(body); ++k, ++node) {
        const Vec2 x = both.rig.node(body, k), e = both.rig.force(body, k);
        if ((e - f[node]).norm() > 1e-9)
          printf("%d %d of %d (%g %g): engine %.6g %.6g diff %.3g %.3g\n", body, k, both.rig.count(body), x.x(), x.y(), e.x(), e.y(),
                 e.x() - f[node].x(), e.y() - f[node].y());
      }
  }
}

TEST(IntegratedContact, Crowd) {
  for (const ContactLength length : {ContactLength::reference, ContactLength::current})
    for (const auto& [name, rule] : laws()) {
      std::vector<double> errors, stored;
      double books = 0, dissipated = 0;
      for (int sample = 0; sample < 20; ++sample) {
        Random random(sample + 1000);
        Scene scene = crowd(random, {rule}, sample % 2 == 0);
        scene.contact.quadrature = ContactQuadrature::segments;
        scene.contact.energy_consistent = false;
        scene.contact.length = length;
        Both both(scene);
        for (int state = 0; state < 4; ++state) {
          stir(both.rig, random, 0.003);
          both.evaluate();
          const Difference d = difference(both.rig, both.result);
          errors.push_back(d.force / d.largest);
          stored.push_back(std::abs(d.stored));
          books = std::max(books, std::abs(both.rig.totals.dissipated - both.result.dissipated));
          dissipated = std::max(dissipated, both.result.dissipated);
          both.accept();
        }
      }
      report(name, errors, books, dissipated);
      report("    stored", stored, 0, 0);
    }
}

TEST(IntegratedContact, Notch) {
  for (const auto& [name, rule] : laws()) {
    std::vector<double> errors;
    double books = 0, dissipated = 0;
    for (int sample = 0; sample < 100; ++sample) {
      Random random(sample + 9000);
      Scene scene = bare_scene();
      scene.contact.quadrature = ContactQuadrature::segments;
      scene.contact.energy_consistent = false;
      scene.skin = 1;
      scene.contacts = {rule};
      Points notched = regular(6, 1), needle{{0, 0}, {3, 4}, {-3, 4}};
      notched[1] *= random.uniform(0.1, 0.3);
      add_body(scene, outline_shape("notched", notched), BodyKind::rigid, {0, 0}, M_PI / 6);
      add_body(scene, outline_shape("needle", needle), BodyKind::rigid, {0, 0}, random.uniform(-0.2, 0.2));
      Both both(scene);
      const double direction = random.uniform(-0.4, 0.4), depth = random.uniform(-0.01, 0.05);
      both.rig.move(
          1, both.rig.node(0, 1) - both.rig.node(1, 0) - depth * Vec2(std::sin(direction), std::cos(direction)));
      both.evaluate();
      both.accept();
      for (int state = 0; state < 4; ++state) {
        stir(both.rig, random, 0.003);
        both.evaluate();
        const Difference d = difference(both.rig, both.result);
        if (d.largest > 0) errors.push_back(d.force / d.largest);
        books = std::max(books, std::abs(both.rig.totals.dissipated - both.result.dissipated));
        dissipated = std::max(dissipated, both.result.dissipated);
        both.accept();
      }
    }
    report(name, errors, books, dissipated);
  }
}

TEST(IntegratedContact, Tip) {
  Scene scene = bare_scene();
  scene.contact.quadrature = ContactQuadrature::segments;
  scene.contact.energy_consistent = false;
  scene.skin = 1;
  scene.contacts = {cohesive(100, 0.5, 0.02, 0.4)};
  add_body(scene, outline_shape("bar", rectangle(1, 0.5, 0.5)), BodyKind::rigid, {0, 0});
  add_body(scene, outline_shape("tip", Points{{0, 0}, {0.3, 0.5}, {-0.4, 0.5}}), BodyKind::rigid, {0, 0});
  ContactRig rig(scene);
  rig.move(1, Vec2(0.1, 0.255) - rig.node(1, 0));
  reference::Contacts contacts(rig.model.scene, reference_outlines(rig.model));
  rig.refresh();
  rig.evaluate();
  rig.commit();
  contacts.evaluate(outline_points(rig));
  contacts.accept();
  for (int kind = 0; kind < 2; ++kind) {
    const OutlineField before = rig.outlines.position;
    if (kind == 0)
      rig.move(1, Vec2(1e-5, 0));
    else
      rig.turn(1, 1e-4);
    rig.show();
    const StepStart start{before, 1};
    rig.totals = rig.contact.forces(rig.outlines, rig.committed, rig.trial, rig.forces, &start);
    const auto result = contacts.evaluate(outline_points(rig));
    const Points f = forces_on_nodes(result, outline_points(rig).size());
    std::size_t node = 0;
    Vec2 sum(0, 0), sum1(0, 0);
    double moment = 0, moment1 = 0;
    for (int body = 0; body < 2; ++body)
      for (int k = 0; k < rig.count(body); ++k, ++node) {
        const Vec2 x = rig.node(body, k), e = rig.force(body, k);
        sum += e, sum1 += f[node], moment += cross(x, e), moment1 += cross(x, f[node]);
        if (e.norm() + f[node].norm() > 0)
          printf("%d %d (%g %g): engine %.10g %.10g reference %.10g %.10g diff %.3g %.3g\n", body, k, x.x(), x.y(), e.x(),
                 e.y(), f[node].x(), f[node].y(), e.x() - f[node].x(), e.y() - f[node].y());
      }
    printf("engine sums %g %g moment %g; reference %g %g moment %g\n", sum.x(), sum.y(), moment, sum1.x(), sum1.y(), moment1);
    rig.commit();
    contacts.accept();
  }
}

TEST(IntegratedContact, Scan) {
  for (int i = -30; i <= 30; ++i) {
    Scene scene = bare_scene();
    scene.contact.quadrature = ContactQuadrature::segments;
    scene.contact.energy_consistent = false;
    scene.skin = 1;
    scene.contacts = {cohesive(100, 0.5, 0.02, 0.4)};
    add_body(scene, outline_shape("bar", rectangle(1, 0.5, 0.5)), BodyKind::rigid, {0, 0});
    add_body(scene, outline_shape("tip", Points{{0, 0}, {0.3, 0.5}, {-0.3, 0.5}}), BodyKind::rigid, {0, 0}, 0.02 * i + 0.001);
    ContactRig rig(scene);
    rig.move(1, Vec2(0.1, 0.258) - rig.node(1, 0));
    reference::Contacts contacts(rig.model.scene, reference_outlines(rig.model));
    rig.refresh();
    rig.evaluate();
    rig.commit();
    contacts.evaluate(outline_points(rig));
    contacts.accept();
    Points f0, e0;
    f0 = forces_on_nodes(contacts.evaluate(outline_points(rig)), outline_points(rig).size());
    for (int k = 0; k < 3; ++k) e0.push_back(rig.force(1, k));
    const OutlineField before = rig.outlines.position;
    rig.move(1, Vec2(1e-5, 0));
    rig.show();
    const StepStart start{before, 1};
    rig.totals = rig.contact.forces(rig.outlines, rig.committed, rig.trial, rig.forces, &start);
    const Points f = forces_on_nodes(contacts.evaluate(outline_points(rig)), outline_points(rig).size());
    const auto n = [&](int a, int b) { const Vec2 t = (rig.node(1, b) - rig.node(1, a)).normalized(); return Vec2(t.y(), -t.x()); };
    const std::size_t o = f.size() - 3;
    printf("%g: engine %.4g %.4g reference %.4g %.4g shear %.6g %.6g\n", 0.02 * i + 0.001, 1e8 * (rig.force(1, 1) - e0[1]).dot(n(0, 1)), 1e8 * (rig.force(1, 2)-e0[2]).dot(n(2, 0)),
           1e8 * (f[o + 1] - f0[o + 1]).dot(n(0, 1)), 1e8 * (f[o + 2] - f0[o + 2]).dot(n(2, 0)), 1e8 * (rig.force(1)-e0[0]-e0[1]-e0[2]).x(),
           1e8 * (f[o] + f[o + 1] + f[o + 2]-f0[o]-f0[o+1]-f0[o+2]).x());
  }
}

TEST(IntegratedContact, Probe) {
  const auto check = [](const char* name, const ContactRule& rule, double least, double most) {
    std::vector<double> errors;
    for (int sample = 0; sample < 200; ++sample) {
      Random random(sample + 1);
      ContactRig rig(pair_of_outlines(random, rule, sample));
      press_together(rig, random, random.uniform(least, most));
      rig.step();
      reference::Contacts contacts(rig.model.scene, reference_outlines(rig.model));
      const Difference d = difference(rig, contacts.evaluate(outline_points(rig)));
      if (d.largest == 0) continue;
      errors.push_back(d.force / d.largest);
      if (d.force > 1e-9 * d.largest)
        printf("%s %d: %g of %g, stored %g of %g\n", name, sample, d.force, d.largest, d.stored, rig.totals.stored);
    }
    std::ranges::sort(errors);
    printf("%s: %zu median %g 90%% %g max %g\n", name, errors.size(), errors[errors.size() / 2],
           errors[errors.size() * 9 / 10], errors.back());
  };
  check("frictionless", frictionless(100), 0.005, 0.06);
  check("smoothed", smoothed(frictionless(100), 0.1), 0.005, 0.06);
  check("mc", mohr_coulomb(100, 0, 0, 1), -0.01, 0.03);
  check("cohesive", cohesive(100, 0.5, 0.02, 0), -0.01, 0.03);
}

}  // namespace
}  // namespace pliant
