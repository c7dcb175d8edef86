#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <system_error>

#include "core/errors.hpp"
#include "scene/read_tables.hpp"

namespace pliant {

namespace {

namespace fs = std::filesystem;

std::string read_text(const fs::path& file) {
  constexpr std::uintmax_t largest = 256u << 20;
  const auto refuse = [&](const std::string& why) { throw InputError(fmt::format("{}: {}", file.string(), why)); };
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status))
    refuse(error && status.type() == fs::file_type::none ? error.message() : "no such file; check the path");
  if (fs::is_directory(status)) refuse("is a folder; name a scene file (.toml) in it");
  if (!fs::is_regular_file(status)) refuse("is not a regular file; name a scene file (.toml)");
  if (fs::file_size(file, error) > largest) refuse("is larger than 256 MiB: not a scene file");
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream.is_open() || stream.bad()) refuse("cannot be read; check its permissions");
  return text;
}

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
  for (const char* key : {"materials", "shapes"}) {
    if (!root.has(key)) root.fail_missing(key, fmt::format("at least one table [{}.NAME]", key));
  }
  for (auto& [name, table] : root.named_tables("materials")) scene.materials.push_back(read_material(table, name));
  for (auto& [name, table] : root.named_tables("shapes")) scene.shapes.push_back(read_shape(table, name));
}

void read_bodies(TableReader& root, Scene& scene) {
  std::set<std::string> taken{"compliant", "rigid"};
  if (!root.has("grains")) root.fail_missing("grains", "at least one table [[grains]]");
  for (TableReader& table : root.tables("grains")) {
    scene.grains.push_back(read_grains(table, scene));
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
  if (root.has("frames")) scene.frames = read_frames(root.required_table("frames"), scene);
}

/// Materials that bodies and walls of the scene carry, in alphabetical order.
std::set<std::string> present_materials(const Scene& scene) {
  std::set<std::string> present;
  for (const Grains& grains : scene.grains) {
    for (const MixEntry& entry : grains.mix) present.insert(entry.material);
  }
  for (const Wall& wall : scene.walls) present.insert(wall.material);
  return present;
}

/// A pair needs a rule, and a stiffness: the automatic one follows from the compliant bodies of the scene.
void check_pair(const TableReader& root, const Scene& scene, const std::vector<TableReader>& tables,
                const std::string& a, const std::string& b) {
  const ContactRule* rule = scene.rule(a, b);
  if (!rule && tables.empty()) root.fail_missing("contacts", "at least one table [[contacts]]");
  if (!rule) {
    tables.back().fail(
        fmt::format("no contact rule for the materials '{0}' and '{1}'; add [[contacts]] between = "
                    "[\"{0}\", \"{1}\"] or between = \"all\"",
                    a, b));
  }
  const bool compliant = std::any_of(scene.grains.begin(), scene.grains.end(),
                                     [](const Grains& grains) { return has_body(grains, BodyKind::compliant); });
  if (compliant || rule->stiffness) return;
  const TableReader& table = tables[static_cast<std::size_t>(rule - scene.contacts.data())];
  table.fail(
      fmt::format("the stiffness between '{}' and '{}' cannot be automatic in a scene without compliant "
                  "bodies; add stiffness in {} (Pa/m)",
                  a, b, table.title()));
}

void check_rules(const TableReader& root, const Scene& scene, const std::vector<TableReader>& tables) {
  const std::set<std::string> present = present_materials(scene);
  for (auto a = present.begin(); a != present.end(); ++a) {
    for (auto b = a; b != present.end(); ++b) check_pair(root, scene, tables, *a, *b);
  }
}

void read_contacts(TableReader& root, Scene& scene) {
  if (root.has("contact") && root.value("contact").node.is_array())
    root.value("contact").reject("a table [contact] of settings; rules for pairs of materials are [[contacts]]");
  TableReader settings = root.optional_table("contact");
  settings.optional("skin", scene.skin, Quantity{"1", positive});
  settings.finish();
  const std::vector<TableReader> tables = root.tables("contacts");
  for (const TableReader& table : tables) scene.contacts.push_back(read_contact(table, scene));
  check_rules(root, scene, tables);
}

}  // namespace

Scene read_scene(const fs::path& file) {
  const std::string file_name = file.string();
  const toml::table document = parse(read_text(file), file_name);
  TableReader root(document, "the scene", file_name);
  Scene scene;
  scene.file = file;
  scene.name = file.stem().string();
  scene.title = scene.name;
  root.optional("title", scene.title, Text{});
  read_domain(root.optional_table("domain"), scene);
  scene.time = read_time(root.required_table("time"));
  scene.discretisation = read_discretisation(root.optional_table("discretisation"));
  read_materials_and_shapes(root, scene);
  read_bodies(root, scene);
  read_contacts(root, scene);
  read_outputs(root, scene);
  root.finish();
  return scene;
}

}  // namespace pliant
