#pragma once

#include <utility>
#include <vector>

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"
#include "bodies/outline.hpp"

namespace pliant {

/// Forces of pressures and soft supports, on the outlines for as long as this lives: they go to the bodies the way of
/// contact forces, and what reads contact forces from the outlines afterwards sees those alone. Free for scenes
/// without.
class OutlineLoads {
 public:
  /// `outlines`: of the motion, with its velocities where Model::outline_rates.
  OutlineLoads(const Model& model, const Instant& at, Outlines& outlines);
  ~OutlineLoads();
  OutlineLoads(const OutlineLoads&) = delete;
  OutlineLoads& operator=(const OutlineLoads&) = delete;

  double damping_power() const { return damping_power_; }  ///< of the supports' dashpots, W/m

 private:
  void add(int index, const Vec2& force);
  void add(const OutlineSupport& support, const Instant& at);

  Outlines& outlines_;
  std::vector<std::pair<int, Vec2>> before_;  ///< index of the node and the force it had
  double damping_power_ = 0;
};

/// What pressures and supports together exert on one body, N/m.
Vec2 outline_load(const Model& model, int body, const Motion& motion);

/// Energy in the springs of soft supports, J/m.
double support_energy(const Model& model, const Dofs& position, const Instant& at);

/// The part of add_load_change (boundary/loads.hpp) that acts on outlines: pressures and supports. Returns the growth of their dashpots' power, W/m.
double add_outline_load_change(const Model& model, const Motion& at, const Instant& to, Dofs& force);

/// Work that pressures do and that supports' histories do on their springs and dashpots over one step, J/m: trapezoidal rule.
double outline_work(const Model& model, const Motion& before, const Motion& after);

}  // namespace pliant
