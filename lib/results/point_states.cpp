#include "results/point_states.hpp"

#include <algorithm>
#include <cmath>

#include "bodies/internal_forces.hpp"
#include "materials/elastic_constants.hpp"
#include "materials/with_material.hpp"

namespace pliant {
namespace {

/// Cauchy stress P F^T / J.
template <class Law>
Stress cauchy(const Tensor<double>& F, double mu, double lambda) {
  const auto [P, J] = Law::template stress<double>(F, mu, lambda);
  return {(P.xx * F.xx + P.xy * F.xy) / J, (P.yx * F.yx + P.yy * F.yy) / J, (P.xx * F.yx + P.xy * F.yy) / J,
          Law::sigma_zz(F, mu, lambda)};
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

std::vector<PointState> point_states(const Model& model, const Body& body, const Dofs& position) {
  const std::vector<Tensor<double>> F = deformation_gradients(model, body, position);
  const std::vector<double>& weight = model.shape_of(body).space.table.weight;
  const Material& material = model.scene.materials[body.material];
  const LameConstants lame = lame_constants(material.young, material.poisson);
  const double c = std::cos(body.angle), s = std::sin(body.angle);
  std::vector<PointState> states(F.size());
  with_material(material.law, [&](auto law) {
    using Law = decltype(law);
    for (std::size_t g = 0; g < F.size(); ++g) {
      states[g].weight = body.scale * body.scale * weight[g];
      states[g].jacobian = determinant(F[g]);
      states[g].stress = cauchy<Law>(F[g], lame.mu, lame.lambda);
      states[g].energy = Law::template energy<double>(F[g], lame.mu, lame.lambda);
      strain_at_start(F[g], c, s, states[g].strain);
    }
  });
  return states;
}

}  // namespace pliant
