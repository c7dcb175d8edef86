#include "results/balance_warning.hpp"

#include <cmath>
#include <string>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace pliant {
namespace {

constexpr double largest_error = 0.01;
/// Strain energies are what is left of numbers as large as the modulus: bodies at rest have balances of rounding only.
constexpr double rounding = 1e-13;
/// What docs/defaults.md recommends where the default heats.
constexpr double calm_safety = 0.4;

/// Modulus times area of all compliant bodies, J/m.
double elastic_scale(const Model& model) {
  double sum = 0;
  for (const Body& body : model.bodies)
    if (body.kind == BodyKind::compliant) sum += model.scene.materials[body.material].young * body.area;
  return sum;
}

/// `stability_governs`: the step, and not its error.
std::string advice(const TimeSettings& time, bool stability_governs) {
  if (time.integrator == Integrator::step_doubling)
    return fmt::format("take a smaller [time] target than {:g}", time.target);
  if (!stability_governs) return fmt::format("take a smaller [time] tolerance than {:g}", time.tolerance);
  return fmt::format(
      "contacts that open and close every few steps may feed vibrations: take [time] safety = {:g} instead of {:g} "
      "(docs/defaults.md, \"Safety and impacts\")",
      time.safety > calm_safety ? calm_safety : time.safety / 2, time.safety);
}

}  // namespace

void warn_of_balance(const Simulation& simulation, const Energies& energy) {
  const double error = simulation.balance_error(energy), gained = simulation.energy_gained(energy);
  const Model& model = simulation.model();
  if (error <= largest_error || std::abs(gained) <= rounding * elastic_scale(model)) return;
  spdlog::warn("energy balance at t = {:.6g} s: {:.2g} J/m {} without cause, {:.3g} % of what came in; {}",
               simulation.state().time, std::abs(gained), gained > 0 ? "gained" : "lost", 100 * error,
               advice(model.scene.time, simulation.state().next_dt >= 0.999 * simulation.largest_dt()));
}

}  // namespace pliant
