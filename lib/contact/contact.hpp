#pragma once

#include <vector>

#include "bodies/model.hpp"
#include "bodies/outline.hpp"
#include "contact/broad_phase.hpp"
#include "contact/contact_laws.hpp"
#include "contact/patch_forces.hpp"

namespace pliant {

/// Contact between the outlines of all bodies: keeps the patches, refreshes them when some pair may have used up its skin, and computes the
/// forces on outline nodes. The history belongs to the caller's state.
class ContactSystem {
 public:
  explicit ContactSystem(const Model& model);

  /// True when some close pair may have moved by the skin since the last refresh, or always before the first.
  bool refresh_needed(const Outlines& outlines);
  /// Rebuilds the patches and carries the history, that of the outlines' positions, over to them; newcomers get their places.
  void refresh(Outlines& outlines, ContactHistory& history);

  /// Contact forces into outlines.force_x, force_y; the new history goes to `trial`.
  PatchTotals forces(Outlines& outlines, const ContactHistory& committed, ContactHistory& trial);

  /// [outline nodes] upper bound of the contact stiffness that each node may feel until the next refresh, N/m2; weighted so that the bound of a
  /// pair is that of its two bodies taken alone (METHOD 6). `compliance` [bodies]: largest w^2 a body shows per unit contact stiffness.
  std::vector<double> stiffness_bound(Outlines& outlines, const std::vector<double>& compliance);

  const ContactLaws& laws() const { return laws_; }
  const std::vector<Patch>& patches() const { return patches_; }
  long refreshes() const { return refreshes_; }
  double skin() const { return skin_; }

 private:
  struct ArcForce {
    int begin, count, force;  ///< outline node of the first entry (not reduced), entries, place in the buffers
  };

  void find_patches(const Outlines& outlines, const std::vector<Box>& boxes);
  void lay_out_patches();
  void carry_history(const std::vector<Patch>& old, ContactHistory& history) const;
  template <class Add>
  void for_each_force(int body, int nodes, Add&& add) const;

  const Model& model_;
  ContactLaws laws_;
  double skin_ = 0, broad_margin_ = 0;
  std::vector<BodyPair> pairs_;  ///< of the broad phase
  std::vector<Patch> patches_;
  std::vector<std::vector<ArcForce>> body_arcs_;  ///< [bodies], in the order of the patches
  int records_ = 0;
  PatchForces forces_;
  std::vector<PatchTotals> totals_;  ///< [patches]
  std::vector<Box> motion_;          ///< [bodies], box of the outline nodes' displacements since the refresh
  bool fresh_ = false;
  long refreshes_ = 0;
};

}  // namespace pliant
