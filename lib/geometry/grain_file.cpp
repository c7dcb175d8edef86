#include "geometry/grain_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/errors.hpp"
#include "geometry/columns.hpp"
#include "geometry/length_limits.hpp"
#include "scene/names.hpp"
#include "scene/units.hpp"

namespace pliant {

namespace {

/// What a column may hold.
struct ColumnKind {
  std::string name, unit;
  bool positive = false;
};
const std::vector<ColumnKind> column_kinds{
    {"x", "m"}, {"y", "m"}, {"scale", "1", true}, {"diameter", "m", true}, {"radius", "m", true}, {"angle", "rad"}};

struct Column {
  ColumnKind kind;
  double factor = 1;   ///< from the file to SI units
  bool plain = false;  ///< the file does not say its unit
  std::vector<double> values{};
};

std::vector<std::string> names_of_columns() {
  std::vector<std::string> names;
  for (const ColumnKind& one : column_kinds) names.push_back(one.name);
  return names;
}

class GrainReader {
 public:
  GrainReader(const std::string& file, const std::string& text, const std::string& unit, std::size_t most)
      : reader_(file, text), unit_(unit), most_(most) {}

  GrainFile read() {
    while (reader_.next()) {
      if (columns_.empty()) commented_.look_at(reader_, names_of_columns());
      const std::vector<std::string_view> fields = columns_of(reader_);
      if (fields.empty()) continue;
      double number = 0;
      if (!columns_.empty() || parse_number(fields[0], number)) {
        if (columns_.empty() && commented_.line())
          read_names(*commented_.line(), commented_.fields());
        else if (columns_.empty())
          take_two_columns(fields);
        add_grain(fields);
      } else {
        read_names(reader_, fields);
      }
    }
    if (lines_.empty())
      fail_at_line(reader_.file(), std::max(1, reader_.number()), "no grains; allowed: at least one line of numbers");
    return finish();
  }

 private:
  /// What a column without a unit of its own is in.
  double plain_factor(const ColumnKind& kind) const {
    return kind.unit == "m" && !unit_.empty() ? parse_quantity("1 " + unit_, "m") : 1;
  }

  void take_two_columns(const std::vector<std::string_view>& fields) {
    if (fields.size() != 2)
      reader_.fail(
          fmt::format("found {} columns without names; allowed: two, x and y, or a first line such as "
                      "\"x [mm], y [mm], diameter [mm], angle [deg]\"",
                      fields.size()));
    for (const int i : {0, 1}) columns_.push_back({column_kinds[i], plain_factor(column_kinds[i]), true});
  }

  void read_names(const LineReader& at, const std::vector<std::string_view>& fields) {
    for (const std::string_view field : fields) columns_.push_back(column_of(at, field));
    for (const char* needed : {"x", "y"})
      if (!column(needed)) at.fail(fmt::format("no column {}; allowed: x and y at least", needed));
    if ((column("scale") != nullptr) + (column("diameter") != nullptr) + (column("radius") != nullptr) > 1)
      at.fail("several columns of sizes; allowed: one of scale, diameter and radius");
  }

  Column column_of(const LineReader& at, std::string_view field) const {
    const ColumnName found = column_name(field);
    const auto kind = std::find_if(column_kinds.begin(), column_kinds.end(),
                                   [&](const ColumnKind& one) { return one.name == found.name; });
    if (kind == column_kinds.end())
      at.fail(fmt::format("unknown column \"{}\"; {}{}", found.name, allowed_names(found.name, names_of_columns()),
                          unit_hint(field)));
    if (column(found.name)) at.fail(fmt::format("a second column {}; allowed: one", found.name));
    if (!found.unit) return {*kind, plain_factor(*kind), true};
    if (kind->unit == "m" && !unit_.empty())
      at.fail(fmt::format("column {} has a unit, and the scene gives '{}' too; remove one", found.name, unit_));
    try {
      return {*kind, parse_quantity("1 " + *found.unit, kind->unit)};
    } catch (const UnitError& error) {
      at.fail(fmt::format("column {}: {}; allowed: {}", found.name, error.what(),
                          kind->unit == "1" ? "none, it is a factor" : "a unit such as " + kind->unit));
    }
  }

  void add_grain(const std::vector<std::string_view>& fields) {
    if (fields.size() != columns_.size())
      reader_.fail(
          fmt::format("found {} columns; allowed: {}, as in the lines before", fields.size(), columns_.size()));
    if (lines_.size() == most_) reader_.fail(fmt::format("more grains; allowed: at most {}", most_));
    for (std::size_t c = 0; c < fields.size(); ++c) {
      double value = 0;
      const ColumnKind& kind = columns_[c].kind;
      const bool number = parse_number(fields[c], value);
      value *= columns_[c].factor;
      if (!number || !std::isfinite(value) || (kind.positive && !(value > 0)))
        reader_.fail(fmt::format("column {}: found \"{}\"; allowed: a number{}", kind.name, fields[c],
                                 kind.positive ? " > 0" : ""));
      check_size(kind, fields[c], value);
      doubt_degrees(columns_[c], value);
      columns_[c].values.push_back(value);
    }
    lines_.push_back(reader_.number());
  }

  void check_size(const ColumnKind& kind, std::string_view found, double value) const {
    const double size = std::abs(value);
    if (kind.unit == "rad" || (size <= largest_length && (!kind.positive || size >= 1 / largest_length))) return;
    reader_.fail(fmt::format("column {}: found \"{}\", {:.3g} {}; allowed: at most {:g}{}", kind.name, found, value,
                             kind.unit == "m" ? "m" : "times the shape", largest_length,
                             kind.positive ? fmt::format(", at least {:g}", 1 / largest_length) : " either way"));
  }

  /// Once a file.
  void doubt_degrees(const Column& column, double value) {
    if (column.kind.unit != "rad" || !column.plain || std::abs(value) <= 2 * std::numbers::pi || !doubt_.empty())
      return;
    doubt_ = fmt::format(
        "{}:{}: column angle: found {:g}, which is read as radians; did you mean the column's name "
        "to be \"angle [deg]\"?",
        reader_.file(), reader_.number(), value);
  }

  const Column* column(std::string_view name) const {
    const auto found =
        std::find_if(columns_.begin(), columns_.end(), [&](const Column& one) { return one.kind.name == name; });
    return found == columns_.end() ? nullptr : &*found;
  }

  std::vector<double> values(std::string_view name, double factor = 1) const {
    const Column* found = column(name);
    std::vector<double> result = found ? found->values : std::vector<double>{};
    for (double& value : result) value *= factor;
    return result;
  }

  GrainFile finish() const {
    GrainFile grains;
    const std::vector<double> x = values("x"), y = values("y");
    for (std::size_t i = 0; i < x.size(); ++i) grains.positions.emplace_back(x[i], y[i]);
    grains.scales = values("scale");
    grains.diameters = column("radius") ? values("radius", 2) : values("diameter");
    grains.angles = values("angle");
    grains.lines = lines_;
    grains.doubt = doubt_;
    return grains;
  }

  LineReader reader_;
  CommentedNames commented_;
  std::string unit_, doubt_;
  std::size_t most_;
  std::vector<Column> columns_;
  std::vector<int> lines_;
};

}  // namespace

GrainFile read_grain_file(const std::filesystem::path& file, const std::string& unit, std::size_t most_grains) {
  const std::string text = read_text_file(file, "a table of grains (.csv)");
  return GrainReader(file.string(), text, unit, most_grains).read();
}

}  // namespace pliant
