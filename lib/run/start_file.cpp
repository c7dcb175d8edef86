#include "run/start_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/archive.hpp"
#include "core/errors.hpp"
#include "input/portable_scene.hpp"
#include "input/scene_difference.hpp"
#include "results/scene_files.hpp"
#include "run/checkpoint.hpp"
#include "scene/line_reader.hpp"

namespace pliant {

namespace fs = std::filesystem;

namespace {

/// "scene.toml:5:8: 'from' in [start]", whatever it names.
std::string key_of(const Scene& scene) {
  const std::string text = read_text_file(scene.file, "a scene file (.toml)");
  return fmt::format("{}:{}: 'from' in [start]", scene.file.string(), place_of_key(text, "start.from"));
}

[[noreturn]] void reject(const std::string& key, const std::string& why) {
  throw InputError(fmt::format("{}: {}; allowed: {}", key, why, start_allowed));
}

CheckpointText read(const fs::path& file, const std::string& key) {
  if (!fs::exists(file))
    reject(key, file.filename() == start_file_name && fs::exists(file.parent_path())
                    ? fmt::format(
                          "there is no {}: no run has come to its end there; one that was begun goes on with --resume",
                          file.string())
                    : fmt::format("there is no {}", file.string()));
  try {
    return read_checkpoint_file(file, "");
  } catch (const OutputError& error) {
    reject(key, error.what());
  }
}

}  // namespace

void write_start_file(const fs::path& folder, const std::string& scene_text, const Simulation& simulation) {
  const nlohmann::ordered_json header = {{"scene", simulation.model().scene.name},
                                         {"time", simulation.state().time},
                                         {"state_hash", fmt::format("{:016x}", state_hash(simulation.state()))},
                                         {"build", build_identity()},
                                         {"mesh", mesh_hash(simulation.model())},
                                         {"bodies", bodies_hash(simulation.model())},
                                         {"scene_text", scene_text}};
  CheckpointFile file(folder / start_file_name, header.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace));
  SaveLeaf save(file);
  StartPoint point = simulation.start_point();
  Walk walk(save);
  walk("start", point);
  file.commit();
}

StartFile::StartFile(const fs::path& file, std::string key)
    : path_(file), key_(std::move(key)), text_(read(file, key_)) {
  const nlohmann::json header = nlohmann::json::parse(text_.header(), nullptr, false);
  if (!header.contains("state_hash"))
    reject(key_, fmt::format("{} is a checkpoint, no state to start from", file.string()));
  scene_text_ = header.value("scene_text", "");
  scene_name_ = header.value("scene", "");
  state_hash_ = header.value("state_hash", "");
  build_ = header.value("build", "");
  mesh_ = header.value("mesh", "");
  bodies_ = header.value("bodies", "");
  time_ = header.value("time", 0.0);
}

void StartFile::require_bodies_of(const fs::path& scene_file) const {
  const SceneFiles files(scene_file);
  files.compare(path_.parent_path());
  const std::string difference = start_difference(scene_text_, files.text());
  if (difference.empty()) return;
  const std::string place = place_of_key(files.text(), difference.substr(1, difference.find('\'', 1) - 1));
  throw InputError(fmt::format(
      "{}:{}{} not the bodies of the run that it starts from, {}: {}; bodies, shapes and discretisation must "
      "be the same (docs/results.md, \"Starting from another run\")",
      scene_file.string(), place, place.empty() ? "" : ":", path_.string(), difference));
}

StartPoint StartFile::point(const Model& model) const {
  const auto refuse = [&](const std::string& why) {
    throw OutputError(fmt::format("{}: does not fit this build of the program: {}; it was written by {}",
                                  path_.string(), why, build_));
  };
  StartPoint point;
  if (bodies_.empty()) refuse("it does not say which bodies it is of");
  if (bodies_ != bodies_hash(model))
    throw InputError(fmt::format(
        "{}: other bodies than those of {}: an outline, a table of grains or what else makes them was changed since{}",
        key_, path_.string(),
        build_ == build_identity() ? "" : fmt::format(", or the build that wrote it ({}) meshes otherwise", build_)));
  if (mesh_ != mesh_hash(model)) refuse("bodies have other nodes");
  try {
    LoadLeaf load(text_.content());
    Walk walk(load);
    walk("start", point);
    if (!load.empty()) refuse("it holds more than is expected");
    point.require_fit(model);
  } catch (const ArchiveError& error) {
    refuse(error.what());
  }
  return point;
}

std::string StartFile::origin() const {
  return nlohmann::ordered_json{{"scene", scene_name_}, {"time", time_}, {"state_hash", state_hash_}}.dump();
}

std::unique_ptr<const StartFile> start_file_of(const Scene& scene) {
  if (scene.start_from.empty()) return nullptr;
  auto file = std::make_unique<const StartFile>(scene.start_from, key_of(scene));
  file->require_bodies_of(scene.file);
  return file;
}

void require_same_start(const Scene& scene, const fs::path& folder) {
  const fs::path copy = folder / start_copy_name;
  if (scene.start_from.empty() || !fs::exists(scene.start_from) || !fs::exists(copy)) return;
  const std::string key = key_of(scene);
  const StartFile named(scene.start_from, key), kept(copy, key);
  if (named.state_hash() != kept.state_hash())
    throw InputError(fmt::format(
        "{}: {} is not the state that the run in {} started from: state_hash {}, was {}; name {} to go on from that "
        "one",
        key, scene.start_from.string(), folder.string(), named.state_hash(), kept.state_hash(), copy.string()));
}

Simulation start_simulation(const Model& model, const StartFile* file) {
  if (!file) return Simulation(model);
  const StartPoint point = file->point(model);
  return Simulation(model, &point);
}

}  // namespace pliant
