#include <algorithm>
#include <charconv>
#include <cmath>

#include "input/read_axis_condition.hpp"
#include "input/read_tables.hpp"

namespace pliant {

namespace {

using Condition = BoundaryCondition;
constexpr const char* axes[] = {"x", "y", "angle"};

const Grains& grains_of(const Condition& condition, const Scene& scene) {
  for (const Grains& grains : scene.grains)
    if (grains.name == condition.grains) return grains;
  return scene.grains.front();
}

/// "ring" for all bodies of a set, "ring 17" for one of them.
void read_target(TableReader& table, Condition& condition, const Scene& scene) {
  table.required("of", condition.grains);
  const std::string text = condition.grains;
  const std::size_t space = text.find_last_of(' ');
  int number = 0;
  const char* end = text.data() + text.size();
  if (space != std::string::npos && std::from_chars(text.data() + space + 1, end, number).ptr == end) {
    condition.grains = text.substr(0, space);
    condition.number = number;
  }
  const Value value = table.value("of");
  if (condition.number && grains_of(condition, scene).name == condition.grains) {
    const std::int64_t count = grains_of(condition, scene).body_count();
    if (number < 0 || number >= count)
      value.reject(fmt::format("a number from 0 to {} after the name '{}'", count - 1, condition.grains));
    return;
  }
  condition.number.reset();
  condition.grains = OneOf{"set of grains", names_of(scene.grains)}(value);
}

OutlinePart read_part(TableReader table) {
  OutlinePart part;
  std::vector<double> angles;
  std::optional<ProbeBox> box;
  std::optional<OutlineSide> side;
  int given = 0;
  if (table.optional("angles", angles)) {
    if (angles[0] == angles[1]) table.fail("angles", "both directions are the same; allowed: two different ones");
    part = {.kind = OutlinePart::Kind::angles, .first = angles[0], .second = angles[1]};
    ++given;
  }
  if (table.optional("box", box)) {
    part = {.kind = OutlinePart::Kind::box, .low = box->low, .high = box->high};
    ++given;
  }
  if (table.optional("side", side)) {
    const Vec2 outward[] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    part = {.kind = OutlinePart::Kind::side, .side = outward[static_cast<int>(*side)]};
    ++given;
  }
  table.finish();
  if (given != 1) table.fail(fmt::format("{}: give one of angles, box, side", table.title()));
  return part;
}

void read_pressure(TableReader& table, Condition& condition) {
  condition.kind = Condition::Kind::pressure;
  table.required("pressure", condition.pressure);
  table.optional("mode", condition.following);
  if (condition.following || !table.optional("direction", condition.direction)) return;
  if (condition.direction->norm() == 0) table.fail("direction", "[0, 0]; allowed: any other");
  condition.direction->normalize();
}

void read_support(TableReader& table, Condition& condition) {
  condition.kind = Condition::Kind::support;
  const std::vector<AxisConditionKind> kinds{{"displacement", AxisCondition::Mode::displacement},
                                             {"velocity", AxisCondition::Mode::velocity}};
  for (auto [axis, prescribed] : {std::pair("x", &condition.x), std::pair("y", &condition.y)}) {
    *prescribed = read_axis_condition(table, axis, kinds, *prescribed);
    if (!prescribed->window.always()) table.fail(axis, "from and until of a soft support stand beside x and y");
  }
  table.optional("stiffness", condition.stiffness);
  table.optional("damping", condition.damping);
}

bool overlaps(const Condition& a, const Condition& b) {
  return a.grains == b.grains && (!a.number || !b.number || *a.number == *b.number);
}

/// Bodies of a breakable grain are its cells. Each would bear the whole force, and turn about its own centre.
void refuse_of_cells(TableReader& table, const Condition& condition, const char* axis, AxisCondition::Mode mode,
                     const Scene& scene) {
  const bool turns = axis == axes[2] && mode != AxisCondition::Mode::fixed;
  if (condition.number || grains_of(condition, scene).cells.empty() || (mode != AxisCondition::Mode::force && !turns))
    return;
  table.fail(axis, fmt::format("'{}' consists of cells, and each would bear it; name one, as in \"{} 0\", or use a "
                               "pressure or a motion along x and y",
                               condition.grains, condition.grains));
}

void read_axes(TableReader& table, Condition& condition, const Scene& scene) {
  AxisCondition Condition::* conditions[] = {&Condition::x, &Condition::y, &Condition::angle};
  for (int c = 0; c < 3; ++c) {
    const std::vector<AxisConditionKind> kinds{{"velocity", AxisCondition::Mode::velocity},
                                               {c == 2 ? "moment" : "force", AxisCondition::Mode::force, true}};
    condition.*conditions[c] = read_axis_condition(table, axes[c], kinds, condition.*conditions[c]);
    if ((condition.*conditions[c]).mode == AxisCondition::Mode::free) continue;
    refuse_of_cells(table, condition, axes[c], (condition.*conditions[c]).mode, scene);
    for (const Condition& other : scene.boundary)
      if (overlaps(condition, other) && (other.*conditions[c]).mode != AxisCondition::Mode::free)
        table.fail(axes[c], "driven by an earlier [[boundary]] as well; a history can change what it does in time");
  }
}

/// What stands along x, y and angle: motions and loads of rigid grains, soft supports of compliant ones.
void read_motion(TableReader& table, Condition& condition, const Scene& scene) {
  const Grains& grains = grains_of(condition, scene);
  if (has_body(grains, BodyKind::compliant) && has_body(grains, BodyKind::rigid))
    table.fail("of", fmt::format("'{}' mixes rigid and compliant grains; allowed: a pressure, or grains of one kind",
                                 grains.name));
  if (has_body(grains, BodyKind::compliant) && table.has("angle"))
    table.fail("angle", fmt::format("'{}' is compliant; 'angle' is for rigid grains only", grains.name));
  has_body(grains, BodyKind::rigid) ? read_axes(table, condition, scene) : read_support(table, condition);
  for (const AxisCondition* prescribed : {&condition.x, &condition.y, &condition.angle})
    if (prescribed->mode != AxisCondition::Mode::free) return;
  table.fail(fmt::format("{} does nothing: all axes are free; remove it", table.title()));
}

}  // namespace

BoundaryCondition read_condition(TableReader table, const Scene& scene) {
  Condition condition;
  condition.where = table.place();
  read_target(table, condition, scene);
  const bool moves = table.has("x") || table.has("y") || table.has("angle");
  if (!moves && !table.has("pressure")) table.fail_missing("pressure", "'pressure', or what moves 'x', 'y' or 'angle'");
  moves ? read_motion(table, condition, scene) : read_pressure(table, condition);
  if (condition.kind != Condition::Kind::axes) {
    if (table.has("part")) condition.part = read_part(table.optional_table("part"));
    condition.window = read_window(table);
  }
  table.finish();
  return condition;
}

void check_angle(TableReader& table, const Grains& grains, const Scene& scene) {
  const std::vector<double>& angles = grains.packing.angles;
  const bool turned = std::any_of(angles.begin(), angles.end(), [](double angle) { return angle != 0; });
  if (grains.angle == 0.0 && !turned) return;
  for (const Species& entry : grains.species) {
    if (scene.material(entry.material).law != MaterialLaw::linear_elastic) continue;
    const bool given = table.has("angle");
    table.fail(given ? "angle" : "packing",
               fmt::format("{}the law \"linear-elastic\" of '{}' counts rotations as strains; allowed: {}",
                           given    ? ""
                           : turned ? "an angle in its file: "
                                    : "it turns its grains: ",
                           entry.material, given || turned ? "0" : "another law or packing"));
  }
}

}  // namespace pliant
