#include "benchmarks/kernels/table.hpp"

#include <omp.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include <fmt/format.h>

#include "benchmarks/kernels/machine.hpp"

namespace pliant::kernels {
namespace {

constexpr const char* of_baseline = "baseline/";

double counter(const benchmark::BenchmarkReporter::Run& run, const std::string& name) {
  const auto found = run.counters.find(name);
  return found == run.counters.end() ? 0 : found->second.value;
}

/// "13.3 ns a point".
std::string time_a_unit(const benchmark::BenchmarkReporter::Run& run) {
  for (const auto& [name, value] : run.counters)
    if (name.starts_with("ns_a_")) return fmt::format("{:.3g} ns a {}", value.value, name.substr(5));
  return "";
}

/// Rates, with what share they are of the machine's; "-" where nothing is counted.
std::string flop_rate(double flops, double seconds, int threads) {
  if (flops == 0) return "-";
  const double rate = flops / seconds;
  return fmt::format("{:6.2f} Gflop/s {:3.0f} %", 1e-9 * rate, 100 * rate / fma_peak(threads));
}
std::string read_rate(double bytes, double seconds, int threads) {
  if (bytes == 0) return "-";
  const Level level = level_of(bytes / threads);
  const double rate = bytes / seconds;
  return fmt::format("{:6.2f} GB/s {:3.0f} % of {}", 1e-9 * rate, 100 * rate / read_bandwidth(level, threads),
                     level_names[static_cast<std::size_t>(level)]);
}

}  // namespace

bool Table::ReportContext(const Context&) {
  const int all = omp_get_num_procs();
  fmt::print("fused multiply-adds: {:.3g} Gflop/s of one thread, {:.3g} of {}; fastest of the repetitions below\n",
             1e-9 * fma_peak(1), 1e-9 * fma_peak(all), all);
  fmt::print("{:<46} {:>12}  {:<22} {:<22} {}\n", "kernel", "time", "a unit", "share of FMA peak",
             "compulsory traffic, share of bandwidth");
  return true;
}

void Table::ReportRuns(const std::vector<Run>& runs) {
  const Run* fastest = nullptr;
  for (const Run& run : runs) {
    if (run.run_type != Run::RT_Iteration) continue;
    if (run.error_occurred) {
      fmt::print("{:<46} {}\n", run.run_name.function_name, run.error_message);
      return;
    }
    if (!fastest || run.GetAdjustedRealTime() < fastest->GetAdjustedRealTime()) fastest = &run;
  }
  if (!fastest) return;
  const std::string name = fastest->run_name.function_name + "/" + fastest->run_name.args;
  const double seconds = fastest->GetAdjustedRealTime() / benchmark::GetTimeUnitMultiplier(fastest->time_unit);
  const int threads = std::max(1, static_cast<int>(counter(*fastest, "threads")));
  seconds_[name] = seconds;
  order_.push_back(name);
  take_note(name, threads, counter(*fastest, "flops") / seconds, counter(*fastest, "bytes") / seconds);
  const std::string flops = flop_rate(counter(*fastest, "flops"), seconds, threads);
  const bool is_machine = name.starts_with("machine/");
  fmt::print("{:<46} {:>9.1f} us  {:<22} {:<22} {}\n", name, 1e6 * seconds, time_a_unit(*fastest), flops,
             is_machine ? fmt::format("{:6.2f} GB/s", 1e-9 * counter(*fastest, "bytes") / seconds)
                        : read_rate(counter(*fastest, "bytes"), seconds, threads));
  std::fflush(stdout);
}

void Table::Finalize() {
  bool first = true;
  for (const std::string& name : order_) {
    const auto plain = seconds_.find(of_baseline + name);
    if (plain == seconds_.end()) continue;
    if (std::exchange(first, false)) fmt::print("\n{:<46} {:>12} {:>12} {:>8}\n", "", "engine", "plain loops", "ratio");
    const double engine = seconds_[name];
    fmt::print("{:<46} {:>9.1f} us {:>9.1f} us {:>8.1f}\n", name, 1e6 * engine, 1e6 * plain->second,
               plain->second / engine);
  }
}

}  // namespace pliant::kernels
