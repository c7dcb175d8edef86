#pragma once

#include <vector>

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"
#include "dynamics/state.hpp"
#include "materials/tensor.hpp"

namespace pliant {

/// Symmetric plane tensor with the out-of-plane stress; Pa.
struct Stress {
  double xx = 0, yy = 0, xy = 0, zz = 0;
};

/// Two principal values of a symmetric plane tensor, the first the larger.
struct Principal {
  double first, second;
};
Principal principal(double xx, double yy, double xy);

double von_mises(const Stress& stress);
/// Largest difference of two principal stresses, zz among them.
double tresca(const Stress& stress);
double pressure(const Stress& stress);

/// One integration point of a compliant body (docs/method.md 3).
struct PointState {
  double weight = 0;          ///< reference area, m2
  double jacobian = 1;        ///< current over reference area
  Stress stress;              ///< Cauchy
  double energy = 0;          ///< strain energy per reference volume, J/m3
  double strain[3] = {};      ///< Green-Lagrange, xx, yy, xy, in the axes of the start
  double plastic_strain = 0;  ///< equivalent; 0 for laws without
};

/// [points] of one compliant body.
std::vector<PointState> point_states(const Model& model, const Body& body, const Dofs& position, const Memory& memory);

}  // namespace pliant
