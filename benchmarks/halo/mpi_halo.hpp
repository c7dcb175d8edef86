#pragma once

#include <mpi.h>

#include <optional>
#include <vector>

#include "contact/halo.hpp"
#include "contact/pair_table.hpp"

namespace pliant::halo {

/// CPU time of the calling thread, s.
double cpu_time();

/// What a process has sent, and how long that and the wait for others took.
struct Traffic {
  long messages = 0, bytes = 0;            ///< of exchanges, to single processes
  long reductions = 0;                     ///< of numbers over all processes
  long wall_bytes = 0;                     ///< own entries of pairs with walls, to all processes
  long renewals = 0, renewal_bytes = 0;    ///< broad phases, and what they exchange
  long new_ghosts = 0, former_ghosts = 0;  ///< bodies that became and ceased to be ghosts
  double exchange_seconds = 0, wall_seconds = 0, reduction_seconds = 0, renewal_seconds = 0;  ///< wall time
  double cpu_seconds = 0;                                                                     ///< CPU time of all that
};

/// Halo of processes of MPI, with one message per step to each process that has partners of own bodies. Forces on
/// walls are sent node by node for each contact pair and added in the order of the pairs. Their sums thus have the bits
/// of one process, whatever the number of processes.
class MpiHalo final : public Halo {
 public:
  /// `model`: with the own bodies of this process. `owner`: [bodies], as find_owners returns it.
  MpiHalo(const Model& model, std::vector<int> owner);

  bool computes(const BodyPair& pair) const override;
  void gather_boxes(std::vector<Box>& boxes) override;
  void set_pairs(const std::vector<BodyPair>& pairs) override;
  void exchange(const HaloFields& accepted, const HaloFields& trial) override;
  void renew(OutlineField& reference) override;
  void add(std::span<std::int64_t> numbers) override;
  void take_largest(std::span<double> numbers) override;
  void add_up_on_walls(const PairTable& table, long rebuild, std::span<const double* const> entries,
                       std::span<double* const> sums) override;

  int ghosts() const { return static_cast<int>(present_.size() - model_.own.bodies.size()); }
  const Traffic& traffic() const { return traffic_; }
  void forget_traffic() { count_new_ghosts(), traffic_ = {}; }
  /// Makes the next exchange, and a renewal after it, leave the first ghost in place: an error that a test must find.
  void omit_a_ghost() { omits_next_ = true; }

 private:
  /// Another process with partners of own bodies.
  struct Neighbour {
    int process;
    std::vector<int> sent, received;  ///< bodies, ascending
    std::vector<double> out, in;      ///< messages
  };
  /// Part of a wall that a contact pair acts on.
  struct WallArc {
    int first, second, images, part;  ///< of the pair
    int side, wall;
    int begin, count;  ///< nodes, not reduced to one period
    int at;            ///< first entry in the buffers of its process
  };

  template <class Visit>
  void visit_body(int body, OutlineField* reference, Visit&& visit) const;
  long transfer(OutlineField* reference);
  void keep_in_place(int body) const;
  void complete_outlines(int body, OutlineField* reference) const;
  void count_new_ghosts();
  void gather_wall_arcs(const PairTable& table);

  const Model& model_;
  std::vector<int> owner_;
  int process_ = 0, processes_ = 1;
  std::vector<std::vector<int>> grains_of_;  ///< [processes] their own grains
  std::vector<Neighbour> neighbours_;
  std::optional<HaloFields> accepted_, trial_;  ///< of the last exchange
  std::vector<int> counted_ghosts_;             ///< at the last count, ascending
  bool omits_next_ = false, omits_ = false;     ///< a ghost, in the next exchange and in the last one
  long wall_rebuild_ = -1;                      ///< rebuild whose wall arcs are known
  std::vector<WallArc> own_arcs_;               ///< in the order of the pairs
  std::vector<WallArc> all_arcs_;               ///< of all processes, in the order of the pairs
  std::vector<int> arc_nodes_;                  ///< [processes] number of nodes in their arcs
  std::vector<double> own_entries_, all_entries_;
  Traffic traffic_;
};

}  // namespace pliant::halo
