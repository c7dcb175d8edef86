// Both programs on the plastic paths of a point that scipy has computed (verify/plasticity).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "materials/von_mises.hpp"
#include "reference/materials/plastic.hpp"

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

}  // namespace
}  // namespace pliant
