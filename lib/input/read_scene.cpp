#include <algorithm>
#include <set>

#include "core/errors.hpp"
#include "core/floating_point_traps.hpp"
#include "input/old_keys.hpp"
#include "input/read_scene.hpp"
#include "input/read_tables.hpp"
#include "scene/line_reader.hpp"

namespace pliant {

namespace {

namespace fs = std::filesystem;

toml::table parse(const std::string& text, const std::string& file) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos)
    fail_at(file, {1, 1}, "the file is empty; see cases/ for examples");
  try {
    return toml::parse(std::string_view(text), std::string_view(file));
  } catch (const toml::parse_error& error) {
    fail_at(file, error.source().begin, fmt::format("not valid TOML: {}", error.description()));
  }
}

/// Names of grains, walls and the two kinds of body are one set: a probe may be of any of them.
void check_new_name(const TableReader& table, const std::string& name, std::set<std::string>& taken) {
  if (taken.insert(name).second) return;
  table.fail(fmt::format("the name '{}' in {} is taken; choose another", name, table.title()));
}

void read_materials_and_shapes(TableReader& root, Scene& scene) {
  for (auto& [name, table] : root.named_tables("materials")) scene.materials.push_back(read_material(table, name));
  for (auto& [name, table] : root.named_tables("shapes"))
    for (ShapeSpec& shape : read_shape(table, name)) scene.shapes.push_back(std::move(shape));
}

void read_bodies(TableReader& root, Scene& scene) {
  std::set<std::string> taken{"all", "compliant", "rigid"};
  for (TableReader& table : root.tables("grains")) {
    scene.grains.push_back(read_grains(table, scene));
    check_angle(table, scene.grains.back(), scene);
    check_new_name(table, scene.grains.back().name, taken);
  }
  if (scene.grains.empty()) root.fail("grains", "empty; allowed: at least one table [[grains]]");
  for (TableReader& table : root.tables("walls")) {
    scene.walls.push_back(read_wall(table, scene));
    check_new_name(table, scene.walls.back().name, taken);
  }
}

void read_outputs(TableReader& root, Scene& scene) {
  std::set<std::string> taken;
  for (TableReader& table : root.tables("probes")) {
    scene.probes.push_back(read_probe(table, scene));
    check_new_name(table, scene.probes.back().name, taken);
  }
  if (root.has("frames")) scene.frames = read_frames(root.optional_table("frames"), scene);
}

}  // namespace

Scene read_scene(const fs::path& file) { return read_scene(file, nullptr); }

Scene read_scene(const fs::path& file, KeyUse* use) {
  const Untrapped untrapped;
  const Source source{file.string(), use};
  toml::table document = parse(read_text_file(file, "a scene file (.toml)"), source.file);
  source.warnings = rename_old_keys(document, source.file);
  TableReader root(document, source);
  Scene scene;
  scene.file = file;
  scene.name = file.stem().string();
  scene.title = scene.name;
  root.optional("title", scene.title);
  read_domain(root.optional_table("domain"), scene);
  scene.time = read_time(root.required_table("time"));
  scene.discretisation = read_discretisation(root.optional_table("discretisation"));
  read_materials_and_shapes(root, scene);
  read_bodies(root, scene);
  for (const TableReader& table : root.tables("boundary")) scene.boundary.push_back(read_condition(table, scene));
  read_contacts(root, scene);
  for (const TableReader& table : root.tables("bonds")) scene.bonds.push_back(read_bond(table, scene));
  read_outputs(root, scene);
  if (root.has("start")) read_start(root.optional_table("start"), scene);
  read_checkpoint(root.optional_table("checkpoint"), scene);
  check_cell(root, scene);
  root.finish();
  scene.warnings = source.warnings;
  return scene;
}

}  // namespace pliant
