#include "cli/check.hpp"

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include "dynamics/simulation.hpp"
#include "results/summary.hpp"

namespace pliant {
namespace {

std::string si(double value, const char* unit) {
  static constexpr const char* prefixes[] = {"f", "p", "n", "u", "m", "", "k", "M", "G", "T"};
  if (value == 0 || !std::isfinite(value)) return fmt::format("{} {}", value, unit);
  const int step = std::clamp(static_cast<int>(std::floor(std::log10(std::abs(value)) / 3)), -5, 4);
  return fmt::format("{:.4g} {}{}", value / std::pow(1000.0, step), prefixes[step + 5], unit);
}

void print_bodies(const Model& model) {
  int compliant = 0, walls = 0;
  double mass = 0;
  for (const Body& body : model.bodies) {
    compliant += body.kind == BodyKind::compliant;
    walls += body.wall;
    if (!body.wall) mass += body.mass;
  }
  fmt::print("bodies       {} ({} compliant, {} rigid, {} walls)\n", model.bodies.size(), compliant,
             static_cast<int>(model.bodies.size()) - compliant - walls, walls);
  fmt::print("nodes        {}   DOFs {}   mass of grains {}\n", model.node_count(), model.dof_count(),
             si(1000 * mass, "g/m"));
  for (const CompliantShape& shape : model.shapes)
    fmt::print(
        "shape        {} nodes, {} integration points, {:.1f} neighbours a point, least shape function {:.3f}, "
        "completeness {:.1e}\n",
        shape.nodes(), shape.space.table.weight.size(),
        static_cast<double>(shape.space.table.node.size()) / static_cast<double>(shape.space.table.weight.size()),
        shape.space.min_shape_value, shape.space.completeness_residual);
}

void print_contacts(const Simulation& simulation) {
  const ContactSystem& contact = simulation.forces().contact();
  double softest = 1e300, stiffest = 0;
  for (const ContactLaw& law : contact.laws().laws) {
    softest = std::min(softest, stiffness_of(law));
    stiffest = std::max(stiffest, stiffness_of(law));
  }
  fmt::print("contact      {} close pairs, stiffness {} to {}, reach {}, skin {}\n", contact.patches().size(),
             si(softest, "Pa/m"), si(stiffest, "Pa/m"), si(contact.laws().max_reach, "m"), si(contact.skin(), "m"));
}

/// Bytes of one frame before compression: positions and fields in float32.
double frame_bytes(const Model& model) {
  double points = 0, cells = 0, outline = 0;
  for (const Body& body : model.bodies) {
    const int n = model.outlines[body.outline].count;
    outline += n;
    if (body.wall) continue;
    const bool compliant = body.kind == BodyKind::compliant;
    points += compliant ? model.shape_of(model.batches[body.batch]).nodes() : n;
    cells +=
        compliant ? static_cast<double>(model.shape_of(model.batches[body.batch]).space.mesh.triangles.size()) : n - 2;
  }
  double bytes = 8 * points + 8 * outline;
  for (const std::string& field : model.scene.frames.fields)
    bytes += field == "velocity" ? 12 * points : field == "contact_pressure" ? 4 * outline : 4 * cells;
  return bytes;
}

/// Runs a few steps for their cost: the state is thrown away.
double seconds_per_evaluation(Simulation& simulation) {
  const double end = simulation.model().scene.time.end;
  for (int i = 0; i < 3 && simulation.state().time < end; ++i) simulation.step(end);
  const auto start = std::chrono::steady_clock::now();
  const std::int64_t before = simulation.state().evaluations;
  double elapsed = 0;
  while (simulation.state().time < end && elapsed < 0.5) {
    simulation.step(end);
    elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  const std::int64_t done = simulation.state().evaluations - before;
  return done > 0 ? elapsed / static_cast<double>(done) : 0;
}

}  // namespace

void print_check(const Scene& scene, int threads) {
  if (threads > 0) omp_set_num_threads(threads);
  const Model model = build_model(scene);
  Simulation simulation(model);
  fmt::print("scene        {}\n", scene.title.empty() ? scene.name : scene.title);
  print_bodies(model);
  print_contacts(simulation);
  const double dt = simulation.largest_dt();
  const double cost = seconds_per_evaluation(simulation);
  if (std::isfinite(dt)) {
    const double evaluations = scene.time.end / dt;
    fmt::print("time step    {} at most, governed by {}\n", si(dt, "s"), simulation.governing());
    fmt::print("evaluations  {:.3g} at least for {}; at {:.0f} a second on {} threads about {:.3g} hours\n",
               evaluations, si(scene.time.end, "s"), 1 / cost, omp_get_max_threads(), evaluations * cost / 3600);
  } else {
    fmt::print("time step    set by the error control alone; now {}\n", si(simulation.state().next_dt, "s"));
  }
  const double frames = scene.frames.period > 0 ? std::floor(scene.time.end / scene.frames.period) + 1 : 0;
  fmt::print("memory       {} now   frames {:.0f} of {}, {} before compression\n",
             si(static_cast<double>(peak_memory_bytes()), "B"), frames, si(frame_bytes(model), "B"),
             si(frames * frame_bytes(model), "B"));
}

}  // namespace pliant
