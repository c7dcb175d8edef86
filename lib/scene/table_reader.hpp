#pragma once

#include <toml++/toml.h>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/value.hpp"

namespace pliant {

/// Reads one table of a scene file, strictly: it remembers the keys that were asked for, and `finish` rejects all
/// others. A new key is one line, `table.optional("safety", time.safety, Quantity{"1", positive})`, and its name in
/// is_scene_key; the default is the value that the field has already.
class TableReader {
 public:
  TableReader(const toml::table& table, std::string title, const std::string& file)
      : table_(&table), title_(std::move(title)), file_(&file) {}

  /// Sets the field from a key that must be there.
  template <class Field, class Kind>
  void required(const std::string& key, Field& field, const Kind& kind) {
    if (!has(key)) fail_missing(key, kind.allowed());
    field = static_cast<Field>(kind(value(key)));
  }

  /// Sets the field when the key is there; returns whether it is.
  template <class Field, class Kind>
  bool optional(const std::string& key, Field& field, const Kind& kind) {
    if (!has(key)) return false;
    field = static_cast<Field>(kind(value(key)));
    return true;
  }

  bool has(const std::string& key);     ///< also marks the key as known
  Value value(const std::string& key);  ///< of a key that is there

  /// The table under a key that must be there; an empty one in its stead when it may be left out.
  TableReader required_table(const std::string& key);
  TableReader optional_table(const std::string& key);
  /// The tables [key.NAME], in the order of the file.
  std::vector<std::pair<std::string, TableReader>> named_tables(const std::string& key);
  /// The tables of an array [[key]]; none when the key is missing.
  std::vector<TableReader> tables(const std::string& key);

  const std::string& title() const { return title_; }
  /// Throws InputError at the table.
  [[noreturn]] void fail(const std::string& message) const;
  /// Throws InputError at the value of a key that is there.
  [[noreturn]] void fail(const std::string& key, const std::string& message) const;
  /// Throws InputError for a missing key, at the unknown key that is likely to stand for it where there is one.
  [[noreturn]] void fail_missing(const std::string& key, const std::string& allowed) const;
  /// Throws InputError for the first key that nothing asked for.
  void finish() const;

 private:
  bool nested() const { return title_.starts_with('['); }
  std::string child_title(const std::string& key) const;
  std::vector<const toml::key*> unknown_keys() const;
  /// The likeliest among the keys that nothing asked for; nullptr: none is suspect.
  const toml::key* misspelling_of(const std::string& key) const;

  const toml::table* table_;
  std::string title_;  ///< such as [materials.soft]
  const std::string* file_;
  std::set<std::string> known_;
};

}  // namespace pliant
