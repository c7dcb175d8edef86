#pragma once

#include <cstdint>
#include <vector>

#include "contact/contact.hpp"

namespace pliant {

/// A-priori bound of the contact stiffness of outline nodes until the next search of their contact pairs. It is
/// weighted so that the bound of a pair is that of its two bodies taken alone (docs/method.md 6). Pairs that are not
/// searched again keep their contribution, even if they move in memory.
class StiffnessBound {
 public:
  explicit StiffnessBound(const Model& model) : model_(model) {}

  /// Counts all contact pairs found since the last call. `compliance` [bodies]: largest w^2 of a body per unit contact
  /// stiffness. Returns the own bodies whose bound may have changed, in ascending order.
  std::vector<int> update(const ContactSystem& contact, const std::vector<double>& compliance);
  /// [outline nodes of the body] stiffness bound, N/m2.
  std::vector<double> of_body(const ContactSystem& contact, int body) const;
  /// Adds the bound to every `stride`-th number.
  void add_of_body(const ContactSystem& contact, int body, double* to, int stride) const;

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("entries", entries_), visitor("weighed", weighed_);
    visitor("layout", layout_);
    visitor("seen", seen_);
  }

 private:
  void follow_layout(const PairTable& table);
  void add_up_on_walls(const PairTable& table, long rebuild);
  /// Whether other processes compute some pairs of an own body.
  bool has_partners_elsewhere(int body) const { return model_.halo && model_.bodies[body].wall; }

  const Model& model_;
  LinedNumbers entries_;              ///< in the order of the force buffers, N/m2
  LinedNumbers spare_;                ///< memory for those of the next layout
  std::vector<ContactPair> weighed_;  ///< as counted in the entries
  std::vector<double> on_walls_;      ///< [outline nodes] on walls, pairs of all processes, N/m2; empty without a halo
  std::int64_t layout_ = -1;          ///< PairTable::laid_out of the entries
  std::int64_t seen_ = -1;            ///< last rebuild whose contact pairs are counted
};

}  // namespace pliant
