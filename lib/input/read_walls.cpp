#include <cmath>

#include "input/read_axis_condition.hpp"
#include "input/read_tables.hpp"

namespace pliant {

namespace {

/// Conditions that a wall may have along one axis; a pressure has no meaning along the wall.
std::vector<AxisConditionKind> axis_condition_kinds(bool normal) {
  std::vector<AxisConditionKind> kinds{{"velocity", AxisCondition::Mode::velocity},
                                       {"force", AxisCondition::Mode::force, true}};
  if (normal) kinds.push_back({"pressure", AxisCondition::Mode::pressure, true});
  return kinds;
}

bool needs_mass(const AxisCondition& prescribed) {
  return (prescribed.mode != AxisCondition::Mode::fixed && prescribed.mode != AxisCondition::Mode::velocity) ||
         !prescribed.window.always();
}

/// Asperities side by side must leave room for the straight segments that join them.
void check_asperities(const TableReader& table, const Asperities& asperities, double period) {
  const auto half_width = [&](int i) {
    return asperities.diameter / 2 *
           std::sin(asperities.half_angles[static_cast<std::size_t>(i) % asperities.half_angles.size()]);
  };
  const double pitch = period / asperities.count;
  for (int i = 0; i < asperities.count; ++i) {
    const double taken = half_width(i) + half_width((i + 1) % asperities.count);
    if (taken < pitch) continue;
    table.fail("half_angles",
               fmt::format("asperities {} and {} take {} m side by side; allowed: less than period / count = {} m",
                           i + 1, (i + 1) % asperities.count + 1, taken, pitch));
  }
}

Asperities read_asperities(TableReader table, double period) {
  Asperities asperities;
  asperities.heights = {0.0};
  table.required("diameter", asperities.diameter);
  table.required("count", asperities.count);
  table.optional("first", asperities.first);
  table.optional("heights", asperities.heights);
  table.required("half_angles", asperities.half_angles);
  check_asperities(table, asperities, period);
  table.finish();
  return asperities;
}

void check_levels(const TableReader& table, const Wall& wall, const std::vector<Wall>& others) {
  for (const Wall& other : others) {
    if (other.solid == wall.solid) continue;
    const bool below = wall.solid == Wall::Solid::below;
    if (below ? wall.level < other.level : wall.level > other.level) continue;
    table.fail("level", fmt::format("{} m; allowed: {} {} m, the level of wall '{}', which is solid on the other side",
                                    wall.level, below ? "<" : ">", other.level, other.name));
  }
}

}  // namespace

Wall read_wall(TableReader table, const Scene& scene) {
  Wall wall;
  wall.where = table.place();
  table.required("name", wall.name);
  if (scene.cell)
    table.fail(fmt::format("wall '{}' has no place in a cell with two periods; remove it, or give [domain] period",
                           wall.name));
  if (!scene.period)
    table.fail(fmt::format("wall '{}' spans the period, and the scene has none; add [domain] period", wall.name));
  table.required("material", wall.material, names_of(scene.materials));
  table.required("solid", wall.solid);
  table.required("level", wall.level);
  check_levels(table, wall, scene.walls);
  const double finest = *scene.period / SceneLimits::wall_nodes;
  table.optional("spacing", wall.spacing, Range{.low = finest, .high = *scene.period});
  if (table.has("asperities")) wall.asperities = read_asperities(table.optional_table("asperities"), *scene.period);
  wall.x = read_axis_condition(table, "x", axis_condition_kinds(false), {});
  wall.y = read_axis_condition(table, "y", axis_condition_kinds(true), {});
  if (needs_mass(wall.x) || needs_mass(wall.y)) {
    table.required("thickness", wall.thickness, positive);
  } else {
    table.optional("thickness", wall.thickness);
  }
  table.finish();
  return wall;
}

}  // namespace pliant
