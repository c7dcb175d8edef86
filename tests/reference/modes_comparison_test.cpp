// Natural frequencies of the reference solver's tangent and masses against those of the engine's kernels.
// INDEPENDENT: they share the mesh and the scene.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "bodies/natural_modes.hpp"
#include "reference/natural_modes.hpp"
#include "reference/shapes.hpp"
#include "setup/build_model.hpp"
#include "support/scenes.hpp"

namespace pliant {
namespace {

using namespace testing;

/// Error of w^2 from the engine's differences of forces, over the largest: some ten entries a row, each to 1e-12.
constexpr double of_a_stiffness = 1e-11;
constexpr std::size_t smooth = 10;  ///< motions over many nodes

/// Error of w^2 of smooth motions from the differences: what they leave of the stiffness of a translation, exactly 0,
/// |A x| / |x| of A = L^T K L, W = L L^T the inverse mass. Another error of A of that size moves w^2 by no more (Weyl).
double error_of_differences(const SmallMotions& motions) {
  const Eigen::Index nodes = motions.inverse_mass.rows();
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(nodes);
  const double whole = ones.dot(motions.inverse_mass.llt().solve(ones));
  double largest = 0;
  for (Eigen::Index along = 0; along < 2; ++along) {
    double square = 0;
    for (Eigen::Index a = 0; a < 2; ++a) {
      const Eigen::MatrixXd part = motions.stiffness(Eigen::seqN(a, nodes, 2), Eigen::seqN(along, nodes, 2));
      const Eigen::VectorXd force = part.rowwise().sum();
      square += force.dot(motions.inverse_mass * force);
    }
    largest = std::max(largest, std::sqrt(square / whole));
  }
  return largest;
}

Scene one_disc(const DiscretisationSettings& settings) {
  Scene scene = bare_scene();
  scene.discretisation = settings;
  scene.contacts = {frictionless(1)};
  scene.shapes = {disc(84, 1)};
  add_grain(scene, scene.shapes[0].name, BodyKind::compliant, {0, 0}, 0.4, "soft");
  scene.grains.back().size.factors = {0.7};
  return scene;
}

TEST(NaturalModesOfBoth, agree) {
  for (const DiscretisationMethod method : {DiscretisationMethod::mls, DiscretisationMethod::mls_gauss,
                                            DiscretisationMethod::t3, DiscretisationMethod::es_t3})
    for (const auto& [kind, mass, scaling] : {std::tuple(reference::MassMatrix::lumped, Mass::lumped, 1.0),
                                              {reference::MassMatrix::scaled, Mass::lumped, 3},
                                              {reference::MassMatrix::corrected, Mass::corrected, 1}}) {
      const Scene scene = one_disc({.method = method, .mass = mass, .mass_scaling = scaling});
      const Model model = build_model(scene);
      const SmallMotions motions = small_motions(model, model.bodies[0]);
      const NaturalModes engine = natural_modes(motions);
      const double error = error_of_differences(motions), fastest = engine.frequency.back();
      const reference::Bodies bodies(scene);
      const Eigen::VectorXd own = natural_frequencies(bodies, bodies.all()[0], kind);
      ASSERT_EQ(engine.motions_at_rest, 3);
      ASSERT_EQ(engine.frequency.size(), static_cast<std::size_t>(own.size()) - 3);
      for (std::size_t i = 0; i < engine.frequency.size(); ++i) {
        const double w = own[static_cast<Eigen::Index>(i) + 3];
        ASSERT_NEAR(engine.frequency[i], w, (i < smooth ? error : of_a_stiffness * fastest * fastest) / (2 * w)) << i;
      }
    }
}

}  // namespace
}  // namespace pliant
