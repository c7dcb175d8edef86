#include "bodies/internal_forces.hpp"

#include <gtest/gtest.h>

#include "bodies/initial_state.hpp"
#include "materials/neo_hookean.hpp"
#include "setup/build_model.hpp"
#include "support/scenes.hpp"

namespace pliant {
namespace {

using namespace testing;

// Ten compliant discs of one shape at different angles: a batch of eight and one of two. Materials of two stiffnesses.
Scene ten_discs(MaterialLaw law = MaterialLaw::neo_hookean, DiscretisationMethod method = DiscretisationMethod::mls) {
  Scene scene = bare_scene();
  scene.discretisation.method = method;
  scene.contacts = {frictionless(1)};
  scene.materials[0].law = law;
  scene.materials.push_back({"stiff", law, 3, 5, 0.3});
  scene.shapes = {polygonal_disc("disc", 1, 26, 50)};
  for (int i = 0; i < 10; ++i)
    add_grain(scene, "disc", BodyKind::compliant, {2.0 * i, 0.3 * i}, 0.4 * i, i % 3 == 1 ? "stiff" : "soft");
  return scene;
}

// Smooth large strains and a little noise, different in each lane, none in the padding.
void deform(const Model& model, Dofs& q, std::uint64_t seed, double size = 0.15) {
  Random random(seed);
  for (const Batch& batch : model.batches)
    for (int lane = 0; lane < batch.count; ++lane) {
      const double a = random.uniform(-size, size), b = random.uniform(-size, size), c = random.uniform(-size, size);
      for (int i = 0; i < model.shape_of(batch).nodes(); ++i) {
        Lanes& x = q.compliant[batch.offset + 2 * i];
        Lanes& y = q.compliant[batch.offset + 2 * i + 1];
        const double u = a * x[lane] + b * y[lane] * y[lane] + 0.02 * random.uniform(-size, size);
        const double v = c * x[lane] - a * y[lane] * x[lane] + 0.02 * random.uniform(-size, size);
        x[lane] += u;
        y[lane] += v;
      }
    }
}

struct Loaded {
  Model model;
  Dofs q, f;
  std::vector<Lanes> jacobian;

  explicit Loaded(const Scene& scene, std::uint64_t seed = 1, double size = 0.15)
      : model(build_model(scene)), q(initial_positions(model)), f(zero_dofs(model)) {
    deform(model, q, seed, size);
    evaluate();
  }
  void evaluate() {
    f = zero_dofs(model);
    jacobian.clear();
    for (const Batch& batch : model.batches)
      jacobian.push_back(
          add_internal_forces(model, batch, {.position = &q.compliant[batch.offset]}, &f.compliant[batch.offset])
              .least_jacobian);
  }
  Lanes energy(int batch) const {
    return strain_energy(model, model.batches[batch], {.position = &q.compliant[model.batches[batch].offset]});
  }
  double largest_force() const {
    double result = 0;
    for (const Lanes& lanes : f.compliant) result = std::max(result, largest(abs(lanes)));
    return result;
  }
};

const MaterialLaw all_laws[] = {MaterialLaw::neo_hookean, MaterialLaw::neo_hookean_quadratic, MaterialLaw::melody};

// EXACT: f_i = - sum_g w_g P(F_g) b_gi in plain scalars, point after point, also for tables of very few points.
// Rounding of some 100 terms of order 0.1.
TEST(InternalForces, AreTheSumOverThePoints) {
  Loaded loaded(ten_discs());
  const Batch& batch = loaded.model.batches[0];
  IntegrationTable& table = loaded.model.shapes[0].space.table;
  for (const std::size_t points : {table.weight.size(), std::size_t{3}, std::size_t{2}, std::size_t{1}}) {
    table.weight.resize(points);
    loaded.evaluate();
    for (int lane = 0; lane < lane_count; ++lane) {
      std::vector<Vec2> expected(static_cast<std::size_t>(loaded.model.shapes[0].nodes()), Vec2(0, 0));
      const std::vector<Tensor<double>> F =
          deformation_gradients(loaded.model, loaded.model.bodies[loaded.model.groups[0].bodies[lane]], loaded.q);
      double least = 1e300;
      for (std::size_t g = 0; g < points; ++g) {
        const auto [P, J, power, loss] = NeoHookean<double>{batch.mu[lane], batch.lambda[lane]}.respond(F[g]);
        least = std::min(least, J);
        for (int e = table.start[g]; e < table.start[g + 1]; ++e) {
          const Vec2 b = table.weight[g] * table.gradient[e];
          expected[table.node[e]] -= Vec2(P.xx * b.x() + P.xy * b.y(), P.yx * b.x() + P.yy * b.y());
        }
      }
      for (std::size_t i = 0; i < expected.size(); ++i)
        for (int c = 0; c < 2; ++c) EXPECT_NEAR(loaded.f.compliant[2 * i + c][lane], expected[i][c], 1e-14);
      EXPECT_NEAR(loaded.jacobian[0][lane], least, 1e-14);
    }
  }
}

// EXACT: forces are minus the gradient of the strain energy. Central differences of step 1e-5: h^2/6 of a third
// derivative of order 1e3 (gradients are 1/h of 0.1) gives 2e-8, rounding 1e-16/1e-5 = 1e-11; relative to forces of
// order 0.1.
TEST(InternalForces, AreMinusTheGradientOfTheEnergy) {
  for (const MaterialLaw law : all_laws)
    for (const DiscretisationMethod method : {DiscretisationMethod::mls, DiscretisationMethod::mls_gauss}) {
      Loaded loaded(ten_discs(law, method));
      const Dofs f = loaded.f;
      for (std::size_t dof = 3; dof < loaded.q.compliant.size(); dof += 17) {
        const int b = dof < loaded.model.batches[1].offset ? 0 : 1;
        const Lanes at = loaded.q.compliant[dof], step = broadcast(1e-5);
        loaded.q.compliant[dof] = at + step;
        const Lanes above = loaded.energy(b);
        loaded.q.compliant[dof] = at - step;
        const Lanes below = loaded.energy(b);
        loaded.q.compliant[dof] = at;
        for (int lane = 0; lane < loaded.model.batches[b].count; ++lane)
          EXPECT_NEAR(f.compliant[dof][lane], -(above - below)[lane] / 2e-5, 2e-7)
              << "dof " << dof << ", lane " << lane;
      }
    }
}

// EXACT: sums over b vanish and P F^T is symmetric, so force and moment balance to rounding of sums of 100 terms.
TEST(InternalForces, BalanceForceAndMoment) {
  for (const MaterialLaw law : all_laws)
    for (const DiscretisationMethod method : {DiscretisationMethod::mls, DiscretisationMethod::mls_gauss}) {
      const Loaded loaded(ten_discs(law, method));
      for (const Batch& batch : loaded.model.batches) {
        Lanes fx{}, fy{}, moment{}, magnitude{};
        for (std::size_t i = batch.offset; i < batch.offset + 2 * loaded.model.shape_of(batch).nodes(); i += 2) {
          const Lanes x = loaded.q.compliant[i], y = loaded.q.compliant[i + 1];
          fx += loaded.f.compliant[i], fy += loaded.f.compliant[i + 1];
          moment += x * loaded.f.compliant[i + 1] - y * loaded.f.compliant[i];
          magnitude += abs(loaded.f.compliant[i]) + abs(loaded.f.compliant[i + 1]);
        }
        for (int lane = 0; lane < batch.count; ++lane) {
          EXPECT_GT(magnitude[lane], 0.1);
          EXPECT_LT(std::abs(fx[lane]) + std::abs(fy[lane]), 1e-12 * magnitude[lane]);
          EXPECT_LT(std::abs(moment[lane]), 1e-12 * magnitude[lane]);
        }
      }
    }
}

// EXACT: rigid motion gives no force; stress at rest is the rounding of F = I, 1e-15, times b w of order 0.1, over the
// completeness 1e-12.
TEST(InternalForces, RigidMotionGivesNone) {
  for (const MaterialLaw law : all_laws) {
    Loaded loaded(ten_discs(law), 1, 0);
    for (std::size_t i = 0; i < loaded.q.compliant.size(); i += 2) {
      const Lanes x = loaded.q.compliant[i], y = loaded.q.compliant[i + 1];
      loaded.q.compliant[i] = std::cos(1.1) * x - std::sin(1.1) * y + 7;
      loaded.q.compliant[i + 1] = std::sin(1.1) * x + std::cos(1.1) * y - 3;
    }
    loaded.evaluate();
    EXPECT_LT(loaded.largest_force(), 1e-11);
    for (int b = 0; b < 2; ++b) EXPECT_LT(largest(abs(loaded.energy(b))), 1e-12);
    for (int b = 0; b < 2; ++b) EXPECT_LT(largest(abs(loaded.jacobian[b] - 1.0)), 1e-11);
  }
}

// EXACT, bit by bit: a body's forces do not depend on its lane nor on what the others do.
TEST(InternalForces, LanesAreIndependent) {
  Loaded together(ten_discs());
  Loaded alone(ten_discs(), 99);
  Batch& from = together.model.batches[0];
  Batch& to = alone.model.batches[0];
  for (std::size_t i = 0; i < 2U * together.model.shape_of(from).nodes(); ++i)
    alone.q.compliant[i][0] = together.q.compliant[i][3];
  to.mu[0] = from.mu[3];
  to.lambda[0] = from.lambda[3];
  alone.evaluate();
  for (std::size_t i = 0; i < 2U * together.model.shape_of(from).nodes(); ++i)
    EXPECT_EQ(alone.f.compliant[i][0], together.f.compliant[i][3]);
  EXPECT_EQ(alone.energy(0)[0], together.energy(0)[3]);
  EXPECT_EQ(alone.jacobian[0][0], together.jacobian[0][3]);
}

// EXACT: padding lanes count for no energy, stay at rest, and have a Jacobian of a real body.
TEST(InternalForces, PaddingIsHarmless) {
  const Loaded loaded(ten_discs());
  ASSERT_EQ(loaded.model.batches.size(), 2U);
  const Batch& batch = loaded.model.batches[1];
  ASSERT_EQ(batch.count, 2);
  const Lanes energy = loaded.energy(1);
  for (int lane = 0; lane < lane_count; ++lane) {
    EXPECT_EQ(batch.weight[lane], lane < 2 ? 1 : 0);
    EXPECT_EQ(energy[lane] > 0, lane < 2);
    EXPECT_GT(loaded.jacobian[1][lane], 0);
    EXPECT_GT(batch.density[lane], 0);
  }
  for (std::size_t i = batch.offset; i < loaded.f.compliant.size(); ++i)
    for (int lane = 2; lane < lane_count; ++lane) EXPECT_LT(std::abs(loaded.f.compliant[i][lane]), 1e-11);
}

// EXACT: an affine deformation gives the same F at all points, the energy area x psi(F), and the Jacobian det F.
TEST(InternalForces, AffineDeformation) {
  Loaded loaded(ten_discs(), 1, 0);
  for (std::size_t i = 0; i < loaded.q.compliant.size(); i += 2) {
    const Lanes x = loaded.q.compliant[i], y = loaded.q.compliant[i + 1];
    loaded.q.compliant[i] = 1.2 * x + 0.3 * y;
    loaded.q.compliant[i + 1] = -0.1 * x + 0.85 * y;
  }
  loaded.evaluate();
  const Batch& batch = loaded.model.batches[0];
  const Lanes energy = loaded.energy(0);
  for (int lane = 0; lane < batch.count; ++lane) {
    // psi of an isotropic law does not see the initial rotation. lambda = 4 mu, psi/mu = 0.0872207960699283
    // (docs/method.md 3) for nu = 0.4.
    if (lane % 3 == 1) continue;
    EXPECT_NEAR(energy[lane], loaded.model.bodies[lane].area * batch.mu[lane] * 0.0872207960699283, 1e-12);
    EXPECT_NEAR(loaded.jacobian[0][lane], 1.2 * 0.85 + 0.03, 1e-12);
    for (const Tensor<double>& F : deformation_gradients(loaded.model, loaded.model.bodies[lane], loaded.q))
      EXPECT_NEAR(determinant(F), 1.05, 1e-12);
  }
}

// EXACT: the least Jacobian finds the one element turned inside out.
TEST(InternalForces, LeastJacobianSeesOneBadPoint) {
  Loaded loaded(ten_discs(), 1, 0);
  // Node 0 of body 5 is pushed through the centre to the far side.
  for (int c = 0; c < 2; ++c) loaded.q.compliant[c][5] *= -2;
  loaded.evaluate();
  for (int lane = 0; lane < lane_count; ++lane) EXPECT_EQ(loaded.jacobian[0][lane] < 0, lane == 5);
}

// EXACT: forces are added to what is there.
TEST(InternalForces, AreAdded) {
  Loaded loaded(ten_discs());
  const Dofs once = loaded.f;
  const Batch& batch = loaded.model.batches[0];
  std::vector<Lanes> twice(once.compliant.begin(), once.compliant.begin() + 2 * loaded.model.shape_of(batch).nodes());
  add_internal_forces(loaded.model, batch, {.position = loaded.q.compliant.data()}, twice.data());
  for (std::size_t i = 0; i < twice.size(); ++i) EXPECT_LT(largest(abs(twice[i] - 2.0 * once.compliant[i])), 1e-14);
}

}  // namespace
}  // namespace pliant
