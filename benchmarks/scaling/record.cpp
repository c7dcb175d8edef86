// Records the parallel loops of a scene's steps on one thread, and plays them back on others:
//
//     pliant_record_loops SCENE STEPS ROUNDS > FILE
//
// In each round STEPS steps are recorded, and as many are timed with one thread and with two. Writes JSON: seconds a
// step as measured, and of each parallel region (benchmarks/scaling/schedule.hpp) as predicted. With 0 rounds it writes
// the bytes that a step touches, and each region of it. Exit code 2: the scene cannot be used.
#include <omp.h>
#include <sys/prctl.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <thread>

#include <spdlog/spdlog.h>
#include <nlohmann/json.hpp>

#include "benchmarks/scaling/loop_recorder.hpp"
#include "dynamics/simulation.hpp"
#include "input/read_scene.hpp"
#include "setup/build_model.hpp"

namespace pliant::scaling {
namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Seconds of an empty parallel region, the median of many.
double region_cost(int threads) {
  omp_set_num_threads(threads);
  std::vector<double> seconds(2000);
  for (double& s : seconds) {
    const auto start = Clock::now();
#pragma omp parallel
    asm volatile("" ::: "memory");
    s = since(start);
  }
  return median(std::move(seconds));
}

class Recording {
 public:
  Recording(const Model& model, int steps) : simulation_(model), steps_(steps) {}

  void record(int steps) {
    omp_set_num_threads(1);
    loop_observer = &recorder_;
    for (int i = 0; i < steps; ++i) {
      recorder_.begin_step();
      step();
      recorder_.end_step();
    }
    loop_observer = nullptr;
  }
  void forget() { recorder_.forget(); }
  /// Seconds a step.
  double time(int threads) {
    omp_set_num_threads(threads);
    const auto start = Clock::now();
    for (int i = 0; i < steps_; ++i) step();
    return since(start) / steps_;
  }
  /// Bytes of the pages of a step, and of each of its regions.
  Json count_pages() {
    omp_set_num_threads(1);
    clear_touched();
    step();
    Json result{{"step", touched()}};
    std::map<LoopRecorder::Key, double> bytes;
    PageCounter counter(bytes);
    loop_observer = &counter;
    step();
    loop_observer = nullptr;
    for (const auto& [key, of_region] : bytes)
      result["regions"].push_back({{"file", key.first}, {"line", key.second}, {"bytes", of_region}});
    return result;
  }
  Json regions() const {
    Json result = Json::array();
    for (const auto& [key, region] : recorder_.regions()) {
      const Prediction prediction = play_back(region.calls);
      result.push_back({{"file", key.first},
                        {"line", key.second},
                        {"function", region.place.function_name()},
                        {"calls", static_cast<double>(region.calls.size()) / recorder_.steps()},
                        {"seconds", prediction.one_thread},
                        {"serial", median(region.serial)},
                        {"worst_chunk", prediction.worst_chunk},
                        {"shares", prediction.shares},
                        {"by_cost", prediction.by_cost}});
    }
    return result;
  }
  double serial_at_end() const { return median(recorder_.serial_at_end()); }

 private:
  void step() {
    const double end = simulation_.model().scene.time.end;
    if (!(simulation_.state().time < end))
      throw std::runtime_error("the scene ends before as many steps; give it a later end");
    simulation_.step(end);
  }

  Simulation simulation_;
  int steps_;
  LoopRecorder recorder_;
};

int run(const char* file, int steps, int rounds) {
  // Pages of 2 MB would tell little of what is touched.
  if (rounds == 0) prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0);
  const Scene scene = read_scene(file);
  if (!scene.start_from.empty())
    throw std::runtime_error("the scene starts from another run; take one without [start]");
  const Model model = build_model(scene);
  Recording recording(model, steps);
  recording.time(1);  // until the step has its length, and memory is allocated
  if (rounds == 0) {
    std::cout << recording.count_pages().dump(1) << '\n';
    return 0;
  }
  recording.record(steps), recording.forget();  // for the length of chunks
  std::vector<int> measured{1};
  if (std::thread::hardware_concurrency() >= 2) measured.push_back(2);
  std::map<int, std::vector<double>> seconds;
  for (int round = 0; round < rounds; ++round) {
    recording.record(steps);
    for (int threads : measured) seconds[threads].push_back(recording.time(threads));
  }
  Json result{{"grains", std::ranges::count(model.bodies, false, &Body::wall)}, {"steps", steps}};
  for (int threads : measured) {
    result["measured"][std::to_string(threads)] = seconds[threads];
    result["region_cost"][std::to_string(threads)] = region_cost(threads);
  }
  result["threads"] = thread_counts;
  result["serial_at_end"] = recording.serial_at_end();
  result["regions"] = recording.regions();
  std::cout << result.dump(1) << '\n';
  return 0;
}

}  // namespace
}  // namespace pliant::scaling

int main(int count, char** arguments) {
  spdlog::set_level(spdlog::level::off);
  try {
    if (count != 4) throw std::runtime_error("usage: pliant_record_loops SCENE STEPS ROUNDS");
    return pliant::scaling::run(arguments[1], std::atoi(arguments[2]), std::atoi(arguments[3]));
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
