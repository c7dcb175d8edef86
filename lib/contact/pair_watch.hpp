#pragma once

#include <array>
#include <vector>

#include "bodies/model.hpp"
#include "contact/broad_phase.hpp"

namespace pliant {

/// The pairs of bodies that may come to touch, and bounds of how far they have moved against each other since it was
/// searched where they can. The broad phase looks further than the skin: bodies that it leaves out need no watching
/// pair by pair, but each its own way. Ways are from place to place: what only vibrates goes nowhere.
class PairWatch {
 public:
  /// `skin`: way after which a pair must be searched; `reach`: gap from which on nothing acts, m.
  PairWatch(const Model& model, double skin, double reach);

  /// Whether some pair, or what the broad phase left out, may have used up its skin where all outlines are now.
  bool is_used_up(const OutlineField& now);
  /// All pairs are to be searched, those that the broad phase finds.
  void forget();
  /// Which pairs are to be searched with all outlines here, and the broad phase, if it is due: pairs have other numbers
  /// then, and true is returned.
  bool update(const OutlineField& now);

  int count() const { return static_cast<int>(pairs_.size()); }
  const BodyPair& operator[](int pair) const { return pairs_[pair]; }
  /// The pairs of which what was found may not stay, where the last update was.
  std::vector<int> used_up(const OutlineField& now) const;
  /// What a pair's bodies can touch was searched there.
  void searched(int pair, const OutlineField& now);
  /// A pair that the broad phase does not find, searched just now.
  void add(const BodyPair& pair, const OutlineField& now);

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("reference", reference_);
    visitor("pairs", pairs_), visitor("pair_start", pair_start_);
    visitor("body_start", body_start_);
    visitor("ways_x", ways_x_), visitor("ways_y", ways_y_);
  }
  void loaded() { lay_out(0); }

 private:
  void measure(const OutlineField& now);
  Box common_way() const;
  double pair_way(int pair) const;
  bool stays_within(int pair, double limit, const OutlineField& now) const;
  double own_way(int body, const Box& common) const;
  void take_new_references(const OutlineField& now);
  void follow(std::vector<BodyPair> found);
  void lay_out(std::size_t first);
  int body(int pair, int side) const { return side == 0 ? pairs_[pair].first : pairs_[pair].second; }
  bool keeps_ways(int pair, int side) const;
  Box way_of_side(int pair, int side, const OutlineField& now) const;
  void shift(int pair, int side, const OutlineField& now);

  const Model& model_;
  double skin_, own_skin_, margin_;
  OutlineField reference_;   ///< where each body was at some time; empty: all is to be searched
  std::vector<Box> motion_;  ///< [bodies], box of the outline nodes' ways from there, of measure
  std::vector<BodyPair> pairs_;
  std::vector<std::array<Box, 2>> pair_start_;  ///< [pairs], motions of the two when it was searched
  /// The same node by node, of small bodies: from their references, m. Boxes alone would blur what bodies that shake or
  /// turn have moved since.
  std::vector<float> ways_x_, ways_y_;
  std::vector<std::array<int, 2>> ways_at_;  ///< [pairs], of the first nodes
  std::vector<Box> body_start_;              ///< [bodies], motions when the broad phase looked last
};

}  // namespace pliant
