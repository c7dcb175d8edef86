#pragma once

#include "bodies/model.hpp"
#include "dynamics/state.hpp"
#include "dynamics/trial.hpp"

namespace pliant {

/// Motion of a cell with two periods (docs/method.md 10). Its vectors are the lattice of the positions, and their rates
/// that of the velocities. Within a step the rates are constant. They change between steps only, and then the velocity
/// of all matter changes by the jump of the cell's velocity gradient times the position, so that matter at rest
/// relative to the cell stays so.

/// Sets the lattice, and adds the cell's motion at t = 0 to the velocities.
void start_cell(const Model& model, State& state);

/// Gives the cell the rates of its histories from the state's time on. The change of kinetic energy is external work.
void turn_cell(const Model& model, State& state);

/// Lets stress move the cell, between two steps: by the difference of the wanted and the present stress over the time
/// dt, s.
void push_cell(const Model& model, State& state, double dt);

/// Throws PhysicsError if the cell gives way.
void check_cell_holds(const State& state);

/// Work of the cell on the images of bodies from the state to a trial at the end of the step, J/m.
double work_on_images(const State& before, const Trial& after);

/// The cell's velocity gradient, 1/s.
Eigen::Matrix2d velocity_gradient(const State& state);
/// The cell's deformation gradient since the scene's periods.
Eigen::Matrix2d deformation_gradient(const Scene& scene, const State& state);

}  // namespace pliant
