#include "run/checkpoint.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <ctime>

#include "build_info.hpp"
#include "core/archive.hpp"
#include "core/errors.hpp"

namespace pliant {
namespace {

constexpr const char* file_name = "checkpoint.bin";

/// The instructions that the compiler was allowed.
constexpr const char* instruction_set =
#if defined(__AVX512F__)
    "AVX-512";
#elif defined(__AVX2__)
    "AVX2";
#else
    "baseline";
#endif

/// What a checkpoint holds, in the order of the file. Reading calls it as well.
template <class Visitor>
void visit_run(Visitor&& visitor, Simulation& simulation, Recorder& recorder) {
  visitor("simulation", simulation);
  visitor("outputs", recorder);
}

}  // namespace

std::string build_identity() {
  return fmt::format("{}, {}, {}, {}", build_commit, build_compiler, build_options, instruction_set);
}

std::string mesh_hash(const Model& model) {
  Fnv1a hash;
  const auto add = [&](std::int64_t number) { hash.add(&number, sizeof number); };
  add(static_cast<std::int64_t>(model.compliant_size));
  add(model.node_count());
  add(model.dof_count());
  for (const Body& body : model.bodies) {
    add(body.kind == BodyKind::rigid);
    add(model.outlines[body.outline].count);
  }
  return fmt::format("{:016x}", hash.value());
}

std::string bodies_hash(const Model& model) {
  Fnv1a hash;
  const auto add = [&](double value, double unit) {
    const std::int64_t number = std::llround(value / (1e-6 * unit));
    hash.add(&number, sizeof number);
  };
  const auto add_points = [&](const Points& points, double unit) {
    for (const Vec2& point : points) add(point.x(), unit), add(point.y(), unit);
  };
  for (const OutlineShape& outline : model.outlines) add_points(outline.points, outline.spacing);
  for (const CompliantShape& shape : model.shapes)
    add_points(shape.space.mesh.nodes, model.outlines[shape.outline].spacing);
  for (const Body& body : model.bodies) {
    const double segment = model.outlines[body.outline].spacing;
    for (const int number : {body.outline, body.compliant_shape, body.material}) hash.add(&number, sizeof number);
    add(body.centre.x(), segment), add(body.centre.y(), segment);
    add(body.angle, 1), add(body.scale, 1);
  }
  return fmt::format("{:016x}", hash.value());
}

void write_checkpoint(const std::filesystem::path& folder, const std::string& scene_text, Simulation& simulation,
                      Recorder& recorder, double time) {
  recorder.sync();
  const State& state = simulation.state();
  const Scene& scene = simulation.model().scene;
  const nlohmann::ordered_json header = {{"scene", scene.name},
                                         {"time", time},
                                         {"end", scene.time.end},
                                         {"steps", state.steps},
                                         {"wall_seconds", recorder.figures.wall_seconds},
                                         {"written", fmt::format("{:%Y-%m-%d %H:%M:%S}", fmt::gmtime(std::time({})))},
                                         {"build", build_identity()},
                                         {"mesh", mesh_hash(simulation.model())},
                                         {"bodies", bodies_hash(simulation.model())},
                                         {"scene_text", scene_text}};
  CheckpointFile file(folder / file_name, header.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace));
  SaveLeaf save(file);
  visit_run(Walk(save), simulation, recorder);
  file.commit();
  recorder.figures.checkpoint_time = time;
}

Checkpoint::Checkpoint(const std::filesystem::path& folder)
    : path_(folder / file_name), text_(read_checkpoint_file(path_)) {
  const nlohmann::json header = nlohmann::json::parse(text_.header(), nullptr, false);
  scene_text_ = header.value("scene_text", "");
  scene_name_ = header.value("scene", "");
  build_ = header.value("build", "");
  mesh_ = header.value("mesh", "");
  bodies_ = header.value("bodies", "");
  time_ = header.value("time", 0.0);
}

void Checkpoint::warn_of_other_build() const {
  if (build_ == build_identity()) return;
  spdlog::warn("{}: written by another build ({}; this is {}); the run goes on, but not with the same last bits",
               path_.string(), build_, build_identity());
}

void Checkpoint::require_bodies_of(const Model& model) const {
  if (bodies_.empty() || bodies_ == bodies_hash(model)) return;
  throw InputError(fmt::format(
      "{}: other bodies than the run began with: an outline or a table of grains was changed since{}; a run cannot "
      "change its shapes and packings; start anew (--force)",
      path_.string(),
      build_ == build_identity() ? "" : fmt::format(", or the build that wrote it ({}) meshes otherwise", build_)));
}

void Checkpoint::restore(Simulation& simulation, Recorder& recorder) const {
  const auto refuse = [&](const std::string& why) {
    throw OutputError(
        fmt::format("{}: does not fit this build of the program: {}; use the build that wrote it ({}), or "
                    "start anew (--force)",
                    path_.string(), why, build_));
  };
  if (mesh_hash(simulation.model()) != mesh_) refuse("bodies have other nodes");
  try {
    LoadLeaf load(text_.content());
    visit_run(Walk(load), simulation, recorder);
    if (!load.empty()) refuse("it holds more than is expected");
  } catch (const ArchiveError& error) {
    refuse(error.what());
  }
}

}  // namespace pliant
