#pragma once

#include <string>
#include <vector>

#include "files/text_output.hpp"
#include "results/probes/probe_functions.hpp"

namespace pliant {

/// What one [[probes]] entry measures: its columns, and their values.
class ProbeSampler {
 public:
  /// Throws InputError for what only the model can tell to be wrong: a node that the body does not have.
  ProbeSampler(const Model& model, const Probe& probe);
  const std::vector<std::string>& columns() const { return columns_; }
  std::vector<double> sample(const Snapshot& snapshot) const;

 private:
  Selection selection_;
  const ProbeFunction& function_;
  Reduction reduction_;
  std::vector<std::string> columns_;
};

/// One a probe of the scene. Throws InputError.
std::vector<ProbeSampler> make_samplers(const Model& model);

/// probes.csv: a row whenever some probe is due, empty cells where another is not.
class ProbeRecorder {
 public:
  ProbeRecorder(const Model& model, const std::filesystem::path& folder, Opening opening = Opening::create);
  double next_time() const;  ///< infinite without probes
  void record_due(Simulation& simulation);
  void flush() { file_.flush(); }
  void sync() { file_.sync(); }
  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("counts", counts_);
    visitor("file", file_);
  }

 private:
  std::vector<ProbeSampler> samplers_;
  std::vector<double> periods_;
  std::vector<long> counts_;  ///< samples taken by each probe: the next is due at count x period
  CsvFile file_;
};

}  // namespace pliant
