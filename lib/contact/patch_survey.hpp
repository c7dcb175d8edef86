#pragma once

#include "bodies/model.hpp"
#include "bodies/outline.hpp"
#include "contact/history.hpp"
#include "contact/master_window.hpp"
#include "contact/patch_forces.hpp"

namespace pliant {

// What is asked of a patch besides its forces.

/// Length of both sides in touch, each pass with weight 1/2, m.
double touching_length(const Model& model, const Outlines& outlines, const Patch& patch, double skin,
                       MasterWindow& scratch);

/// Places of the nodes that can come in touch within a step, at the present outlines, where a history has none yet. Known before the touch, so
/// that slip counts from its first step.
void locate_newcomers(const Model& model, const Outlines& outlines, const Patch& patch, double skin,
                      ContactHistory& history, MasterWindow& scratch);

/// Where the gap is small enough at the start of a run, bonds are whole. Does nothing without a law that knows bonds.
void make_bonds(const Model& model, const Outlines& outlines, const Patch& patch, double skin, ContactHistory& history,
                MasterWindow& scratch);

/// Whether some node of the patch stands inside the other outline.
bool overlaps(const Model& model, const Outlines& outlines, const Patch& patch, double skin, MasterWindow& scratch);

/// A-priori contact stiffness a node, N/m2 per metre of thickness, of everything that may come in touch within `outward`, added to the
/// entries of the patch's nodes as forces have them: half the tributary length times the stiffness, shared by the two segment nodes on the master.
void compute_patch_stiffness(const Model& model, const Outlines& outlines, const Patch& patch, double stiffness,
                             double skin, double outward, const double (&factor)[2], std::vector<double>& entries,
                             MasterWindow& scratch);

}  // namespace pliant
