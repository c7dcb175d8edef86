#include "scene/portable_scene.hpp"
#include "scene/read_tables.hpp"

namespace pliant {

namespace {

/// A vector, or a history of it, whose rows hold vectors.
void read_gravity(TableReader& table, Scene& scene) {
  const toml::array* rows = table.has("gravity") ? table.value("gravity").node.as_array() : nullptr;
  if (!rows || rows->empty() || !rows->get(0)->is_array()) {
    table.optional("gravity", scene.gravity, Vector{"m/s2"});
    return;
  }
  std::vector<History> histories(2);
  table.optional("gravity", histories, VectorHistory{"m/s2"});
  scene.gravity_history = histories;
  scene.gravity = scene.gravity_at(0);
}

}  // namespace

void read_domain(TableReader table, Scene& scene) {
  table.optional("period", scene.period, Quantity{"m", positive});
  read_gravity(table, scene);
  table.finish();
}

TimeSettings read_time(TableReader table) {
  const Range share{.low = 0, .high = 1, .low_open = true};
  TimeSettings time;
  table.required("end", time.end, Quantity{"s", positive});
  table.optional("integrator", time.integrator,
                 Choice<Integrator>{{{"verlet", Integrator::verlet}, {"step-doubling", Integrator::step_doubling}}});
  table.optional("stop_at_outputs", time.stop_at_outputs, Flag{});
  if (time.integrator == Integrator::verlet) {
    table.optional("tolerance", time.tolerance, Quantity{"1", share});
    table.optional("safety", time.safety, Quantity{"1", share});
  } else {
    table.optional("target", time.target, Quantity{"1", share});
    table.optional("alpha", time.alpha, Quantity{"1", Range{.low = 1}});
    table.optional("beta", time.beta, Quantity{"1", share});
  }
  table.finish();
  return time;
}

DiscretisationSettings read_discretisation(TableReader table) {
  DiscretisationSettings settings;
  table.optional("recipe", settings.recipe,
                 Choice<Recipe>{{{"mls", Recipe::mls},
                                 {"mls-gauss", Recipe::mls_gauss},
                                 {"t3", Recipe::t3},
                                 {"es-t3", Recipe::es_t3},
                                 {"rpim", Recipe::rpim}}});
  table.optional("mass", settings.mass, Choice<Mass>{{{"lumped", Mass::lumped}, {"corrected", Mass::corrected}}});
  if (settings.mass == Mass::lumped) table.optional("rim_mass", settings.rim_mass, Quantity{"1", Range{.low = 1}});
  const bool triangles = settings.recipe == Recipe::t3 || settings.recipe == Recipe::es_t3;
  if (!triangles) table.optional("support", settings.support, Integer{7, settings.recipe == Recipe::mls ? 14 : 25});
  if (!triangles && settings.recipe != Recipe::mls &&
      table.optional("gauss_points", settings.gauss_points, Integer{1, 6})) {
    const int points = settings.gauss_points;
    if (points != 1 && points != 3 && points != 6) table.value("gauss_points").reject("1, 3 or 6");
  }
  table.finish();
  return settings;
}

void read_start(TableReader table, Scene& scene) {
  std::string from;
  table.required("from", from, Text{});
  if (from.empty()) table.value("from").reject(start_allowed);
  const std::filesystem::path path = std::filesystem::path(table.file()).parent_path() / from;
  scene.start_from = std::filesystem::is_directory(path) ? path / start_file_name : path;
  table.finish();
}

void read_checkpoint(TableReader table, Scene& scene) {
  table.optional("period", scene.checkpoint_period, QuantityOr{"never", {"s", positive}});
  table.finish();
}

}  // namespace pliant
