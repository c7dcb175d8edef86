#pragma once

#include <memory>
#include <vector>

#include "reference/bonds/bond.hpp"

namespace pliant::reference {

/// One bond at one state: forces on the two nodes of its segment, and on the two nodes beside either point of the
/// master.
struct BondElement {
  std::array<int, 6> node;                ///< in the list of all outline nodes; one may occur more than once
  Eigen::Matrix<double, 12, 1> force;     ///< residual: minus the forces on the nodes, N/m
  Eigen::Matrix<double, 12, 12> tangent;  ///< of `force`, unsymmetric where damage grows
  ContactLever lever;                     ///< of the master
};

struct BondResult {
  std::vector<BondElement> elements;
  double stored = 0;      ///< J/m
  double dissipated = 0;  ///< by damage since the last accepted state, J/m
  bool damages = false;   ///< damage has grown since then: forces have no potential
};

/// Adds the forces of bonds to those of all outline nodes, N/m.
void add_forces(const BondResult& result, Points& forces);

/// Numbers of bonds by their state. A bond softens until both of its ends are torn.
struct BondCounts {
  int whole = 0, softening = 0, torn = 0;
};

/// All bonds of a scene (docs/method.md 11).
///
/// Forces are the derivative of the energy (67) at given damage. Damage is that of the trial state, and the tangent
/// contains its derivative. Damage in a mixed mode depends on two criteria and not on the energy alone. So a step has
/// no potential, and the tangent is unsymmetric where damage grows. This is how flow of Drucker and Prager is treated.
/// Damage is accepted with the step, like other history.
class Bonds {
 public:
  /// Throws InputError for what this solver does not have: strengths that vary.
  Bonds(const Scene& scene, std::vector<ContactOutline> outlines);
  ~Bonds();

  /// Makes the bonds of all rules whose time has come, at accepted positions x [all outline nodes], m. Throws
  /// InputError for a rule of the start that finds nothing to bond, for a fracture energy that is too small, and for a
  /// stiffness that neither the rule nor contact gives.
  void make(const Points& x, const Periods& periods, double time);
  /// Evaluates bonds at outline positions. Trial histories are kept beside the accepted ones.
  BondResult evaluate(const Points& x, const Periods& periods);
  /// Accepts the trial histories of the last evaluation.
  void accept();

  const std::vector<Bond>& all() const;
  double damage(std::size_t bond, std::size_t end) const;  ///< accepted
  BondCounts counts() const;                               ///< accepted
  /// When rules make bonds after the start, s.
  std::vector<double> times() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace pliant::reference
