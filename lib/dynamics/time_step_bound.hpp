#pragma once

#include <string>
#include <vector>

#include "bodies/dofs.hpp"
#include "bonds/bond_system.hpp"
#include "contact/contact.hpp"
#include "contact/stiffness_bound.hpp"
#include "dynamics/state.hpp"

namespace pliant {

/// Stability bound of velocity Verlet, dt <= safety x 2/w (sqrt(1 + 4 z^2) - 2 z), body by body (docs/method.md 6):
/// w^2 = 1.05 w_b^2 + w_c^2 plus that of soft supports; z = c/(2 w), c the rate of dashpots and viscosity.
class TimeStepBound {
 public:
  TimeStepBound(const Model& model, const LawTable& laws);

  /// Two more power iterations on the internal forces of every compliant body.
  void update_internal(const Dofs& position, const Memory& memory, int iterations = 2);
  /// Updates the a-priori bound of contacts and bonds with the candidates and bonds found since the last call.
  void update_contact(const ContactSystem& contact, const BondSystem& bonds);

  /// Largest step, s, with the safety factor; infinite without stiffness. `contact_factor`: factor on the stiffness of
  /// all contacts.
  double largest_dt() const { return limit_.dt; }
  double largest_dt(double contact_factor) const { return limit(contact_factor).dt; }
  /// Name of the limiting body and share of contact in its w^2, for messages.
  std::string governing() const;

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("direction", direction_);
    visitor("internal", internal_);
    visitor("contact", contact_);
    visitor("stiffness", stiffness_);
    visitor("bonds_seen", bonds_seen_);
    visitor("viscous_direction", viscous_direction_);
    visitor("viscous", viscous_);
  }
  void loaded() { limit_ = limit(1); }

 private:
  struct Limit {
    std::size_t body;  ///< limiting body
    double dt;         ///< s
  };

  void bound_conditions();
  void iterate_viscous(int b, const Lanes* position, int iterations);
  void iterate_batch(int b, BatchMotion motion, int iterations);
  Limit limit(double contact_factor) const;
  double total(std::size_t body, double contact_factor) const;
  double damping(std::size_t body) const;
  double largest_dt_of(std::size_t body, double contact_factor) const;

  const Model& model_;
  StiffnessBound stiffness_;
  long bonds_seen_ = 0;                ///< version of the bonds that are counted
  std::vector<Lanes> direction_;       ///< power iteration vectors, as Dofs::compliant, each in its body's frame
  std::vector<Lanes> internal_;        ///< [batches] w_b^2, 1/s2
  std::vector<double> contact_;        ///< [bodies] w_c^2 of contacts and bonds, 1/s2
  std::vector<double> contact_floor_;  ///< [bodies] w_c^2 of one partner all around: possible before the next rebuild
  std::vector<double> compliance_;     ///< [bodies] w^2 per unit contact stiffness
  std::vector<double> support_;        ///< [bodies] w^2 of soft supports, 1/s2
  std::vector<double> damping_;        ///< [bodies] largest rate of supports' dashpots, 1/s
  std::vector<double> shortened_;      ///< [bodies] factor by which restitution shortens steps of contact; empty: none
  std::vector<double> limit_square_;   ///< [bodies] largest stable w^2 dt^2 without dashpots
  std::vector<Lanes> viscous_direction_, viscous_;  ///< as direction_ and internal_, for Kelvin-Voigt: rates, 1/s
  Limit limit_;  ///< from all of the above, updated when they change: each step needs it
};

}  // namespace pliant
