#include <cmath>

#include "scene/read_tables.hpp"

namespace pliant {

namespace {

/// Refuses a period that would write more rows or frames than anybody can read.
void check_output_count(const TableReader& table, double end, double period) {
  const double count = end / period;
  if (count <= static_cast<double>(SceneLimits::outputs)) return;
  table.fail("period", fmt::format("{:.3g} outputs until the end at {} s; allowed: at most {}, so a period >= {} s",
                                   count, end, SceneLimits::outputs, end / SceneLimits::outputs));
}

/// What a probe of this quantity may be of.
std::vector<std::string> probe_targets(ProbeQuantity quantity, const Scene& scene) {
  std::vector<std::string> targets;
  if (quantity != ProbeQuantity::diameter) targets = names_of(scene.walls);
  if (quantity == ProbeQuantity::friction_factor) return targets;
  for (const Grains& grains : scene.grains) targets.push_back(grains.name);
  for (const auto& [name, kind] : {std::pair("compliant", BodyKind::compliant), std::pair("rigid", BodyKind::rigid)}) {
    for (const Grains& grains : scene.grains) {
      if (has_body(grains, kind) && targets.back() != name) targets.push_back(name);
    }
  }
  return targets;
}

}  // namespace

void read_domain(TableReader table, Scene& scene) {
  table.optional("period", scene.period, Quantity{"m", positive});
  table.optional("gravity", scene.gravity, Vector{"m/s2"});
  table.finish();
}

TimeSettings read_time(TableReader table) {
  const Range share{.low = 0, .high = 1, .low_open = true};
  TimeSettings time;
  table.required("end", time.end, Quantity{"s", positive});
  table.optional("integrator", time.integrator,
                 Choice<Integrator>{{{"verlet", Integrator::verlet}, {"step-doubling", Integrator::step_doubling}}});
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

Probe read_probe(TableReader table, const Scene& scene) {
  Probe probe;
  table.required("name", probe.name, Identifier{});
  table.required("quantity", probe.quantity,
                 Choice<ProbeQuantity>{{{"force", ProbeQuantity::force},
                                        {"friction_factor", ProbeQuantity::friction_factor},
                                        {"position", ProbeQuantity::position},
                                        {"velocity", ProbeQuantity::velocity},
                                        {"diameter", ProbeQuantity::diameter},
                                        {"energy", ProbeQuantity::energy}}});
  if (probe.quantity != ProbeQuantity::energy) {
    table.required("of", probe.of, OneOf{"wall or grains", probe_targets(probe.quantity, scene)});
  }
  table.required("period", probe.period, Quantity{"s", positive});
  check_output_count(table, scene.time.end, probe.period);
  table.finish();
  return probe;
}

Frames read_frames(TableReader table, const Scene& scene) {
  const OneOf field{"field", {"velocity", "von_mises", "jacobian", "pressure", "contact_pressure"}};
  Frames frames;
  table.required("period", frames.period, Quantity{"s", positive});
  check_output_count(table, scene.time.end, frames.period);
  table.optional("fields", frames.fields, List<OneOf>{field, 0});
  for (std::size_t i = 0; i < frames.fields.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (frames.fields[i] == frames.fields[j]) table.fail("fields", fmt::format("\"{}\" twice", frames.fields[i]));
    }
  }
  table.finish();
  return frames;
}

}  // namespace pliant
