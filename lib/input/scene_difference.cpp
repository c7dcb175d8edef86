#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <sstream>

#include "core/errors.hpp"
#include "input/old_keys.hpp"
#include "input/scene_difference.hpp"
#include "scene/scene.hpp"
#include "scene/units.hpp"

namespace pliant {
namespace {

toml::table significant(const std::string& text) {
  try {
    toml::table table = toml::parse(text);
    rename_old_keys(table, "the scene");
    table.erase("title");
    table.erase("checkpoint");
    if (toml::table* time = table["time"].as_table()) time->erase("end");
    return table;
  } catch (const toml::parse_error& error) {
    throw InputError(fmt::format("the scene is not valid TOML: {}", error.description()));
  }
}

/// What a new start leaves as it is.
toml::table of_bodies(const std::string& text) {
  toml::table table = significant(text);
  for (const char* key : {"start", "time", "boundary", "contacts", "probes", "frames"}) table.erase(key);
  if (toml::table* domain = table["domain"].as_table()) domain->erase("gravity"), domain->erase("cell");
  if (toml::table* contact = table["contact"].as_table())
    for (const char* key : {"skin", "length", "refresh", "energy_consistent"}) contact->erase(key);
  for (const char* key : {"domain", "contact"})
    if (const toml::table* left = table[key].as_table(); left && left->empty()) table.erase(key);
  if (toml::table* materials = table["materials"].as_table())
    for (auto&& [name, material] : *materials)
      if (toml::table* one = material.as_table())
        for (auto entry = one->begin(); entry != one->end();)
          entry = entry->first.str() == "law" ? std::next(entry) : one->erase(entry);
  if (toml::array* walls = table["walls"].as_array())
    for (toml::node& wall : *walls)
      if (toml::table* one = wall.as_table())
        for (const char* key : {"x", "y", "thickness"}) one->erase(key);
  return table;
}

std::string shown(const toml::node* node) {
  constexpr std::size_t longest = 60;
  if (!node) return "not there";
  if (node->is_table()) return "a table";
  if (const auto* number = node->as_floating_point()) return fmt::format("{}", number->get());
  std::ostringstream text;
  node->visit([&](const auto& value) { text << value; });
  return text.str().size() <= longest ? text.str() : text.str().substr(0, longest) + "...";
}

/// In a unit that a quantity may have; none for what is no such quantity.
std::optional<double> value_in(const toml::node& node, const char* unit) {
  if (node.is_number()) return node.value<double>();
  try {
    if (const auto* text = node.as_string()) return parse_quantity(text->get(), unit);
  } catch (const UnitError&) {
    return std::nullopt;
  }
  return std::nullopt;
}

/// "10 mm", "1 cm" and 0.01 are one quantity, to the rounding of units.
bool same_quantity(const toml::node& a, const toml::node& b) {
  if (a.is_number() && b.is_number()) return false;
  constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
  const auto same = [&](const char* unit) {
    const std::optional<double> left = value_in(a, unit), right = value_in(b, unit);
    return left && right && std::abs(*left - *right) <= rounding * std::abs(*left);
  };
  return std::ranges::any_of(
      std::array{"m", "rad", "1", "Pa", "s", "m/s", "rad/s", "1/s", "kg/m3", "Pa/m", "1/Pa", "J/m2"}, same);
}

/// Of two nodes that are not both tables or both arrays. 1 and 1.0 are the same.
bool same_value(const toml::node& a, const toml::node& b) {
  if (a.is_number() && b.is_number()) return a.value<double>() == b.value<double>();
  const toml::table left{{"x", a}}, right{{"x", b}};
  return left == right;
}

bool same_quantity_or_value(const toml::node& a, const toml::node& b) {
  return same_quantity(a, b) || same_value(a, b);
}

using Same = bool (*)(const toml::node&, const toml::node&);

std::string difference(const std::string& path, const toml::node* before, const toml::node* now, Same same);

std::string table_difference(const std::string& path, const toml::table& before, const toml::table& now, Same same) {
  std::set<std::string> keys;
  for (const toml::table* table : {&before, &now})
    for (auto&& [key, value] : *table) keys.emplace(key.str());
  for (const std::string& key : keys) {
    const std::string found = difference(path.empty() ? key : path + "." + key, before.get(key), now.get(key), same);
    if (!found.empty()) return found;
  }
  return {};
}

std::string array_difference(const std::string& path, const toml::array& before, const toml::array& now, Same same) {
  for (std::size_t i = 0; i < std::max(before.size(), now.size()); ++i) {
    const std::string found = difference(fmt::format("{} {}", path, i + 1), before.get(i), now.get(i), same);
    if (!found.empty()) return found;
  }
  return {};
}

/// Of a table that is only in one of both, the first key is named.
std::string difference(const std::string& path, const toml::node* before, const toml::node* now, Same same) {
  static const toml::table none;
  const auto has_keys = [](const toml::node* node) { return node && node->is_table() && !node->as_table()->empty(); };
  if (!before && has_keys(now)) before = &none;
  if (!now && has_keys(before)) now = &none;
  if (before && now && before->is_table() && now->is_table())
    return table_difference(path, *before->as_table(), *now->as_table(), same);
  if (before && now && before->is_array() && now->is_array())
    return array_difference(path, *before->as_array(), *now->as_array(), same);
  if (before && now && same(*before, *now)) return {};
  return fmt::format("'{}' was {}, now {}", path, shown(before), shown(now));
}

}  // namespace

std::string scene_difference(const std::string& before, const std::string& now) {
  return table_difference({}, significant(before), significant(now), same_value);
}

std::string start_difference(const std::string& before, const std::string& now) {
  return table_difference({}, of_bodies(before), of_bodies(now), same_quantity_or_value);
}

}  // namespace pliant
