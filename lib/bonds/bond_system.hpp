#pragma once

#include <vector>

#include "bodies/model.hpp"
#include "bodies/outline_fields.hpp"
#include "bonds/bond.hpp"
#include "bonds/bond_law.hpp"
#include "contact/law_table.hpp"

namespace pliant {

/// Sums over all bonds.
struct BondTotals {
  double stored = 0;  ///< J/m
  double loss = 0;    ///< by damage since the last accepted step, J/m
};

/// Bonds of another run, for a run of the same bodies.
struct InheritedBonds {
  std::vector<Bond> bonds;
  std::vector<char> made;  ///< [rules]
  BondHistory history;

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("bonds", bonds), visitor("made", made), visitor("history", history);
  }
};

/// All bonds of a scene (docs/method.md 11). A bond adds tension and shear to contact, which acts beside
/// it as anywhere else. So nothing jumps where a bond tears. The history belongs to the caller's state.
class BondSystem {
 public:
  BondSystem(const Model& model, const LawTable& laws);

  bool is_empty() const { return bonds_.empty(); }
  /// Makes the bonds of all rules whose time has come. Returns whether there are new ones. Throws InputError for a rule
  /// of the start that finds nothing to bond, and for one whose values do not fit the strength or the contacts.
  bool make(const OutlineField& position, double time, BondHistory& history);
  /// Adds the forces on outline nodes, N/m, and on the vectors of the periods; reads the history `from` and writes
  /// `to`.
  BondTotals add_forces(const OutlineField& position, const BondHistory& from, BondHistory& to, OutlineField& force);
  /// Bonds across a gap turn with it, which makes them stiffer: call this before add_stiffness() after each search of
  /// contacts.
  void measure_turning(const OutlineField& position, const BondHistory& history);
  /// Bodies whose stiffness the last measure_turning() has changed.
  const std::vector<int>& turned() const { return turned_; }
  /// Adds a bound of the stiffness of a body's nodes, N/m2, to every `stride`-th number. `compliance` [bodies]: as
  /// StiffnessBound::update weighs the two sides of a contact.
  void add_stiffness(int body, const std::vector<double>& compliance, double* to, int stride) const;

  const std::vector<Bond>& bonds() const { return bonds_; }
  BondLaw<double> law_of(const Bond& bond) const;
  long version() const { return version_; }  ///< changes with the bonds

  InheritedBonds leave(const BondHistory& history) const { return {bonds_, made_, history}; }
  void inherit(const InheritedBonds& from, BondHistory& history);

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("bonds", bonds_), visitor("made", made_), visitor("version", version_);
  }
  void loaded() { index(); }

 private:
  /// Nodes of eight bonds in a field: the ends of the slave's segment, and the two nodes around either master point.
  struct Nodes {
    LaneBits end[2], master[2], next[2];
  };
  struct Eight {
    Nodes nodes;
    Lanes xi[2], rest_gap[2], rest_slip[2];
    Lanes shift[2];  ///< numbers of the master's images along the two periods
    Lanes weight;    ///< half of the length, m; 0 in padding
    BondLaw<Lanes> law;
  };
  /// Share of a number of the force buffer that a node receives.
  struct Receipt {
    std::int32_t node;  ///< in an OutlineField
    std::int32_t from;  ///< first number of its eight there, for x; that for y follows behind it
    double share;
    double stiffness;    ///< N/m2
    std::int32_t other;  ///< body at the other side
    std::int32_t bond;
  };

  struct Frame;
  static Frame frame_of(const Eight& eight, const OutlineField& position);

  void refuse_unfit(const BondRule& rule, const BondLaw<double>& law) const;
  void index();
  void add_to_eight(std::size_t number);
  BondTotals forces_of_eight(std::size_t number, const OutlineField& position, const BondHistory& from,
                             BondHistory& to);
  Lattice forces_on_images() const;

  const Model& model_;
  const LawTable& laws_;
  std::vector<Bond> bonds_;
  std::vector<char> made_;  ///< [rules]
  long version_ = 0;
  // Derived from the bonds:
  std::vector<Eight> eights_;
  std::vector<Lanes> buffer_;       ///< [eights x forces_per_bond], N/m
  std::vector<int> receipt_begin_;  ///< [bodies + 1]
  std::vector<Receipt> receipts_;
  std::vector<BondTotals> totals_;  ///< [eights]
  std::vector<Lanes> turning_;      ///< [eights] factors on the stiffness: 0 for torn bonds across a gap, 1 without one
  std::vector<int> turned_;         ///< see turned()
};

}  // namespace pliant
