#pragma once

#include <benchmark/benchmark.h>

#include <map>
#include <string>
#include <vector>

namespace pliant::kernels {

/// A line a benchmark, of the fastest repetition: time, time a unit, and which shares of the machine's peak of fused
/// multiply-adds and of its bandwidth were reached; at last, how many times longer the plain loops took.
class Table : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& context) override;
  void ReportRuns(const std::vector<Run>& runs) override;
  void Finalize() override;

 private:
  std::map<std::string, double> seconds_;  ///< by name
  std::vector<std::string> order_;
};

}  // namespace pliant::kernels
