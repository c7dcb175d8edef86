#pragma once

#include "bodies/model.hpp"
#include "core/parallel.hpp"

namespace pliant {

/// Calls action(arrays) with the NodeArrays of a batch: selected once, outside all loops.
template <class Action>
decltype(auto) with_nodes(const Model& model, const Batch& batch, Action&& action) {
  if (batch.layout == Layout::nodewise) {
    const NodewiseShape& shape = model.nodewise_shape_of(batch);
    return action(NodeArrays<Lanes>{shape.mass_at_unit_density.data(), shape.inverse_mass_at_unit_density.data(),
                                    shape.nodal_distance.data()});
  }
  if (batch.layout == Layout::same_topology) {
    const SameTopologyShapes& shapes = model.same_topology_shapes[batch.tables];
    return action(NodeArrays<Lanes>{shapes.mass_at_unit_density.data(), shapes.inverse_mass_at_unit_density.data(),
                                    shapes.nodal_distance.data()});
  }
  const CompliantShape& shape = model.shape_of(batch);
  return action(NodeArrays<double>{shape.space.mass_at_unit_density.data(), shape.inverse_mass_at_unit_density.data(),
                                   shape.space.nodal_distance.data()});
}

/// Calls action(tables) with the tables of bodies in lanes: the Discretisation of their shape, or the
/// SameTopologyShapes of their batch.
template <class Action>
decltype(auto) with_tables(const Model& model, const Batch& batch, Action&& action) {
  return batch.layout == Layout::same_topology ? action(model.same_topology_shapes[batch.tables])
                                               : action(model.shape_of(batch).space);
}

/// Sums, or maxima, over the nodes of each body in a batch, from those over its slots: all lanes of a nodewise body
/// belong to one body.
inline Lanes sum_over_body(const Batch& batch, Lanes lanes) {
  return batch.layout == Layout::nodewise ? broadcast(sum(lanes)) : lanes;
}
inline Lanes largest_of_body(const Batch& batch, Lanes lanes) {
  return batch.layout == Layout::nodewise ? broadcast(largest(lanes)) : lanes;
}

/// Calls work(b) for each own batch. Threads share the batches, but a nodewise body of many regions is handled alone,
/// as threads share its work.
template <class Work>
void for_each_batch(const Model& model, Work&& work) {
  const std::vector<int>& batches = model.own.batches;
  parallel_for(static_cast<int>(batches.size()), [&](int i) {
    if (model.batches[batches[i]].regions == 1) work(batches[i]);
  });
  for (std::size_t i = static_cast<std::size_t>(model.own.lane_batches); i < batches.size(); ++i)
    if (model.batches[batches[i]].regions > 1) work(batches[i]);
}

}  // namespace pliant
