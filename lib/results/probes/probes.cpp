#include "results/probes/probes.hpp"

#include <algorithm>
#include <limits>

#include "scene/quantities.hpp"

namespace pliant {

ProbeSampler::ProbeSampler(const Model& model, const Probe& probe)
    : selection_(select(model, probe)), function_(probe_function(probe.quantity)) {
  const ProbeQuantity& quantity = probe_quantity(probe.quantity);
  const Reduction own = quantity.reductions.empty() || probe.node ? Reduction::mean : quantity.reductions.front();
  reduction_ = probe.reduce.value_or(own);
  for (const std::string& column : quantity.columns) columns_.push_back(probe.name + "." + column);
}

std::vector<double> ProbeSampler::sample(const Snapshot& snapshot) const {
  std::vector<double> row = function_.measure(snapshot, selection_).reduced(reduction_);
  if (function_.finish && reduction_ == Reduction::mean) function_.finish(row);
  return row;
}

std::vector<ProbeSampler> make_samplers(const Model& model) {
  std::vector<ProbeSampler> result;
  for (const Probe& probe : model.scene.probes) result.emplace_back(model, probe);
  return result;
}

namespace {

std::vector<std::string> all_columns(const std::vector<ProbeSampler>& samplers) {
  std::vector<std::string> result{"time [s]"};
  for (const ProbeSampler& sampler : samplers)
    result.insert(result.end(), sampler.columns().begin(), sampler.columns().end());
  return result;
}

}  // namespace

ProbeRecorder::ProbeRecorder(const Model& model, const std::filesystem::path& folder, Opening opening)
    : samplers_(make_samplers(model)),
      counts_(samplers_.size(), 0),
      file_(folder / "probes.csv", all_columns(samplers_), opening) {
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
  const Snapshot snapshot(simulation);
  std::vector<double> row{time};
  bool some_due = false;
  for (std::size_t p = 0; p < samplers_.size(); ++p) {
    // Products that mean the same instant may differ by rounding.
    const bool due = time >= static_cast<double>(counts_[p]) * periods_[p] * (1 - 1e-12);
    const std::size_t columns = samplers_[p].columns().size();
    const std::vector<double> values =
        due ? samplers_[p].sample(snapshot) : std::vector<double>(columns, std::numeric_limits<double>::quiet_NaN());
    row.insert(row.end(), values.begin(), values.end());
    counts_[p] += due;
    some_due |= due;
  }
  if (some_due) file_.row(row);
}

}  // namespace pliant
