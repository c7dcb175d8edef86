#include "input/scene_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace pliant {
namespace {

std::string cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, 1, '\\');
  return text;
}

std::string allowed(const KeyKind& kind) {
  if (const auto* one = std::get_if<OneOf>(&kind); one && one->names.empty())
    return fmt::format("a {} of the scene", one->what);
  if (const auto* list = std::get_if<List<OneOf>>(&kind); list && list->element.names.empty())
    return fmt::format("an array of {} elements, each a {} of the scene", list->least, list->element.what);
  return std::visit([](const auto& one) { return one.allowed(); }, kind);
}

std::string meaning(const SceneKey& row) {
  return row.formerly.empty() ? row.meaning : fmt::format("{} (formerly `{}`)", row.meaning, row.formerly);
}

std::string text_of_default(const Default& otherwise) {
  if (otherwise.required == required.required) return "required";
  if (otherwise.required.empty()) return otherwise.value;
  return fmt::format("{}{}required {}", otherwise.value, otherwise.value.empty() ? "" : "; ", otherwise.required);
}

}  // namespace

std::string SubTable::allowed() const {
  return form == Form::one ? "a table" : form == Form::named ? "tables, each with a name" : "an array of tables";
}

const std::vector<SceneTable>& scene_tables() {
  static const std::vector<SceneTable> tables = [] {
    std::vector<SceneTable> all = setting_tables();
    for (const auto part : {body_tables, load_and_contact_tables, output_tables})
      for (SceneTable& table : part()) all.push_back(std::move(table));
    return all;
  }();
  return tables;
}

const SceneTable& scene_table(const std::string& title) {
  const auto table = std::ranges::find(scene_tables(), title, &SceneTable::title);
  if (table == scene_tables().end()) throw std::logic_error(fmt::format("scene_tables() has no '{}'", title));
  return *table;
}

const SceneTable& sub_table(const SceneTable& parent, const SceneKey& key) {
  using Form = SubTable::Form;
  const Form form = std::get<SubTable>(key.kind).form;
  if (parent.title != top_table) return scene_table(fmt::format("{} of {}", key.name, parent.title));
  return scene_table(form == Form::one     ? fmt::format("[{}]", key.name)
                     : form == Form::named ? fmt::format("[{}.NAME]", key.name)
                                           : fmt::format("[[{}]]", key.name));
}

std::span<const std::string> scene_keys() {
  static const std::vector<std::string> names = [] {
    std::set<std::string> all;
    for (const SceneTable& table : scene_tables())
      for (const SceneKey& row : table.keys) all.insert(row.name);
    return std::vector<std::string>(all.begin(), all.end());
  }();
  return names;
}

bool is_scene_key(std::string_view word) { return std::ranges::binary_search(scene_keys(), word); }

std::string scene_key_tables() {
  std::string text;
  for (const SceneTable& table : scene_tables()) {
    text += fmt::format("## {}\n\n| key | meaning | value | default | with |\n|---|---|---|---|---|\n", table.title);
    for (const SceneKey& row : table.keys)
      text += fmt::format("| `{}` | {} | {} | {} | {} |\n", row.name, cell(meaning(row)), cell(allowed(row.kind)),
                          text_of_default(row.otherwise), row.with);
    text += "\n";
  }
  return text;
}

}  // namespace pliant
