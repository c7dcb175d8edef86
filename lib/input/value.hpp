#pragma once

#include <fmt/format.h>

#include <toml++/toml.h>
#include <initializer_list>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

#include "core/vec2.hpp"
#include "scene/names.hpp"
#include "scene/scene.hpp"

namespace pliant {

struct SceneKey;

/// A scene file that is being read.
struct Source {
  std::string file;                                           ///< its name, for messages
  std::set<std::pair<const SceneKey*, bool>>* use = nullptr;  ///< see KeyUse
  mutable std::vector<std::string> warnings{};
};

/// One value of a scene file and what it is called in messages.
struct Value {
  const toml::node& node;
  std::string label;  ///< such as 'density' in [materials.soft]
  const Source& source;

  /// Throws InputError "file:line:column: message" at the value.
  [[noreturn]] void fail(const std::string& message) const;
  /// Throws InputError "... label: found ..., allowed: ...".
  [[noreturn]] void reject(const std::string& allowed) const;
  /// What the reader is told of a value that is allowed: "file:line:column: label: found ..., message".
  void warn(const std::string& message) const;
  /// Throws unless the value is an array; then its elements, labelled by their number.
  std::vector<Value> elements(const std::string& allowed) const;
  /// Throws unless the value is a string.
  std::string text(const std::string& allowed) const;
  /// What stands in the file, shortened: a string in quotes, a number, "a table".
  std::string found() const;
};

[[noreturn]] void fail_at(const std::string& file, const toml::source_position& at, const std::string& message);

/// Interval of allowed numbers.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false, high_open = false;
  bool contains(double x) const;
  std::string text() const;  ///< "> 0", ">= 0 and < 0.5", or "any"
};
inline constexpr Range any_number{};
inline constexpr Range positive{.low = 0, .low_open = true};
inline constexpr Range non_negative{.low = 0};

// What a key may hold. Each type has `allowed()`, the text for messages, and converts a Value or throws InputError.

/// A number in SI units or a string with a unit ("2 GPa"), in `unit` afterwards ("1": a pure number). An angle without
/// a unit that is more than a turn as radians is warned of.
struct Quantity {
  std::string unit;
  Range range = any_number;
  std::string allowed() const;
  double operator()(const Value& value) const;
};

/// A coefficient of friction, or an angle whose tangent it is ("30 deg"). A number without a unit from 2 to 90 is
/// warned of.
struct Friction {
  std::string allowed() const { return "a number, >= 0, or an angle from 0 to below 90 deg whose tangent it is"; }
  double operator()(const Value& value) const;
};

/// A quantity, or a keyword ("auto", "random") that leaves it open (std::nullopt).
struct QuantityOr {
  std::string keyword;
  Quantity quantity;
  std::string allowed() const { return fmt::format("\"{}\" or {}", keyword, quantity.allowed()); }
  std::optional<double> operator()(const Value& value) const;
};

struct Integer {
  std::int64_t low, high;
  std::string allowed() const { return fmt::format("an integer from {} to {}", low, high); }
  std::int64_t operator()(const Value& value) const;
};

struct Flag {
  std::string allowed() const { return "true or false"; }
  bool operator()(const Value& value) const;
};

/// Free text on one line.
struct Text {
  std::string allowed() const { return "a string"; }
  std::string operator()(const Value& value) const { return value.text(allowed()); }
};

/// A name that the scene gives to one of its parts: it also becomes part of file names.
struct Identifier {
  std::string allowed() const { return "a name of 1 to 64 letters, digits, '_' and '-'"; }
  std::string operator()(const Value& value) const;
  static bool valid(std::string_view name);
};

/// One of a list of names.
struct OneOf {
  std::string what;  ///< such as "material"
  std::vector<std::string> names;
  std::string allowed() const { return fmt::format("a {} ({})", what, fmt::join(names, ", ")); }
  std::string operator()(const Value& value) const;
};

/// One of the names of an enumeration, or of true and false.
struct Choice {
  std::vector<std::pair<std::string, int>> entries;
  const std::type_info* type;  ///< of the values

  std::vector<std::string> all() const;
  std::string allowed() const { return fmt::format("one of \"{}\"", fmt::join(all(), "\", \"")); }
  int operator()(const Value& value) const;
};
template <class Enum>
Choice choice(std::initializer_list<std::pair<const char*, Enum>> entries) {
  Choice all{{}, &typeid(Enum)};
  for (const auto& [name, value] : entries) all.entries.emplace_back(name, static_cast<int>(value));
  return all;
}

/// An array of values of one kind, of `least` to `most` elements.
template <class Element>
struct List {
  static constexpr std::size_t unlimited = std::numeric_limits<std::size_t>::max();
  Element element;
  std::size_t least = 1, most = unlimited;

  std::string allowed() const {
    const std::string count = least == most ? fmt::format("{}", least) : fmt::format("at least {}", least);
    return fmt::format("an array of {} elements, each {}", count, element.allowed());
  }
  auto operator()(const Value& value) const {
    const std::vector<Value> elements = value.elements(allowed());
    if (elements.size() < least || elements.size() > most) value.reject(allowed());
    std::vector<decltype(element(value))> converted;
    converted.reserve(elements.size());
    for (const Value& one : elements) converted.push_back(element(one));
    return converted;
  }
};

/// [x, y].
struct Vector {
  std::string unit;
  std::string allowed() const { return fmt::format("[x, y], each {}", Quantity{unit}.allowed()); }
  Vec2 operator()(const Value& value) const;
};

/// [[xx, xy], [yx, yy]].
struct Matrix {
  std::string unit;
  std::string allowed() const { return fmt::format("[[xx, xy], [yx, yy]], each {}", Quantity{unit}.allowed()); }
  Eigen::Matrix2d operator()(const Value& value) const;
};

/// [[left, bottom], [right, top]], m.
struct Corners {
  std::string allowed() const { return "[[left, bottom], [right, top]] in m, left < right and bottom < top"; }
  ProbeBox operator()(const Value& value) const;
};

/// Rows [time, value] of an array, the times growing; take(time, value) gets them one after another.
template <class Take>
void for_each_history_entry(const Value& value, const std::string& allowed, Take&& take) {
  const std::vector<Value> rows = value.elements(allowed);
  if (rows.empty()) value.reject(allowed);
  double last = -std::numeric_limits<double>::infinity();
  for (const Value& row : rows) {
    const std::vector<Value> entry = row.elements("[time, value]");
    if (entry.size() != 2) row.reject("[time, value]");
    const double time = Quantity{"s"}(entry[0]);
    if (time <= last) entry[0].reject(fmt::format("a time after the one before it, {} s", last));
    take(last = time, entry[1]);
  }
}

/// A constant or a table [[time, value], ...] with growing times.
struct HistoryOf {
  Quantity quantity;
  std::string allowed() const { return fmt::format("{}, or a table [[time, value], ...] of them", quantity.allowed()); }
  History operator()(const Value& value) const;
};

/// A table [[time, [x, y]], ...] with growing times: the histories of x and y.
struct VectorHistory {
  std::string unit;
  std::string allowed() const { return fmt::format("a table [[time, [x, y]], ...], x and y in {}", unit); }
  std::vector<History> operator()(const Value& value) const;
};

// Kinds with what depends on the rest of the scene.

struct Least {
  std::int64_t value;
};
struct Count {
  std::size_t value;
};

template <class Kind>
const Kind& within(const Kind& kind) {
  return kind;
}
Quantity within(Quantity kind, const Range& range);
Integer within(Integer kind, Least least);
OneOf within(const OneOf& kind, const std::vector<std::string>& names);
List<OneOf> within(List<OneOf> kind, const std::vector<std::string>& names);
List<Quantity> within(List<Quantity> kind, Count count);
/// Those of its names, in their order.
Choice within(const Choice& kind, const std::vector<std::string>& names);
/// The reader's own kind.
template <class Kind, class Own>
  requires std::is_invocable_v<Own, const Value&>
const Own& within(const Kind& /*kind*/, const Own& own) {
  return own;
}

}  // namespace pliant
