#include "input/old_keys.hpp"

#include <fmt/format.h>

#include <utility>

#include "input/scene_keys.hpp"

namespace pliant {
namespace {

class OldKeys {
 public:
  explicit OldKeys(const std::string& file) : file_(file) {}

  void rename(toml::table& table, const SceneTable& rows) {
    for (const SceneKey& row : rows.keys) {
      if (!row.formerly.empty()) rename(table, rows, row);
      if (const auto* tables = std::get_if<SubTable>(&row.kind))
        if (toml::node* node = table.get(row.name)) rename(*node, tables->form, sub_table(rows, row));
    }
  }

  std::vector<std::string> warnings() const { return warnings_; }

 private:
  void rename(toml::table& table, const SceneTable& rows, const SceneKey& row) {
    const auto old = table.find(row.formerly);
    if (old == table.end()) return;
    const toml::source_region place = old->first.source();
    if (table.contains(row.name))
      fail_at(file_, place.begin,
              fmt::format("'{}' in {} is the old name of '{}', which is given as well; remove one", row.formerly,
                          rows.title, row.name));
    warnings_.push_back(
        fmt::format("{}:{}:{}: '{}' in {} is now called '{}'; the next version will refuse the old name", file_,
                    place.begin.line, place.begin.column, row.formerly, rows.title, row.name));
    // Moved, not copied: copies forget their place.
    std::move(old->second).visit([&](auto&& value) {
      table.insert_or_assign(toml::key(row.name, toml::source_region(place)), std::forward<decltype(value)>(value));
    });
    table.erase(row.formerly);
  }

  void rename(toml::node& node, SubTable::Form form, const SceneTable& rows) {
    toml::table* table = node.as_table();
    toml::array* array = node.as_array();
    if (table && form == SubTable::Form::one) rename(*table, rows);
    if (table && form == SubTable::Form::named)
      for (auto&& [name, one] : *table)
        if (toml::table* inner = one.as_table()) rename(*inner, rows);
    if (array && form == SubTable::Form::array)
      for (toml::node& one : *array)
        if (toml::table* inner = one.as_table()) rename(*inner, rows);
  }

  const std::string& file_;
  std::vector<std::string> warnings_;
};

}  // namespace

std::vector<std::string> rename_old_keys(toml::table& scene, const std::string& file) {
  OldKeys old(file);
  old.rename(scene, scene_table(top_table));
  return old.warnings();
}

}  // namespace pliant
