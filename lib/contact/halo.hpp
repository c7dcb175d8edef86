#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"
#include "bodies/outline_fields.hpp"
#include "contact/broad_phase.hpp"

namespace pliant {

class PairTable;

/// What the owner of a body sends of a motion: outlines of compliant bodies, positions and forces of rigid ones.
struct HaloFields {
  Dofs &position, &force;
  Outlines& outlines;
};

/// Communication with the processes that advance the other bodies of a scene. A process owns some grains
/// (Model::own). Their partners that other processes own are its ghosts: it has their outlines, but does not advance
/// them. All processes advance all walls. A pair of bodies of two processes is computed by both, with the same bits, so
/// no forces are sent except those on walls. All functions but the first three are collective: all processes call them
/// in the same order.
class Halo {
 public:
  virtual ~Halo() = default;

  /// Bodies whose outlines this process has: Model::own, then the ghosts.
  const std::vector<int>& present() const { return present_; }
  /// Indices in Model::rigid_bodies of the ghosts.
  const std::vector<int>& rigid_ghosts() const { return rigid_ghosts_; }
  /// Whether this process computes a pair. One process computes each pair of two walls.
  virtual bool computes(const BodyPair& pair) const = 0;

  /// Gets the boxes of all bodies from their owners; [bodies].
  virtual void gather_boxes(std::vector<Box>& boxes) = 0;
  /// Makes the partners in these pairs the ghosts. Other processes have the same pairs of bodies of both.
  virtual void set_pairs(const std::vector<BodyPair>& pairs) = 0;
  /// Gets the fields of the accepted motion and of a trial for the ghosts. The accepted outlines are those of the last
  /// exchange. Both motions may be the same.
  virtual void exchange(const HaloFields& accepted, const HaloFields& trial) = 0;
  /// Gets all fields of the last exchange, and another one of outlines, for ghosts that may be new.
  virtual void renew(OutlineField& reference) = 0;
  /// Adds up numbers over all processes.
  virtual void add(std::span<std::int64_t> numbers) = 0;
  /// Takes the largest of each number over all processes. Numbers must not be NaN.
  virtual void take_largest(std::span<double> numbers) = 0;
  /// Adds up entries of contact pairs on the nodes of walls, over the pairs of all processes in their order. `rebuild`:
  /// number of the last rebuild of the table. `entries`: [fields] buffers laid out by the table. `sums`: [fields]
  /// fields over outline nodes; those of walls are overwritten.
  virtual void add_up_on_walls(const PairTable& table, long rebuild, std::span<const double* const> entries,
                               std::span<double* const> sums) = 0;

  double largest(double number) {
    take_largest({&number, 1});
    return number;
  }

 protected:
  std::vector<int> present_, rigid_ghosts_;
};

/// Bodies whose outlines this process has: all, or those of its halo. The first ones are Model::own.
inline const std::vector<int>& present_bodies(const Model& model) {
  return model.halo ? model.halo->present() : model.own.bodies;
}

}  // namespace pliant
