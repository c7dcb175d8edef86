#pragma once

#include <cstdint>
#include <vector>

#include "contact/contact_pair.hpp"
#include "contact/history.hpp"

namespace pliant {

/// Kind of law between any two bodies, whether they are close or not.
struct PairLaws {
  std::vector<std::int32_t> groups;  ///< [bodies] index of each body's group
  std::vector<std::int32_t> kinds;   ///< [groups x groups] as ContactLaws::kind
  std::int32_t count = 0;            ///< number of groups

  std::int32_t kind(int first, int second) const { return kinds[groups[first] * count + groups[second]]; }
  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("groups", groups), visitor("kinds", kinds), visitor("count", count);
  }
};

/// Contact state at the end of a run, for another run of the same bodies.
struct InheritedContact {
  std::vector<ContactPair> contact_pairs;
  PairLaws laws;
  ContactHistory history;  ///< with the records that the contact pairs refer to

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("contact_pairs", contact_pairs), visitor("laws", laws), visitor("history", history);
  }
};

}  // namespace pliant
