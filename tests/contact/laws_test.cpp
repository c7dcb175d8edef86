#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bodies/model.hpp"
#include "contact/law_table.hpp"
#include "setup/build_model.hpp"
#include "support/random.hpp"
#include "support/scenes.hpp"

namespace pliant {
namespace {

using namespace testing;

// One line of a table of states, made by hand.
struct StateRow {
  const char* name;
  double gap, pressure, shear_limit, energy;
};

// EXACT: each value is a few roundings of numbers of order one.
template <class Law>
void expect_table(const Law& law, const std::vector<StateRow>& table) {
  for (const StateRow& row : table) {
    const Traction traction = law(broadcast(row.gap));
    for (int lane = 0; lane < lane_count; ++lane) {
      EXPECT_NEAR(traction.pressure[lane], row.pressure, 1e-14) << row.name;
      EXPECT_NEAR(traction.shear_limit[lane], row.shear_limit, 1e-14) << row.name;
      EXPECT_NEAR(traction.energy[lane], row.energy, 1e-14) << row.name;
    }
  }
}

// kn = 10.
TEST(LawTable, Frictionless) {
  expect_table(Frictionless{10, 0, 0},
               {{"pressed", -0.3, 3, 0, 0.45}, {"just met", 0, 0, 0, 0}, {"apart", 0.2, 0, 0, 0}});
}

// kn = 10, friction 0.5, cohesion 0.2, tensile cut-off 1 at a gap of 0.1. Energy: what closing from the cut-off takes,
// 5 (g^2 - 0.01).
TEST(LawTable, MohrCoulomb) {
  expect_table(MohrCoulomb{10, 10, 0.1, 0.5, 0.2}, {{"pressed", -0.3, 3, 1.7, 0.4},
                                                    {"just met", 0, 0, 0.2, -0.05},
                                                    {"pulled: no friction from tension", 0.06, -0.6, 0.2, -0.032},
                                                    {"beyond the cut-off", 0.1, 0, 0, 0},
                                                    {"apart", 0.5, 0, 0, 0}});
}

// Without tension: dry friction.
TEST(LawTable, Coulomb) {
  expect_table(MohrCoulomb{10, 10, 0, 0.5, 0}, {{"pressed", -0.2, 2, 1, 0.2}, {"apart", 1e-9, 0, 0, 0}});
}

// kn = 10, strength 2: critical gap 0.2; range 0.6, shear strength 3. Fracture energy 2 x 0.6/2 = 0.6.
TEST(LawTable, Cohesive) {
  expect_table(Cohesive{10, 10, 0.6, 2, 3}, {{"pressed", -0.3, 3, 3, -0.6 + 0.45},
                                             {"just met", 0, 0, 3, -0.6},
                                             {"pulled", 0.1, -1, 3, -0.6 + 0.05},
                                             {"at the strength", 0.2, -2, 3, -0.4},
                                             {"half torn", 0.4, -1, 1.5, -0.1},
                                             {"torn", 0.6, 0, 0, 0},
                                             {"apart", 0.9, 0, 0, 0}});
}

// kn = 10, smooth over 0.2: the straight branch starts at a pressure of 1 and meets zero at 0.1. Energy: 10 x^3/1.2,
// then the parabola about 0.1 and 10 x 0.04/24.
TEST(LawTable, Smoothed) {
  expect_table(Smoothed<Frictionless>{{10, 0, 0}, 0.2}, {{"end of the start", -0.2, 1, 0, 10 * 0.008 / 1.2},
                                                         {"half way", -0.1, 0.25, 0, 10 * 0.001 / 1.2},
                                                         {"deep", -0.5, 4, 0, 0.8 + 0.4 / 24},
                                                         {"just met", 0, 0, 0, 0},
                                                         {"apart", 0.3, 0, 0, 0}});
  expect_table(Smoothed<MohrCoulomb>{{10, 10, 0, 0.5, 0.2}, 0.2}, {{"deep", -0.5, 4, 2.2, 0.8 + 0.4 / 24},
                                                                   {"half way", -0.1, 0.25, 0.325, 10 * 0.001 / 1.2},
                                                                   {"apart", 1e-9, 0, 0, 0}});
}

// EXACT: dpsi/dg = -p wherever the law is smooth; central differences of quadratics have no truncation error:
// 1e-16/1e-5.
TEST(LawTable, PressureIsTheDerivativeOfTheEnergy) {
  const auto defect = [](const auto& law, double gap) {
    constexpr double h = 1e-5;
    const double slope = (law(broadcast(gap + h)).energy[0] - law(broadcast(gap - h)).energy[0]) / (2 * h);
    return std::abs(slope + law(broadcast(gap)).pressure[0]);
  };
  for (double gap = -0.5123; gap < 0.8; gap += 0.0137) {
    EXPECT_LT(defect(Frictionless{10, 0, 0}, gap), 1e-9);
    EXPECT_LT(defect(MohrCoulomb{10, 10, 0.1, 0.5, 0.2}, gap), 1e-9);
    EXPECT_LT(defect(Cohesive{10, 10, 0.6, 2, 3}, gap), 1e-9);
    EXPECT_LT(defect(Smoothed<Frictionless>{{10, 0, 0}, 0.2}, gap), 1e-9);
  }
}

// EXACT to the last bits, which inlining may change: lanes do not look at each other.
TEST(LawTable, LanesAreIndependent) {
  const Lanes gaps = {-0.3, 0, 0.1, 0.2, 0.4, 0.6, 0.9, 1e100};
  const Cohesive law{10, 10, 0.6, 2, 3};
  const Traction together = law(gaps);
  for (int lane = 0; lane < lane_count; ++lane) {
    const Traction alone = law(broadcast(gaps[lane]));
    EXPECT_DOUBLE_EQ(together.pressure[lane], alone.pressure[7 - lane]);
    EXPECT_DOUBLE_EQ(together.shear_limit[lane], alone.shear_limit[7 - lane]);
    EXPECT_DOUBLE_EQ(together.energy[lane], alone.energy[7 - lane]);
  }
}

// ---- what all laws promise

const std::vector<ContactLaw> one_of_each = {
    Frictionless{10, 0, 0},
    MohrCoulomb{10, 8, 0.1, 0.5, 0.2},
    Cohesive{10, 8, 0.6, 2, 3},
    Smoothed<Frictionless>{{10, 0, 0}, 0.2},
    Smoothed<MohrCoulomb>{{10, 8, 0, 0.5, 0.2}, 0.2},
    Damped<Frictionless>{{10, 0, 0}, 0.3, 0.1},
    Damped<MohrCoulomb>{{10, 8, 0, 0.5, 0.2}, 0.3, 0.1},
};

TEST(AllContactLaws, stand_in_the_list_above) {
  ASSERT_EQ(one_of_each.size(), std::variant_size_v<ContactLaw>) << "EXACT";
  for (std::size_t i = 0; i < one_of_each.size(); ++i) EXPECT_EQ(one_of_each[i].index(), i) << "EXACT";
}

template <class Law>
Contact answer(const Law& law, Lanes gap, LaneBits projects, Lanes moved, Lanes slip) {
  return respond(law, law(gap), projects & (gap < law.reach), slip, moved);
}

Lanes uniform_lanes(Random& random, double low, double high) {
  return in_each_lane(Lanes{}, [&](double) { return random.uniform(low, high); });
}

/// EXACT: asked again without motion from what it remembers since, a law answers the same; numbers of order 10 and a
/// few dozen roundings. Audits, probes and the drawing of forces ask so.
TEST(AllContactLaws, answer_the_same_again_at_rest) {
  Random random(71);
  for (const ContactLaw& any_law : one_of_each)
    std::visit(
        [&]<class Law>(const Law& law) {
          for (int sample = 0; sample < 50; ++sample) {
            Lanes slip{};
            for (int step = 0; step < 20; ++step) {
              const Lanes gap = uniform_lanes(random, -0.4, 0.7);
              const Lanes moved = Law::has_shear ? uniform_lanes(random, -0.3, 0.3) : Lanes{};
              const LaneBits projects = uniform_lanes(random, 0, 1) < 0.9;
              const Contact first = answer(law, gap, projects, moved, slip);
              const Contact again = answer(law, gap, projects, Lanes{}, first.slip);
              for (int lane = 0; lane < lane_count; ++lane) {
                if (!projects[lane]) continue;
                EXPECT_NEAR(again.pressure[lane], first.pressure[lane], 1e-13) << Law::name;
                EXPECT_NEAR(again.shear[lane], first.shear[lane], 1e-13) << Law::name;
                EXPECT_NEAR(again.energy[lane], first.energy[lane], 1e-13) << Law::name;
                EXPECT_NEAR(again.slip_work[lane], 0, 1e-13) << Law::name;
              }
              slip = first.slip;
            }
          }
        },
        any_law);
}

// ---- which law a pair gets

// Bodies 0 and 1 soft (E = 1), 2 stiff (E = 5) and of finer outline, 3 and 4 rigid.
Scene five_bodies() {
  Scene scene = bare_scene();
  scene.materials.push_back({"stiff", MaterialLaw::neo_hookean, 1, 5, 0.3});
  scene.shapes = {polygonal_disc("coarse", 1, 20, 40), polygonal_disc("fine", 1, 40, 120)};
  add_grain(scene, "coarse", BodyKind::compliant, {0, 0});
  add_grain(scene, "coarse", BodyKind::compliant, {3, 0});
  add_grain(scene, "fine", BodyKind::compliant, {6, 0}, 0, "stiff");
  add_grain(scene, "coarse", BodyKind::rigid, {9, 0});
  add_grain(scene, "coarse", BodyKind::rigid, {12, 0});
  return scene;
}

ContactRule with_auto_stiffness(ContactRule rule) {
  rule.stiffness.reset();
  rule.range.reset();
  return rule;
}

// EXACT, docs/method.md 4: 8 E/h of the softer body and the finer outline; range 0.12 h; kt = kn, tau_c = sigma_c.
TEST(LawsOfPairs, AutomaticStiffnessAndRange) {
  Scene scene = five_bodies();
  scene.contacts = {with_auto_stiffness(cohesive(0, 1e-3, 0, 0))};
  scene.contacts[0].shear_strength.reset();
  const Model model = build_model(scene);
  const LawTable laws(model);
  const double coarse = model.outlines[model.bodies[0].outline].spacing,
               fine = model.outlines[model.bodies[2].outline].spacing;
  const auto law = [&](int a, int b) { return std::get<Cohesive>(laws.between(a, b)); };
  const auto expect_law = [&](int a, int b, double young, double h) {
    EXPECT_NEAR(law(a, b).normal_stiffness * h / (8 * young), 1, 1e-14) << a << " " << b;
    EXPECT_NEAR(law(a, b).shear_stiffness * h / (8 * young), 1, 1e-14);
    EXPECT_NEAR(law(a, b).reach / (0.12 * h), 1, 1e-14);
    EXPECT_EQ(law(a, b).shear_strength, 1e-3);
    EXPECT_EQ(law(b, a).normal_stiffness, law(a, b).normal_stiffness);
  };
  expect_law(0, 1, 1, coarse);
  expect_law(0, 2, 1, fine);
  expect_law(0, 3, 1, coarse);
  expect_law(2, 3, 5, fine);
  // Pairs of rigid bodies: no less than the scene's largest, here that of body 2 and a rigid one or its like.
  EXPECT_GE(law(3, 4).normal_stiffness, 8 * 5 / fine * (1 - 1e-14));
  EXPECT_NEAR(laws.max_reach(), 0.12 * std::max(coarse, model.outlines[model.bodies[3].outline].spacing), 1e-15);
}

// EXACT: the rule of the two materials, in either order, before that of all.
TEST(LawsOfPairs, SpecialRuleComesFirst) {
  Scene scene = five_bodies();
  ContactRule special = mohr_coulomb(7, 0.4, 0.1, 0.14);
  special.first = "hard", special.second = "soft";
  special.shear_stiffness = 3;
  scene.contacts = {frictionless(5), special};
  const LawTable laws(build_model(scene));
  for (const auto& [a, b] : {std::pair{0, 3}, {3, 0}, {1, 4}, {4, 1}}) {
    const MohrCoulomb law = std::get<MohrCoulomb>(laws.between(a, b));
    EXPECT_EQ(law.normal_stiffness, 7);
    EXPECT_EQ(law.shear_stiffness, 3);
    EXPECT_EQ(law.friction, 0.4);
    EXPECT_EQ(law.cohesion, 0.1);
    EXPECT_DOUBLE_EQ(law.reach, 0.02);
    EXPECT_EQ(stiffness_of(law), 7);
  }
  for (const auto& [a, b] : {std::pair{0, 1}, {0, 2}, {2, 3}, {3, 4}})
    EXPECT_EQ(std::get<Frictionless>(laws.between(a, b)).normal_stiffness, 5);
}

std::string error_of(const Scene& scene) {
  try {
    LawTable(build_model(scene));
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

// EXACT: a dashpot of a contact takes nothing that is worth a restitution from bodies that are soft themselves.
TEST(LawsOfPairs, RestitutionIsOfRigidPairs) {
  Scene scene = five_bodies();
  scene.contacts = {mohr_coulomb(7, 0.4, 0, 0)};
  scene.contacts[0].restitution = 0.5;
  for (const char* part : {"between 'all' and 'all': restitution = 0.5", "'soft'", "viscosity", "a rule of their own"})
    EXPECT_NE(error_of(scene).find(part), std::string::npos) << part << " in " << error_of(scene);
  scene.contacts[0].restitution = 1;
  EXPECT_EQ(error_of(scene), "") << "elastic anyway";
  scene.contacts.push_back(scene.contacts[0]);
  scene.contacts[1].first = scene.contacts[1].second = "hard";
  scene.contacts[1].restitution = 0.5;
  EXPECT_EQ(error_of(scene), "");
}

// EXACT: errors name the thing, the value and what to do.
TEST(LawsOfPairs, RefusesWhatCannotWork) {
  Scene scene = five_bodies();
  EXPECT_NE(error_of(scene).find("no [[contacts]] rule between materials 'soft' and 'soft'"), std::string::npos);
  scene.contacts = {cohesive(10, 1, 0.05, 1)};
  EXPECT_NE(error_of(scene).find("range 0.05 m must exceed strength / stiffness = 0.1 m"), std::string::npos);
  scene.contacts = {frictionless(1)};
  EXPECT_EQ(error_of(scene), "");
  scene = bare_scene();
  scene.contacts = {with_auto_stiffness(frictionless(0))};
  for (int i = 0; i < 2; ++i) add_body(scene, polygonal_disc("disc", 1, 20), BodyKind::rigid, {2.0 * i, 0});
  EXPECT_NE(error_of(scene).find("\"auto\" needs a compliant body"), std::string::npos);
}

}  // namespace
}  // namespace pliant
