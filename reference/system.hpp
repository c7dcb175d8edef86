#pragma once

#include <string>

#include "reference/bodies.hpp"
#include "reference/bonds/bonds.hpp"
#include "reference/loads.hpp"
#include "reference/materials/internal.hpp"

namespace pliant::reference {

/// Positions and velocities of all degrees of freedom at a time.
struct Motion {
  Vector q, v;
  double time = 0;
  bool moves = true;  ///< false: at rest at each time, as in statics, without any damping
  bool ends_step = false;
  Instant instant() const { return {time, ends_step}; }
};

/// All forces at one motion, as residuals: mass x acceleration + residual = 0. Mass-proportional damping is not
/// included; it is treated with the mass matrix.
struct Forces {
  Vector residual;          ///< [dofs]
  Vector magnitude;         ///< [dofs], sum of the absolute values of its terms
  Vector damping;           ///< [dofs], the part that depends on velocities
  Vector outline_velocity;  ///< [2 x outline nodes], m/s
  SparseMatrix stiffness;   ///< of the residual by positions; empty unless requested
  SparseMatrix viscosity;   ///< of the residual by velocities; empty unless requested
  bool symmetric = true;
  double strain = 0, contact = 0, boundary = 0;  ///< stored, J/m; in bonds: as in contacts
  double potential = 0;                          ///< of all forces that have one: stored energy less that of loads, J/m
  double creep_power = 0;                        ///< dissipated by Maxwell branches, W/m
  double plastic_loss = 0;                       ///< dissipated by plastic flow since the last accepted motion, J/m
  double dissipated = 0;                         ///< by contacts since the last accepted motion, J/m
  double bond_loss = 0;                          ///< by damage of bonds since the last accepted motion, J/m
  double least_jacobian = 1e300;
  int worst_body = -1;  ///< body with the least Jacobian
  double deepest = 0;   ///< penetration over the segment's length
  /// Derivative of the energy of contacts and bonds, or minus their work, by the vectors of the periods: column i by
  /// vector i, N/m.
  Eigen::Matrix2d on_periods = Eigen::Matrix2d::Zero();
  ContactResult contacts;
  BondResult bonds;
};

/// System of equations of a scene.
class System {
 public:
  explicit System(const Scene& scene);

  const Bodies& bodies() const { return bodies_; }
  const Loads& loads() const { return loads_; }
  /// Evaluates all forces, with the tangent if requested, from the history variables of the last accept().
  Forces evaluate(const Motion& motion, bool tangent);
  /// Accepts the history variables of the last motion evaluated.
  void accept();
  /// Makes the bonds whose time has come at an accepted motion. They are free of stress there.
  void make_bonds(const Motion& accepted);
  const Bonds& bonds() const { return bonds_; }
  Periods periods(double time) const { return Periods(bodies_.scene(), time); }
  /// [compliant bodies] in their order.
  const std::vector<InternalForces>& internal() const { return internal_; }

 private:
  void add_internal(const Motion& motion, bool tangent, Forces& forces, Triplets& entries);
  void add_outlines(const Motion& motion, const SparseMatrix& jacobian, bool tangent, Forces& forces,
                    Triplets& entries);
  void add_contacts(bool tangent, OutlineResidual& outlines, Vector& magnitude, Forces& forces) const;
  void add_bonds(bool tangent, OutlineResidual& outlines, Vector& magnitude, Forces& forces) const;
  void add_applied(const Motion& motion, Forces& forces) const;
  void add_dashpots(const Motion& motion, const SparseMatrix& jacobian, bool tangent, Forces& forces,
                    Triplets& rates) const;
  void add_viscosity(const Motion& motion, bool tangent, Forces& forces, Triplets& entries, Triplets& rates) const;

  Bodies bodies_;
  Loads loads_;
  std::vector<InternalForces> internal_;              ///< [compliant bodies]
  std::vector<std::vector<PointHistory>> histories_;  ///< [compliant bodies] at the last motion evaluated
  double evaluated_ = 0, accepted_ = 0;               ///< times, s
  Contacts contacts_;
  Bonds bonds_;
};

}  // namespace pliant::reference
