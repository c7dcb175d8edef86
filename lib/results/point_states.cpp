#include "results/point_states.hpp"

#include <algorithm>
#include <cmath>

#include "bodies/internal_forces.hpp"
#include "materials/with_law.hpp"

namespace pliant {
namespace {

/// Cauchy stress P F^T / J.
template <class Law>
Stress cauchy(const Law& law, const Tensor<double>& F, const Record<Law, double>& record) {
  Record<Law, double> now;
  const auto [P, J, power, loss] = respond(law, F, Tensor<double>{}, record, now);
  return {(P.xx * F.xx + P.xy * F.xy) / J, (P.yx * F.yx + P.yy * F.yy) / J, (P.xx * F.yx + P.xy * F.yy) / J,
          sigma_zz_of(law, F, now)};
}

/// What the law remembers of one point of a body.
template <class Law>
Record<Law, double> record_of(const Model& model, const Body& body, const Memory& memory, std::size_t point) {
  Record<Law, double> record;
  if constexpr (has_internal_variables<Law>) {
    const Batch& batch = model.batches[body.batch];
    const bool nodewise = batch.layout == Layout::nodewise;
    const std::size_t number = nodewise ? model.nodewise_shape_of(batch).point_number[point] : point;
    const std::size_t slot = nodewise ? number / lane_count : number;
    const int lane = nodewise ? static_cast<int>(number % lane_count) : body.lane;
    for (std::size_t k = 0; k < record.size(); ++k)
      record[k] = memory.material[batch.memory + k * static_cast<std::size_t>(batch.points) + slot][lane];
  }
  return record;
}

/// R E R^T with E = (F^T F - 1)/2: F contains the turn R by which the grain was put into the scene.
void strain_at_start(const Tensor<double>& F, double c, double s, double (&strain)[3]) {
  const double xx = 0.5 * (F.xx * F.xx + F.yx * F.yx - 1), yy = 0.5 * (F.xy * F.xy + F.yy * F.yy - 1),
               xy = 0.5 * (F.xx * F.xy + F.yx * F.yy);
  strain[0] = c * c * xx - 2 * c * s * xy + s * s * yy;
  strain[1] = s * s * xx + 2 * c * s * xy + c * c * yy;
  strain[2] = c * s * (xx - yy) + (c * c - s * s) * xy;
}

}  // namespace

Principal principal(double xx, double yy, double xy) {
  const double mean = 0.5 * (xx + yy), radius = std::hypot(0.5 * (xx - yy), xy);
  return {mean + radius, mean - radius};
}

double von_mises(const Stress& s) {
  const double x = s.xx - s.yy, y = s.yy - s.zz, z = s.zz - s.xx;
  return std::sqrt(0.5 * (x * x + y * y + z * z) + 3 * s.xy * s.xy);
}

double tresca(const Stress& s) {
  const Principal p = principal(s.xx, s.yy, s.xy);
  return std::max(p.first, s.zz) - std::min(p.second, s.zz);
}

double pressure(const Stress& s) { return -(s.xx + s.yy + s.zz) / 3; }

std::vector<PointState> point_states(const Model& model, const Body& body, const Dofs& position, const Memory& memory) {
  const std::vector<Tensor<double>> F = deformation_gradients(model, body, position);
  const std::vector<double>& weight = model.shape_of(body).space.table.weight;
  const double c = std::cos(body.angle), s = std::sin(body.angle);
  std::vector<PointState> states(F.size());
  with_law(model.scene.materials[body.material], [&]<class Law>(const Law& law) {
    for (std::size_t g = 0; g < F.size(); ++g) {
      const Record<Law, double> record = record_of<Law>(model, body, memory, g);
      states[g].weight = body.scale * body.scale * weight[g];
      states[g].jacobian = determinant(F[g]);
      states[g].stress = cauchy(law, F[g], record);
      states[g].energy = energy_of(law, F[g], record);
      constexpr int plastic_strain = index_of_internal_variable<Law>("equivalent_plastic_strain");
      if constexpr (plastic_strain >= 0) states[g].plastic_strain = record[plastic_strain];
      strain_at_start(F[g], c, s, states[g].strain);
    }
  });
  return states;
}

}  // namespace pliant
