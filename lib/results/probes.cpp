#include "results/probes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "bodies/mass_correction.hpp"
#include "bodies/nodal.hpp"

namespace pliant {
namespace {

/// Names and units of the columns of each quantity.
std::vector<std::string> quantity_columns(ProbeQuantity quantity) {
  switch (quantity) {
    case ProbeQuantity::force:
      return {"force_x [N/m]", "force_y [N/m]"};
    case ProbeQuantity::friction_factor:
      return {"friction_factor [-]"};
    case ProbeQuantity::position:
      return {"position_x [m]", "position_y [m]", "angle [rad]"};
    case ProbeQuantity::velocity:
      return {"velocity_x [m/s]", "velocity_y [m/s]", "angular_velocity [rad/s]"};
    case ProbeQuantity::diameter:
      return {"diameter_x [m]", "diameter_y [m]"};
    case ProbeQuantity::energy:
      break;
  }
  return {"kinetic [J/m]",       "strain [J/m]",      "contact [J/m]",     "dissipated [J/m]",
          "external_work [J/m]", "balance_error [-]", "momentum_error [-]"};
}

std::vector<int> selected_bodies(const Model& model, const std::string& of) {
  std::vector<int> result;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const bool named = body.wall ? body.name == of : model.scene.grains[body.grains].name == of;
    const bool of_kind = !body.wall && of == (body.kind == BodyKind::compliant ? "compliant" : "rigid");
    if (named || of_kind) result.push_back(static_cast<int>(b));
  }
  return result;
}

}  // namespace

ProbeSampler::ProbeSampler(const Model& model, const Probe& probe)
    : model_(model), probe_(probe), bodies_(selected_bodies(model, probe.of)) {
  for (const std::string& column : quantity_columns(probe.quantity)) columns_.push_back(probe.name + "." + column);
}

std::vector<double> ProbeSampler::sample(Simulation& simulation) const {
  switch (probe_.quantity) {
    case ProbeQuantity::force:
      return force(simulation);
    case ProbeQuantity::friction_factor: {
      const std::vector<double> f = force(simulation);
      return {f[1] != 0 ? f[0] / std::abs(f[1]) : std::numeric_limits<double>::quiet_NaN()};
    }
    case ProbeQuantity::position:
      return mean(simulation, simulation.state().position, true);
    case ProbeQuantity::velocity:
      return mean(simulation, material_velocity(model_, simulation.state().velocity), false);
    case ProbeQuantity::diameter:
      return extent(simulation);
    case ProbeQuantity::energy:
      break;
  }
  const Audit audit = simulation.audit();
  const Energies& e = audit.energy;
  return {e.kinetic,           e.strain, e.contact, e.dissipated, e.external_work, simulation.balance_error(e),
          audit.momentum_error};
}

/// Contact force on the selected bodies together.
std::vector<double> ProbeSampler::force(const Simulation& simulation) const {
  const Outlines& outlines = simulation.forces().outlines();
  std::vector<double> total{0, 0};
  for (int b : bodies_)
    for (int i = outlines.offset[b]; i < outlines.offset[b] + model_.outlines[outlines.shape[b]].count; ++i) {
      total[0] += outlines.force_x[i];
      total[1] += outlines.force_y[i];
    }
  return total;
}

/// Means over the selected bodies; compliant bodies have no angle of their own.
std::vector<double> ProbeSampler::mean(const Simulation&, const Dofs& dofs, bool positions) const {
  std::vector<double> total{0, 0, 0};
  bool all_rigid = true;
  for (int b : bodies_) {
    const Body& body = model_.bodies[b];
    if (body.kind == BodyKind::compliant) {
      const Vec2 centre = mean_value(model_, body, dofs) + (positions ? body.centre : Vec2(0, 0));
      total[0] += centre.x(), total[1] += centre.y();
      all_rigid = false;
    } else {
      for (std::size_t c = 0; c < 3; ++c) total[c] += dofs.rigid[3 * static_cast<std::size_t>(body.rigid) + c];
    }
  }
  for (double& t : total) t /= static_cast<double>(bodies_.size());
  if (!all_rigid) total[2] = std::numeric_limits<double>::quiet_NaN();
  return total;
}

/// Mean extents of the outlines.
std::vector<double> ProbeSampler::extent(const Simulation& simulation) const {
  const Outlines& outlines = simulation.forces().outlines();
  std::vector<double> total{0, 0};
  for (int b : bodies_) {
    const Box box = bounding_box(model_.outlines[outlines.shape[b]], outlines, b);
    total[0] += (box.x_max - box.x_min) / static_cast<double>(bodies_.size());
    total[1] += (box.y_max - box.y_min) / static_cast<double>(bodies_.size());
  }
  return total;
}

namespace {

std::vector<ProbeSampler> make_samplers(const Model& model) {
  std::vector<ProbeSampler> result;
  for (const Probe& probe : model.scene.probes) result.emplace_back(model, probe);
  return result;
}

std::vector<std::string> all_columns(const std::vector<ProbeSampler>& samplers) {
  std::vector<std::string> result{"time [s]"};
  for (const ProbeSampler& sampler : samplers)
    result.insert(result.end(), sampler.columns().begin(), sampler.columns().end());
  return result;
}

}  // namespace

ProbeRecorder::ProbeRecorder(const Model& model, const std::filesystem::path& folder)
    : samplers_(make_samplers(model)),
      counts_(samplers_.size(), 0),
      file_(folder / "probes.csv", all_columns(samplers_)) {
  for (const Probe& probe : model.scene.probes) periods_.push_back(probe.period);
}

double ProbeRecorder::next_time() const {
  double next = std::numeric_limits<double>::infinity();
  for (std::size_t p = 0; p < periods_.size(); ++p)
    next = std::min(next, static_cast<double>(counts_[p]) * periods_[p]);
  return next;
}

void ProbeRecorder::record_due(Simulation& simulation) {
  const double time = simulation.state().time;
  std::vector<double> row{time};
  bool some_due = false;
  for (std::size_t p = 0; p < samplers_.size(); ++p) {
    // Products that mean the same instant may differ by rounding.
    const bool due = time >= static_cast<double>(counts_[p]) * periods_[p] * (1 - 1e-12);
    const std::size_t columns = samplers_[p].columns().size();
    const std::vector<double> values =
        due ? samplers_[p].sample(simulation) : std::vector<double>(columns, std::numeric_limits<double>::quiet_NaN());
    row.insert(row.end(), values.begin(), values.end());
    counts_[p] += due;
    some_due |= due;
  }
  if (some_due) file_.row(row);
}

}  // namespace pliant
