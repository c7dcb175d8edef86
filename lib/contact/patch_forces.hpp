#pragma once

#include "bodies/model.hpp"
#include "bodies/outline.hpp"
#include "contact/contact_laws.hpp"
#include "contact/patch.hpp"
#include "contact/projection.hpp"

namespace pliant {

/// What the two passes of a patch add up to.
struct PatchTotals {
  double stored = 0;      ///< normal and elastic tangential energy, J/m
  double dissipated = 0;  ///< slip work since the last accepted step, J/m
  double deepest = 0;     ///< largest penetration over the longest segment near; contacts can be lost beyond 1
  int contacts = 0;       ///< nodes in touch
};

/// Where the forces of all patches go: each arc has its own stretch, gathered later by its body in a fixed order.
struct PatchForces {
  std::vector<double> x, y;  ///< N/m
};

/// Forces of one patch: each body's nodes against the other's segments, each pass with weight 1/2 (METHOD 4).
/// `committed` is the history of the last accepted step, `trial` receives the new one. Penetrations are seen down to the longest segment near and
/// `skin` more: as no step moves two bodies further than the skin against each other, none can pass from a permitted depth to beyond sight.
PatchTotals compute_patch(const Model& model, const ContactLaws& laws, const Outlines& outlines, const Patch& patch,
                          double skin, const ContactHistory& committed, ContactHistory& trial, PatchForces& forces,
                          MasterWindow& scratch);

/// Places of the nodes that can come in touch within a step, at the present outlines, where a history has none yet. Known before the touch, so
/// that slip counts from its first step.
void locate_newcomers(const Model& model, const ContactLaws& laws, const Outlines& outlines, const Patch& patch,
                      double skin, ContactHistory& history, MasterWindow& scratch);

/// A-priori contact stiffness a node, N/m2 per metre of thickness, of everything that may come in touch within `outward`, written in the place
/// of the forces' x: half the tributary length times the stiffness, shared by the two segment nodes on the master.
void compute_patch_stiffness(const Model& model, const Outlines& outlines, const Patch& patch, double stiffness,
                             double skin, double outward, const double (&factor)[2], PatchForces& forces,
                             MasterWindow& scratch);

}  // namespace pliant
