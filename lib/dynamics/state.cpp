#include "dynamics/state.hpp"

#include "core/archive.hpp"

namespace pliant {

std::uint64_t state_hash(const State& state) {
  HashLeaf leaf;
  const_cast<State&>(state).visit_motion(Walk(leaf));  // this leaf only looks
  return leaf.hash.value();
}

}  // namespace pliant
