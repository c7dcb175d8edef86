#pragma once

#include <toml++/toml.h>
#include <set>
#include <string>
#include <string_view>
#include <typeinfo>
#include <utility>
#include <vector>

#include "scene/schema.hpp"
#include "scene/value.hpp"

namespace pliant {

/// Reads one table of a scene file, strictly: it remembers the keys that were asked for, and `finish` rejects all
/// others. A new key is one line, `table.optional("safety", time.safety, Quantity{"1", positive})`, and its name in
/// is_scene_key; the default is the value that the field has already.
class TableReader {
 public:
  /// `schema`, if any, learns what is asked for; `pattern` is the title without names and numbers.
  TableReader(const toml::table& table, std::string title, const Source& source, SceneSchema* schema = nullptr,
              std::string pattern = {})
      : table_(&table), title_(std::move(title)), source_(&source), schema_(schema), pattern_(std::move(pattern)) {
    if (schema_) number_ = schema_->begin_table(pattern_);
  }

  /// Sets the field from a key that must be there.
  template <class Field, class Kind>
  void required(const std::string& key, Field& field, const Kind& kind) {
    if (!has(key)) fail_missing(key, kind.allowed());
    if (schema_) schema_->note(number_, key, {typeid(Kind).name(), kind.allowed(), {}, true});
    field = static_cast<Field>(kind(value(key)));
    note_choice(key, field, kind);
  }

  /// Sets the field when the key is there; returns whether it is.
  template <class Field, class Kind>
  bool optional(const std::string& key, Field& field, const Kind& kind) {
    const bool there = has(key);
    if (schema_) schema_->note(number_, key, {typeid(Kind).name(), kind.allowed(), default_text(field, kind), false});
    if (there) field = static_cast<Field>(kind(value(key)));
    note_choice(key, field, kind);
    return there;
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
  const std::string& file() const { return source_->file; }
  std::string place() const;  ///< "file:line:column", for messages
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
  TableReader child(const toml::table& table, const std::string& key) const;
  void note_tables(const std::string& key, const char* allowed);

  template <class Field, class Kind>
  void note_choice(const std::string& key, const Field& field, const Kind& kind) {
    if constexpr (requires { kind.entries; }) {
      if (!schema_) return;
      for (const auto& [name, entry] : kind.entries)
        if (entry == field) schema_->chosen(number_, key, name);
    }
  }
  std::vector<const toml::key*> unknown_keys() const;
  /// The likeliest among the keys that nothing asked for; nullptr: none is suspect.
  const toml::key* misspelling_of(const std::string& key) const;

  const toml::table* table_;
  std::string title_;  ///< such as [materials.soft]
  const Source* source_;
  SceneSchema* schema_;
  std::string pattern_;
  int number_ = 0;  ///< of this table in the schema
  std::set<std::string> known_;
};

}  // namespace pliant
