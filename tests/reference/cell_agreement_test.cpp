// Contacts with images along both periods of a deformed cell: the engine against the reference solver.
#include <gtest/gtest.h>

#include <algorithm>

#include "geometry/lattice.hpp"
#include "reference/contact_crowd.hpp"
#include "support/figures.hpp"

namespace pliant {
namespace {

using namespace testing;

/// Discs and squares of both kinds that overlap their neighbours, over all edges and corners of the cell, each given at
/// some image. The cell is sheared by more than its height in time 1.
Scene crowded_cell(Random& random, const ContactRule& rule, ContactQuadrature quadrature) {
  Scene scene = nodal_scene();
  scene.contact.quadrature = quadrature;
  scene.contact.energy_consistent = false;  // the reference solver has no energy correction
  scene.contacts = {rule};
  scene.skin = 1;  // so that no state asks for new candidates
  scene.cell.emplace();
  scene.cell->periods = {3.2, 3.1};
  scene.cell->gradient[0][1] = {{0, 1}, {0, 1.3}};
  scene.cell->gradient[1][0] = {{0, 1}, {0, 0.1}};
  scene.cell->gradient[1][1] = {{0, 1}, {1, 1.03}};
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      const Vec2 image{3.2 * (random.below(5) - 2), 3.1 * (random.below(5) - 2)};
      const Vec2 centre = image + Vec2{1.6 * i + random.uniform(0, 0.05), 1.55 * j + random.uniform(0, 0.05)};
      if (i == 0 && j == 1)
        add_body(scene, outline_shape("square", rectangle(1.55, 1.55, 0.13)), BodyKind::rigid, centre,
                 random.uniform(-0.02, 0.02));
      else
        add_body(scene, polygonal_disc("disc", 1.62 + 0.02 * i, 30 + 3 * j, 60),
                 i == 0 ? BodyKind::compliant : BodyKind::rigid, centre, random.uniform(0, 6));
    }
  return scene;
}

/// Sets the cell of a rig, and moves the centres of bodies along.
void deform_cell(ContactRig& rig, const Eigen::Matrix2d& vectors) {
  const Eigen::Matrix2d growth = vectors * matrix_of(rig.q.lattice).inverse() - Eigen::Matrix2d::Identity();
  for (std::size_t b = 0; b < rig.model.bodies.size(); ++b) {
    Vec2 centre(0, 0);
    for (const Vec2& x : rig.outline(static_cast<int>(b))) centre += x / rig.count(static_cast<int>(b));
    rig.move(static_cast<int>(b), growth * centre);
  }
  rig.q.lattice = lattice_of(vectors);
  rig.show();
}

/// Largest difference of forces over the largest force, and of sums of energies, J/m.
struct CellDifference {
  double force = 0, energy = 0, images = 0;

  void add(const ContactRig& rig, const reference::ContactResult& result) {
    const Points forces = forces_on_nodes(result, outline_points(rig).size());
    Eigen::Matrix2d pull = Eigen::Matrix2d::Zero();
    const auto count = [&](const reference::ContactLever& lever) {
      pull += lever.residual * Vec2(lever.image.x, lever.image.y).transpose();
    };
    for (const reference::ContactElement& element : result.elements) count(element.lever);
    for (const reference::ContactPatch& patch : result.patches) count(patch.lever);
    double largest = 0, worst = 0;
    std::size_t node = 0;
    for (int body = 0; body < static_cast<int>(rig.model.bodies.size()); ++body)
      for (int k = 0; k < rig.count(body); ++k, ++node) {
        largest = std::max(largest, forces[node].norm());
        worst = std::max(worst, (rig.force(body, k) - forces[node]).norm());
      }
    ASSERT_GT(largest, 0.01);
    force = std::max(force, worst / largest);
    // The engine's are the forces on the vectors of the periods.
    images = std::max(images, (pull + matrix_of(rig.forces.lattice)).norm() / pull.norm());
    energy = std::max(
        {energy, std::abs(rig.totals.stored - result.stored), std::abs(rig.totals.dissipated - result.dissipated)});
  }
};

CellDifference compare_in_cells(const ContactRule& rule, ContactQuadrature quadrature) {
  CellDifference all;
  OutlineField before;
  for (int sample = 0; sample < 10; ++sample) {
    Random random(sample + 3);
    const Scene scene = crowded_cell(random, rule, quadrature);
    ContactRig rig(scene);
    reference::Contacts contacts(scene, reference_outlines(rig.model));
    for (int state = 0; state < 5; ++state) {
      if (state > 0) stir(rig, random, 0.003);
      const double time = 0.3 * (sample % 4) + 0.002 * state;  // also far sheared
      deform_cell(rig, scene.cell->gradient_at(time) * matrix_of(initial_lattice(scene)));
      if (state == 0) rig.refresh();
      const StepStart start{before, 1};
      rig.totals = rig.contact.forces(rig.outlines, rig.committed, rig.trial, rig.forces, state > 0 ? &start : nullptr);
      all.add(rig, contacts.evaluate(outline_points(rig), reference::Periods(scene, time)));
      rig.commit();
      rig.refresh();
      before = rig.outlines.position;
      contacts.accept();
    }
  }
  return all;
}

// INDEPENDENT: two programs. Tolerance: that of verify/frozen_states, positions of 10 being rounded; energies, of order
// 0.1, the same. Slip includes the motion of the images.
TEST(CellAgreement, forces_over_edges_and_corners) {
  LargestFigures figures;
  for (const ContactQuadrature quadrature : {ContactQuadrature::nodes, ContactQuadrature::segments})
    for (const ContactRule& rule : {frictionless(100), mohr_coulomb(100, 0.3, 0.05)}) {
      const CellDifference found = compare_in_cells(rule, quadrature);
      figures.note("contact forces in a deformed cell", found.force);
      EXPECT_LE(found.force, 1e-11);
      EXPECT_LE(found.images, 1e-11);
      EXPECT_LE(found.energy, 1e-11);
    }
}

}  // namespace
}  // namespace pliant
