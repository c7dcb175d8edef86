#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bodies/model.hpp"
#include "contact/broad_phase.hpp"
#include "contact/node_displacements.hpp"

namespace pliant {

/// Position and extent of a body.
struct BodyPlace {
  double x, y;
  double outer, inner;  ///< radii of discs about it, around the outline and inside it; negative: none
};

/// Pairs of bodies that may come into contact, with bounds of the relative displacement since each was searched. The
/// broad phase uses a margin of several skins. The pairs that it excludes are monitored all together, not one by one,
/// and so are pairs that turn out to be further apart than their boxes. Displacements are between two configurations,
/// so vibration does not add up.
class VerletList {
 public:
  /// `skin`: relative displacement after which a pair must be searched; `reach`: gap beyond which no law acts, m.
  VerletList(const Model& model, double skin, double reach);

  /// Whether some pair, or those that the broad phase excluded, may have exceeded the skin at these positions. If pairs
  /// are then searched, these are the trial positions.
  bool skin_is_exceeded(const OutlineField& now);
  /// Discards the list: the next update() runs the broad phase, and all its pairs must be searched.
  void forget();
  /// Call after skin_is_exceeded(trial), before pairs are searched at the positions `here`. Sets new references, and
  /// runs the broad phase if it is due. It then returns true, and pairs have other numbers.
  bool update(const OutlineField& here, const OutlineField& trial);

  int count() const { return static_cast<int>(pairs_.size()); }
  const BodyPair& operator[](int pair) const { return pairs_[pair]; }
  /// Call once after each update. Returns the pairs whose candidates must be searched again; all others are valid for
  /// the trial.
  std::vector<int> pairs_to_search(const OutlineField& trial);
  /// Whether the candidates of pairs that were searched are valid for the trial.
  bool hold(const std::vector<int>& pairs, const OutlineField& trial) const;
  /// Gap beyond which pairs that the broad phase just found need no monitoring, m.
  double margin() const { return margin_; }
  /// Records that a pair was searched at these positions. `gap`: distance of its outlines; if that is more than the
  /// margin, any value between the two.
  void searched(int pair, const OutlineField& now, double gap = 0);
  /// Adds a pair that the broad phase does not find, searched at these positions.
  void add(const BodyPair& pair, const OutlineField& now);

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("reference", reference_);
    visitor("pairs", pairs_), visitor("excess", of_pairs_.excess);
    visitor("gap", of_pairs_.gap), visitor("watched", of_pairs_.watched);
    visitor("image", of_pairs_.image), visitor("swept_lattice", swept_lattice_);
    visitor("pair_ways", pair_displacements_), visitor("since_sweep", since_sweep_), visitor("swept_at", swept_at_);
  }
  void loaded();

 private:
  enum Use : char { keep, check, search_again };

  DisplacementsSoFar displacements(const OutlineField& now) const { return {now, reference_, motion_}; }
  void measure(const OutlineField& now);
  DisplacementDisc displacement_since_sweep(int body) const;
  double approach_by_cell() const;
  double come_out_of_place(int body, const OutlineField& now) const;
  Use use_of(int pair, const OutlineField& now) const;
  void note_image(int pair, const OutlineField& now);
  double with_image(int pair, const DisplacementDisc& first, DisplacementDisc second, const OutlineField& now) const;
  double displacement_bound(int pair, const OutlineField& now) const;
  double displacement(int pair, const OutlineField& now) const;
  bool stays_within(int pair, double limit, const OutlineField& now) const;
  void reset_references(const OutlineField& here, const OutlineField& trial);
  std::vector<BodyPair> close_boxes(const OutlineField& here);
  bool discs_are_apart(const BodyPair& pair, const OutlineField& here) const;
  void follow(std::vector<BodyPair> found, const OutlineField& here);

  const Model& model_;
  double skin_, own_skin_, margin_;
  OutlineField reference_;  ///< reference positions of each body; empty: search everything
  // At the trial positions:
  std::vector<DisplacementDisc> motion_;  ///< [bodies] discs of the outline nodes' displacements from the reference
  Vec2 drift_ = Vec2::Zero();             ///< mean displacement of all grains since the last broad phase, m
  double come_out_ = 0;                   ///< how far bodies have come since then, relative to it, m
  bool just_swept_ = false;               ///< whether the last update ran the broad phase
  std::vector<Use> use_;                  ///< [pairs] what the last test of the skin asks for
  std::vector<BodyPair> pairs_;
  /// Vector from a body to its image, m.
  struct ImageShift {
    double x, y;
  };
  /// What is known of each pair, [pairs].
  struct OfPairs {
    /// Overestimate of the disc bound at the last exact check, m. It is subtracted from later bounds below the skin, so
    /// that few pairs are checked node by node.
    std::vector<double> excess;
    std::vector<double> gap;        ///< distance of the outlines at the last search, m
    std::vector<char> watched;      ///< 0: beyond the margin at the last broad phase
    std::vector<ImageShift> image;  ///< of the second body at the last search; empty unless periods move

    void resize(std::size_t pairs, bool periods_move) {
      excess.resize(pairs), gap.resize(pairs), watched.resize(pairs), image.resize(periods_move ? pairs : 0);
    }
    /// Of a pair that has not been searched.
    void reset(int pair) {
      excess[pair] = gap[pair] = 0, watched[pair] = 1;
      if (!image.empty()) image[pair] = {0, 0};
    }
    void copy(int pair, const OfPairs& from, int old) {
      excess[pair] = from.excess[old], gap[pair] = from.gap[old], watched[pair] = from.watched[old];
      if (!image.empty()) image[pair] = from.image[old];
    }
  } of_pairs_;
  NodeDisplacements pair_displacements_;  ///< [pairs][sides] since the last search
  // Memory of the list before, for the next one:
  OfPairs spare_of_pairs_;
  NodeDisplacements spare_displacements_;
  std::vector<Box> boxes_;
  Lattice swept_lattice_;                               ///< at the last broad phase
  Eigen::Matrix2d swept_by_ = Eigen::Matrix2d::Zero();  ///< growth of the cell since, at the trial
  /// [bodies] displacements from the reference at the last broad phase
  std::vector<DisplacementDisc> since_sweep_;
  std::vector<BodyPlace> swept_at_;  ///< [bodies] at the last broad phase; unused for walls
  int grains_;                       ///< number of bodies that are not walls
  /// scratch: sums over blocks of bodies, in units of displacement
  std::vector<std::array<std::int64_t, 2>> of_block_;
  std::vector<double> farthest_;  ///< scratch: largest value of each block of bodies
  std::vector<char> exceeded_;    ///< scratch: whether a pair of each block must be searched again
};

}  // namespace pliant
