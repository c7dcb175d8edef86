// Contact as an integral over segments: the engine against the reference solver.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "reference/contact_pair.hpp"
#include "support/figures.hpp"

namespace pliant {
namespace {

using namespace testing;

Scene pair_of_outlines(Random& random, const ContactRule& rule, int sample) {
  Scene scene = bare_scene();
  scene.contact.quadrature = ContactQuadrature::segments;
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
