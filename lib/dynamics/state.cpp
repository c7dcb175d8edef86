#include "dynamics/state.hpp"

#include "core/archive.hpp"

namespace pliant {

std::uint64_t state_hash(const State& state) { return hash_of(state); }

}  // namespace pliant
