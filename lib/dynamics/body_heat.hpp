#pragma once

#include <vector>

#include "bodies/model.hpp"
#include "contact/contact_pair.hpp"

namespace pliant {

/// Heat of bodies, which are adiabatic: what dissipation leaves in them, without conduction and expansion. A body takes
/// `taylor_quinney` of its plastic loss (Taylor and Quinney 1934, Proc. R. Soc. Lond. A 143, 307-326), what its
/// viscosity dissipates, and half of what its contacts do. Powers count with their values at the ends of steps, which
/// makes their part of first order in the step. Mass damping, supports and the dashpots of loads heat nothing.

/// Whether some material has a heat capacity.
bool tracks_heat(const Scene& scene);

/// Dissipation of materials in an evaluation, per batch of several bodies, one lane a body, then per chunk of points,
/// all lanes one body.
struct MaterialDissipation {
  const std::vector<Lanes>& power;  ///< W/m; empty: none
  const std::vector<Lanes>& loss;   ///< J/m in the step; empty: none
};

/// Adds the heat of a step of `dt` to `heat`, [bodies], J/m.
void add_heat(const Model& model, const MaterialDissipation& material, const std::vector<ContactPair>& pairs,
              const std::vector<PairTotals>& totals, double dt, std::vector<double>& heat);

/// Rise of a body's temperature since the start, K; NaN for materials without a heat capacity.
double temperature_rise(const Model& model, int body, const std::vector<double>& heat);

}  // namespace pliant
