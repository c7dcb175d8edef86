#include "scene/schema.hpp"

#include <algorithm>

namespace pliant {
namespace {

/// The texts that differ, in the order of the first of each.
std::vector<std::string> distinct(const std::vector<std::string>& texts) {
  std::vector<std::string> result;
  for (const std::string& text : texts)
    if (std::find(result.begin(), result.end(), text) == result.end()) result.push_back(text);
  return result;
}

/// One text for texts of one kind that name things or limits of their scenes: what they have in common.
std::string merged(const std::vector<std::string>& texts) {
  const std::vector<std::string> different = distinct(texts);
  if (different.size() == 1) return different[0];
  std::string common = different[0];
  for (const std::string& text : different)
    common.resize(static_cast<std::size_t>(std::mismatch(common.begin(), common.end(), text.begin(), text.end()).first -
                                           common.begin()));
  const bool names = common.find('(') != std::string::npos;
  const bool choices = common.starts_with("one of");
  if (!names && (choices || different.size() == 2)) return fmt::format("{}", fmt::join(different, ", or "));
  common.resize(std::min({common.size(), common.find_last_of(",("), common.rfind(" from")}));
  while (common.ends_with(' ')) common.pop_back();
  return common + (names ? " of the scene" : ", within limits that the scene sets");
}

std::string escaped(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, 1, '\\');
  return text;
}

}  // namespace

int SceneSchema::begin_table(const std::string& pattern) {
  tables_.push_back({pattern, {}, {}});
  if (std::find(patterns_.begin(), patterns_.end(), pattern) == patterns_.end()) patterns_.push_back(pattern);
  return static_cast<int>(tables_.size()) - 1;
}

void SceneSchema::asked(int table, const std::string& key, bool present) {
  tables_[table].uses[key].present = present;
  std::vector<std::string>& keys = keys_[tables_[table].pattern];
  if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
}

void SceneSchema::note(int table, const std::string& key, const Note& note) {
  tables_[table].uses[key].notes.push_back(note);
}

void SceneSchema::chosen(int table, const std::string& key, const std::string& name) {
  tables_[table].choices[key] = name;
}

std::set<std::string> SceneSchema::keys() const {
  std::set<std::string> all;
  for (const auto& [pattern, keys] : keys_) all.insert(keys.begin(), keys.end());
  return all;
}

SceneSchema::Tables SceneSchema::tables_of(const std::string& pattern) const {
  Tables result;
  for (const Table& table : tables_)
    if (table.pattern == pattern) result.push_back(&table);
  return result;
}

/// What is allowed, kind by kind of value.
std::string SceneSchema::allowed(const Tables& tables, const std::string& key) {
  std::map<std::string, std::vector<std::string>> by_kind;
  for (const Table* table : tables)
    if (const auto use = table->uses.find(key); use != table->uses.end())
      for (const Note& note : use->second.notes) by_kind[note.type].push_back(note.allowed);
  std::set<std::string> texts;
  for (const auto& [kind, all] : by_kind) texts.insert(merged(all));
  return fmt::format("{}", fmt::join(texts, ", or "));
}

/// What holds without the key.
std::string SceneSchema::without(const Tables& tables, const std::string& key) {
  bool always = true, sometimes = false, always_there = true, only_tables = true;
  std::vector<std::string> defaults;
  for (const Table* table : tables) {
    const auto use = table->uses.find(key);
    if (use == table->uses.end()) continue;
    always_there &= use->second.present;
    always &= !use->second.notes.empty();
    for (const Note& note : use->second.notes) {
      only_tables &= note.type == table_type;
      always &= note.required, sometimes |= note.required;
      if (!note.value_without.empty()) defaults.push_back(note.value_without);
    }
  }
  if (always || (only_tables && always_there)) return "required";
  const std::vector<std::string> values = distinct(defaults);
  const std::string value = values.size() > 1 ? "depends on the scene" : values.empty() ? "" : values[0];
  if (!sometimes) return value.empty() ? "none" : value;
  return value.empty() ? "required in some cases" : value + ", required in some cases";
}

/// The choice in the same table that decides: no table with another name of it asks for the key, and all with these
/// names do.
std::string SceneSchema::condition(const Tables& tables, const std::string& key) {
  std::map<std::string, std::set<std::string>> asked_with, all;
  for (const Table* table : tables)
    for (const auto& [choice, name] : table->choices) {
      all[choice].insert(name);
      if (table->uses.contains(key)) asked_with[choice].insert(name);
    }
  for (const auto& [choice, names] : asked_with) {
    if (choice == key || names == all[choice]) continue;
    const bool decides = std::all_of(tables.begin(), tables.end(), [&](const Table* table) {
      const auto name = table->choices.find(choice);
      return name == table->choices.end() || names.contains(name->second) == table->uses.contains(key);
    });
    if (decides) return fmt::format("{} = \"{}\"", choice, fmt::join(names, "\", \""));
  }
  return {};
}

std::string SceneSchema::markdown() const {
  std::string text;
  for (const std::string& pattern : patterns_) {
    const auto keys = keys_.find(pattern);
    if (keys == keys_.end()) continue;
    text += fmt::format("## {}\n\n| key | value | default | with |\n|---|---|---|---|\n", pattern);
    const Tables tables = tables_of(pattern);
    for (const std::string& key : keys->second)
      text += fmt::format("| `{}` | {} | {} | {} |\n", key, escaped(allowed(tables, key)), without(tables, key),
                          condition(tables, key));
    text += "\n";
  }
  return text;
}

}  // namespace pliant
