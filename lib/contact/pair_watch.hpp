#pragma once

#include <limits>
#include <vector>

#include "bodies/model.hpp"
#include "contact/broad_phase.hpp"

namespace pliant {

/// The pairs of bodies that may come to touch, and bounds of how far they have moved against each other since it was
/// searched where they can. The broad phase looks further than the skin: bodies that it leaves out need no watching
/// pair by pair, but each its own way.
class PairWatch {
 public:
  /// `skin`: way after which a pair must be searched; `reach`: gap from which on nothing acts, m.
  PairWatch(const Model& model, double skin, double reach);

  /// Whether some pair, or what the broad phase left out, may have used up its skin on the way from one place of all
  /// outlines, where ways were added up, to another.
  bool is_used_up(const OutlineField& from, const OutlineField& to);
  /// Adds up the ways from one place of all outlines to another.
  void add_up(const OutlineField& from, const OutlineField& to);
  /// All pairs are to be searched, those that the broad phase finds.
  void forget();
  /// The broad phase, if it is due, and whether it was: pairs have other numbers then.
  bool update(const std::vector<Box>& boxes);

  int count() const { return static_cast<int>(pairs_.size()); }
  const BodyPair& operator[](int pair) const { return pairs_[pair]; }
  /// Whether what was found of a pair may stay.
  bool may_keep(int pair) const;
  /// What a pair's bodies can touch was searched at the place up to which ways are added up.
  void searched(int pair) { pair_moved_[pair] = 0; }
  /// A pair that the broad phase does not find, searched just now.
  void add(const BodyPair& pair) { pairs_.push_back(pair), pair_moved_.push_back(0); }

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("pairs", pairs_);
    visitor("pair_moved", pair_moved_);
    visitor("body_moved", body_moved_);
  }

 private:
  void measure(const OutlineField& from, const OutlineField& to);
  Vec2 common_motion() const;
  double pair_motion(int pair) const;
  double own_motion(int body, const Vec2& common) const;

  static constexpr double unknown = std::numeric_limits<double>::infinity();
  const Model& model_;
  double skin_, own_skin_, margin_;
  std::vector<BodyPair> pairs_;
  std::vector<double> pair_moved_;  ///< [pairs] since they were searched, m
  std::vector<double> body_moved_;  ///< [bodies] against all others since the broad phase, m
  std::vector<Box> motion_;         ///< [bodies], box of the outline nodes' ways, of measure
};

}  // namespace pliant
