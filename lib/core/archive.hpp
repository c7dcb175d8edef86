#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace pliant {

/// Persistent objects enumerate themselves: `template <class V> void visit(V&& v) { v("time", time_); v("contact
/// pairs", contact_pairs_); }`, each member once, in any order that stays. Members are plain values, arrays of them,
/// strings, objects that enumerate themselves, or arrays of such objects. A class with members derived from these has
/// loaded(), which is called after its members have been read. Save, load, hash and comparison thus use one mechanism.
template <class T>
concept Enumerates = requires(T& object) { object.visit([](const char*, auto&) {}); };

template <class T>
constexpr bool enumerating_elements = requires(T& array) { requires Enumerates<typename T::value_type>; };

/// Calls leaf.value(path, plain value) and leaf.array(path, vector or string) for everything that an object enumerates,
/// depth first. `path` names the member from the outermost object on, as in "simulation.state.time".
template <class Leaf>
class Walk {
 public:
  explicit Walk(Leaf& leaf, std::string path = {}) : leaf_(leaf), path_(std::move(path)) {}

  template <class T>
  void operator()(const char* name, T& object) {
    const std::string path = path_.empty() ? name : path_ + "." + name;
    if constexpr (Enumerates<T>) {
      object.visit(Walk(leaf_, path));
      if constexpr (Leaf::loads && requires { object.loaded(); }) object.loaded();
    } else if constexpr (requires { leaf_.array(path, object); } && !enumerating_elements<T>) {
      leaf_.array(path, object);
    } else if constexpr (requires { object.begin()->begin(); } || enumerating_elements<T>) {
      std::uint64_t size = object.size();
      leaf_.value(path + ".size", size);
      if constexpr (Leaf::loads) leaf_.expect(path, size);
      object.resize(size);
      for (auto& element : object) (*this)(name, element);
    } else {
      static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
      leaf_.value(path, object);
    }
  }

 private:
  Leaf& leaf_;
  std::string path_;
};

/// Array whose elements consist of their bytes only.
template <class T>
concept PlainArray = requires(T& array) {
  array.data();
  array.resize(1);
} && std::is_trivially_copyable_v<typename T::value_type> && !std::is_pointer_v<typename T::value_type>;

/// 64-bit FNV-1a hash.
class Fnv1a {
 public:
  void add(const void* data, std::size_t bytes) {
    const auto* at = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < bytes; ++i) hash_ = (hash_ ^ at[i]) * 1099511628211ULL;
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 14695981039346656037ULL;
};

/// Leaf that hashes every bit.
struct HashLeaf {
  static constexpr bool loads = false;
  Fnv1a hash;

  template <class T>
  void value(const std::string&, const T& value) {
    hash.add(&value, sizeof value);
  }
  template <PlainArray T>
  void array(const std::string&, const T& values) {
    hash.add(values.data(), values.size() * sizeof(typename T::value_type));
  }
};

/// Hash of everything that an object enumerates; names do not count.
template <Enumerates T>
std::uint64_t hash_of(const T& object) {
  HashLeaf leaf;
  const_cast<T&>(object).visit(Walk(leaf));  // this leaf does not change it
  return leaf.hash.value();
}

/// Leaf that appends to a string of bytes or a file, member by member: path, 0, bytes per element, number of elements,
/// and the elements as they are in memory. `Sink` has append(const char*, std::size_t).
template <class Sink>
class SaveLeaf {
 public:
  static constexpr bool loads = false;
  explicit SaveLeaf(Sink& sink) : sink_(sink) {}

  template <class T>
  void value(const std::string& path, const T& value) {
    add(path, &value, sizeof value, 1);
  }
  template <PlainArray T>
  void array(const std::string& path, const T& values) {
    add(path, values.data(), sizeof(typename T::value_type), values.size());
  }

 private:
  void add(const std::string& path, const void* data, std::uint64_t element, std::uint64_t count) {
    sink_.append(path.c_str(), path.size() + 1);
    sink_.append(reinterpret_cast<const char*>(&element), sizeof element);
    sink_.append(reinterpret_cast<const char*>(&count), sizeof count);
    sink_.append(static_cast<const char*>(data), element * count);
  }
  Sink& sink_;
};

/// Error for bytes that do not belong to this object, such as those of another version of the program.
struct ArchiveError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Leaf that reads the output of SaveLeaf, in the same order. Throws ArchiveError if it does not fit.
class LoadLeaf {
 public:
  static constexpr bool loads = true;
  explicit LoadLeaf(std::string_view bytes) : rest_(bytes) {}

  template <class T>
  void value(const std::string& path, T& value) {
    if (next(path, sizeof value) != 1) throw ArchiveError("'" + path + "' is an array");
    take(&value, sizeof value);
  }
  template <PlainArray T>
  void array(const std::string& path, T& values) {
    constexpr std::size_t element = sizeof(typename T::value_type);
    values.resize(next(path, element));
    take(values.data(), values.size() * element);
  }
  /// Checks the size before memory for elements is allocated: throws if fewer bytes are left than their names take.
  void expect(const std::string& path, std::uint64_t elements) const {
    if (elements > rest_.size() / (path.size() + 1)) throw ArchiveError("'" + path + "' has another size");
  }
  bool empty() const { return rest_.empty(); }

 private:
  /// Number of elements of the next member, which must be `path`.
  std::uint64_t next(const std::string& path, std::uint64_t element) {
    const std::string_view found = rest_.substr(0, rest_.find('\0'));
    if (found != path) throw ArchiveError("'" + std::string(found) + "' stands where '" + path + "' is expected");
    rest_.remove_prefix(std::min(found.size() + 1, rest_.size()));
    std::uint64_t size = 0, count = 0;
    take(&size, sizeof size);
    take(&count, sizeof count);
    if (size != element || count > rest_.size() / element) throw ArchiveError("'" + path + "' has another size");
    return count;
  }
  void take(void* data, std::size_t bytes) {
    if (bytes > rest_.size()) throw ArchiveError("it ends too early");
    if (bytes > 0) std::memcpy(data, rest_.data(), bytes);
    rest_.remove_prefix(bytes);
  }
  std::string_view rest_;
};

}  // namespace pliant
