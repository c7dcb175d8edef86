#pragma once

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "bodies/model.hpp"
#include "bodies/outline.hpp"
#include "contact/contact_laws.hpp"
#include "contact/contact_pair.hpp"
#include "contact/energy_debt.hpp"
#include "contact/history.hpp"
#include "contact/inherited.hpp"
#include "contact/pair_table.hpp"
#include "contact/verlet_list.hpp"

namespace pliant {

/// What a fixed refresh period counts.
struct RunClock {
  double time = 0;         ///< of the positions, s
  std::int64_t steps = 0;  ///< accepted so far
};

/// Where a step began.
struct StepStart {
  const OutlineField& position;      ///< of outlines, with their copies
  double elapsed;                    ///< since then, s
  const RigidStep* rigid = nullptr;  ///< [rigid bodies]; null where no debts are kept
};

/// What an evaluation leaves behind.
struct Evaluated {
  PairForceBuffer forces;
  std::vector<PairTotals> totals;  ///< [contact pairs]
  std::int64_t number = 0;         ///< ContactHistory::evaluation; 0: of no step
  long refreshes = 0;              ///< before it
  double elapsed = 0;              ///< in the step that led to it, s

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("forces", forces), visitor("totals", totals);
    visitor("number", number), visitor("refreshes", refreshes), visitor("elapsed", elapsed);
  }
};

/// Contact between the outlines of all bodies: keeps the contact pairs, refreshes them when some pair may have exceeded
/// its skin, and computes the forces on outline nodes. The history belongs to the caller's state.
///
/// Of a body in motion it knows only its stretch of the outlines, which update_outlines fills, and gives back only its
/// stretch of the forces on them, which the bodies gather afterwards. Between the two is the seam where a body's
/// outline may come from elsewhere, as from another process: fill its stretch before candidates_hold, fetch its stretch
/// after forces().
class ContactSystem {
 public:
  explicit ContactSystem(const Model& model);

  /// False when some close pair may have moved by the skin since the candidates were found, or always before the first
  /// time. With a fixed period: when it is over; contacts that come earlier are missed. Also when laws change: see
  /// ContactLaws::law_interval.
  bool candidates_hold(const OutlineField& position, const RunClock& clock = {});
  /// Rebuilds the contact pairs and carries the history, that of these outlines, over to them; new contacts get their
  /// places. Throws InputError when a body that may touch itself does so at the start.
  void find_candidates(const Outlines& outlines, ContactHistory& history, const RunClock& clock = {});
  /// The same, but contact pairs that have used less than three fourths of their skin stay as they are. Returns
  /// whether all hold on trial, where they were last asked whether they do; without one, where they are.
  bool renew_candidates(const Outlines& outlines, ContactHistory& history, const RunClock& clock = {},
                        const OutlineField* trial = nullptr);

  /// What another run of the same bodies may inherit; `history` is that of the state now.
  InheritedContact leave(const ContactHistory& history) const;
  /// Before the first search: it carries places, slip and what laws remember over, but of pairs whose law was of
  /// another kind. Those begin as in any run. Throws ArchiveError for contacts of other bodies.
  void inherit(const InheritedContact& from, ContactHistory& history);

  /// Contact forces on outline nodes, N/m, from one history into another. `step`: what led here from where the history
  /// was, so that contacts may repay what they owe. Without it, as at the start, all stands still.
  PairTotals forces(const Outlines& outlines, const ContactHistory& from, ContactHistory& to, OutlineField& force,
                    const StepStart* step = nullptr);

  /// A trial whose history is that of the state now was accepted.
  void accept(const ContactHistory& history);

  /// [bodies] upper bound of the damping ratio over all contacts until the next refresh, in terms of the bound of
  /// stiffness; 0: no dashpot.
  std::vector<double> damping_ratios() const;

  /// [outline nodes] least of what laws remember by this name over each node's contacts; `none` where no law does.
  std::vector<double> least_internal_variable(const ContactHistory& history, std::string_view name, double none) const;

  const ContactLaws& laws() const { return laws_; }
  /// Of all pairs that are watched: some are empty.
  const std::vector<ContactPair>& contact_pairs() const { return table_.contact_pairs(); }
  const PairTable& table() const { return table_; }
  /// A contact pair that was found last, where it was.
  PairView view(const ContactPair& contact_pair) const;
  /// Places in the table of the contact pairs that were found at the last refresh.
  const std::vector<int>& found() const { return found_; }
  /// Whether contact of some pairs is integrated over segments.
  bool may_integrate() const { return may_integrate_; }
  long refreshes() const { return refreshes_; }
  long pairs_searched() const { return pairs_searched_; }  ///< over all refreshes, those of the broad phase alone not
  double skin() const { return skin_; }

  /// What a refresh leaves behind; the layout follows from the contact pairs.
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
    if (!keeps_debts()) return;
    visitor("last", last_);
  }
  void loaded() {
    table_.set_laws([&](const ContactPair& p) { return laws_.between(p.first, p.second, refreshed_.time); });
    make_room(keeps_debts() ? trial_ : last_);
  }

 private:
  bool take_over_pairs(const Outlines& outlines, const OutlineField& trial, ContactHistory& history,
                       const RunClock& clock);
  void remember(const Outlines& outlines, const std::vector<int>& pairs);
  bool period_is_over(const RunClock& clock) const;
  void warn_of_missed_contacts(const OutlineField& position);
  std::vector<ContactPair> search(const std::vector<int>& pairs);
  void lay_out_anew(const std::vector<ContactPair>& found, ContactHistory& history);
  void make_room(Evaluated& evaluated) const;
  bool integrates(int first, int second, const ContactLaw& law) const;
  const OutlineField* find_displacements(const OutlineField& now, const OutlineField& before);
  bool keeps_debts() const { return model_.scene.keeps_energy_debts(); }
  PairTotals settle(const PairView& view, int contact_pair, const StepStart* step, const ContactHistory& from,
                    ContactHistory& to, PairForceBuffer& forces);
  void add_self_pairs(std::vector<ContactPair>& all);
  void refuse_self_overlap() const;
  bool starts_from_a_state() const { return laws_before_.count > 0; }
  bool keeps_law(const ContactPair& contact_pair) const;  ///< of the state that it starts from; false: there is none
  bool has_corners(int body) const { return model_.outlines[model_.bodies[body].outline].has_corners(); }
  void prefetch(const ContactPair& contact_pair, const OutlineField& position, const StepStart* step,
                const ContactHistory& from, const ContactHistory& to, const PairForceBuffer& forces) const;

  const Model& model_;
  ContactLaws laws_;
  double skin_;
  bool may_integrate_;
  VerletList verlet_list_;
  PairTable table_;         ///< in the order of the pairs, unless bodies touch themselves
  double most_repaid_;      ///< see energy_debt.hpp
  Evaluated last_, trial_;  ///< what accepted steps left behind and, where debts are kept, what is not accepted
  std::vector<PairTotals> block_totals_;  ///< scratch
  OutlineField moved_;                    ///< scratch, in a step, m
  Outlines found_at_;                     ///< of each body, where some candidates of its were found last
  std::vector<int> found_;                ///< see found()
  bool fresh_ = false, warned_ = false;
  RunClock refreshed_;  ///< when the candidates were found
  long refreshes_ = 0, pairs_searched_ = 0;
  PairLaws laws_before_;  ///< of the run whose state it starts from
};

}  // namespace pliant
