#pragma once

#include <filesystem>

#include "dynamics/simulation.hpp"
#include "files/text_output.hpp"

namespace pliant {

/// steps.csv: every accepted step of the first 200,000, then every tenth. Rejections and evaluations count from the
/// start.
class StepLog {
 public:
  explicit StepLog(const std::filesystem::path& folder, Opening opening = Opening::create)
      : file_(folder / "steps.csv", {"time [s]", "dt [s]", "error [-]", "rejections", "evaluations", "contacts"},
              opening) {}

  void record(const State& state, const StepReport& report) {
    constexpr long all = 200000, thinned = 10;
    if (state.steps > all && state.steps % thinned != 0) return;
    file_.row({state.time, report.dt, report.error, static_cast<double>(state.rejections),
               static_cast<double>(state.evaluations), static_cast<double>(report.evaluation.contact.contacts)});
  }
  void flush() { file_.flush(); }
  void sync() { file_.sync(); }
  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("file", file_);
  }

 private:
  CsvFile file_;
};

}  // namespace pliant
