#include "geometry/columns.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scene/units.hpp"

namespace pliant {

namespace {

constexpr std::string_view separators = ",;\t";

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Blanks part columns, but not a name from its unit.
std::vector<std::string_view> fields_between_blanks(std::string_view line) {
  std::vector<std::string_view> fields;
  bool within = false;
  for (const std::string_view field : fields_of(line, ' ')) {
    if (!fields.empty() && (within || field.starts_with('[')))
      fields.back() = {fields.back().data(), field.data() + field.size()};
    else
      fields.push_back(field);
    const std::string_view whole = fields.back();
    within = whole.find('[') != std::string_view::npos && !whole.ends_with(']');
  }
  return fields;
}

std::vector<std::string_view> split(std::string_view line) {
  line = trimmed(line);
  for (const char separator : separators)
    if (line.find(separator) != std::string_view::npos) return fields_of(line, separator);
  return fields_between_blanks(line);
}

/// "0,5": a number once its one comma, between digits, is a point.
bool has_decimal_comma(std::string_view field) {
  const auto comma = field.find(',');
  if (comma == std::string_view::npos || comma == 0 || comma + 1 == field.size()) return false;
  if (!is_digit(field[comma - 1]) || !is_digit(field[comma + 1])) return false;
  std::string number(field);
  number[comma] = '.';
  double value = 0;
  return parse_number(number, value);
}

/// Several numbers between other separators, at least one with a decimal comma.
bool has_decimal_commas(std::string_view line) {
  if (line.find(',') == std::string_view::npos) return false;
  for (const char separator : {';', '\t', ' '}) {
    const std::vector<std::string_view> fields = fields_of(line, separator);
    const auto is_number = [](std::string_view field) {
      double value = 0;
      return has_decimal_comma(field) || parse_number(field, value);
    };
    if (fields.size() > 1 && std::ranges::all_of(fields, is_number) && std::ranges::any_of(fields, has_decimal_comma))
      return true;
  }
  return false;
}

bool is_unit(const std::string& text) {
  for (const char* kind : {"m", "rad"}) try {
      parse_quantity("1 " + text, kind);
      return true;
    } catch (const UnitError&) {
    }
  return false;
}

/// "x (mm)", "x_mm" and "x/mm" as "x [mm]"; nullopt: the field is none of these.
std::optional<ColumnName> misplaced_unit(std::string_view field) {
  const auto end = std::ranges::find_if_not(field, is_letter) - field.begin();
  const std::string_view name = field.substr(0, static_cast<std::size_t>(end));
  std::string_view rest = trimmed(field.substr(name.size()));
  if (name.empty() || rest.empty()) return {};
  const bool enclosed = rest.starts_with('(') && rest.ends_with(')');
  if (!enclosed && !rest.starts_with('_') && !rest.starts_with('/')) return {};
  rest = rest.substr(1, rest.size() - (enclosed ? 2 : 1));
  if (rest.empty() || !is_unit(std::string(rest))) return {};
  return ColumnName{column_name(name).name, std::string(rest)};
}

}  // namespace

std::vector<std::string_view> columns_of(const LineReader& reader) {
  const std::string_view line = trimmed(reader.line().substr(0, reader.line().find('#')));
  if (has_decimal_commas(line))
    reader.fail(fmt::format("found \"{}\", numbers with a decimal comma; allowed: a decimal point, as in 0.5", line));
  return split(line);
}

ColumnName column_name(std::string_view field) {
  const auto open = field.find('[');
  const bool bracketed = open != std::string_view::npos && field.ends_with(']');
  ColumnName column{std::string(bracketed ? trimmed(field.substr(0, open)) : field), {}};
  for (char& c : column.name) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c | 0x20) : c;
  if (bracketed) column.unit = field.substr(open + 1, field.size() - open - 2);
  return column;
}

std::string unit_hint(std::string_view field) {
  const std::optional<ColumnName> meant = misplaced_unit(field);
  return meant ? fmt::format("; a unit stands in brackets: write \"{} [{}]\"", meant->name, *meant->unit) : "";
}

void CommentedNames::look_at(const LineReader& reader, const std::vector<std::string>& names) {
  if (!reader.line().starts_with('#')) return;
  CommentedNames found;
  found.line_ = reader;
  std::vector<std::string> columns;
  for (const std::string_view field : found.fields())
    columns.push_back(misplaced_unit(field).value_or(column_name(field)).name);
  const auto is_there = [](const std::vector<std::string>& list) {
    return [&list](const std::string& name) { return std::ranges::find(list, name) != list.end(); };
  };
  if (!std::ranges::all_of(columns, is_there(names)) || !is_there(columns)("x") || !is_there(columns)("y")) return;
  line_ = found.line_;
}

std::vector<std::string_view> CommentedNames::fields() const {
  const std::string_view line = line_->line();
  const auto begin = line.find_first_not_of('#');
  return begin == std::string_view::npos ? std::vector<std::string_view>{} : split(line.substr(begin));
}

}  // namespace pliant
