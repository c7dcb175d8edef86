#pragma once

#include <functional>
#include <map>
#include <tuple>

#include "reference/contact/integrated_pass.hpp"
#include "reference/contact/pair_laws.hpp"
#include "reference/contact/periods.hpp"

namespace pliant::reference {

/// All integrated contacts of a scene (docs/method.md 4, "Contact as an integral"), by brute force: every segment of
/// every body against every segment of every other, and of its own periodic images.
class IntegratedContacts {
 public:
  /// `has`: whether the contact of two bodies, by their numbers, is integrated.
  IntegratedContacts(const Scene& scene, const std::vector<ContactOutline>& outlines, const PairLaws& laws,
                     std::function<bool(int, int)> has);

  ContactResult evaluate(const Points& x, const Periods& periods);  ///< as in Contacts
  void accept();

 private:
  using Encounter = std::tuple<int, int, Image>;  ///< slave, master, image; image 0 for walls
  using Memories = std::map<Encounter, NodeSlips>;

  void meet(int slave, int master, ContactResult& result);
  void meet_image(const Encounter& encounter, ContactResult& result);

  const std::vector<ContactOutline>& outlines_;
  const PairLaws& laws_;
  std::function<bool(int, int)> has_;
  Periods periods_, past_periods_;            ///< now, and at the last accepted state
  std::vector<std::vector<double>> lengths_;  ///< [bodies][segments] reference lengths, m; empty: current lengths count
  std::vector<double> longest_;               ///< [bodies] longest segment, m
  Memories accepted_, trial_;
  Points x_, past_;  ///< all outline nodes, now and at the last accepted state; empty before that
};

}  // namespace pliant::reference
