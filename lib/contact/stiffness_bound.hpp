#pragma once

#include <cstdint>
#include <vector>

#include "contact/contact.hpp"

namespace pliant {

/// A-priori bound of the contact stiffness that outline nodes may feel until their contact pairs are searched again,
/// weighted so that the bound of a pair is that of its two bodies taken alone (docs/method.md 6). Patches that stay as
/// they are keep their part, wherever it lies.
class StiffnessBound {
 public:
  explicit StiffnessBound(const Model& model) : model_(model) {}

  /// Looks at all contact pairs found since the last time. `compliance` [bodies]: largest w^2 a body shows per unit
  /// contact stiffness. Returns the bodies whose bound may have changed, in their order.
  std::vector<int> update(const ContactSystem& contact, const std::vector<double>& compliance);
  /// [outline nodes of the body] N/m2.
  std::vector<double> of_body(const ContactSystem& contact, int body) const;
  /// Adds it to every `stride`-th number.
  void add_of_body(const ContactSystem& contact, int body, double* to, int stride) const;

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("entries", entries_), visitor("weighed", weighed_);
    visitor("layout", layout_);
    visitor("seen", seen_);
  }

 private:
  void follow_layout(const PairTable& table);

  const Model& model_;
  std::vector<double> entries_;       ///< as the buffers of forces, N/m2
  std::vector<ContactPair> weighed_;  ///< as they stand in the entries
  std::int64_t layout_ = -1;          ///< of the entries: PairTable::laid_out
  std::int64_t seen_ = -1;            ///< refresh up to which contact pairs were looked at
};

}  // namespace pliant
