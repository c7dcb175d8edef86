#include "results/start_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/archive.hpp"
#include "core/errors.hpp"
#include "results/checkpoint.hpp"
#include "results/scene_files.hpp"

namespace pliant {

namespace fs = std::filesystem;

namespace {

CheckpointText read(const fs::path& file) {
  if (!fs::exists(file))
    throw InputError(
        fmt::format("{}: no such file: [start] from needs the output folder of a run that has come to its "
                    "end; let it go on with --resume",
                    file.string()));
  return read_checkpoint_file(file);
}

}  // namespace

void write_start_file(const fs::path& folder, const std::string& scene_text, const Simulation& simulation) {
  const nlohmann::ordered_json header = {{"scene", simulation.model().scene.name},
                                         {"time", simulation.state().time},
                                         {"state_hash", fmt::format("{:016x}", state_hash(simulation.state()))},
                                         {"build", build_identity()},
                                         {"mesh", mesh_hash(simulation.model())},
                                         {"scene_text", scene_text}};
  CheckpointFile file(folder / start_file_name, header.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace));
  SaveLeaf save(file);
  StartPoint point = simulation.start_point();
  Walk walk(save);
  walk("start", point);
  file.commit();
}

StartFile::StartFile(const fs::path& file) : path_(file), text_(read(file)) {
  const nlohmann::json header = nlohmann::json::parse(text_.header(), nullptr, false);
  if (!header.contains("state_hash")) throw InputError(fmt::format("{}: is no state to start from", file.string()));
  scene_text_ = header.value("scene_text", "");
  scene_name_ = header.value("scene", "");
  state_hash_ = header.value("state_hash", "");
  build_ = header.value("build", "");
  mesh_ = header.value("mesh", "");
  time_ = header.value("time", 0.0);
}

void StartFile::require_bodies_of(const fs::path& scene_file) const {
  const SceneFiles files(scene_file);
  files.compare(path_.parent_path());
  const std::string difference = start_difference(scene_text_, files.text());
  if (!difference.empty())
    throw InputError(
        fmt::format("{}: not the bodies of the run that it starts from, {}: {}; bodies, shapes and discretisation must "
                    "be the same (docs/results.md, \"Starting from another run\")",
                    scene_file.string(), path_.string(), difference));
}

StartPoint StartFile::point(const Model& model) const {
  const auto refuse = [&](const std::string& why) {
    throw OutputError(fmt::format("{}: does not fit this build of the program: {}; it was written by {}",
                                  path_.string(), why, build_));
  };
  StartPoint point;
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
  auto file = std::make_unique<const StartFile>(scene.start_from);
  file->require_bodies_of(scene.file);
  return file;
}

Simulation start_simulation(const Model& model, const StartFile* file) {
  if (!file) return Simulation(model);
  const StartPoint point = file->point(model);
  return Simulation(model, &point);
}

}  // namespace pliant
