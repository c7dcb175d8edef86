#pragma once

#include "bodies/model.hpp"
#include "bodies/outline.hpp"
#include "contact/history.hpp"
#include "contact/master_window.hpp"
#include "contact/patch.hpp"

namespace pliant {

/// What the two passes of a patch add up to.
struct PatchTotals {
  double stored = 0;         ///< normal and elastic tangential energy, J/m
  double dissipated = 0;     ///< work of slip and damage since the last accepted step, J/m
  double damping_power = 0;  ///< of dashpots, W/m
  double deepest = 0;        ///< largest penetration over the longest segment near; contacts can be lost beyond 1
  int contacts = 0;          ///< nodes in touch
};

/// Where the forces of all patches go: each arc has its own stretch, gathered later by its body in a fixed order.
struct PatchForces {
  std::vector<double> x, y;  ///< N/m
};

/// Forces of one patch: each body's nodes against the other's segments, each pass with weight 1/2 (METHOD 4).
/// `committed` is the history of the last accepted step, `trial` receives the new one. Penetrations are seen down to the longest segment near and
/// `skin` more: as no step moves two bodies further than the skin against each other, none can pass from a permitted depth to beyond sight.
PatchTotals compute_patch(const Model& model, const Outlines& outlines, const Patch& patch, double skin,
                          const ContactHistory& committed, ContactHistory& trial, PatchForces& forces,
                          MasterWindow& scratch);

}  // namespace pliant
