#include "geometry/outline_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/errors.hpp"
#include "geometry/columns.hpp"
#include "geometry/length_limits.hpp"
#include "geometry/polygon_rules.hpp"
#include "scene/units.hpp"

namespace pliant {

namespace {

/// "x [mm]" or "x": the unit in m, 0 where there is none.
double column_unit(const LineReader& reader, std::string_view field, const char* name) {
  const ColumnName column = column_name(field);
  if (column.name != name)
    reader.fail(
        fmt::format("found \"{}\"; allowed: two numbers, or in the first line the names of the columns, "
                    "\"x, y\" or \"x [mm], y [mm]\"{}",
                    reader.line(), unit_hint(field)));
  if (!column.unit) return 0;
  try {
    return parse_quantity("1 " + *column.unit, "m");
  } catch (const UnitError& error) {
    reader.fail(fmt::format("column {}: {}; allowed: a unit of length", name, error.what()));
  }
}

double header_unit(const LineReader& reader, const std::vector<std::string_view>& fields) {
  if (fields.size() != 2) reader.fail(fmt::format("found {} columns; allowed: two, x and y", fields.size()));
  const double x = column_unit(reader, fields[0], "x"), y = column_unit(reader, fields[1], "y");
  if (x != y) reader.fail("the columns have different units; allowed: one unit for both");
  return x;
}

Vec2 point_of(const LineReader& reader, const std::vector<std::string_view>& fields) {
  Vec2 point;
  if (fields.size() != 2 || !parse_number(fields[0], point.x()) || !parse_number(fields[1], point.y()))
    reader.fail(fmt::format("found \"{}\"; allowed: two numbers, x and y", reader.line()));
  return point;
}

/// The points of one loop: where it closes it must end.
void add_csv_point(const LineReader& reader, FilePoints& found, const Vec2& point) {
  const std::size_t n = found.points.size();
  if (n >= 2 && found.points.back() == found.points.front())
    reader.fail(
        fmt::format("a point behind line {}, where the outline comes back to its first point; allowed: one "
                    "outline a file, no holes",
                    found.lines.back()));
  found.points.push_back(point);
  found.lines.push_back(reader.number());
}

/// One unit: that of the file or that of the scene.
double unit_of(const std::string& file, const FilePoints& found, const std::string& unit) {
  if (found.unit > 0 && !unit.empty())
    throw InputError(fmt::format("{}: its columns have a unit, and the scene gives '{}' too; remove one", file, unit));
  if (found.unit > 0) return found.unit;
  return unit.empty() ? 1 : parse_quantity("1 " + unit, "m");
}

void require_outline(const std::string& file, const FilePoints& found, std::size_t most_points) {
  const std::size_t n = found.points.size();
  if (n < 3)
    fail_at_line(file, n == 0 ? 1 : found.lines.back(), fmt::format("an outline of {} points; allowed: at least 3", n));
  if (n > most_points)
    fail_at_line(file, found.lines[most_points],
                 fmt::format("an outline of {} points; allowed: at most {}", n, most_points));
  const PolygonDefect defect = polygon_defect(found.points);
  if (!defect.text.empty())
    fail_at_line(file, found.lines[defect.point],
                 defect.text + "; allowed: a closed outline that does not cross or touch itself");
}

void refuse_far(const std::string& file, const FilePoints& found, double scale) {
  for (std::size_t i = 0; i < found.points.size(); ++i)
    if (found.points[i].cwiseAbs().maxCoeff() > largest_length / scale)
      fail_at_line(file, found.lines[i],
                   fmt::format("the point ({:g}, {:g}) is out of range; allowed: coordinates of at most {:g} m either "
                               "way",
                               found.points[i].x(), found.points[i].y(), largest_length));
}

FilePoints file_points_without_repeats(const FilePoints& whole) {
  FilePoints result;
  result.unit = whole.unit;
  for (const std::size_t i : without_repeats(whole.points)) {
    result.points.push_back(whole.points[i]);
    result.lines.push_back(whole.lines[i]);
  }
  return result;
}

}  // namespace

FilePoints read_csv_outline(const std::string& file, const std::string& text) {
  LineReader reader(file, text);
  FilePoints found;
  CommentedNames commented;
  bool first = true;
  while (reader.next()) {
    if (first) commented.look_at(reader, {"x", "y"});
    const std::vector<std::string_view> fields = columns_of(reader);
    if (fields.empty()) continue;
    double number = 0;
    const bool header = first && !parse_number(fields[0], number);
    if (first && !header && commented.line()) found.unit = header_unit(*commented.line(), commented.fields());
    if (header)
      found.unit = header_unit(reader, fields);
    else
      add_csv_point(reader, found, point_of(reader, fields));
    first = false;
  }
  return found;
}

std::vector<Points> read_outline_file(const std::filesystem::path& file, const std::string& unit,
                                      const std::string& parts, std::size_t most_points) {
  const std::string name = file.string();
  const std::string text = read_text_file(file, "an outline (.csv or .msh)");
  const bool gmsh = file.extension() == ".msh";
  if (!gmsh && !parts.empty()) throw PartsError(fmt::format("{}: has no parts; allowed: those of a .msh file", name));
  const std::vector<FilePoints> found =
      gmsh ? read_gmsh_outlines(name, text, parts) : std::vector<FilePoints>{read_csv_outline(name, text)};
  std::vector<Points> outlines;
  for (const FilePoints& whole : found) {
    const double scale = unit_of(name, whole, unit);
    refuse_far(name, whole, scale);
    const FilePoints one = file_points_without_repeats(whole);
    require_outline(name, one, most_points);
    Points outline = one.points;
    for (Vec2& p : outline) p *= scale;
    if (signed_area(outline) < 0) std::reverse(outline.begin(), outline.end());
    outlines.push_back(std::move(outline));
  }
  return outlines;
}

}  // namespace pliant
