#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "bodies/model.hpp"
#include "bodies/outline_fields.hpp"
#include "contact/contact_pair.hpp"
#include "contact/energy_correction.hpp"
#include "contact/history.hpp"
#include "contact/law_table.hpp"
#include "contact/pair_table.hpp"
#include "contact/verlet_list.hpp"

namespace pliant {

/// Time and number of steps that measure a fixed rebuild interval.
struct RunClock {
  double time = 0;         ///< time of the positions, s
  std::int64_t steps = 0;  ///< steps accepted so far
};

/// State at the start of a step.
struct StepStart {
  const OutlineField& position;      ///< of the outlines, with their cyclic copies
  double dt;                         ///< size of the step, s
  const RigidStep* rigid = nullptr;  ///< [rigid bodies]; null without energy correction
};

/// Contact between the outlines of all bodies: stores the contact pairs, rebuilds those that may have exceeded their
/// skin, and computes the forces on outline nodes. The history belongs to the caller's state.
///
/// A moving body enters only through its range of the outlines, which update_outlines fills. Its forces return in the
/// same range of the outline forces, which the body gathers afterwards. At this interface an outline may come from
/// elsewhere, for example from another process: fill its range before candidates_hold and read its range after
/// forces().
class ContactSystem {
 public:
  explicit ContactSystem(const Model& model);

  /// Returns false if some close pair may have moved by the skin since its candidates were found, and always before the
  /// first search. With a fixed rebuild interval it returns false when the interval is over; contacts that come earlier
  /// are missed. It also returns false when laws change: see LawTable::law_interval.
  bool candidates_hold(const OutlineField& position, const RunClock& clock = {});
  /// With a fixed rebuild interval: warns once if contacts may be missed at these positions.
  void warn_of_missed_contacts(const OutlineField& position);
  /// Rebuilds all contact pairs and transfers the history, which must belong to these outlines. New contacts get their
  /// surface coordinates. Throws InputError if a body with self-contact overlaps itself at the start.
  void find_candidates(const Outlines& outlines, ContactHistory& history, const RunClock& clock = {});
  /// Partial rebuild: keeps contact pairs that have used less than three fourths of their skin. `trial`: positions of
  /// the last candidates_hold. Returns whether all candidates are valid for the trial; without one, for `outlines`.
  bool renew_candidates(const Outlines& outlines, ContactHistory& history, const RunClock& clock = {},
                        const OutlineField* trial = nullptr);

  /// Contact state that another run of the same bodies may inherit; `history` is that of the present state.
  InheritedContact leave(const ContactHistory& history) const;
  /// Call before the first search. Transfers surface coordinates, slip and internal variables, except for pairs whose
  /// law was of another kind: those begin as in any run. Throws ArchiveError for contacts of other bodies.
  void inherit(const InheritedContact& from, ContactHistory& history);

  /// Contact forces on outline nodes, N/m; reads the history `from` and writes `to`. `step`: the step from the state of
  /// `from` to here, from which the energy correction follows. Without it, as at the start, no time has passed.
  PairTotals forces(const Outlines& outlines, const ContactHistory& from, ContactHistory& to, OutlineField& force,
                    const StepStart* step = nullptr);

  /// [bodies] upper bound of the damping ratio over all contacts until the next rebuild, relative to the bound of
  /// stiffness; 0: no dashpot.
  std::vector<double> damping_ratios() const;

  /// [contact pairs] sums of the last evaluation, which wrote the history `of`.
  const std::vector<PairTotals>& totals(const ContactHistory& of) const {
    return corrects_energy() ? of.last.totals : unkept_.totals;
  }

  const LawTable& laws() const { return laws_; }
  /// All pairs of the Verlet list; some have no candidates.
  const std::vector<ContactPair>& contact_pairs() const { return table_.contact_pairs(); }
  const PairTable& table() const { return table_; }
  /// View of a contact pair at the outlines of its last search.
  PairView view(const ContactPair& contact_pair) const;
  /// Indices in the table of the contact pairs that the last rebuild searched.
  const std::vector<int>& found() const { return found_; }
  long refreshes() const { return refreshes_; }
  long pairs_searched() const { return pairs_searched_; }  ///< narrow-phase searches, all rebuilds
  double skin() const { return skin_; }

  /// State after a rebuild; sizes of buffers follow from the contact pairs.
  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("watch", verlet_list_);
    visitor("table", table_);
    visitor("found_at", found_at_);
    visitor("fresh", fresh_);
    visitor("warned", warned_);
    visitor("refreshed", refreshed_);
    visitor("refreshes", refreshes_);
    visitor("pairs_searched", pairs_searched_);
  }
  void loaded() {
    table_.set_laws([&](const ContactPair& p) { return laws_.between(p.first, p.second, refreshed_.time); });
    if (!corrects_energy()) make_room(unkept_);
  }

 private:
  bool rebuild_list(const Outlines& outlines, const OutlineField& trial, ContactHistory& history,
                    const RunClock& clock);
  void remember(const Outlines& outlines, const std::vector<int>& pairs);
  bool period_is_over(const RunClock& clock) const;
  std::vector<ContactPair> search(const std::vector<int>& pairs, std::vector<ContactPair> found);
  std::vector<ContactPair> found_or_kept(std::vector<ContactPair> found);
  void lay_out_anew(std::vector<ContactPair> found, ContactHistory& history);
  void carry_step(const std::vector<ContactPair>& old, StepForces& last) const;
  void make_room(StepForces& evaluated) const;
  bool integrates(int first, int second) const;
  bool corrects_energy() const { return largest_correction_ > 0 && model_.scene.corrects_energy(); }
  PairTotals corrected_forces(const PairView& view, int contact_pair, const StepStart* step, const ContactHistory& from,
                              ContactHistory& to) const;
  Lattice forces_on_images(const PairForceBuffer& forces) const;
  void add_self_pairs(std::vector<ContactPair>& all);
  void refuse_self_overlap() const;
  bool has_corners(int body) const { return model_.outlines[model_.bodies[body].outline].has_corners(); }
  void prefetch(const ContactPair& contact_pair, const OutlineField& position, const StepStart* step,
                const ContactHistory& from, const ContactHistory& to, const PairForceBuffer& forces) const;

  const Model& model_;
  LawTable laws_;
  double skin_;
  bool may_integrate_;
  VerletList verlet_list_;
  PairTable table_;                       ///< ordered as the Verlet list, unless there is self-contact
  double largest_correction_;             ///< limit of the energy correction, see energy_correction.hpp
  StepForces unkept_;                     ///< scratch, without energy correction
  StepForces before_;                     ///< scratch: the last step before a layout
  std::vector<ContactPair> spare_pairs_;  ///< memory for those of the next layout
  std::vector<PairTotals> block_totals_;  ///< scratch
  Outlines found_at_;                     ///< [bodies] outlines at the last search of a pair with the body
  std::vector<int> found_;                ///< see found()
  bool fresh_ = false, warned_ = false;
  RunClock refreshed_;  ///< of the last rebuild
  long refreshes_ = 0, pairs_searched_ = 0;
  bool starts_from_a_state_ = false;  ///< that of another run
};

}  // namespace pliant
