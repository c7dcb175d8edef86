#pragma once

#include <string>
#include <vector>

#include "dynamics/simulation.hpp"
#include "files/text_files.hpp"

namespace pliant {

/// What one [[probes]] entry measures: its columns, and their values for the current state.
class ProbeSampler {
 public:
  ProbeSampler(const Model& model, const Probe& probe);
  const std::vector<std::string>& columns() const { return columns_; }
  std::vector<double> sample(Simulation& simulation) const;

 private:
  std::vector<double> mean(const Simulation& simulation, const Dofs& dofs, bool positions) const;
  std::vector<double> force(const Simulation& simulation) const;
  std::vector<double> extent(const Simulation& simulation) const;

  const Model& model_;
  const Probe& probe_;
  std::vector<int> bodies_;
  std::vector<std::string> columns_;
};

/// probes.csv: a row whenever some probe is due, empty cells where another is not.
class ProbeRecorder {
 public:
  ProbeRecorder(const Model& model, const std::filesystem::path& folder);
  double next_time() const;  ///< infinite without probes
  void record_due(Simulation& simulation);
  void flush() { file_.flush(); }

 private:
  std::vector<ProbeSampler> samplers_;
  std::vector<double> periods_;
  std::vector<long> counts_;  ///< samples taken by each probe: the next is due at count x period
  CsvFile file_;
};

}  // namespace pliant
