#include "input/value.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/errors.hpp"
#include "scene/units.hpp"

namespace pliant {

void fail_at(const std::string& file, const toml::source_position& at, const std::string& message) {
  throw InputError(fmt::format("{}:{}:{}: {}", file, at.line, at.column, message));
}

void Value::fail(const std::string& message) const { fail_at(source.file, node.source().begin, message); }

void Value::warn(const std::string& message) const {
  const toml::source_position at = node.source().begin;
  source.warnings.push_back(
      fmt::format("{}:{}:{}: {}: found {}, {}", source.file, at.line, at.column, label, found(), message));
}

void Value::reject(const std::string& allowed) const {
  fail(fmt::format("{}: found {}; allowed: {}", label, found(), allowed));
}

std::vector<Value> Value::elements(const std::string& allowed) const {
  const toml::array* array = node.as_array();
  if (!array) reject(allowed);
  std::vector<Value> all;
  all.reserve(array->size());
  for (const toml::node& element : *array) {
    all.push_back({element, fmt::format("element {} of {}", all.size() + 1, label), source});
  }
  return all;
}

std::string Value::text(const std::string& allowed) const {
  const auto* string = node.as_string();
  if (!string) reject(allowed);
  return string->get();
}

std::string Value::found() const {
  constexpr std::size_t longest_shown = 60;
  if (const auto* text = node.as_string()) {
    const std::string& all = text->get();
    return all.size() <= longest_shown ? fmt::format("{:?}", all)
                                       : fmt::format("{:?}...", all.substr(0, longest_shown));
  }
  if (const auto* number = node.as_integer()) return fmt::format("the integer {}", number->get());
  if (const auto* number = node.as_floating_point()) return fmt::format("the number {:#}", number->get());
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  if (node.is_table()) return "a table";
  if (const auto* array = node.as_array()) return fmt::format("an array of {} elements", array->size());
  return "a date or time";
}

bool Range::contains(double x) const {
  const bool above = low_open ? x > low : x >= low;
  const bool below = high_open ? x < high : x <= high;
  return std::isfinite(x) && above && below;
}

std::string Range::text() const {
  const std::string from = std::isinf(low) ? "" : fmt::format("{} {}", low_open ? ">" : ">=", low);
  const std::string to = std::isinf(high) ? "" : fmt::format("{} {}", high_open ? "<" : "<=", high);
  if (from.empty() && to.empty()) return "any";
  return from.empty() || to.empty() ? from + to : from + " and " + to;
}

std::string Quantity::allowed() const {
  const std::string kind = unit == "1" ? "a number" : fmt::format("a quantity in {}", unit);
  return range.text() == "any" ? kind : fmt::format("{}, {}", kind, range.text());
}

namespace {

/// A quantity, whatever its range.
double read_number(const Value& value, const std::string& unit, const std::string& allowed) {
  if (const auto* text = value.node.as_string()) {
    try {
      return parse_quantity(text->get(), unit);
    } catch (const UnitError& error) {
      value.fail(fmt::format("{}: found {}, {}; allowed: {}", value.label, value.found(), error.what(), allowed));
    }
  }
  if (const auto* real = value.node.as_floating_point()) return real->get();
  if (const auto* integer = value.node.as_integer()) return static_cast<double>(integer->get());
  value.reject(allowed);
}

bool has_angle_unit(const Value& value) {
  const auto* text = value.node.as_string();
  return text && is_angle(text->get());
}

/// Of an angle that says no unit and is more than a turn.
std::string doubt_of_degrees(const Value& value, const std::string& unit, double number) {
  if (unit != "rad" || std::abs(number) <= 2 * std::numbers::pi || has_angle_unit(value)) return {};
  return fmt::format("which is read as radians; did you mean \"{:g} deg\"?", number);
}

}  // namespace

double Quantity::operator()(const Value& value) const {
  const double number = read_number(value, unit, allowed());
  const std::string doubt = doubt_of_degrees(value, unit, number);
  if (!range.contains(number)) {
    if (doubt.empty()) value.reject(allowed());
    value.fail(fmt::format("{}: found {}, {} allowed: {}", value.label, value.found(), doubt, allowed()));
  }
  if (!doubt.empty()) value.warn(doubt);
  return number;
}

double Friction::operator()(const Value& value) const {
  const bool angle = has_angle_unit(value);
  const double number = read_number(value, angle ? "rad" : "1", allowed());
  const Range steep{.low = 0, .high = std::numbers::pi / 2, .high_open = true};
  if (!(angle ? steep : non_negative).contains(number)) value.reject(allowed());
  constexpr double steepest = 2;  // 63 deg: beyond, a number that may be an angle is likelier one
  if (!angle && number > steepest && number < 90)
    value.warn(fmt::format("which is a coefficient, of {:.3g} deg; did you mean \"{:g} deg\"?",
                           std::atan(number) * 180 / std::numbers::pi, number));
  return angle ? std::tan(number) : number;
}

std::optional<double> QuantityOr::operator()(const Value& value) const {
  const auto* text = value.node.as_string();
  if (text && text->get() == keyword) return std::nullopt;
  if (!text && !value.node.is_number()) value.reject(allowed());
  if (text && edit_distance(text->get(), keyword) <= 1) value.reject(allowed());
  return quantity(value);
}

std::int64_t Integer::operator()(const Value& value) const {
  const auto* number = value.node.as_integer();
  if (!number || number->get() < low || number->get() > high) value.reject(allowed());
  return number->get();
}

bool Flag::operator()(const Value& value) const {
  const auto* flag = value.node.as_boolean();
  if (!flag) value.reject(allowed());
  return flag->get();
}

bool Identifier::valid(std::string_view name) {
  const auto in_names = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), in_names);
}

std::string Identifier::operator()(const Value& value) const {
  const std::string name = value.text(allowed());
  if (!valid(name)) value.reject(allowed());
  return name;
}

std::string OneOf::operator()(const Value& value) const {
  const std::string name = value.text(allowed());
  if (std::find(names.begin(), names.end(), name) != names.end()) return name;
  value.fail(fmt::format("{}: unknown {} {}; {}", value.label, what, value.found(), allowed_names(name, names)));
}

std::vector<std::string> Choice::all() const {
  std::vector<std::string> names;
  for (const auto& [name, entry] : entries) names.push_back(name);
  return names;
}

int Choice::operator()(const Value& value) const {
  const std::string name = OneOf{"name", all()}(value);
  return std::ranges::find(entries, name, &std::pair<std::string, int>::first)->second;
}

Vec2 Vector::operator()(const Value& value) const {
  const std::vector<Value> parts = value.elements(allowed());
  if (parts.size() != 2) value.reject(allowed());
  const Quantity component{unit};
  return {component(parts[0]), component(parts[1])};
}

Eigen::Matrix2d Matrix::operator()(const Value& value) const {
  const std::vector<Value> rows = value.elements(allowed());
  if (rows.size() != 2) value.reject(allowed());
  // Read first: Eigen's comma initializer aborts when an exception leaves it half done.
  const Vec2 first = Vector{unit}(rows[0]), second = Vector{unit}(rows[1]);
  Eigen::Matrix2d matrix;
  matrix << first.transpose(), second.transpose();
  return matrix;
}

ProbeBox Corners::operator()(const Value& value) const {
  const auto points = List<Vector>{Vector{"m"}, 2, 2}(value);
  if (points[0].x() < points[1].x() && points[0].y() < points[1].y()) return {points[0], points[1]};
  value.reject(allowed());
}

History HistoryOf::operator()(const Value& value) const {
  if (!value.node.is_array()) {
    if (!value.node.is_string() && !value.node.is_number()) value.reject(allowed());
    return {{0.0}, {quantity(value)}};
  }
  History history;
  for_each_history_entry(value, allowed(), [&](double time, const Value& entry) {
    history.time.push_back(time);
    history.value.push_back(quantity(entry));
  });
  return history;
}

std::vector<History> VectorHistory::operator()(const Value& value) const {
  std::vector<History> histories(2);
  for_each_history_entry(value, allowed(), [&](double time, const Value& entry) {
    const Vec2 vector = Vector{unit}(entry);
    for (int c = 0; c < 2; ++c) {
      histories[c].time.push_back(time);
      histories[c].value.push_back(vector[c]);
    }
  });
  return histories;
}

Quantity within(Quantity kind, const Range& range) {
  kind.range = range;
  return kind;
}

Integer within(Integer kind, Least least) { return {least.value, kind.high}; }

OneOf within(const OneOf& kind, const std::vector<std::string>& names) { return {kind.what, names}; }

List<OneOf> within(List<OneOf> kind, const std::vector<std::string>& names) {
  kind.element.names = names;
  return kind;
}

List<Quantity> within(List<Quantity> kind, Count count) {
  kind.least = kind.most = count.value;
  return kind;
}

Choice within(const Choice& kind, const std::vector<std::string>& names) {
  Choice some{{}, kind.type};
  for (const std::string& name : names)
    some.entries.push_back(*std::ranges::find(kind.entries, name, &std::pair<std::string, int>::first));
  return some;
}

}  // namespace pliant
