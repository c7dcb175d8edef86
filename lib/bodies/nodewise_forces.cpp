#include "bodies/nodewise_forces.hpp"

#include <algorithm>

#include "core/parallel.hpp"

namespace pliant {
namespace {

/// Two or four components handled as one.
using Pair = double __attribute__((vector_size(16)));
using Quad = double __attribute__((vector_size(32)));

template <class Vector>
Vector load_as(const void* from) {
  Vector value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

/// (x, x, y, y).
Quad twice_each(const Vec2* b) {
  const Pair pair = load_as<Pair>(b);
  return __builtin_shufflevector(pair, pair, 0, 0, 1, 1);
}

/// Deformation gradients of eight points, one per lane.
Tensor<Lanes> deformation_gradients(const NodewiseShape& shape, int first, const double* q) {
  const int *start = shape.start.data(), *node = shape.node.data();
  const Vec2* gradient = shape.gradient.data();
  double rows[4][lane_count];
  for (int lane = 0; lane < lane_count; ++lane) {
    Pair x{}, y{};
    for (int e = start[first + lane]; e < start[first + lane + 1]; ++e) {
      const Pair b = load_as<Pair>(gradient + e);
      x += q[node[e]] * b;
      y += q[node[e] + lane_count] * b;
    }
    rows[0][lane] = x[0], rows[1][lane] = x[1], rows[2][lane] = y[0], rows[3][lane] = y[1];
  }
  return {load(rows[0]), load(rows[1]), load(rows[2]), load(rows[3])};
}

void store_columns(const Tensor<Lanes>& P, StressColumns* to) {
  const Lanes rows[8] = {P.xx, P.yx, P.xy, P.yy};
  Lanes points[8];
  transpose(rows, points);
  for (int lane = 0; lane < lane_count; ++lane) std::memcpy(&to[lane], &points[lane], sizeof(StressColumns));
}

const double* numbers_of(const Lanes* values) { return reinterpret_cast<const double*>(values); }

template <class Law>
PointTotals stresses_of(const Law law, const NodewiseShape& shape, const Batch& batch, const Chunk& points,
                        const BatchMotion motion, StressColumns* stresses) {
  PointTotals totals;
  for (int p = points.first; p < points.last; p += lane_count) {
    Tensor<Lanes> rate{};
    if constexpr (has_rate<Law>) rate = deformation_gradients(shape, p, numbers_of(motion.velocity));
    Record<Law> now;
    const Response<Lanes> response =
        respond(law.weighted(load(&shape.weight[p])), deformation_gradients(shape, p, numbers_of(motion.position)),
                rate, load_record<Law>(batch, motion, p / lane_count), now);
    store_record<Law>(batch, motion, p / lane_count, now);
    totals.least_jacobian = min(response.J, totals.least_jacobian);
    if constexpr (dissipates<Law>) totals.power += response.power;
    if constexpr (has_loss<Law>) totals.loss += response.loss;
    store_columns(response.P, stresses + p);
  }
  return totals;
}

template <class Law>
double energy_of_chunk(const Law& law, const NodewiseShape& shape, const Batch& batch, int first, int last,
                       const BatchMotion& motion) {
  Lanes total{};
  for (int p = first; p < last; p += lane_count)
    total += load(&shape.weight[p]) * energy_of(law, deformation_gradients(shape, p, numbers_of(motion.position)),
                                                load_record<Law>(batch, motion, p / lane_count));
  return sum(total);
}

}  // namespace

PointTotals nodewise_stresses(const Model& model, const Chunk& points, const BatchMotion& motion,
                              StressColumns* stresses) {
  const Batch& batch = model.batches[points.batch];
  return with_point_law(model, batch, motion, [&](const auto& law) {
    return stresses_of(law, model.nodewise_shape_of(batch), batch, points, motion, stresses);
  });
}

void add_nodewise_forces(const Model& model, const Region& region, const StressColumns* stresses, Lanes* forces) {
  const NodewiseShape& shape = model.nodewise_shape_of(model.batches[region.batch]);
  const int *start = shape.node_start.data(), *point = shape.point.data();
  const Vec2* gradient = shape.node_gradient.data();
  for (int slot = region.first; slot < region.last; ++slot) {
    double x[lane_count], y[lane_count];
    for (int lane = 0; lane < lane_count; ++lane) {
      const int node = lane_count * slot + lane, last = start[node + 1];
      Quad even{}, odd{};  // two sums, so that neither waits for the other's last product
      int e = start[node];
      for (; e + 1 < last; e += 2) {
        even += load_as<Quad>(stresses + point[e]) * twice_each(gradient + e);
        odd += load_as<Quad>(stresses + point[e + 1]) * twice_each(gradient + e + 1);
      }
      if (e < last) even += load_as<Quad>(stresses + point[e]) * twice_each(gradient + e);
      even += odd;
      x[lane] = even[0] + even[2], y[lane] = even[1] + even[3];
    }
    forces[2 * slot] -= load(x);
    forces[2 * slot + 1] -= load(y);
  }
}

PointTotals add_nodewise_forces(const Model& model, const Batch& batch, const BatchMotion& motion, Lanes* forces) {
  const int number = static_cast<int>(&batch - model.batches.data()), points = model.nodewise_shape_of(batch).points();
  thread_local std::vector<StressColumns> scratch;
  thread_local std::vector<PointTotals> scratch_totals;
  constexpr int step = NodewiseShape::chunk_points;
  const int chunks = (points + step - 1) / step;
  scratch.resize(static_cast<std::size_t>(points));
  scratch_totals.resize(static_cast<std::size_t>(chunks));
  StressColumns* stresses = scratch.data();  // of the calling thread, shared by all threads
  PointTotals* of_chunks = scratch_totals.data();
  parallel_for(chunks, [&](int c) {
    of_chunks[c] = nodewise_stresses(model, {number, c * step, std::min(points, (c + 1) * step)}, motion, stresses);
  });
  parallel_for(batch.regions,
               [&](int r) { add_nodewise_forces(model, model.regions[batch.first_region + r], stresses, forces); });
  PointTotals totals;
  for (int c = 0; c < chunks; ++c) {
    totals.least_jacobian = min(totals.least_jacobian, of_chunks[c].least_jacobian);
    totals.power[0] += sum(of_chunks[c].power), totals.loss[0] += sum(of_chunks[c].loss);
  }
  totals.least_jacobian = broadcast(-largest(-totals.least_jacobian));
  return totals;
}

Lanes nodewise_strain_energy(const Model& model, const Batch& batch, const BatchMotion& motion) {
  const NodewiseShape& shape = model.nodewise_shape_of(batch);
  constexpr int step = NodewiseShape::chunk_points;
  const int points = shape.points();
  Lanes result{};
  result[0] = ordered_sum<1>((points + step - 1) / step, [&](int c) {
    return with_law(model.groups[batch.group].law, batch.constants, [&](const auto& law) {
      return energy_of_chunk(law, shape, batch, c * step, std::min(points, (c + 1) * step), motion);
    });
  });
  return batch.weight * result;
}

}  // namespace pliant
