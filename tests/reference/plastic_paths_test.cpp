// Both programs on the plastic paths of a point that scipy has computed (verify/plasticity).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "materials/drucker_prager.hpp"
#include "materials/von_mises.hpp"
#include "reference/materials/plastic.hpp"
#include "support/random.hpp"

namespace pliant {
namespace {

/// Of the law of the table: two shears, so that E and nu follow from mu and the bulk modulus.
Material law_of_table() {
  const double mu = 0.8, bulk = 1.9;
  Material material;
  material.law = MaterialLaw::von_mises;
  material.young = 9 * bulk * mu / (3 * bulk + mu), material.poisson = (3 * bulk - 2 * mu) / (2 * (3 * bulk + mu));
  material.yield = 0.11, material.hardening = 0.07, material.saturation = 0.16, material.saturation_rate = 9;
  return material;
}

struct Increment {
  bool is_first;
  Tensor<double> F, P;
  double sigma_zz;
  std::array<double, 4> now;
};

std::vector<Increment> table() {
  std::ifstream file(PLIANT_SOURCE_DIR "/verify/plasticity/oracles/paths.csv");
  std::vector<Increment> all;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || !std::isdigit(static_cast<unsigned char>(line[0]))) continue;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream row(line);
    int path = 0, increment = 0;
    Increment one{};
    row >> path >> increment >> one.F.xx >> one.F.xy >> one.F.yx >> one.F.yy >> one.P.xx >> one.P.xy >> one.P.yx >>
        one.P.yy >> one.sigma_zz;
    for (double& value : one.now) row >> value;
    one.is_first = increment == 0;
    all.push_back(one);
  }
  return all;
}

constexpr double error = 1e-12;  ///< by which two forms of the table's own program differ

// INDEPENDENT: stresses, plastic metrics and plastic strains after each increment.
TEST(PlasticPaths, engine_agrees_with_scipy) {
  const auto law = VonMises<double>::of(law_of_table()).over(1);
  VonMises<double>::Record record{}, now{};
  ASSERT_EQ(table().size(), 150);
  for (const Increment& one : table()) {
    if (one.is_first) record = {1, 0, 1, 0};
    const Tensor<double> P = law.respond(one.F, record, now).P;
    EXPECT_NEAR(P.xx, one.P.xx, error);
    EXPECT_NEAR(P.xy, one.P.xy, error);
    EXPECT_NEAR(P.yx, one.P.yx, error);
    EXPECT_NEAR(P.yy, one.P.yy, error);
    EXPECT_NEAR(law.sigma_zz(one.F, now), one.sigma_zz, error);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(now[k], one.now[k], error);
    record = now;
  }
}

// INDEPENDENT: the same of the reference solver.
TEST(PlasticPaths, reference_agrees_with_scipy) {
  reference::PointHistory history;
  for (const Increment& one : table()) {
    if (one.is_first) history = {};
    const reference::PlasticIncrement found =
        reference::plastic_increment(law_of_table(), {one.F.xx, one.F.xy, one.F.yx, one.F.yy}, history, 1);
    const double P[] = {one.P.xx, one.P.xy, one.P.yx, one.P.yy};
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(found.stress[k], P[k], error);
    history = found.now;
    EXPECT_NEAR(history.metric.xx, one.now[0], error);
    EXPECT_NEAR(history.metric.xy, one.now[1], error);
    EXPECT_NEAR(history.metric.yy, one.now[2], error);
    EXPECT_NEAR(history.plastic_strain, one.now[3], error);
  }
}

/// Soil that is compressed and sheared, turned, and then torn: onto the cone, and to the apex.
std::vector<Tensor<double>> path_of_soil(int increments) {
  std::vector<Tensor<double>> path;
  for (int i = 1; i <= 2 * increments; ++i) {
    const double t = double(i) / increments, load = std::min(t, 1.0), tear = std::max(t - 1, 0.0);
    const double xx = 1 + 0.3 * tear, yy = 1 - 0.1 * load + 0.4 * tear, xy = 0.15 * load, c = std::cos(t),
                 s = std::sin(t);
    path.push_back({c * xx, c * xy - s * yy, s * xx, s * xy + c * yy});
  }
  return path;
}

struct Losses {
  double engine = 0, reference = 0;
};

/// Sums over the path; compares stresses and plastic strains after each increment.
Losses follow_soil(int increments) {
  Material material = law_of_table();
  material.law = MaterialLaw::drucker_prager;
  material.cohesion = 0.02, material.friction_angle = 0.5, material.dilatancy_angle = 0.2, material.hardening = 0.03;
  const auto law = DruckerPrager<double>::of(material).over(1);
  DruckerPrager<double>::Record record{1, 0, 1, 1, 0, 0, 0}, now{};
  reference::PointHistory history;
  Losses sum;
  bool reached_apex = false;
  for (const Tensor<double>& F : path_of_soil(increments)) {
    const Response<double> engine = law.respond(F, record, now);
    const reference::PlasticIncrement own =
        reference::plastic_increment(material, {F.xx, F.xy, F.yx, F.yy}, history, 1);
    record = now, history = own.now;
    const double stress[] = {engine.P.xx, engine.P.xy, engine.P.yx, engine.P.yy};
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(own.stress[i], stress[i], error);
    EXPECT_NEAR(history.plastic_strain, record[4], error);
    EXPECT_NEAR(own.energy, law.energy(F, record), error);
    EXPECT_NEAR(history.metric.xy, record[1], error);
    reached_apex |= own.now.plastic_strain > 0 && std::abs(record[5]) < 1e-15;
    sum.engine += engine.loss, sum.reference += own.loss;
  }
  EXPECT_TRUE(reached_apex);
  return sum;
}

// INDEPENDENT, RATE: Drucker and Prager's law of both programs, one by formulas of the return, the other from
// derivatives of the strain's invariants. Losses of a step are of first order: the mean of the stresses before and
// after, and the yield stress at the end.
TEST(PlasticPaths, drucker_prager_agrees) {
  const Losses coarse = follow_soil(100), fine = follow_soil(200);
  const double difference = fine.engine - fine.reference;
  EXPECT_NEAR((coarse.engine - coarse.reference) / difference, 2, 0.3);
  EXPECT_LT(std::abs(difference), 0.02 * fine.engine);
}

// EXACT: the stiffness of an increment is the difference quotient of its stress: elastic, on the cone and at the apex,
// with rounding of 1e-16 over h = 1e-7 and h^2 of third derivatives. No sample lies within h of a limit of the three.
TEST(PlasticPaths, stiffness_of_drucker_prager_is_the_derivative) {
  Material material = law_of_table();
  material.law = MaterialLaw::drucker_prager;
  material.cohesion = 0.01, material.friction_angle = 0.5, material.dilatancy_angle = 0.2, material.hardening = 0.03;
  testing::Random random(1);
  int elastic = 0, cone = 0, apex = 0;
  for (int sample = 0; sample < 200; ++sample) {
    Tensor<double> F{1 + random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05),
                     1 + random.uniform(-0.05, 0.05)};
    const auto stress_at = [&] {
      return reference::plastic_increment(material, {F.xx, F.xy, F.yx, F.yy}, {}, 1).stress;
    };
    const reference::PlasticIncrement at = reference::plastic_increment(material, {F.xx, F.xy, F.yx, F.yy}, {}, 1);
    const double widens = at.now.plastic_strain > 0 ? at.now.plastic_volume / at.now.plastic_strain : 0;
    ++(at.loss == 0 ? elastic : widens > 0.6 ? apex : cone);  // dilatancy 0.34, friction 0.80
    double* const entries[] = {&F.xx, &F.xy, &F.yx, &F.yy};
    for (int j = 0; j < 4; ++j) {
      const double h = 1e-7, held = *entries[j];
      *entries[j] = held + h;
      const Eigen::Vector4d up = stress_at();
      *entries[j] = held - h;
      const Eigen::Vector4d change = (up - stress_at()) / (2 * h);
      *entries[j] = held;
      EXPECT_LT((change - at.stiffness.col(j)).cwiseAbs().maxCoeff(), 1e-7);
    }
  }
  EXPECT_GT(std::min({elastic, cone, apex}), 20);
}

}  // namespace
}  // namespace pliant
