#include "results/summary.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "build_info.hpp"
#include "core/memory.hpp"
#include "core/warnings.hpp"

namespace pliant {

std::string summary_json(Simulation& simulation, const RunFigures& figures, const std::string& status) {
  const State& state = simulation.state();
  const Model& model = simulation.model();
  const EnergyBalance audit = simulation.energy_balance();
  const Energies& e = audit.energy;
  nlohmann::ordered_json json;
  json["scene"] = model.scene.name;
  json["title"] = model.scene.title;
  json["status"] = status;
  json["time"] = state.time;
  json["end"] = model.scene.time.end;
  json["state_hash"] = fmt::format("{:016x}", state_hash(state));
  json["evaluations"] = state.evaluations;
  json["steps"] = state.steps;
  json["rejections"] = state.rejections;
  json["preparation_seconds"] = figures.preparation_seconds;
  json["wall_seconds"] = figures.wall_seconds;
  json["evaluations_per_second"] =
      figures.wall_seconds > 0 ? static_cast<double>(state.evaluations) / figures.wall_seconds : 0.0;
  const PhaseTimes::Seconds seconds = simulation.phases().seconds(figures.process_seconds);
  for (std::size_t p = 0; p < seconds.size(); ++p) json["phase_seconds"][phase_names[p]] = seconds[p];
  json["energy"] = {{"kinetic", e.kinetic},
                    {"strain", e.strain},
                    {"contact", e.contact},
                    {"boundary", e.boundary},
                    {"dissipated", e.dissipated},
                    {"external_work", e.external_work},
                    {"balance_error", simulation.balance_error(e)}};
  const InitialOverlap& overlap = simulation.overlap();
  json["initial_overlap"] = {{"pairs", overlap.pairs},
                             {"depth", overlap.depth},
                             {"depth_over_segment", overlap.share},
                             {"stored_energy", overlap.stored}};
  json["momentum_error"] = std::max(figures.worst_momentum_error, audit.momentum_error);
  json["peak_memory_bytes"] = peak_memory_bytes();
  json["bodies"] = model.bodies.size();
  json["nodes"] = model.node_count();
  json["dofs"] = model.dof_count();
  json["commit"] = build_commit;
  json["compiler"] = build_compiler;
  json["threads"] = figures.threads;
  if (!figures.started_from.empty()) json["started_from"] = nlohmann::ordered_json::parse(figures.started_from);
  json["resumed"] = figures.resumed;
  json["checkpoint_time"] = figures.checkpoint_time < 0 ? nlohmann::json() : nlohmann::json(figures.checkpoint_time);
  json["warnings"] = figures.warnings;
  for (const std::string& text : warnings_so_far())
    if (std::ranges::find(figures.warnings, text) == figures.warnings.end()) json["warnings"].push_back(text);
  return json.dump(2) + "\n";
}

}  // namespace pliant
