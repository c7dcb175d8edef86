#include "run/balance_warning.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace pliant {
namespace {

constexpr double largest_error = 0.01;
/// Energies are what is left of numbers as large as the modulus times area, and forces times positions: bodies at rest
/// have balances of rounding only.
constexpr double rounding = 1e-13;
/// What docs/notes/impacts.md recommends where the default heats.
constexpr double calm_safety = 0.4;
/// Penetration over segment length from which on it is to blame, and that stiffer contacts should come down to.
constexpr double deep = 0.3, shallow = 0.1;

/// Modulus times area of all compliant bodies, and weights and contact forces times coordinates, J/m.
double energy_scale(const Simulation& simulation) {
  const Model& model = simulation.model();
  const OutlineField &outlines = simulation.state().outlines.position, &force = simulation.state().contact_force;
  const Vec2 gravity = model.scene.gravity_at(simulation.state().time).cwiseAbs();
  double sum = 0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (body.kind == BodyKind::compliant) sum += model.scene.materials[body.material].young * body.area;
    Vec2 furthest(0, 0);
    for (int i = model.outline_offset[b]; i < model.outline_offset[b] + model.outlines[body.outline].count; ++i) {
      const Vec2 at = outlines.at(i).cwiseAbs();
      sum += at.dot(force.at(i).cwiseAbs());
      furthest = furthest.cwiseMax(at);
    }
    sum += body.mass * gravity.dot(furthest);
  }
  return sum;
}

/// Depths of bodies that hit each other go as one over the root of the stiffness, of pressed ones as one over it.
std::string against_depth(const TimeSettings& time, const StepStatistics& seen) {
  const double ratio = seen.deepest / shallow;
  return fmt::format(
      "contacts got {:.2g} of a segment deep at t = {:.4g} s, where bodies rebound within few steps: take a "
      "[[contacts]] "
      "stiffness {:.2g} times as high if that was an impact, {:.2g} times if loads press, for {:g} of a segment, with "
      "[time] safety = {:g}",
      seen.deepest, seen.deepest_time, std::ceil(ratio * ratio), ratio, shallow, std::min(time.safety, calm_safety));
}

/// Errors of bodies alone go as the square of the step.
double safety_for(const TimeSettings& time, double error) {
  return time.safety * std::sqrt(0.5 * largest_error / error);
}

std::string against_free_motion(const Simulation& simulation, double error) {
  const TimeSettings& time = simulation.model().scene.time;
  const char* cause = simulation.state().damped > 0
                          ? "viscosity and damping see motions that steps of this length distort"
                          : "steps are long against the motion";
  return fmt::format("no contact had a part in it: {}: take [time] safety = {:.2g} instead of {:g}", cause,
                     safety_for(time, error), time.safety);
}

std::string against_error_control(const TimeSettings& time, bool feeds) {
  return fmt::format(
      "step-doubling has no bound of stability and {} vibrations at any target, at a smaller one than {:g} often "
      "more: take [time] integrator = \"verlet\" with safety = {:g}",
      feeds ? "feeds" : "damps", time.target, calm_safety);
}

std::string against_jumps(const Simulation& simulation, bool feeds) {
  const TimeSettings& time = simulation.model().scene.time;
  const StepStatistics& seen = simulation.statistics();
  if (seen.by_error > seen.by_stability)
    return fmt::format("the error limits most steps: take a smaller [time] tolerance than {:g}", time.tolerance);
  return fmt::format(
      "contacts that open and close every few steps may {} vibrations: take [time] safety = {:g} instead of {:g} "
      "(docs/defaults.md, \"Safety and impacts\")",
      feeds ? "feed" : "damp", time.safety > calm_safety ? calm_safety : time.safety / 2, time.safety);
}

/// The likeliest cause by what the run has met, and what to do.
std::string diagnosis(const Simulation& simulation, double error, bool feeds) {
  const StepStatistics& seen = simulation.statistics();
  const InitialOverlap& overlap = simulation.overlap();
  const Model& model = simulation.model();
  if (overlap.share > deep && overlap.share >= 0.9 * seen.deepest)
    return fmt::format("bodies overlapped by {:.2g} of a segment at the start: {}", overlap.share,
                       remedy(overlap, model));
  if (seen.deepest > deep) return against_depth(model.scene.time, seen);
  if (!traits_of(model.scene.time.integrator).is_bounded) return against_error_control(model.scene.time, feeds);
  return seen.contacts == 0 ? against_free_motion(simulation, error) : against_jumps(simulation, feeds);
}

}  // namespace

void warn_of_balance(const Simulation& simulation, const Energies& energy) {
  const double error = simulation.balance_error(energy), gained = simulation.energy_gained(energy);
  if (error <= largest_error || std::abs(gained) <= rounding * energy_scale(simulation)) return;
  spdlog::warn("energy balance at t = {:.6g} s: {:.2g} J/m {} without cause, {:.3g} % of what came in; {}",
               simulation.state().time, std::abs(gained), gained > 0 ? "gained" : "lost", 100 * error,
               diagnosis(simulation, error, gained > 0));
}

}  // namespace pliant
