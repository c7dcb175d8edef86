#pragma once

#include <cstdint>
#include <vector>

#include "contact/history.hpp"
#include "contact/patch.hpp"

namespace pliant {

/// What contact remembers at the end of a run, for another one of the same bodies.
struct InheritedContact {
  std::vector<Patch> patches;
  std::vector<std::int32_t> kinds;  ///< [patches] ContactLawKind of each
  ContactHistory history;           ///< whose records the patches name

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("patches", patches), visitor("kinds", kinds), visitor("history", history);
  }
};

}  // namespace pliant
