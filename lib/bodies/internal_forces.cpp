#include "bodies/internal_forces.hpp"

#include "materials/with_material.hpp"

namespace pliant {
namespace {

constexpr int K = BlockedTable::points_per_block;

/// F at the K points of a block.
inline void gather_deformation(const BlockedTable& table, int block, const Lanes* q, Tensor<Lanes> (&F)[K]) {
  for (auto& f : F) f = Tensor<Lanes>{};
  for (int e = table.start[block]; e < table.start[block + 1]; ++e) {
    const BlockedTable::Entry& entry = table.entries[e];
    const Lanes x = q[2 * entry.node], y = q[2 * entry.node + 1];
    for (int k = 0; k < K; ++k) {
      F[k].xx += x * entry.gradient[k][0];
      F[k].xy += x * entry.gradient[k][1];
      F[k].yx += y * entry.gradient[k][0];
      F[k].yy += y * entry.gradient[k][1];
    }
  }
}

inline void scatter_stress(const BlockedTable& table, int block, const Tensor<Lanes> (&P)[K], Lanes* f) {
  for (int e = table.start[block]; e < table.start[block + 1]; ++e) {
    const BlockedTable::Entry& entry = table.entries[e];
    Lanes fx = f[2 * entry.node], fy = f[2 * entry.node + 1];
    for (int k = 0; k < K; ++k) {  // one statement a product: each becomes one fused operation
      fx -= P[k].xx * entry.gradient[k][0];
      fx -= P[k].xy * entry.gradient[k][1];
      fy -= P[k].yx * entry.gradient[k][0];
      fy -= P[k].yy * entry.gradient[k][1];
    }
    f[2 * entry.node] = fx;
    f[2 * entry.node + 1] = fy;
  }
}

template <class Law>
Lanes add_forces(Law, const BlockedTable& table, Lanes mu, Lanes lambda, const Lanes* q, Lanes* f) {
  Lanes least_J = broadcast(1e300);
  for (int block = 0; block < table.blocks(); ++block) {
    Tensor<Lanes> F[K], P[K];
    gather_deformation(table, block, q, F);
    for (int k = 0; k < K; ++k) {
      const double w = table.weight[K * block + k];
      // A padded point has F = 0 and no weight: give it the identity, so that no infinity meets the zero.
      if (w == 0) F[k].xx = F[k].yy = broadcast(1);
      const Response<Lanes> response = Law::template stress<Lanes>(F[k], mu, lambda);
      P[k] = {w * response.P.xx, w * response.P.xy, w * response.P.yx, w * response.P.yy};
      least_J = min(response.J, least_J);
    }
    scatter_stress(table, block, P, f);
  }
  return least_J;
}

template <class Law>
Lanes energy(Law, const BlockedTable& table, Lanes mu, Lanes lambda, const Lanes* q) {
  Lanes total{};
  for (int block = 0; block < table.blocks(); ++block) {
    Tensor<Lanes> F[K];
    gather_deformation(table, block, q, F);
    for (int k = 0; k < K; ++k)
      if (const double w = table.weight[K * block + k]; w > 0)
        total += w * Law::template energy<Lanes>(F[k], mu, lambda);
  }
  return total;
}

}  // namespace

Lanes add_internal_forces(const Model& model, const Batch& batch, const Lanes* positions, Lanes* forces) {
  const BlockedTable& table = model.shape_of(batch).table;
  return with_material(model.groups[batch.group].law,
                       [&](auto law) { return add_forces(law, table, batch.mu, batch.lambda, positions, forces); });
}

Lanes strain_energy(const Model& model, const Batch& batch, const Lanes* positions) {
  const BlockedTable& table = model.shape_of(batch).table;
  return batch.weight * with_material(model.groups[batch.group].law,
                                      [&](auto law) { return energy(law, table, batch.mu, batch.lambda, positions); });
}

std::vector<Tensor<double>> deformation_gradients(const CompliantShape& shape, const Lanes* positions, int lane) {
  const IntegrationTable& table = shape.space.table;
  std::vector<Tensor<double>> result(table.weight.size(), Tensor<double>{0, 0, 0, 0});
  for (std::size_t g = 0; g < result.size(); ++g)
    for (int e = table.start[g]; e < table.start[g + 1]; ++e) {
      const Vec2 b = table.gradient[e];
      const double x = positions[2 * table.node[e]][lane], y = positions[2 * table.node[e] + 1][lane];
      result[g].xx += x * b.x(), result[g].xy += x * b.y();
      result[g].yx += y * b.x(), result[g].yy += y * b.y();
    }
  return result;
}

}  // namespace pliant
