#include "benchmarks/halo/gather_state.hpp"

#include <mpi.h>

#include <numeric>

#include "benchmarks/halo/partition.hpp"
#include "bodies/body_view.hpp"
#include "core/archive.hpp"

namespace pliant::halo {
namespace {

/// Positions, momenta and forces of a body.
std::vector<double> numbers_of(const Simulation& simulation, int number) {
  const Model& model = simulation.model();
  const State& state = simulation.state();
  const Body& body = model.bodies[number];
  std::vector<double> numbers;
  for (const Dofs* dofs : {&state.position, &state.reduced_momentum, &state.force})
    if (body.rigid >= 0) {
      const auto first = dofs->rigid.begin() + 3 * body.rigid;
      numbers.insert(numbers.end(), first, first + 3);
    } else {
      const BodyView values(model, body, *dofs);
      for (std::size_t i = 0; i < static_cast<std::size_t>(model.shape_of(body).nodes()); ++i)
        numbers.insert(numbers.end(), {values[i].x(), values[i].y()});
    }
  return numbers;
}

/// Receives numbers_of() bodies of other processes on process 0.
std::vector<double> receive(std::size_t size, int body, int process) {
  std::vector<double> numbers(size);
  MPI_Recv(numbers.data(), static_cast<int>(size), MPI_DOUBLE, process, body, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return numbers;
}

}  // namespace

std::uint64_t motion_hash(const Simulation& simulation, const std::vector<int>& owner) {
  int process = 0;
  if (!owner.empty()) MPI_Comm_rank(MPI_COMM_WORLD, &process);
  Fnv1a hash;
  const auto add = [&](const auto& value) { hash.add(&value, sizeof value); };
  const State& state = simulation.state();
  add(state.time), add(simulation.control().next_dt), add(simulation.largest_dt());
  add(state.steps), add(state.rejections), add(state.evaluations);
  for (int b = 0; b < static_cast<int>(simulation.model().bodies.size()); ++b) {
    const int sender = owner.empty() || owner[b] == every_process ? 0 : owner[b];
    if (process != 0 && process != sender) continue;
    std::vector<double> numbers = numbers_of(simulation, b);
    if (process == sender && sender != 0)
      MPI_Send(numbers.data(), static_cast<int>(numbers.size()), MPI_DOUBLE, 0, b, MPI_COMM_WORLD);
    if (process == 0 && sender != 0) numbers = receive(numbers.size(), b, sender);
    hash.add(numbers.data(), numbers.size() * sizeof(double));
  }
  return hash.value();
}

}  // namespace pliant::halo
