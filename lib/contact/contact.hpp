#pragma once

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "bodies/model.hpp"
#include "bodies/outline.hpp"
#include "contact/contact_laws.hpp"
#include "contact/history.hpp"
#include "contact/pair_watch.hpp"
#include "contact/patch.hpp"

namespace pliant {

/// What a fixed refresh period counts.
struct RunClock {
  double time = 0;         ///< of the positions, s
  std::int64_t steps = 0;  ///< accepted so far
};

/// Contact between the outlines of all bodies: keeps the patches, refreshes them when some pair may have used up its
/// skin, and computes the forces on outline nodes. The history belongs to the caller's state.
///
/// Of a body in motion it knows only its stretch of the outlines, which show_outlines fills, and gives back only its
/// stretch of the forces on them, which the bodies gather afterwards. Between the two is the seam where a body's
/// outline may come from elsewhere, as from another process: fill its stretch before candidates_hold, fetch its stretch
/// after forces().
class ContactSystem {
 public:
  explicit ContactSystem(const Model& model);

  /// False when some close pair may have moved by the skin since the candidates were found, or always before the first
  /// time. With a fixed period: when it is over; contacts that come earlier are missed. Also when laws change: see
  /// ContactLaws::era.
  bool candidates_hold(const OutlineField& position, const RunClock& clock = {});
  /// Rebuilds the patches and carries the history, that of these outlines, over to them; newcomers get their places.
  /// Throws InputError when a body that may touch itself does so at the start.
  void find_candidates(const Outlines& outlines, ContactHistory& history, const RunClock& clock = {});
  /// The same, but patches of pairs that have used up less than half of their skin stay as they are.
  void renew_candidates(const Outlines& outlines, ContactHistory& history, const RunClock& clock = {});

  /// Contact forces on outline nodes, N/m, from one history into another.
  PatchTotals forces(const Outlines& outlines, const ContactHistory& from, ContactHistory& to, OutlineField& force);

  /// [outline nodes] upper bound of the contact stiffness that each node may feel until the candidates are found anew,
  /// N/m2, seen from where they were found; weighted so that the bound of a pair is that of its two bodies taken alone
  /// (docs/method.md 6). `compliance` [bodies]: largest w^2 a body shows per unit contact stiffness.
  std::vector<double> stiffness_bound(const std::vector<double>& compliance) const;

  /// [bodies] upper bound of the damping ratio over all contacts until the next refresh, in terms of the bound of
  /// stiffness; 0: no dashpot.
  std::vector<double> damping_ratios() const;

  /// [outline nodes] least of what laws remember by this name over each node's contacts; `none` where no law does.
  std::vector<double> least_remembered(const ContactHistory& history, std::string_view name, double none) const;

  const ContactLaws& laws() const { return laws_; }
  const std::vector<Patch>& patches() const { return patches_; }
  long refreshes() const { return refreshes_; }
  long pairs_searched() const { return pairs_searched_; }  ///< over all refreshes, those of the broad phase alone not
  double skin() const { return skin_; }

  /// What a refresh leaves behind; the layout follows from the patches.
  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("watch", watch_);
    visitor("patches", patches_);
    visitor("found_at", found_at_);
    visitor("fresh", fresh_);
    visitor("warned", warned_);
    visitor("refreshed", refreshed_);
    visitor("refreshes", refreshes_);
    visitor("pairs_searched", pairs_searched_);
  }
  void loaded() {
    for (Patch& patch : patches_) patch.law = laws_.between(patch.first, patch.second, refreshed_.time);
    lay_out_patches();
  }

 private:
  struct ArcForce {
    int begin, count, force;  ///< outline node of the first entry (not reduced), entries, place in the buffers
  };

  void take_over_patches(const Outlines& outlines, ContactHistory& history, const RunClock& clock);
  bool period_is_over(const RunClock& clock) const;
  void warn_of_missed_contacts(const OutlineField& position);
  std::vector<char> find_patches(const std::vector<Box>& boxes, const std::vector<Patch>& old);
  void add_self_patches();
  void refuse_self_overlap() const;
  void lay_out_patches();
  bool has_corners(int body) const { return model_.outlines[model_.bodies[body].outline].has_corners(); }
  void prefetch(const Patch& patch, const OutlineField& position) const;
  void carry_history(const std::vector<Patch>& old, ContactHistory& history) const;
  /// Calls add(node, entry, count) for runs of consecutive nodes with their entries in the force buffers: all of a
  /// body's arcs, in a fixed order.
  template <class Add>
  void for_each_run(int body, int nodes, Add&& add) const {
    for (const ArcForce& arc : body_arcs_[body])
      for (int done = 0; done < arc.count;) {
        const int at = arc.begin + done, node = at - turn_of(at, nodes) * nodes;
        const int count = std::min(arc.count - done, nodes - node);
        add(node, arc.force + done, count);
        done += count;
      }
  }

  const Model& model_;
  ContactLaws laws_;
  double skin_;
  PairWatch watch_;
  std::vector<Patch> patches_;                    ///< in the order of their pairs
  std::vector<std::vector<ArcForce>> body_arcs_;  ///< [bodies], in the order of the patches
  int records_ = 0;
  PatchForces forces_;
  std::vector<PatchTotals> totals_;  ///< [patches]
  Outlines found_at_;                ///< where some candidates were found last
  bool fresh_ = false, warned_ = false;
  RunClock refreshed_;  ///< when the candidates were found
  long refreshes_ = 0, pairs_searched_ = 0;
};

}  // namespace pliant
