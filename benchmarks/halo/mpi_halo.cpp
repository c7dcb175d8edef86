#include "benchmarks/halo/mpi_halo.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <ctime>
#include <iterator>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include "benchmarks/halo/partition.hpp"
#include "bodies/place_outlines.hpp"

namespace pliant::halo {
namespace {

using Clock = std::chrono::steady_clock;

/// Adds the wall time and the CPU time of its life to two sums, s.
class Timer {
 public:
  Timer(double& seconds, double& cpu_seconds) : seconds_(seconds), cpu_seconds_(cpu_seconds) {}
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;
  ~Timer() {
    seconds_ += std::chrono::duration<double>(Clock::now() - start_).count();
    cpu_seconds_ += cpu_time() - cpu_start_;
  }

 private:
  double &seconds_, &cpu_seconds_;
  Clock::time_point start_ = Clock::now();
  double cpu_start_ = cpu_time();
};

std::vector<int> begins(const std::vector<int>& counts) {
  std::vector<int> result(counts.size());
  std::exclusive_scan(counts.begin(), counts.end(), result.begin(), 0);
  return result;
}

/// Gathers arrays of `counts` numbers of all processes, in their order.
template <class Number>
void gather(const std::vector<Number>& own, std::vector<Number>& all, std::vector<int> counts, MPI_Datatype type) {
  const std::vector<int> first = begins(counts);
  all.resize(static_cast<std::size_t>(std::accumulate(counts.begin(), counts.end(), 0)));
  MPI_Allgatherv(own.data(), static_cast<int>(own.size()), type, all.data(), counts.data(), first.data(), type,
                 MPI_COMM_WORLD);
}

}  // namespace

double cpu_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

MpiHalo::MpiHalo(const Model& model, std::vector<int> owner) : model_(model), owner_(std::move(owner)) {
  MPI_Comm_rank(MPI_COMM_WORLD, &process_);
  MPI_Comm_size(MPI_COMM_WORLD, &processes_);
  grains_of_.resize(static_cast<std::size_t>(processes_));
  for (int b = 0; b < static_cast<int>(owner_.size()); ++b)
    if (owner_[b] != every_process) grains_of_[owner_[b]].push_back(b);
  present_ = model_.own.bodies;
}

bool MpiHalo::computes(const BodyPair& pair) const {
  const int a = owner_[pair.first], b = owner_[pair.second];
  return a == process_ || b == process_ || (a == every_process && b == every_process && process_ == 0);
}

void MpiHalo::gather_boxes(std::vector<Box>& boxes) {
  const Timer timer(traffic_.renewal_seconds, traffic_.cpu_seconds);
  std::vector<double> own, all;
  for (const int b : grains_of_[process_])
    own.insert(own.end(), {boxes[b].x_min, boxes[b].x_max, boxes[b].y_min, boxes[b].y_max});
  std::vector<int> counts;
  for (const std::vector<int>& grains : grains_of_) counts.push_back(4 * static_cast<int>(grains.size()));
  gather(own, all, counts, MPI_DOUBLE);
  traffic_.renewal_bytes += static_cast<long>(own.size() * sizeof(double));
  auto next = all.begin();
  for (const std::vector<int>& grains : grains_of_)
    for (const int b : grains) boxes[b] = {next[0], next[1], next[2], next[3]}, next += 4;
}

/// Each process finds the bodies that it sends without asking: both owners of a pair have it.
void MpiHalo::set_pairs(const std::vector<BodyPair>& pairs) {
  std::map<int, std::array<std::set<int>, 2>> partners;  // by process: own bodies and its bodies
  const auto add = [&](int own, int other) {
    if (owner_[own] != process_ || owner_[other] == process_ || owner_[other] == every_process) return;
    partners[owner_[other]][0].insert(own), partners[owner_[other]][1].insert(other);
  };
  for (const BodyPair& pair : pairs) add(pair.first, pair.second), add(pair.second, pair.first);
  neighbours_.clear(), rigid_ghosts_.clear();
  present_ = model_.own.bodies;
  for (const auto& [process, bodies] : partners) {
    neighbours_.push_back(
        {process, {bodies[0].begin(), bodies[0].end()}, {bodies[1].begin(), bodies[1].end()}, {}, {}});
    present_.insert(present_.end(), bodies[1].begin(), bodies[1].end());
    for (const int b : bodies[1])
      if (model_.bodies[b].rigid >= 0) rigid_ghosts_.push_back(model_.bodies[b].rigid);
  }
}

/// Calls visit(numbers, count) for all that the owner of a body sends. `reference`: null in an exchange.
template <class Visit>
void MpiHalo::visit_body(int body, OutlineField* reference, Visit&& visit) const {
  const int first = model_.outline_offset[body], count = model_.outline_of(body).count;
  const auto visit_outline = [&](OutlineField& field) { visit(&field.x[first], count), visit(&field.y[first], count); };
  if (const int rigid = model_.bodies[body].rigid; rigid >= 0) {
    const std::size_t dof = 3 * static_cast<std::size_t>(rigid);
    visit(&trial_->position.rigid[dof], 3);
    visit(&accepted_->force.rigid[dof], 3);
    if (reference) visit(&accepted_->position.rigid[dof], 3);
  } else {
    visit_outline(trial_->outlines.position);
    if (reference) visit_outline(accepted_->outlines.position);
  }
  if (reference) visit_outline(*reference);
}

/// Computes what follows from the numbers that visit_body has received.
void MpiHalo::complete_outlines(int body, OutlineField* reference) const {
  const int first = model_.outline_offset[body], number = model_.bodies[body].rigid;
  const auto extend = [&](OutlineField& field) {
    extend_cyclically(model_.outline_of(body), &field.x[first], &field.y[first]);
  };
  const auto complete = [&](const HaloFields& fields) {
    OutlineField& outlines = fields.outlines.position;
    if (number < 0) return extend(outlines);
    place_rigid_outline(model_, model_.rigid_bodies[number],
                        &fields.position.rigid[3 * static_cast<std::size_t>(number)], outlines);
  };
  complete(*trial_);
  if (!reference) return;
  complete(*accepted_);
  extend(*reference);
}

/// Leaves a ghost where the accepted motion has it.
void MpiHalo::keep_in_place(int body) const {
  if (const int rigid = model_.bodies[body].rigid; rigid >= 0) {
    const std::ptrdiff_t dof = 3 * static_cast<std::ptrdiff_t>(rigid);
    std::copy_n(accepted_->position.rigid.begin() + dof, 3, trial_->position.rigid.begin() + dof);
    return;
  }
  const OutlineField& from = accepted_->outlines.position;
  OutlineField& to = trial_->outlines.position;
  const int first = model_.outline_offset[body], count = model_.outline_of(body).count;
  std::copy_n(&from.x[first], count, &to.x[first]), std::copy_n(&from.y[first], count, &to.y[first]);
}

/// One message to and from each neighbour. Returns the bytes sent.
long MpiHalo::transfer(OutlineField* reference) {
  std::vector<MPI_Request> requests(2 * neighbours_.size());
  const auto size_of = [&](const std::vector<int>& bodies) {
    std::size_t size = 0;
    for (const int b : bodies)
      visit_body(b, reference, [&](const double*, int count) { size += static_cast<std::size_t>(count); });
    return size;
  };
  std::size_t next = 0, sent = 0;
  for (Neighbour& neighbour : neighbours_) {
    neighbour.in.resize(size_of(neighbour.received));
    MPI_Irecv(neighbour.in.data(), static_cast<int>(neighbour.in.size()), MPI_DOUBLE, neighbour.process, 0,
              MPI_COMM_WORLD, &requests[next++]);
  }
  for (Neighbour& neighbour : neighbours_) {
    neighbour.out.clear();
    for (const int b : neighbour.sent)
      visit_body(b, reference, [&](const double* numbers, int count) {
        neighbour.out.insert(neighbour.out.end(), numbers, numbers + count);
      });
    MPI_Isend(neighbour.out.data(), static_cast<int>(neighbour.out.size()), MPI_DOUBLE, neighbour.process, 0,
              MPI_COMM_WORLD, &requests[next++]);
    sent += neighbour.out.size();
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  bool omit = omits_;
  for (const Neighbour& neighbour : neighbours_) {
    const double* from = neighbour.in.data();
    for (const int b : neighbour.received) {
      visit_body(b, reference, [&](double* numbers, int count) {
        std::copy_n(from, count, numbers);
        from += count;
      });
      if (std::exchange(omit, false)) keep_in_place(b);
      complete_outlines(b, reference);
    }
  }
  return static_cast<long>(sent * sizeof(double));
}

void MpiHalo::exchange(const HaloFields& accepted, const HaloFields& trial) {
  const Timer timer(traffic_.exchange_seconds, traffic_.cpu_seconds);
  accepted_.emplace(accepted), trial_.emplace(trial);
  omits_ = std::exchange(omits_next_, false);
  traffic_.bytes += transfer(nullptr);
  traffic_.messages += static_cast<long>(neighbours_.size());
  count_new_ghosts();
}

void MpiHalo::renew(OutlineField& reference) {
  const Timer timer(traffic_.renewal_seconds, traffic_.cpu_seconds);
  traffic_.renewal_bytes += transfer(&reference);
  ++traffic_.renewals;
}

void MpiHalo::count_new_ghosts() {
  std::vector<int> ghosts(present_.begin() + static_cast<std::ptrdiff_t>(model_.own.bodies.size()), present_.end());
  std::ranges::sort(ghosts);
  if (ghosts == counted_ghosts_) return;
  const auto count_only_in = [](const std::vector<int>& these, const std::vector<int>& others) {
    return std::ranges::count_if(these, [&](int b) { return !std::ranges::binary_search(others, b); });
  };
  traffic_.new_ghosts += count_only_in(ghosts, counted_ghosts_);
  traffic_.former_ghosts += count_only_in(counted_ghosts_, ghosts);
  counted_ghosts_ = std::move(ghosts);
}

void MpiHalo::add(std::span<std::int64_t> numbers) {
  const Timer timer(traffic_.reduction_seconds, traffic_.cpu_seconds);
  MPI_Allreduce(MPI_IN_PLACE, numbers.data(), static_cast<int>(numbers.size()), MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
  ++traffic_.reductions;
}

void MpiHalo::take_largest(std::span<double> numbers) {
  const Timer timer(traffic_.reduction_seconds, traffic_.cpu_seconds);
  MPI_Allreduce(MPI_IN_PLACE, numbers.data(), static_cast<int>(numbers.size()), MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  ++traffic_.reductions;
}

/// Gathers the arcs of all processes, which hold until the next rebuild.
void MpiHalo::gather_wall_arcs(const PairTable& table) {
  own_arcs_.clear();
  for (const ContactPair& pair : table.contact_pairs())
    for (int side = 0; side < 2; ++side) {
      const int body = side == 0 ? pair.first : pair.second;
      const Arc arc = pair.forces(side);
      if (owner_[body] == every_process && arc.count > 0)
        own_arcs_.push_back(
            {pair.first, pair.second, pair.images.x, pair.part, side, body, arc.begin, arc.count, pair.entry[side]});
    }
  constexpr int size = sizeof(WallArc) / sizeof(int);
  std::vector<int> own(size * own_arcs_.size()), counts(static_cast<std::size_t>(processes_)), all;
  if (!own.empty()) std::memcpy(own.data(), own_arcs_.data(), own.size() * sizeof(int));
  const int count = static_cast<int>(own.size());
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, MPI_COMM_WORLD);
  gather(own, all, counts, MPI_INT);
  all_arcs_.resize(all.size() / size);
  if (!all.empty()) std::memcpy(all_arcs_.data(), all.data(), all.size() * sizeof(int));
  // Entries arrive process after process; there `at` counts nodes from the first of all on.
  arc_nodes_.assign(static_cast<std::size_t>(processes_), 0);
  int nodes = 0;
  auto arc = all_arcs_.begin();
  for (int process = 0; process < processes_; ++process)
    for (int i = 0; i < counts[process] / size; ++i, ++arc) {
      arc->at = nodes;
      nodes += arc->count, arc_nodes_[process] += arc->count;
    }
  std::ranges::sort(all_arcs_, {},
                    [](const WallArc& a) { return std::tuple(a.first, a.second, a.images, a.part, a.side); });
}

void MpiHalo::add_up_on_walls(const PairTable& table, long rebuild, std::span<const double* const> entries,
                              std::span<double* const> sums) {
  const Timer timer(traffic_.wall_seconds, traffic_.cpu_seconds);
  if (std::exchange(wall_rebuild_, rebuild) != rebuild) gather_wall_arcs(table);
  const std::size_t fields = entries.size();
  own_entries_.clear();
  for (const WallArc& arc : own_arcs_)
    for (int i = arc.at; i < arc.at + arc.count; ++i)
      for (const double* field : entries) own_entries_.push_back(field[i]);
  std::vector<int> counts = arc_nodes_;
  for (int& count : counts) count *= static_cast<int>(fields);
  gather(own_entries_, all_entries_, counts, MPI_DOUBLE);
  traffic_.wall_bytes += static_cast<long>(own_entries_.size() * sizeof(double));
  for (int b = 0; b < static_cast<int>(owner_.size()); ++b)
    if (owner_[b] == every_process)
      for (double* sum : sums) std::fill_n(sum + model_.outline_offset[b], model_.outline_of(b).count, 0.0);
  for (const WallArc& arc : all_arcs_) {
    const int nodes = model_.outline_of(arc.wall).count, offset = model_.outline_offset[arc.wall];
    for (int i = 0; i < arc.count; ++i) {
      const int node = arc.begin + i - turn_of(arc.begin + i, nodes) * nodes;
      for (std::size_t f = 0; f < fields; ++f)
        sums[f][offset + node] += all_entries_[fields * static_cast<std::size_t>(arc.at + i) + f];
    }
  }
}

}  // namespace pliant::halo
