#pragma once

#include <vector>

#include "bodies/model.hpp"
#include "contact/broad_phase.hpp"
#include "contact/node_displacements.hpp"

namespace pliant {

/// Where a body is.
struct BodyPlace {
  double x, y;
  double outer, inner;  ///< radii of discs about it, the one around its outline and the one within; negative: none
};

/// The pairs of bodies that may come to touch, and bounds of how far they have moved against each other since it was
/// searched where they can. The broad phase looks further than the skin: bodies that it leaves out need no watching
/// pair by pair, but all together, and so those that turn out to be further apart than their boxes. Displacements are
/// from place to place: what only vibrates goes nowhere.
class VerletList {
 public:
  /// `skin`: displacement after which a pair must be searched; `reach`: gap from which on nothing acts, m.
  VerletList(const Model& model, double skin, double reach);

  /// Whether some pair, or what the broad phase left out, may have exceeded its skin where all outlines are now: on
  /// trial, when pairs are then searched.
  bool skin_is_exceeded(const OutlineField& now);
  /// All pairs are to be searched, those that the broad phase finds.
  void forget();
  /// After skin_is_exceeded(trial), before pairs are searched with all outlines here: takes new references, and the
  /// broad phase, if it is due. Pairs have other numbers then, and true is returned.
  bool update(const OutlineField& here, const OutlineField& trial);

  int count() const { return static_cast<int>(pairs_.size()); }
  const BodyPair& operator[](int pair) const { return pairs_[pair]; }
  /// Once after each update: the pairs of which what was found may not stay. All others hold on trial.
  std::vector<int> exceeded(const OutlineField& here);
  /// Whether pairs that were searched hold on trial.
  bool hold(const std::vector<int>& pairs, const OutlineField& trial) const;
  /// Gap beyond which pairs that the broad phase just found need no watching, m.
  double margin() const { return margin_; }
  /// What a pair's bodies can touch was searched there. `gap`: between their outlines; where it is more than the
  /// margin, anything between.
  void searched(int pair, const OutlineField& now, double gap = 0);
  /// A pair that the broad phase does not find, searched just now.
  void add(const BodyPair& pair, const OutlineField& now);

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("reference", reference_);
    visitor("pairs", pairs_), visitor("excess", excess_);
    visitor("gap", gap_), visitor("watched", watched_);
    visitor("pair_ways", pair_displacements_), visitor("since_sweep", since_sweep_), visitor("swept_at", swept_at_);
  }
  void loaded();

 private:
  DisplacementsSoFar displacements(const OutlineField& now) const { return {now, reference_, motion_}; }
  int count_of_bodies() const { return static_cast<int>(motion_.size()); }
  double measure(const OutlineField& now);
  double come_out_of_place(int body, double from_mean, double drift_x, double drift_y, const OutlineField& now) const;
  double displacement_bound(int pair, const OutlineField& now) const;
  double displacement(int pair, const OutlineField& now) const;
  bool stays_within(int pair, double limit, const OutlineField& now) const;
  void reset_references(const OutlineField& here, const OutlineField& trial);
  bool discs_are_apart(const BodyPair& pair) const;
  void follow(std::vector<BodyPair> found, const OutlineField& here);

  const Model& model_;
  double skin_, own_skin_, margin_;
  OutlineField reference_;  ///< where each body was at some time; empty: all is to be searched
  // On trial:
  std::vector<DisplacementDisc> motion_;  ///< [bodies], of the outline nodes' displacements from the reference
  double come_out_ = 0;                   ///< of measure, m
  bool just_swept_ = false;               ///< the broad phase looked, in the last update
  enum Use : char { little, much, all };
  std::vector<Use> use_;  ///< [pairs], of the skin, when somebody asked last
  std::vector<BodyPair> pairs_;
  /// [pairs] by how much discs told more than nodes when both were last asked, m: what discs tell below the skin is
  /// taken to be too much by as much, so that few pairs are asked node by node.
  std::vector<double> excess_;
  std::vector<double> gap_;               ///< [pairs] when each was searched, m
  std::vector<char> watched_;             ///< [pairs] 0: far apart when the broad phase looked
  NodeDisplacements pair_displacements_;  ///< [pairs][sides], since each was searched
  /// [bodies], displacements from the reference when the broad phase looked
  std::vector<DisplacementDisc> since_sweep_;
  std::vector<BodyPlace> swept_at_;  ///< [bodies], where it saw them; of walls nothing
};

}  // namespace pliant
