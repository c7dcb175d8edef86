#pragma once

#include <fmt/format.h>

#include <concepts>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "input/value.hpp"

namespace pliant {

// Which fields of a scene a kind of key can fill, and what a field's value is called in scene files.

template <class Field>
struct Held {
  using Type = Field;
};
template <class Inner>
struct Held<std::optional<Inner>> {
  using Type = Inner;
};
/// What a field holds: T of std::optional<T>.
template <class Field>
using HeldBy = typename Held<Field>::Type;

template <class Read, class Field>
concept Storable =
    std::same_as<Read, Field> || std::same_as<Read, HeldBy<Field>> ||
    (std::same_as<Read, std::int64_t> && std::integral<HeldBy<Field>> && !std::same_as<HeldBy<Field>, bool>) ||
    (std::same_as<Read, int> && (std::is_enum_v<HeldBy<Field>> || std::same_as<HeldBy<Field>, bool>));

template <class Kind, class Field, class... Limit>
concept CanFill = requires(const Kind& kind, const Value& value, const Limit&... limit) {
  { within(kind, limit...)(value) };
  requires Storable<std::decay_t<decltype(within(kind, limit...)(value))>, Field>;
};

template <class Field, class... Limit, class Kind>
bool fills(const Kind& kind) {
  if constexpr (!CanFill<Kind, Field, Limit...>)
    return false;
  else if constexpr (std::is_same_v<Kind, Choice>)
    return *kind.type == typeid(HeldBy<Field>);
  else
    return true;
}

template <class Field, class Read>
void assign(Field& field, Read&& read) {
  if constexpr (std::same_as<std::decay_t<Read>, Field>)
    field = std::forward<Read>(read);
  else
    field = static_cast<HeldBy<Field>>(std::forward<Read>(read));
}

/// "none" for what no scene could give: nothing, or a number out of range that stands for it.
template <class Field, class Kind>
std::string text_of(const Field& field, const Kind& kind) {
  if constexpr (requires { field.has_value(); }) {
    if (field) return text_of(*field, kind);
    if constexpr (requires { kind.keyword; }) return fmt::format("\"{}\"", kind.keyword);
  } else if constexpr (requires { kind.entries; }) {
    for (const auto& [name, value] : kind.entries)
      if (value == static_cast<int>(field)) return fmt::format("\"{}\"", name);
  } else if constexpr (std::same_as<Field, bool>) {
    return field ? "true" : "false";
  } else if constexpr (std::is_arithmetic_v<Field>) {
    std::string unit;
    if constexpr (requires { kind.range; })
      if (!kind.range.contains(field)) return "none";
    if constexpr (requires { kind.low; })
      if (static_cast<std::int64_t>(field) < kind.low) return "none";
    if constexpr (requires { kind.unit; }) unit = kind.unit;
    if constexpr (requires { kind.quantity.unit; }) unit = kind.quantity.unit;
    return unit.empty() || unit == "1" ? fmt::format("{}", field) : fmt::format("{} {}", field, unit);
  } else if constexpr (std::same_as<Field, std::string>) {
    if (!field.empty()) return fmt::format("\"{}\"", field);
  } else if constexpr (requires { field.isZero(); }) {
    return field.isZero() ? "zero" : "not zero";
  } else if constexpr (std::same_as<Field, std::vector<double>>) {
    if (!field.empty()) return fmt::format("[{}]", fmt::join(field, ", "));
  } else if constexpr (requires { field.empty(); }) {
    if (!field.empty()) return "not empty";
  } else if constexpr (requires { field.time.empty(); }) {
    if (!field.time.empty()) return "not empty";
  }
  return "none";
}

}  // namespace pliant
