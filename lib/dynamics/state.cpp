#include "dynamics/state.hpp"

#include <cstring>

namespace pliant {
namespace {

class Hasher {
 public:
  template <class T>
  void operator()(const char*, const T& value) {
    add(&value, sizeof value);
  }
  template <class T>
  void operator()(const char*, const std::vector<T>& values) {
    add(values.data(), values.size() * sizeof(T));
  }
  std::uint64_t value() const { return hash_; }

 private:
  void add(const void* data, std::size_t bytes) {
    const auto* at = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < bytes; ++i) hash_ = (hash_ ^ at[i]) * 1099511628211ULL;
  }
  std::uint64_t hash_ = 14695981039346656037ULL;
};

}  // namespace

std::uint64_t state_hash(const State& state) {
  Hasher hasher;
  state.visit(hasher);
  return hasher.value();
}

}  // namespace pliant
