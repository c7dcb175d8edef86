#include "scene/table_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace pliant {

namespace {

bool earlier(const toml::source_position& a, const toml::source_position& b) {
  return std::pair(a.line, a.column) < std::pair(b.line, b.column);
}

}  // namespace

bool TableReader::has(const std::string& key) {
  if (!is_scene_key(key)) throw std::logic_error(fmt::format("'{}' is missing in is_scene_key", key));
  known_.insert(key);
  if (schema_) schema_->asked(number_, key, table_->contains(key));
  return table_->contains(key);
}

Value TableReader::value(const std::string& key) {
  known_.insert(key);
  return {*table_->get(key), fmt::format("'{}' in {}", key, title_), *source_};
}

TableReader TableReader::required_table(const std::string& key) {
  if (!has(key)) fail_missing(key, fmt::format("a table [{}]", key));
  return optional_table(key);
}

TableReader TableReader::optional_table(const std::string& key) {
  static const toml::table empty;
  note_tables(key, "a table");
  if (!has(key)) return child(empty, key);
  const Value found = value(key);
  if (!found.node.is_table()) found.reject("a table");
  return child(*found.node.as_table(), key);
}

TableReader TableReader::child(const toml::table& table, const std::string& key) const {
  const bool at_the_top = pattern_ == top_pattern;
  return {table, child_title(key), *source_, schema_,
          at_the_top ? fmt::format("[{}]", key) : fmt::format("{} of {}", key, pattern_)};
}

void TableReader::note_tables(const std::string& key, const char* allowed) {
  if (schema_) schema_->note(number_, key, {SceneSchema::table_type, allowed, {}, false});
}

std::vector<std::pair<std::string, TableReader>> TableReader::named_tables(const std::string& key) {
  note_tables(key, "tables, each with a name");
  if (!has(key)) return {};
  const Value all = value(key);
  if (!all.node.is_table()) all.reject(fmt::format("tables [{}.NAME]", key));
  std::vector<std::pair<std::string, TableReader>> named;
  for (auto&& [name, node] : *all.node.as_table()) {
    const Value one{node, fmt::format("'{}.{}'", key, name.str()), *source_};
    if (!node.is_table()) one.reject("a table");
    if (!Identifier::valid(name.str())) one.fail(fmt::format("{}: allowed: {}", one.label, Identifier{}.allowed()));
    named.emplace_back(name.str(), TableReader(*node.as_table(), fmt::format("[{}.{}]", key, name.str()), *source_,
                                               schema_, fmt::format("[{}.NAME]", key)));
  }
  std::stable_sort(named.begin(), named.end(), [](const auto& a, const auto& b) {
    return earlier(a.second.table_->source().begin, b.second.table_->source().begin);
  });
  return named;
}

std::vector<TableReader> TableReader::tables(const std::string& key) {
  note_tables(key, "an array of tables");
  if (!has(key)) return {};
  const std::string allowed = fmt::format("an array of tables [[{}]]", key);
  std::vector<TableReader> all;
  for (const Value& element : value(key).elements(allowed)) {
    if (!element.node.is_table()) element.reject("a table");
    const auto number = all.size() + 1;
    const std::string title =
        nested() ? fmt::format("{} {} of {}", key, number, title_) : fmt::format("[[{}]] {}", key, number);
    all.emplace_back(*element.node.as_table(), title, *source_, schema_,
                     nested() ? fmt::format("{} of {}", key, pattern_) : fmt::format("[[{}]]", key));
  }
  return all;
}

std::string TableReader::child_title(const std::string& key) const {
  return nested() ? fmt::format("{} of {}", key, title_) : fmt::format("[{}]", key);
}

std::string TableReader::place() const {
  return fmt::format("{}:{}:{}", source_->file, table_->source().begin.line, table_->source().begin.column);
}

void TableReader::fail(const std::string& message) const { fail_at(source_->file, table_->source().begin, message); }

void TableReader::fail(const std::string& key, const std::string& message) const {
  fail_at(source_->file, table_->get(key)->source().begin, fmt::format("'{}' in {}: {}", key, title_, message));
}

const toml::key* TableReader::misspelling_of(const std::string& key) const {
  const toml::key* likeliest = nullptr;
  int least = 0;
  for (const toml::key* other : unknown_keys()) {
    const int distance = edit_distance(other->str(), key);
    // Most keys of the table have not been asked for yet: a name that some table knows is suspect only if it is close.
    if (is_scene_key(other->str()) && distance > std::max(1, static_cast<int>(key.size()) / 3)) continue;
    if (likeliest && distance >= least) continue;
    likeliest = other;
    least = distance;
  }
  return likeliest;
}

void TableReader::fail_missing(const std::string& key, const std::string& allowed) const {
  const toml::key* culprit = misspelling_of(key);
  if (!culprit) fail(fmt::format("missing key '{}' in {}: add {}", key, title_, allowed));
  fail_at(source_->file, culprit->source().begin,
          fmt::format("unknown key '{}' in {}, perhaps meant as '{}', which is missing: give {}", culprit->str(),
                      title_, key, allowed));
}

std::vector<const toml::key*> TableReader::unknown_keys() const {
  std::vector<const toml::key*> unknown;
  for (auto&& [key, node] : *table_) {
    if (!known_.contains(std::string(key.str()))) unknown.push_back(&key);
  }
  std::sort(unknown.begin(), unknown.end(),
            [](const toml::key* a, const toml::key* b) { return earlier(a->source().begin, b->source().begin); });
  return unknown;
}

void TableReader::finish() const {
  const auto unknown = unknown_keys();
  if (unknown.empty()) return;
  const toml::key& first = *unknown.front();
  fail_at(source_->file, first.source().begin,
          fmt::format("unknown key '{}' in {}; {}", first.str(), title_,
                      allowed_names(first.str(), {known_.begin(), known_.end()})));
}

}  // namespace pliant
