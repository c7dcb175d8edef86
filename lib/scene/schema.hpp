#pragma once

#include <fmt/format.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include "scene/value.hpp"

namespace pliant {

/// Pattern of the root of a scene file.
inline constexpr const char* top_pattern = "Top level";

/// What scene files may hold, learned from reading some: each table notes the keys that it is asked for, with what is
/// allowed and what holds without them. Together the files must take every branch of the readers (docs/keys, cases; a
/// test sees to it).
class SceneSchema {
 public:
  static constexpr const char* table_type = "table";
  /// What one reading of a table says of a key.
  struct Note {
    std::string type;  ///< tells kinds of values apart; table_type: a table or several
    std::string allowed, value_without;
    bool required = false;
  };

  /// A table begins to be read: `pattern` is its title without names and numbers, as in [materials.NAME]. Returns its
  /// number.
  int begin_table(const std::string& pattern);
  void asked(int table, const std::string& key, bool present);
  void note(int table, const std::string& key, const Note& note);
  /// The name that a table chooses from a fixed list.
  void chosen(int table, const std::string& key, const std::string& name);

  std::set<std::string> keys() const;
  /// A section a table, a row a key: what is allowed, what holds without it, and where it applies.
  std::string markdown() const;

 private:
  struct KeyUse {
    bool present = false;
    std::vector<Note> notes;
  };
  struct Table {
    std::string pattern;
    std::map<std::string, KeyUse> uses;
    std::map<std::string, std::string> choices;
  };
  using Tables = std::vector<const Table*>;

  Tables tables_of(const std::string& pattern) const;
  static std::string allowed(const Tables& tables, const std::string& key);
  static std::string without(const Tables& tables, const std::string& key);
  static std::string condition(const Tables& tables, const std::string& key);

  std::vector<Table> tables_;
  std::vector<std::string> patterns_;                     ///< in the order of reading
  std::map<std::string, std::vector<std::string>> keys_;  ///< of each pattern, in the order of reading
};

/// read_scene that lets a schema, if any, learn what the file is asked for.
Scene read_scene(const std::filesystem::path& file, SceneSchema* schema);

/// A value in the form that scene files have, for tables of defaults; empty for types that have none.
template <class Field, class Kind>
std::string default_text(const Field& field, const Kind& kind) {
  if constexpr (requires { field.has_value(); }) {
    if (field) return default_text(*field, kind);
    if constexpr (requires { kind.keyword; }) return fmt::format("\"{}\"", kind.keyword);
    return "none";
  } else if constexpr (requires { kind.entries; }) {
    for (const auto& [name, value] : kind.entries)
      if (value == field) return fmt::format("\"{}\"", name);
    return {};
  } else if constexpr (std::is_arithmetic_v<Field>) {
    std::string unit;
    if constexpr (requires { kind.range; })
      if (!kind.range.contains(field)) return "automatic";
    if constexpr (requires { kind.unit; }) unit = kind.unit;
    if constexpr (requires { kind.quantity.unit; }) unit = kind.quantity.unit;
    return unit.empty() || unit == "1" ? fmt::format("{}", field) : fmt::format("{} {}", field, unit);
  } else if constexpr (std::is_same_v<Field, std::string>) {
    return field.empty() ? "none" : fmt::format("\"{}\"", field);
  } else if constexpr (requires { field.isZero(); }) {
    return field.isZero() ? "zero" : "";
  } else if constexpr (std::is_same_v<Field, std::vector<double>>) {
    return field.empty() ? "none" : fmt::format("[{}]", fmt::join(field, ", "));
  } else if constexpr (requires { field.empty(); }) {
    return field.empty() ? "none" : "";
  } else {
    return {};
  }
}

}  // namespace pliant
