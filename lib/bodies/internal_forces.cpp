#include "bodies/internal_forces.hpp"

#include <algorithm>

#include "bodies/body_view.hpp"
#include "bodies/node_arrays.hpp"
#include "bodies/nodewise_forces.hpp"
#include "core/prefetch.hpp"

namespace pliant {
namespace {

/// A table's arrays by plain pointers: a store of Lanes may alias the vectors' own pointers, which would be read again
/// each time.
template <class Gradient, class Weight>
struct Rows {
  const int *start, *node;
  const Gradient* gradient;
  const Weight* weight;
  int points;
};

/// Rows of an IntegrationTable or a LaneTable.
template <class Table>
auto rows_of(const Table& table) {
  return Rows{table.start.data(), table.node.data(), table.gradient.data(), table.weight.data(),
              static_cast<int>(table.weight.size())};
}

template <class... T>
inline Tensor<Lanes> deformation_gradient(const Rows<T...>& rows, int point, const Lanes* q) {
  Tensor<Lanes> F{};
  for (int e = rows.start[point]; e < rows.start[point + 1]; ++e) {
    const auto bx = rows.gradient[e].x(), by = rows.gradient[e].y();
    const Lanes x = q[2 * rows.node[e]], y = q[2 * rows.node[e] + 1];
    F.xx += x * bx;
    F.xy += x * by;
    F.yx += y * bx;
    F.yy += y * by;
  }
  return F;
}

template <class... T>
inline void subtract_forces(const Rows<T...>& rows, int point, const Tensor<Lanes>& P, Lanes* f) {
  for (int e = rows.start[point], end = rows.start[point + 1]; e < end; ++e) {
    const auto bx = rows.gradient[e].x(), by = rows.gradient[e].y();
    Lanes* node = f + 2 * rows.node[e];
    Lanes fx = node[0], fy = node[1];
    fx -= P.xx * bx;  // one statement per product: each becomes one fused operation
    fx -= P.xy * by;
    fy -= P.yx * bx;
    fy -= P.yy * by;
    node[0] = fx;
    node[1] = fy;
  }
}

/// Three points are processed at once, each at another stage, so that the processor does not wait for the long chain of
/// operations of one point's stress: gradients of the next point and forces of the one before come between. Those of a
/// law in two parts come between its parts. Law and motion are copies, which no store of Lanes can alias.
template <class Law, class... T>
PointTotals add_forces(const Law law, const Rows<T...>& rows, const Batch& batch, const BatchMotion motion, Lanes* f) {
  PointTotals totals;
  const int last = rows.points - 1;
  const auto weighted_stress = [&](int point, const auto& trial, const Tensor<Lanes>& F, const Record<Law>& old) {
    Tensor<Lanes> rate{};
    if constexpr (has_rate<Law>) rate = deformation_gradient(rows, point, motion.velocity);
    Record<Law> now;
    const Response<Lanes> response = respond(law.weighted(rows.weight[point]), trial, F, rate, old, now);
    store_record<Law>(batch, motion, point, now);
    totals.least_jacobian = min(response.J, totals.least_jacobian);
    if constexpr (dissipates<Law>) totals.power += response.power;
    if constexpr (has_loss<Law>) totals.loss += response.loss;
    return response.P;
  };
  const Upcoming<Access::read> next_position(motion.next_position, motion.next_count);
  const Upcoming<Access::write> next_forces(motion.next_forces, motion.next_count);
  Tensor<Lanes> P{}, next_P, F = deformation_gradient(rows, 0, motion.position);
  for (int point = 0; point <= last; ++point) {
    next_position.ask(point), next_forces.ask(point);
    const Record<Law> old = load_record<Law>(batch, motion, point);
    const auto trial = trial_of(law, F, old);
    if constexpr (!has_trial<Law>) next_P = weighted_stress(point, trial, F, old);
    const Tensor<Lanes> next_F = deformation_gradient(rows, std::min(point + 1, last), motion.position);
    if (point > 0) subtract_forces(rows, point - 1, P, f);
    if constexpr (has_trial<Law>) next_P = weighted_stress(point, trial, F, old);
    P = next_P, F = next_F;
  }
  subtract_forces(rows, last, P, f);
  return totals;
}

template <class Law, class... T>
Lanes energy(const Law& law, const Rows<T...>& rows, const Batch& batch, const BatchMotion& motion) {
  Lanes total{};
  for (int point = 0; point < rows.points; ++point)
    total += rows.weight[point] *
             energy_of(law, deformation_gradient(rows, point, motion.position), load_record<Law>(batch, motion, point));
  return total;
}

}  // namespace

PointTotals add_internal_forces(const Model& model, const Batch& batch, const BatchMotion& motion, Lanes* forces) {
  if (batch.layout == Layout::nodewise) return add_nodewise_forces(model, batch, motion, forces);
  return with_tables(model, batch, [&](const auto& tables) {
    return with_point_law(model, batch, motion, [&](const auto& law) {
      return add_forces(law, rows_of(tables.table), batch, motion, forces);
    });
  });
}

Lanes strain_energy(const Model& model, const Batch& batch, const BatchMotion& motion) {
  if (batch.layout == Layout::nodewise) return nodewise_strain_energy(model, batch, motion);
  return batch.weight * with_tables(model, batch, [&](const auto& tables) {
           return with_law(model.groups[batch.group].law, batch.constants,
                           [&](const auto& law) { return energy(law, rows_of(tables.table), batch, motion); });
         });
}

std::vector<Tensor<double>> deformation_gradients(const Model& model, const Body& body, const Dofs& position) {
  const IntegrationTable& table = model.shape_of(body).space.table;
  const BodyView q(model, body, position);
  std::vector<Tensor<double>> result(table.weight.size(), Tensor<double>{0, 0, 0, 0});
  for (std::size_t g = 0; g < result.size(); ++g)
    for (int e = table.start[g]; e < table.start[g + 1]; ++e) {
      const Vec2 b = table.gradient[e], x = q[static_cast<std::size_t>(table.node[e])];
      result[g].xx += x.x() * b.x(), result[g].xy += x.x() * b.y();
      result[g].yx += x.y() * b.x(), result[g].yy += x.y() * b.y();
    }
  return result;
}

}  // namespace pliant
