// Runs steps of a scene on the processes of MPI, each with a part of the bodies:
//
//     mpirun -n N pliant_halo SCENE STEPS [--alone | --omit-a-ghost]
//
// Process 0 writes JSON: a hash of the final motion, which does not depend on N, and what each process sent and how
// long that took. A scene with [start] starts from there. --alone, for one process, runs the engine without a halo.
// --omit-a-ghost leaves out one ghost of each process from one exchange, so that the hash must change. Exit code 2:
// the scene cannot be used.
#include <mpi.h>
#include <omp.h>

#include <chrono>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <string>

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <nlohmann/json.hpp>

#include "benchmarks/halo/gather_state.hpp"
#include "benchmarks/halo/mpi_halo.hpp"
#include "benchmarks/halo/partition.hpp"
#include "benchmarks/halo/unsupported.hpp"
#include "bodies/initial_state.hpp"
#include "bodies/place_outlines.hpp"
#include "core/errors.hpp"
#include "input/read_scene.hpp"
#include "run/start_file.hpp"
#include "setup/build_model.hpp"

namespace pliant::halo {
namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

struct Options {
  std::string scene;
  int steps = 0;
  bool alone = false, omits_a_ghost = false;
};

Options read_options(int count, char** arguments) {
  Options options;
  const std::string usage = "usage: pliant_halo SCENE STEPS [--alone | --omit-a-ghost]";
  if (count < 3 || count > 4) throw InputError(usage);
  options.scene = arguments[1];
  options.steps = std::atoi(arguments[2]);
  if (options.steps < 1) throw InputError(fmt::format("STEPS is '{}', must be a number >= 1", arguments[2]));
  if (count == 4) {
    options.alone = arguments[3] == std::string("--alone");
    options.omits_a_ghost = arguments[3] == std::string("--omit-a-ghost");
    if (!options.alone && !options.omits_a_ghost)
      throw InputError(fmt::format("unknown option '{}'; {}", arguments[3], usage));
  }
  return options;
}

/// Wall time and CPU time, s.
struct Seconds {
  double wall, cpu;
};

/// Returns the time that the steps took. `omitting`: leaves out a ghost half-way; null: does not.
Seconds take_steps(Simulation& simulation, int steps, MpiHalo* omitting) {
  const auto start = Clock::now();
  const double cpu_start = cpu_time();
  for (int i = 0; i < steps; ++i) {
    if (omitting && i == steps / 2) omitting->omit_a_ghost();
    simulation.step(std::numeric_limits<double>::infinity());
  }
  return {std::chrono::duration<double>(Clock::now() - start).count(), cpu_time() - cpu_start};
}

/// Figures of one process; numbers a step where the name says so.
Json figures(const Simulation& simulation, const MpiHalo& halo, const Seconds& seconds, int steps) {
  const OwnBodies& own = simulation.model().own;
  const Traffic& t = halo.traffic();
  const double waits = t.exchange_seconds + t.wall_seconds + t.reduction_seconds + t.renewal_seconds;
  const auto per_step = [&](long number) { return static_cast<double>(number) / steps; };
  return {{"owned_bodies", own.bodies.size()},
          {"ghosts", halo.ghosts()},
          {"new_ghosts", t.new_ghosts},
          {"former_ghosts", t.former_ghosts},
          {"contact_pairs", simulation.forces().contact().contact_pairs().size()},
          {"messages_per_step", per_step(t.messages)},
          {"bytes_per_step", per_step(t.bytes)},
          {"wall_bytes_per_step", per_step(t.wall_bytes)},
          {"reductions_per_step", per_step(t.reductions)},
          {"renewals", t.renewals},
          {"renewal_bytes", t.renewal_bytes},
          {"seconds",
           {{"exchange", t.exchange_seconds},
            {"walls", t.wall_seconds},
            {"reductions", t.reduction_seconds},
            {"renewals", t.renewal_seconds},
            {"work", seconds.wall - waits},
            {"cpu_of_work", seconds.cpu - t.cpu_seconds}}}};
}

/// Gathers one JSON value of each process on process 0.
Json gather(const Json& own, int process, int processes) {
  const std::string text = own.dump();
  if (process != 0) {
    MPI_Send(text.data(), static_cast<int>(text.size()), MPI_CHAR, 0, 0, MPI_COMM_WORLD);
    return {};
  }
  Json all = Json::array({own});
  for (int sender = 1; sender < processes; ++sender) {
    MPI_Status status;
    MPI_Probe(sender, 0, MPI_COMM_WORLD, &status);
    int size = 0;
    MPI_Get_count(&status, MPI_CHAR, &size);
    std::string received(static_cast<std::size_t>(size), ' ');
    MPI_Recv(received.data(), size, MPI_CHAR, sender, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    all.push_back(Json::parse(received));
  }
  return all;
}

Json summary(const Simulation& simulation, std::uint64_t hash, int processes, double seconds, long rebuilds) {
  const State& state = simulation.state();
  return {{"processes", processes},
          {"steps", state.steps},
          {"rejections", state.rejections},
          {"time", state.time},
          {"seconds", seconds},
          {"rebuilds", simulation.forces().contact().refreshes() - rebuilds},
          {"contacts_of_process_0", state.contacts},
          {"hash", fmt::format("{:016x}", hash)}};
}

void run(const Options& options, int process, int processes) {
  const Scene scene = read_scene(options.scene);
  const std::unique_ptr<const StartFile> file = start_file_of(scene);
  Model model = build_model(scene);
  refuse_unsupported(model);
  std::optional<StartPoint> start;
  if (file) start = file->point(model);
  std::vector<int> owner;
  std::optional<MpiHalo> halo;
  if (options.alone) {
    if (processes > 1) throw InputError(fmt::format("--alone is for one process, not for {}", processes));
  } else {
    owner = find_owners(model, placed_outlines(model, start ? start->position : initial_positions(model)), processes);
    model.own = own_bodies(model, owner, process);
    halo.emplace(model, owner);
    model.halo = &*halo;
  }
  Simulation simulation(model, start ? &*start : nullptr);
  if (halo) halo->forget_traffic();
  const long rebuilds = simulation.forces().contact().refreshes();
  const Seconds seconds = take_steps(simulation, options.steps, options.omits_a_ghost ? &*halo : nullptr);
  const Json own = halo ? figures(simulation, *halo, seconds, options.steps) : Json{};
  Json result = summary(simulation, motion_hash(simulation, owner), processes, seconds.wall, rebuilds);
  if (halo) result["by_process"] = gather(own, process, processes);
  if (process == 0) std::cout << result.dump(1) << '\n';
}

}  // namespace
}  // namespace pliant::halo

int main(int count, char** arguments) {
  MPI_Init(&count, &arguments);
  int process = 0, processes = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &process);
  MPI_Comm_size(MPI_COMM_WORLD, &processes);
  omp_set_num_threads(1);
  spdlog::set_level(spdlog::level::off);
  int code = 0;
  try {
    pliant::halo::run(pliant::halo::read_options(count, arguments), process, processes);
  } catch (const pliant::Error& error) {
    // All processes read the same input and take the same steps, so all of them come here.
    if (process == 0) std::cerr << error.what() << '\n';
    code = static_cast<int>(error.code());
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
  MPI_Finalize();
  return code;
}
