#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/curves.hpp"
#include "geometry/length_limits.hpp"
#include "geometry/outline_file.hpp"
#include "geometry/polygon_rules.hpp"
#include "input/read_tables.hpp"
#include "scene/units.hpp"

namespace pliant {

namespace {

void read_polygon(TableReader& table, ShapeSpec& shape) {
  shape.in_place = true;
  table.required("points", shape.points);
  for (std::size_t i = 0; i < shape.points.size(); ++i)
    if (shape.points[i].cwiseAbs().maxCoeff() > largest_length)
      table.fail("points", fmt::format("point {} is out of range; allowed: coordinates of at most {:g} m either way",
                                       i + 1, largest_length));
  Points points;
  for (const std::size_t i : without_repeats(shape.points)) points.push_back(shape.points[i]);
  shape.points = std::move(points);
  if (shape.points.size() < 3) table.fail("points", "fewer than three that differ by more than 1e-6 of their extent");
  const std::string defect = polygon_defect(shape.points).text;
  if (!defect.empty()) table.fail("points", defect + "; allowed: a closed outline that does not cross or touch itself");
  if (signed_area(shape.points) < 0) std::reverse(shape.points.begin(), shape.points.end());
}

void read_regular(TableReader& table, ShapeSpec& shape) {
  int sides = 0;
  table.required("diameter", shape.diameter);
  table.required("sides", sides);
  shape.points = regular_polygon(sides, shape.diameter);
}

/// Arcs for corners: the outline is a smooth curve then.
void read_rounding(TableReader& table, ShapeSpec& shape) {
  std::optional<double> radius;
  if (!table.optional("rounding", radius)) return;
  const Points rounded = rounded_polygon(shape.points, *radius);
  if (rounded.empty())
    table.value("rounding")
        .reject(fmt::format("a radius that fits all corners, at most {:.6g} m", largest_rounding(shape.points)));
  shape.points = rounded;
  shape.kind = ShapeKind::curve;
}

void read_ellipse(TableReader& table, ShapeSpec& shape) {
  double width = 0, height = 0;
  table.required("width", width);
  table.required("height", height);
  shape.points = ellipse(width, height);
}

void require_length_unit(TableReader& table, const std::string& unit) {
  try {
    if (parse_quantity("1 " + unit, "m") > 0) return;
  } catch (const UnitError&) {
  }
  table.value("unit").reject("a unit of length, such as \"mm\"");
}

/// A family of several shapes: the n-th is called NAME.n.
void name_member(ShapeSpec& shape, std::size_t n) {
  shape.family = shape.name;
  shape.name = fmt::format("{}.{}", shape.family, n);
}

/// The outlines' own size, or that of the circle of a given diameter.
std::vector<ShapeSpec> read_file(TableReader& table, ShapeSpec shape) {
  const NamedFile file = read_named_file(table);
  std::string parts;
  if (table.optional("parts", parts) && parts.empty())
    table.value("parts").reject("\"all\", \"merged\", or the name of a part or of a physical group");
  const std::vector<Points> outlines = [&] {
    try {
      return read_outline_file(file.path, file.unit, parts, SceneLimits::polygon_points);
    } catch (const PartsError& error) {
      table.fail("parts", error.what());
    }
  }();
  shape.in_place = !table.optional("diameter", shape.diameter);
  table.optional("outline", shape.kind);
  if (outlines.size() > static_cast<std::size_t>(SceneLimits::variants))
    table.fail("parts", fmt::format("{} parts; allowed: at most {}", outlines.size(), SceneLimits::variants));
  if (outlines.size() > 1 && !shape.in_place)
    table.fail("diameter", fmt::format("the file gives {} parts; allowed: for a single outline", outlines.size()));
  std::vector<ShapeSpec> shapes(outlines.size(), shape);
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    shapes[i].points = outlines[i];
    if (!shape.in_place)
      shapes[i].points = scaled_to_area(outlines[i], std::numbers::pi / 4 * shape.diameter * shape.diameter);
    if (parts == "all" || shapes.size() > 1) name_member(shapes[i], i + 1);
  }
  return shapes;
}

/// Seeds of the variants of a Fourier grain; one that is fitted to each cell has the descriptors instead.
struct Variants {
  std::vector<double> descriptors;
  std::int64_t seed = 1;
  std::optional<int> count;  ///< of a family, be it of one
};

Variants read_variants(TableReader& table, ShapeSpec& shape) {
  Variants variants;
  table.required("diameter", shape.diameter);
  table.required("descriptors", variants.descriptors);
  table.optional("seed", variants.seed);
  if (!table.has("variants") || !table.value("variants").node.is_string()) {
    table.optional("variants", variants.count);
    return variants;
  }
  const Value value = table.value("variants");
  if (value.text("") != "each")
    value.reject(fmt::format("an integer from 1 to {}, or \"each\"", SceneLimits::variants));
  std::optional<Variant> each;
  table.optional("variants", each);
  shape.descriptors = variants.descriptors;
  return variants;
}

/// Shapes from the seeds seed, seed + 1, ...: they differ in nothing else.
std::vector<ShapeSpec> make_variants(const TableReader& table, const ShapeSpec& shape, const Variants& variants) {
  std::vector<ShapeSpec> shapes(static_cast<std::size_t>(variants.count.value_or(1)), shape);
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    shapes[i].points =
        fourier_grain(shape.diameter, variants.descriptors, variants.seed + static_cast<std::int64_t>(i));
    if (shapes[i].points.empty())
      table.fail("descriptors",
                 fmt::format("with seed {} the radius is not positive all round; allowed: descriptors whose sum is "
                             "below 1",
                             variants.seed + static_cast<std::int64_t>(i)));
    if (!variants.count) continue;
    name_member(shapes[i], i + 1);
  }
  return shapes;
}

/// Reads one kind of shape by the name it has in scene files.
std::vector<ShapeSpec> read_outline(TableReader& table, ShapeSpec shape) {
  ShapeName name;
  table.required("kind", name);
  const bool curved = name == ShapeName::ellipse || name == ShapeName::fourier;
  shape.kind = name == ShapeName::disc ? ShapeKind::disc : curved ? ShapeKind::curve : ShapeKind::polygon;
  if (name == ShapeName::disc) table.required("diameter", shape.diameter);
  if (name == ShapeName::polygon) read_polygon(table, shape);
  if (name == ShapeName::regular) read_regular(table, shape);
  if (name == ShapeName::polygon || name == ShapeName::regular) read_rounding(table, shape);
  if (name == ShapeName::ellipse) read_ellipse(table, shape);
  if (name == ShapeName::file) return read_file(table, shape);
  if (name != ShapeName::fourier) return {shape};
  const Variants variants = read_variants(table, shape);
  return make_variants(table, shape, variants);
}

void read_nodes(TableReader& table, ShapeSpec& shape) {
  if (table.has("nodes") && table.has("spacing")) table.fail("spacing", "both it and 'nodes' are given; remove one");
  if (!table.has("nodes") && !table.has("spacing")) table.fail_missing("nodes", "'nodes' (a number) or 'spacing' (m)");
  const auto fewest = shape.kind == ShapeKind::polygon ? static_cast<std::int64_t>(shape.points.size()) : 6;
  table.optional("nodes", shape.nodes);
  table.optional("outline_nodes", shape.outline_nodes, Least{fewest});
  if (!table.optional("spacing", shape.spacing)) return;
  const double largest = extent_of(shape) / 2;
  if (*shape.spacing > largest)
    table.value("spacing").reject(fmt::format("at most half of the shape's extent, {} m", largest));
  // Interior nodes lie about hexagonally: one node an area of sqrt(3)/2 spacing^2.
  const double nodes = area_of(shape) / (std::sqrt(3.0) / 2 * *shape.spacing * *shape.spacing);
  if (nodes <= static_cast<double>(SceneLimits::nodes_per_shape)) return;
  table.fail("spacing", fmt::format("about {:.3g} nodes in the shape; allowed: at most {}, so a larger spacing", nodes,
                                    SceneLimits::nodes_per_shape));
}

}  // namespace

NamedFile read_named_file(TableReader& table) {
  NamedFile named;
  std::string file;
  table.required("file", file);
  if (table.optional("unit", named.unit)) require_length_unit(table, named.unit);
  named.path = std::filesystem::path(table.file()).parent_path() / file;
  if (!std::filesystem::is_regular_file(named.path))
    table.value("file").reject(fmt::format("a file; {} is none", named.path.string()));
  return named;
}

double extent_of(const ShapeSpec& shape) {
  return shape.kind == ShapeKind::disc ? shape.diameter : largest_extent(shape.points);
}

double area_of(const ShapeSpec& shape) {
  return shape.kind == ShapeKind::disc ? std::numbers::pi / 4 * shape.diameter * shape.diameter
                                       : signed_area(shape.points);
}

std::vector<ShapeSpec> read_shape(TableReader table, const std::string& name) {
  ShapeSpec shape;
  shape.name = name;
  shape.where = table.place();
  std::vector<ShapeSpec> shapes = read_outline(table, shape);
  for (ShapeSpec& one : shapes) read_nodes(table, one);
  table.finish();
  return shapes;
}

}  // namespace pliant
