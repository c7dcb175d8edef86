#include "bodies/spread_forces.hpp"

#include <algorithm>

#include "core/parallel.hpp"
#include "materials/kelvin_voigt.hpp"
#include "materials/tensor.hpp"
#include "materials/with_material.hpp"

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

/// Deformation gradients of eight points, one a lane.
Tensor<Lanes> deformation_gradients(const SpreadShape& shape, int first, const double* q) {
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

void add_columns(const Tensor<Lanes>& P, StressColumns* to) {
  const Lanes rows[8] = {P.xx, P.yx, P.xy, P.yy};
  Lanes points[8];
  transpose(rows, points);
  for (int lane = 0; lane < lane_count; ++lane) {
    const Lanes& point = points[lane];
    to[lane].xx += point[0], to[lane].yx += point[1], to[lane].xy += point[2], to[lane].yy += point[3];
  }
}

void store_columns(const Tensor<Lanes>& P, StressColumns* to) {
  const Lanes rows[8] = {P.xx, P.yx, P.xy, P.yy};
  Lanes points[8];
  transpose(rows, points);
  for (int lane = 0; lane < lane_count; ++lane) std::memcpy(&to[lane], &points[lane], sizeof(StressColumns));
}

template <class Law>
double stresses_of(Law, const SpreadShape& shape, Lanes mu, Lanes lambda, const Chunk& points, const double* q,
                   StressColumns* stresses) {
  Lanes least_J = broadcast(1e300);
  for (int p = points.first; p < points.last; p += lane_count) {
    const Lanes w = load(&shape.weight[p]);
    const Response<Lanes> response =
        Law::template stress<Lanes>(deformation_gradients(shape, p, q), w * mu, w * lambda);  // P is linear in them
    least_J = min(response.J, least_J);
    store_columns(response.P, stresses + p);
  }
  return -largest(-least_J);
}

template <class Law>
double energy_of(Law, const SpreadShape& shape, Lanes mu, Lanes lambda, int first, int last, const double* q) {
  Lanes total{};
  for (int p = first; p < last; p += lane_count)
    total += load(&shape.weight[p]) * Law::template energy<Lanes>(deformation_gradients(shape, p, q), mu, lambda);
  return sum(total);
}

const double* flat(const Lanes* values) { return reinterpret_cast<const double*>(values); }

}  // namespace

double spread_stresses(const Model& model, const Chunk& points, const Lanes* positions, StressColumns* stresses) {
  const Batch& batch = model.batches[points.batch];
  return with_material(model.groups[batch.group].law, [&](auto law) {
    return stresses_of(law, model.spread_shape_of(batch), batch.mu, batch.lambda, points, flat(positions), stresses);
  });
}

double add_viscous_stresses(const Model& model, const Chunk& points, const Lanes* positions, const Lanes* velocities,
                            StressColumns* stresses) {
  const Batch& batch = model.batches[points.batch];
  const SpreadShape& shape = model.spread_shape_of(batch);
  Lanes power{};
  for (int p = points.first; p < points.last; p += lane_count) {
    const Tensor<Lanes> F = deformation_gradients(shape, p, flat(positions));
    const KelvinVoigt rate(F, deformation_gradients(shape, p, flat(velocities)));
    const Lanes factor = 2.0 * batch.viscosity * load(&shape.weight[p]);
    power += factor * rate.square();
    add_columns(rate.stress(F, factor), stresses + p);
  }
  return sum(power) * batch.weight[0];
}

void add_spread_forces(const Model& model, const Region& region, const StressColumns* stresses, Lanes* forces) {
  const SpreadShape& shape = model.spread_shape_of(model.batches[region.batch]);
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

Lanes add_spread_forces(const Model& model, const Batch& batch, const Lanes* positions, Lanes* forces) {
  const int number = static_cast<int>(&batch - model.batches.data()), points = model.spread_shape_of(batch).points();
  thread_local std::vector<StressColumns> scratch;
  scratch.resize(static_cast<std::size_t>(points));
  StressColumns* stresses = scratch.data();  // of the calling thread, for all that share its work
  constexpr int step = SpreadShape::chunk_points;
  const int chunks = (points + step - 1) / step;
  const double least = -parallel_max(chunks, -1e300, [&](int c) {
    return -spread_stresses(model, {number, c * step, std::min(points, (c + 1) * step)}, positions, stresses);
  });
  parallel_for(batch.regions,
               [&](int r) { add_spread_forces(model, model.regions[batch.first_region + r], stresses, forces); });
  return broadcast(least);
}

Lanes add_spread_viscous_forces(const Model& model, const Batch& batch, const Lanes* positions, const Lanes* velocities,
                                Lanes* forces) {
  const int number = static_cast<int>(&batch - model.batches.data()), points = model.spread_shape_of(batch).points();
  std::vector<StressColumns> stresses(static_cast<std::size_t>(points));
  constexpr int step = SpreadShape::chunk_points;
  Lanes power{};
  power[0] = ordered_sum<1>((points + step - 1) / step,
                            [&](int c) {
                              const Chunk chunk{number, c * step, std::min(points, (c + 1) * step)};
                              return add_viscous_stresses(model, chunk, positions, velocities, stresses.data());
                            }) /
             batch.weight[0];
  parallel_for(batch.regions, [&](int r) {
    add_spread_forces(model, model.regions[batch.first_region + r], stresses.data(), forces);
  });
  return power;
}

Lanes spread_strain_energy(const Model& model, const Batch& batch, const Lanes* positions) {
  const SpreadShape& shape = model.spread_shape_of(batch);
  constexpr int step = SpreadShape::chunk_points;
  const int points = shape.points();
  Lanes result{};
  result[0] = ordered_sum<1>((points + step - 1) / step, [&](int c) {
    return with_material(model.groups[batch.group].law, [&](auto law) {
      return energy_of(law, shape, batch.mu, batch.lambda, c * step, std::min(points, (c + 1) * step), flat(positions));
    });
  });
  return batch.weight * result;
}

}  // namespace pliant
