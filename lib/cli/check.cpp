#include "cli/check.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>

#include <fmt/format.h>

#include "cli/bond_estimates.hpp"
#include "cli/dry_run.hpp"
#include "cli/estimates.hpp"
#include "cli/expected_errors.hpp"
#include "cli/preflight_warnings.hpp"
#include "cli/stability.hpp"
#include "cli/thin_parts.hpp"
#include "core/memory.hpp"
#include "run/default_threads.hpp"
#include "run/start_file.hpp"
#include "setup/build_model.hpp"

namespace pliant {
namespace {

/// 1.18e-11 and "s" as "11.8 ps".
std::string si(double value, const char* unit) {
  static constexpr const char* prefixes[] = {"f", "p", "n", "u", "m", "", "k", "M", "G", "T"};
  if (value == 0 || !std::isfinite(value)) return fmt::format("{} {}", value, unit);
  const int step = std::clamp(static_cast<int>(std::floor(std::log10(std::abs(value)) / 3 + 1e-9)), -5, 4);
  return fmt::format("{:.3g} {}{}", value / std::pow(1000.0, step), prefixes[step + 5], unit);
}

/// Seconds of waiting as a person says them.
std::string duration(double seconds) {
  if (seconds < 100) return fmt::format("{:.2g} s", seconds);
  if (seconds < 6000) return fmt::format("{:.0f} min", seconds / 60);
  return seconds < 360'000 ? fmt::format("{:.1f} h", seconds / 3600) : fmt::format("{:.0f} days", seconds / 86400);
}

std::string count(double number) {
  return number < 10'000 ? fmt::format("{:.0f}", number)
         : number < 1e6  ? fmt::format("{:.3g} thousand", number / 1e3)
                         : fmt::format("{:.3g} million", number / 1e6);
}

/// Continuation lines have no heading.
void print_row(const char* heading, const std::string& text) { fmt::print("{:<12} {}\n", heading, text); }

const char* kind_name(const Body& body) { return body.kind == BodyKind::compliant ? "compliant" : "rigid"; }

void print_bodies(const Model& model) {
  int compliant = 0, walls = 0;
  for (const Body& body : model.bodies) compliant += body.kind == BodyKind::compliant, walls += body.wall;
  const int all = static_cast<int>(model.bodies.size());
  print_row("bodies",
            fmt::format("{}: compliant {}, rigid {}, walls {}", all, compliant, all - compliant - walls, walls));
  int field = 0;
  for (const Body& body : model.bodies)
    if (body.kind == BodyKind::compliant) field += model.shape_of(body).nodes();
  print_row("nodes", fmt::format("{}: in compliant bodies {}, on outlines of rigid bodies and walls {}",
                                 model.node_count(), field, model.node_count() - field));
  print_row("DOFs", std::to_string(model.dof_count()));
}

/// How compliant bodies share batches, where it is not one shape a batch.
void print_layouts(const Model& model) {
  int bodies[3] = {0, 0, 0};
  for (const Batch& batch : model.batches) bodies[static_cast<int>(batch.layout)] += batch.count;
  const auto [shared, same_topology, nodewise] = bodies;
  if (same_topology + nodewise > 0)
    print_row("lanes", fmt::format("of one shape: {} bodies; of one topology: {}; vectorised over nodes: {}", shared,
                                   same_topology, nodewise));
}

/// Solid fractions of what fills a region: of the outlines as they start.
void print_packings(const Model& model) {
  for (std::size_t g = 0; g < model.scene.grains.size(); ++g) {
    const Packing& packing = model.scene.grains[g].packing;
    if (packing.kind != PackingKind::random && packing.kind != PackingKind::fourier_voronoi) continue;
    double area = 0;
    for (const Body& body : model.bodies)
      if (body.grains == static_cast<int>(g)) area += body.area;
    const double region = (packing.right - packing.left) * (packing.top - packing.bottom);
    print_row("packing",
              fmt::format("{}: {} grains from y = {} to {}, solid fraction {:.4f}", model.scene.grains[g].name,
                          packing.count, si(packing.bottom, "m"), si(packing.top, "m"), area / region));
  }
}

struct Share {
  int bodies = 0;
  double mass = 0;  ///< kg/m
  void add(const Body& body) { ++bodies, mass += body.mass; }
};

void print_share(const char* heading, const std::string& label, const Share& share) {
  const std::string mass = share.mass > 0 ? fmt::format("{:.4g} kg/m", share.mass) : "none given";
  print_row(heading, fmt::format("{:<32} {:>7}   {}", label, share.bodies, mass));
}

void print_masses(const Model& model) {
  std::map<std::string, Share> shares;
  Share grains, all;
  for (const Body& body : model.bodies) {
    const std::string& material = model.scene.materials[body.material].name;
    shares[body.wall ? fmt::format("wall {} of {}", body.name, material)
                     : fmt::format("{} grains of {}", kind_name(body), material)]
        .add(body);
    all.add(body);
    if (!body.wall) grains.add(body);
  }
  const char* heading = "mass";
  for (const auto& [label, share] : shares) {
    print_share(heading, label, share);
    heading = "";
  }
  print_share("", "all grains", grains);
  if (const double slowed = slowed_by_mass_scaling(model); slowed > 0)
    print_row("", fmt::format("mass_scaling slows a uniform stretch of compliant grains by {:.2g} %, their translation "
                              "by nothing",
                              100 * slowed));
  if (all.bodies > grains.bodies) print_share("", "all bodies", all);
}

void print_shapes(const Model& model) {
  constexpr std::size_t most_shown = 8;  // of many variants the first say enough
  for (std::size_t s = 0; s < std::min(most_shown, model.shapes.size()); ++s) {
    const CompliantShape& shape = model.shapes[s];
    const Discretisation& space = shape.space;
    const double points = static_cast<double>(space.table.weight.size());
    print_row("shape", fmt::format("{} nodes, {} on the outline; {:.0f} integration points of {:.1f} neighbours each; "
                                   "least shape function {:.3f}; condition {:.1e}; completeness {:.1e}",
                                   shape.nodes(), model.outlines[shape.outline].count, points,
                                   static_cast<double>(space.table.node.size()) / points, space.min_shape_value,
                                   space.condition, space.completeness_residual));
  }
  if (model.shapes.size() > most_shown)
    print_row("", fmt::format("and {} more shapes", model.shapes.size() - most_shown));
}

std::string describe(const PairEstimate& pair, double pressure) {
  std::string text = fmt::format("{:<24} {:<13} {:>9.3g} Pa/m {:<6} h {:<8}", pair.first + " - " + pair.second,
                                 pair.law, pair.stiffness, pair.automatic ? "auto" : "given", si(pair.spacing, "m"));
  if (pair.shear_stiffness > 0 && pair.shear_stiffness != pair.stiffness)
    text += fmt::format(" in shear {:.3g} Pa/m", pair.shear_stiffness);
  const auto percent = [&](double length) { return fmt::format("{:.2g} % of h", 100 * length / pair.spacing); };
  if (pressure > 0) text += fmt::format(" {} deep at {}", percent(pair.penetration(pressure)), si(pressure, "Pa"));
  if (pair.strength > 0)
    text += fmt::format("; pull greatest at {}, none from {}", percent(pair.strength / pair.stiffness),
                        percent(pair.reach));
  if (pair.friction > 0)
    text += fmt::format("{} friction {:.3g}", pressure > 0 || pair.strength > 0 ? ";" : "", pair.friction);
  return text;
}

void print_contacts(const Model& model, const ContactSystem& contact) {
  const char* heading = "contact";
  for (const PairEstimate& pair : pair_estimates(model, contact.laws())) {
    print_row(heading, describe(pair, largest_pressure(model.scene)));
    heading = "";
  }
  const auto close = std::ranges::count_if(contact.contact_pairs(),
                                           [](const ContactPair& contact_pair) { return !contact_pair.is_empty(); });
  print_row(heading, fmt::format("pairs of bodies close at the start: {}; skin {}", close, si(contact.skin(), "m")));
}

void print_bonds(const Simulation& simulation) {
  const char* heading = "bonds";
  for (const std::string& line : describe_bonds(simulation.model(), simulation.forces().bonds())) {
    print_row(heading, line);
    heading = "";
  }
}

void print_overlap(const Simulation& simulation) {
  const std::string text = describe(simulation.overlap(), simulation.model());
  if (!text.empty()) print_row("overlap", text);
}

void print_errors(const Model& model) {
  if (const std::string text = describe_expected_errors(model); !text.empty()) print_row("errors", text);
  if (const std::string text = describe_bending(model); !text.empty()) print_row("bending", text);
}

void print_cautions(const Model& model) {
  const char* heading = "mind";
  for (const std::string& preflight_warning : preflight_warnings(model)) {
    print_row(heading, preflight_warning);
    heading = "";
  }
}

/// Fastest motion of bodies against each other that the scene prescribes, m/s: what all do together uses up no skin.
/// Walls without prescribed motion rest at the start.
double prescribed_speed(const Scene& scene) {
  Vec2 least = Vec2::Constant(1e300), largest = -least;
  const auto add = [&](int component, double v) {
    least[component] = std::min(least[component], v), largest[component] = std::max(largest[component], v);
  };
  for (const Grains& grains : scene.grains)
    for (int c = 0; c < 2; ++c) add(c, grains.velocity.uniform[c]);
  for (const Wall& wall : scene.walls)
    for (int c = 0; c < 2; ++c) {
      const AxisCondition& prescribed = c == 0 ? wall.x : wall.y;
      if (prescribed.mode != AxisCondition::Mode::velocity)
        add(c, 0);
      else
        for (double v : prescribed.history.value) add(c, v);
    }
  return (largest - least).norm();
}

void print_time_step(const Model& model, const Stability& stable, double skin) {
  const Scene& scene = model.scene;
  const bool bounded = traits_of(scene.time.integrator).is_bounded;
  if (!std::isfinite(stable.dt)) return print_row("time step", "set by the error control alone: nothing is stiff");
  print_row("time step", fmt::format("{} {}, governed by {}", si(stable.dt, "s"),
                                     bounded ? "at most" : "would be the bound of verlet", stable.governing));
  print_row("", fmt::format("{} with all contacts {:.0f} times as stiff: {:.2g} times as many steps",
                            si(stable.stiffer_dt, "s"), stiffer, stable.dt / stable.stiffer_dt));
  if (!bounded) print_row("", "step doubling sets its own by the error; it is not stable far beyond that bound");
  if (const auto advice = advice_on_mass_scaling(model, stable)) print_row("", *advice);
  const double speed = prescribed_speed(scene);
  if (speed * stable.dt > skin)
    print_row(
        "",
        fmt::format("bodies that pass at {} use up the contact skin in {}: a larger [contact] skin allows longer steps",
                    si(speed, "m/s"), si(skin / speed, "s")));
}

/// Evaluations of the whole run: counted, or those of the dry run and what its pace or the bound makes of the rest.
struct Forecast {
  double evaluations = 0;
  const char *before = "", *after = "";
};

Forecast forecast(const Scene& scene, const DryRun& first, double bound) {
  const double done = static_cast<double>(first.evaluations), left = scene.time.end - first.time;
  if (first.finished) return {done, "", ", counted: the first second went to the end"};
  const IntegratorTraits integrator = traits_of(scene.time.integrator);
  const double least = integrator.is_bounded ? least_steps(scene, left, std::min(bound, left)) : 0;
  const double paced = first.pace > 0          ? left / first.pace
                       : integrator.is_bounded ? 0
                                               : integrator.evaluations * left / first.next_dt;
  if (paced > least) return {done + paced, "about ", ", at the pace of the first second"};
  return {done + least, "at least ", ", at the largest stable step"};
}

/// Largest power of two of threads that spend half of their time at work or more; the rest they wait for each other. A
/// step opens seven parallel regions, each of which costs 1.7 us with two threads (docs/speed.md) and more as the
/// logarithm of their number.
int useful_threads(double seconds_on_one) {
  constexpr double waiting_of_two = 7 * 1.7e-6;
  int threads = 1;
  while (threads < 1024 && seconds_on_one / (2 * threads) >= waiting_of_two * std::log2(2.0 * threads)) threads *= 2;
  return threads;
}

void print_cost(const Model& model, const DryRun& first, const Forecast& run, std::int64_t frames) {
  std::string text =
      fmt::format("{}{} until {}{}", run.before, count(run.evaluations), si(model.scene.time.end, "s"), run.after);
  if (first.rejections > 0)
    text += fmt::format("; {:.2g} % of the first {} were rejected",
                        100.0 * static_cast<double>(first.rejections) / static_cast<double>(first.evaluations),
                        first.evaluations);
  print_row("evaluations", text);
  // Measured on a local disk: each frame is synchronised to it, and compressed at some 60 MB/s.
  const double frame_seconds = 0.01 + frame_bytes(model) / 60e6;
  const int threads = omp_get_max_threads();
  print_row("time",
            fmt::format("{}{}, {:.0f} evaluations a second on {} thread{}; and {} to write frames", run.before,
                        duration(run.evaluations * first.seconds_per_evaluation), 1 / first.seconds_per_evaluation,
                        threads, threads > 1 ? "s" : "", duration(frame_seconds * static_cast<double>(frames))));
  const int useful = useful_threads(threads * first.seconds_per_evaluation);
  print_row("threads", useful > 1 ? fmt::format("up to some {} can be of use", useful)
                                  : "more than one would wait for each other");
}

void print_sizes(const Model& model, const OutputSize& size) {
  // What a run holds besides: HDF5, text on its way out, two copies of a frame.
  const double memory = static_cast<double>(peak_memory_bytes()) + 8e6 + 3 * frame_bytes(model);
  print_row("memory", "about " + si(memory, "B"));
  print_row("output", fmt::format("about {}: {} frames {}, their index {}, probes {}, steps {}", si(size.total(), "B"),
                                  size.frames, si(size.frames_h5, "B"), si(size.frames_xdmf, "B"),
                                  si(size.probes_csv, "B"), si(size.steps_csv, "B")));
}

}  // namespace

void print_check(const Scene& scene, int threads) {
  set_threads(threads);
  const std::unique_ptr<const StartFile> from = start_file_of(scene);
  const Model model = build_model(scene);
  print_row("scene", scene.title.empty() ? scene.name : scene.title);
  print_bodies(model);
  print_layouts(model);
  print_packings(model);
  print_masses(model);
  print_shapes(model);
  const Stability stable = stability(model);
  Simulation simulation = start_simulation(model, from.get());
  if (from) print_row("start", fmt::format("from '{}' at its t = {:.6g} s", from->scene_name(), from->time()));
  print_contacts(model, simulation.forces().contact());
  print_bonds(simulation);
  print_overlap(simulation);
  print_errors(model);
  print_cautions(model);
  print_time_step(model, stable, simulation.forces().contact().skin());
  const DryRun first = dry_run(simulation);
  const Forecast run = forecast(scene, first, stable.dt);
  const OutputSize size = output_size(model, run.evaluations);
  print_cost(model, first, run, size.frames);
  print_sizes(model, size);
}

}  // namespace pliant
