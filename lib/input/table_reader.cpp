#include "input/table_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace pliant {

namespace {

bool earlier(const toml::source_position& a, const toml::source_position& b) {
  return std::pair(a.line, a.column) < std::pair(b.line, b.column);
}

}  // namespace

const SceneKey& TableReader::row_of(const std::string& key, bool must, bool (*serves)(const KeyKind&)) {
  for (const SceneKey& row : rows_->keys) {
    if (row.name != key || !serves(row.kind) || !holds(row).value_or(true)) continue;
    const bool agrees = must ? !row.otherwise.required.empty() : !row.otherwise.value.empty();
    if (!agrees) throw std::logic_error(fmt::format("the row of '{}' says otherwise of its default", key));
    asked_.insert(&row);
    if (source_->use) source_->use->emplace(&row, must);
    return row;
  }
  throw std::logic_error(fmt::format("no row of {} is for '{}' here, read into this field", rows_->title, key));
}

void TableReader::check_default(const SceneKey& row, const std::string& value) const {
  if (row.otherwise.derived || row.otherwise.value == value) return;
  throw std::logic_error(
      fmt::format("the default of '{}' in {} is {}, not {}", row.name, rows_->title, value, row.otherwise.value));
}

std::optional<bool> TableReader::holds(const SceneKey& row) const {
  const std::string& with = row.with;
  if (std::ranges::find(rows_->keys, with, &SceneKey::name) != rows_->keys.end()) return table_->contains(with);
  const std::size_t names = with.find("= \"");
  if (names == with.npos) return std::nullopt;
  const auto chosen = chosen_.find(with.substr(0, with.find(' ')));
  return chosen != chosen_.end() && (with.find(chosen->second) != with.npos) != (with[names - 1] == '!');
}

bool TableReader::has(const std::string& key) {
  if (std::ranges::find(rows_->keys, key, &SceneKey::name) == rows_->keys.end())
    throw std::logic_error(fmt::format("{} has no row for '{}'", rows_->title, key));
  known_.insert(key);
  return table_->contains(key);
}

Value TableReader::value(const std::string& key) {
  known_.insert(key);
  return {*table_->get(key), fmt::format("'{}' in {}", key, title_), *source_};
}

const SceneKey& TableReader::row_of_tables(const std::string& key, SubTable::Form form) {
  for (const SceneKey& row : rows_->keys) {
    const auto* tables = std::get_if<SubTable>(&row.kind);
    if (row.name != key || !tables || tables->form != form) continue;
    asked_.insert(&row);
    if (source_->use) source_->use->emplace(&row, !row.otherwise.required.empty());
    return row;
  }
  throw std::logic_error(fmt::format("no row of {} is for tables '{}'", rows_->title, key));
}

TableReader TableReader::required_table(const std::string& key) {
  if (!has(key)) fail_missing(key, fmt::format("a table [{}]", key));
  return optional_table(key);
}

TableReader TableReader::optional_table(const std::string& key) {
  static const toml::table empty;
  const SceneTable& rows = sub_table(*rows_, row_of_tables(key, SubTable::Form::one));
  const std::string title = nested() ? fmt::format("{} of {}", key, title_) : fmt::format("[{}]", key);
  if (!has(key)) return {empty, title, *source_, rows};
  const Value found = value(key);
  if (!found.node.is_table()) found.reject("a table");
  return {*found.node.as_table(), title, *source_, rows};
}

std::vector<std::pair<std::string, TableReader>> TableReader::named_tables(const std::string& key) {
  const SceneTable& rows = sub_table(*rows_, row_of_tables(key, SubTable::Form::named));
  if (!has(key)) fail_missing(key, fmt::format("at least one table [{}.NAME]", key));
  const Value all = value(key);
  if (!all.node.is_table()) all.reject(fmt::format("tables [{}.NAME]", key));
  std::vector<std::pair<std::string, TableReader>> named;
  for (auto&& [name, node] : *all.node.as_table()) {
    const Value one{node, fmt::format("'{}.{}'", key, name.str()), *source_};
    if (!node.is_table()) one.reject("a table");
    if (!Identifier::valid(name.str())) one.fail(fmt::format("{}: allowed: {}", one.label, Identifier{}.allowed()));
    const std::string title = fmt::format("[{}.{}]", key, name.str());
    named.emplace_back(name.str(), TableReader(*node.as_table(), title, *source_, rows));
  }
  std::stable_sort(named.begin(), named.end(), [](const auto& a, const auto& b) {
    return earlier(a.second.table_->source().begin, b.second.table_->source().begin);
  });
  return named;
}

std::vector<TableReader> TableReader::tables(const std::string& key) {
  const SceneKey& row = row_of_tables(key, SubTable::Form::array);
  if (!has(key)) {
    if (row.otherwise.value.empty()) fail_missing(key, fmt::format("at least one table [[{}]]", key));
    return {};
  }
  const SceneTable& rows = sub_table(*rows_, row);
  const std::string allowed = fmt::format("an array of tables [[{}]]", key);
  std::vector<TableReader> all;
  for (const Value& element : value(key).elements(allowed)) {
    if (!element.node.is_table()) element.reject("a table");
    const auto number = all.size() + 1;
    const std::string title =
        nested() ? fmt::format("{} {} of {}", key, number, title_) : fmt::format("[[{}]] {}", key, number);
    all.push_back(TableReader(*element.node.as_table(), title, *source_, rows));
  }
  return all;
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
  if (unknown.empty()) return check_conditions();
  const toml::key& first = *unknown.front();
  fail_at(source_->file, first.source().begin,
          fmt::format("unknown key '{}' in {}; {}", first.str(), title_,
                      allowed_names(first.str(), {known_.begin(), known_.end()})));
}

void TableReader::check_conditions() const {
  const auto read = [&](const SceneKey& row) {
    return std::ranges::any_of(asked_, [&](const SceneKey* other) { return other->name == row.name; });
  };
  for (const SceneKey& row : rows_->keys) {
    const bool with = holds(row).value_or(asked_.contains(&row));
    if (with ? !read(row) && holds(row) : asked_.contains(&row))
      throw std::logic_error(fmt::format("'{}' in {}: whether it is read is not as the row says, with {}", row.name,
                                         rows_->title, row.with));
  }
}

}  // namespace pliant
