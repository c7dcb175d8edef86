#include "input/portable_scene.hpp"
#include "input/read_tables.hpp"

namespace pliant {

namespace {

/// A vector, or a history of it, whose rows hold vectors.
void read_gravity(TableReader& table, Scene& scene) {
  const toml::array* rows = table.has("gravity") ? table.value("gravity").node.as_array() : nullptr;
  if (!rows || rows->empty() || !rows->get(0)->is_array()) {
    table.optional("gravity", scene.gravity);
    return;
  }
  table.optional("gravity", scene.gravity_history);
  scene.gravity = scene.gravity_at(0);
}

}  // namespace

void read_domain(TableReader table, Scene& scene) {
  table.optional("period", scene.period);
  read_gravity(table, scene);
  table.finish();
}

TimeSettings read_time(TableReader table) {
  TimeSettings time;
  table.required("end", time.end);
  table.optional("integrator", time.integrator);
  table.optional("stop_at_outputs", time.stop_at_outputs);
  if (time.integrator == Integrator::verlet) {
    table.optional("tolerance", time.tolerance);
    table.optional("safety", time.safety);
  } else {
    table.optional("target", time.target);
    table.optional("alpha", time.alpha);
    table.optional("beta", time.beta);
  }
  table.finish();
  return time;
}

DiscretisationSettings read_discretisation(TableReader table) {
  DiscretisationSettings settings;
  table.optional("method", settings.method);
  table.optional("mass", settings.mass);
  if (settings.mass == Mass::lumped) table.optional("mass_scaling", settings.mass_scaling);
  const bool triangles = settings.method == DiscretisationMethod::t3 || settings.method == DiscretisationMethod::es_t3;
  if (!triangles) table.optional("support", settings.support);
  if (!triangles && settings.method != DiscretisationMethod::mls &&
      table.optional("gauss_points", settings.gauss_points)) {
    const int points = settings.gauss_points;
    if (points != 1 && points != 3 && points != 6) table.value("gauss_points").reject("1, 3 or 6");
  }
  table.finish();
  return settings;
}

void read_start(TableReader table, Scene& scene) {
  std::string from;
  table.required("from", from);
  if (from.empty()) table.value("from").reject(start_allowed);
  const std::filesystem::path path = std::filesystem::path(table.file()).parent_path() / from;
  scene.start_from = std::filesystem::is_directory(path) ? path / start_file_name : path;
  table.finish();
}

void read_checkpoint(TableReader table, Scene& scene) {
  table.optional("period", scene.checkpoint_period);
  table.finish();
}

}  // namespace pliant
