#include "reference/outputs/cell_stress.hpp"

#include <cstddef>
#include <vector>

namespace pliant::reference {
namespace {

/// Integral of the Cauchy stress over a compliant body, J/m.
Eigen::Matrix2d stress_inside(const View& view, const Body& body) {
  const std::vector<PointStress> points = view.stresses_of(body);
  // Stresses of small strains are per reference area.
  const bool small = view.bodies().material_of(body).law == MaterialLaw::linear_elastic;
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (std::size_t g = 0; g < points.size(); ++g) {
    const PointStress& s = points[g];
    Eigen::Matrix2d stress;
    stress << s.xx, s.xy, s.xy, s.yy;
    sum += view.weights_of(body)[static_cast<Eigen::Index>(g)] * (small ? 1 : s.jacobian) * stress;
  }
  return sum;
}

/// Moment of the contact forces on a body about its centre, J/m.
Eigen::Matrix2d moment_on(const View& view, const Body& body, const Points& forces, const Points& x) {
  const Vec2 centre = view.mean(body, view.positions());
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (std::size_t k = 0; k < body.outline.size(); ++k) {
    const std::size_t node = static_cast<std::size_t>(body.first_outline) + k;
    sum += forces[node] * (x[node] - centre).transpose();
  }
  return sum;
}

}  // namespace

CellStress cell_stress(const View& view) {
  const Points forces = view.contact_forces(), x = view.bodies().outline_positions(view.positions());
  const Eigen::Matrix2d flow = view.run().cell_flow();
  CellStress stress;
  for (const Body& body : view.bodies().all()) {
    stress.contact +=
        body.compliant() && view.run().is_static() ? stress_inside(view, body) : moment_on(view, body, forces, x);
    const Vec2 own = view.mean(body, view.velocities()) - flow * view.mean(body, view.positions());
    stress.kinetic -= body.mass * own * own.transpose();
  }
  for (const ContactElement& element : view.forces().contacts.elements) stress.contact += element.lever.moment;
  for (const ContactPatch& patch : view.forces().contacts.patches) stress.contact += patch.lever.moment;
  for (const BondElement& bond : view.forces().bonds.elements) stress.contact += bond.lever.moment;
  const double area = view.system().periods(view.run().motion().time).area();
  stress.contact /= area, stress.kinetic /= area;
  return stress;
}

}  // namespace pliant::reference
