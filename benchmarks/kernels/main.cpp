// ./pliant bench kernels: times the kernels of the engine, and beside them the plain loops of users' own codes. Results
// also go to results/bench/kernels.json, as Google Benchmark writes them, unless --benchmark_out says otherwise.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "benchmarks/kernels/table.hpp"

namespace {

/// What holds unless the caller says otherwise.
void add_default(std::vector<std::string>& arguments, const std::string& option, const std::string& value) {
  const bool given =
      std::ranges::any_of(arguments, [&](const std::string& a) { return a.starts_with("--" + option + "="); });
  if (!given) arguments.push_back("--" + option + "=" + value);
}

}  // namespace

int main(int count, char** given) {
  std::vector<std::string> arguments(given, given + count);
  const std::filesystem::path folder = PLIANT_SOURCE_DIR "/results/bench";
  std::filesystem::create_directories(folder);
  add_default(arguments, "benchmark_repetitions", "10");
  add_default(arguments, "benchmark_min_time", "0.02");
  add_default(arguments, "benchmark_out", (folder / "kernels.json").string());
  add_default(arguments, "benchmark_out_format", "json");
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  int pointer_count = static_cast<int>(pointers.size());
  benchmark::Initialize(&pointer_count, pointers.data());
  if (benchmark::ReportUnrecognizedArguments(pointer_count, pointers.data())) return 1;
  pliant::kernels::Table table;
  benchmark::RunSpecifiedBenchmarks(&table);
  benchmark::Shutdown();
}
