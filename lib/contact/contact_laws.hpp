#pragma once

#include <variant>
#include <vector>

#include "bodies/model.hpp"
#include "contact/laws/cohesive.hpp"
#include "contact/laws/frictionless.hpp"
#include "contact/laws/mohr_coulomb.hpp"

namespace pliant {

using ContactLaw = std::variant<Frictionless, MohrCoulomb, Cohesive>;

/// The law of every pair of bodies, resolved once a scene. Bodies of equal material, outline and kind form a class.
struct ContactLaws {
  std::vector<int> body_class;  ///< [bodies]
  int classes = 0;
  std::vector<int> pair_law;  ///< [classes x classes], index in `laws`
  std::vector<ContactLaw> laws;
  double max_reach = 0;  ///< m

  int between(int first, int second) const { return pair_law[body_class[first] * classes + body_class[second]]; }
};

inline double reach_of(const ContactLaw& law) {
  return std::visit([](const auto& l) { return l.reach; }, law);
}
inline double stiffness_of(const ContactLaw& law) {
  return std::visit(
      [](const auto& l) { return l.has_shear ? std::max(l.normal_stiffness, l.shear_stiffness) : l.normal_stiffness; },
      law);
}

/// Stiffness `auto`: kn = kt = 8 E/h, E of the softer compliant body, h the finer outline spacing; pairs of rigid bodies get three
/// times the scene's largest; g_max `auto`: 0.12 h. Throws InputError for a missing rule or value.
ContactLaws make_contact_laws(const Model& model);

}  // namespace pliant
