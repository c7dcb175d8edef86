#pragma once

#include <toml++/toml.h>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "input/key_fields.hpp"
#include "input/scene_keys.hpp"

namespace pliant {

/// Reads one table of a scene file, strictly: it remembers the keys that were asked for, and `finish` rejects all
/// others. A new key is one row in scene_tables() and one line here, `table.optional("safety", time.safety)`. The
/// default is the value that the field has already. A limit narrows the kind of the row to what else the scene says:
/// see `within`. Whatever disagrees with the rows is a mistake in this program: std::logic_error.
class TableReader {
 public:
  /// The root of the file.
  TableReader(const toml::table& table, const Source& source)
      : TableReader(table, "the scene", source, scene_table(top_table)) {}

  /// Sets the field from a key that must be there.
  template <class Field, class... Limit>
  void required(const std::string& key, Field& field, const Limit&... limit) {
    read(key, true, field, limit...);
  }

  /// Sets the field when the key is there; returns whether it is.
  template <class Field, class... Limit>
  bool optional(const std::string& key, Field& field, const Limit&... limit) {
    return read(key, false, field, limit...);
  }

  bool has(const std::string& key);     ///< also marks the key as known
  Value value(const std::string& key);  ///< of a key that is there

  /// The table under a key that must be there; an empty one in its stead when it may be left out.
  TableReader required_table(const std::string& key);
  TableReader optional_table(const std::string& key);
  /// The tables [key.NAME], in the order of the file.
  std::vector<std::pair<std::string, TableReader>> named_tables(const std::string& key);
  /// The tables of an array [[key]]; none when the key may be missing and is.
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
  TableReader(const toml::table& table, std::string title, const Source& source, const SceneTable& rows)
      : table_(&table), title_(std::move(title)), source_(&source), rows_(&rows) {}

  template <class Field, class... Limit>
  bool read(const std::string& key, bool must, Field& field, const Limit&... limit) {
    const SceneKey& row = row_of(key, must, [](const KeyKind& kind) {
      return std::visit([](const auto& one) { return fills<Field, Limit...>(one); }, kind);
    });
    std::visit(
        [&](const auto& fixed) {
          if constexpr (CanFill<std::decay_t<decltype(fixed)>, Field, Limit...>) {
            const auto& kind = within(fixed, limit...);
            if (!must) check_default(row, text_of(field, kind));
            if (has(key))
              assign(field, kind(value(key)));
            else if (must)
              fail_missing(key, kind.allowed());
            if constexpr (std::is_same_v<decltype(fixed), const Choice&>) chosen_[key] = text_of(field, kind);
          }
        },
        row.kind);
    return has(key);
  }

  /// The row whose condition holds and whose kind serves; notes that it was asked for.
  const SceneKey& row_of(const std::string& key, bool must, bool (*serves)(const KeyKind&));
  const SceneKey& row_of_tables(const std::string& key, SubTable::Form form);
  void check_default(const SceneKey& row, const std::string& value) const;
  /// Whether the row's condition holds in this table; nothing of words for people.
  std::optional<bool> holds(const SceneKey& row) const;

  void check_conditions() const;

  bool nested() const { return title_.starts_with('['); }
  std::vector<const toml::key*> unknown_keys() const;
  /// The likeliest among the keys that nothing asked for; nullptr: none is suspect.
  const toml::key* misspelling_of(const std::string& key) const;

  const toml::table* table_;
  std::string title_;  ///< such as [materials.soft]
  const Source* source_;
  const SceneTable* rows_;
  std::set<std::string> known_;
  std::set<const SceneKey*> asked_;            ///< what its conditions are checked by
  std::map<std::string, std::string> chosen_;  ///< names, in quotes, that keys have or would have by default
};

}  // namespace pliant
