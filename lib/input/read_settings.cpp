#include <Eigen/LU>
#include <algorithm>

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

/// Least determinant of the gradient over the run: between two points of its histories it is a parabola.
double least_determinant(const CellSettings& cell, double& when) {
  std::vector<double> times{0};
  for (const auto& row : cell.gradient)
    for (const History& component : row) times.insert(times.end(), component.time.begin(), component.time.end());
  std::erase_if(times, [](double t) { return t < 0; });
  std::sort(times.begin(), times.end());
  double least = 1e300;
  const auto look = [&](double t) {
    if (const double j = cell.gradient_at(t).determinant(); j < least) least = j, when = t;
  };
  for (std::size_t i = 0; i < times.size(); ++i) {
    look(times[i]);
    if (i == 0) continue;
    const double a = times[i - 1], b = times[i], middle = 0.5 * (a + b), width = b - a;
    const double at_a = cell.gradient_at(a).determinant(), at_b = cell.gradient_at(b).determinant(),
                 at_middle = cell.gradient_at(middle).determinant();
    const double curvature = at_a - 2 * at_middle + at_b;
    if (curvature > 0) look(std::clamp(middle - 0.25 * width * (at_b - at_a) / curvature, a, b));
  }
  return least;
}

void read_cell(TableReader table, CellSettings& cell) {
  const char* names[2][2] = {{"xx", "xy"}, {"yx", "yy"}};
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      if (!table.optional(names[i][j], cell.gradient[i][j])) continue;
      const double start = i == j ? 1 : 0, found = cell.gradient[i][j].at(0);
      if (found != start)
        table.fail(names[i][j], fmt::format("the history has {} at t = 0; allowed: {}, that of the cell at the start",
                                            found, start));
    }
  for (const auto& [i, j] : {std::pair(0, 0), std::pair(1, 1), std::pair(0, 1)}) {
    const std::string key = fmt::format("stress_{}", names[i][j]);
    if (!table.optional(key, cell.stress[i][j])) continue;
    if (!cell.gradient[i][j].time.empty())
      table.fail(key, fmt::format("both it and '{}' are given; remove one", names[i][j]));
  }
  table.optional("inertia", cell.mass);
  table.optional("damping", cell.damping);
  table.finish();
  double when = 0;
  if (const double least = least_determinant(cell, when); !(least > 0))
    table.fail(fmt::format("{}: the area of the cell is {:.3g} times that at the start at t = {:.6g} s; allowed: > 0",
                           table.title(), least, when));
}

}  // namespace

void read_domain(TableReader table, Scene& scene) {
  table.optional("period", scene.period);
  std::vector<double> periods;
  if (table.optional("periods", periods)) {
    if (scene.period) table.fail("periods", "both it and 'period' are given; remove one");
    scene.cell.emplace();
    scene.cell->periods = {periods[0], periods[1]};
    read_cell(table.optional_table("cell"), *scene.cell);
  }
  read_gravity(table, scene);
  if (scene.cell && (!scene.gravity.isZero(0) || !scene.gravity_history.empty()))
    table.fail("gravity", "nothing bears it in a cell with two periods; remove it, or give 'period' and walls");
  table.finish();
}

void check_cell(const TableReader& root, const Scene& scene) {
  if (!scene.cell) return;
  if (scene.time.integrator != Integrator::verlet)
    root.fail("time", "integrator = \"step-doubling\" does not move a cell with two periods; allowed: \"verlet\"");
  if (scene.discretisation.mass != Mass::lumped)
    root.fail("discretisation", "mass = \"corrected\" does not follow a cell with two periods; allowed: \"lumped\"");
  if (!scene.boundary.empty())
    root.fail("boundary", "loads, motions and supports do not move with a cell of two periods; remove them");
  for (const Material& material : scene.materials)
    if (material.mass_damping > 0)
      root.fail("materials", fmt::format("mass_damping of '{}' is against a frame at rest, which a cell with two "
                                         "periods has none of; take 'viscosity', or 'restitution' of contacts",
                                         material.name));
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
