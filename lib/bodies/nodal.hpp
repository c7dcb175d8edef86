#pragma once

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"

namespace pliant {

/// Quantity of one compliant body at its field nodes, [nodes]: u(X_k) = sum phi_i(X_k) q_i. Positions are relative to
/// the body's fixed centre.
Points nodal_values(const Model& model, const Body& body, const Dofs& dofs);
/// The same at its outline nodes, [outline nodes].
Points outline_values(const Model& model, const Body& body, const Dofs& dofs);

/// The degrees of freedom themselves, [nodes], without shape functions.
Points dof_values(const Model& model, const Body& body, const Dofs& dofs);

/// Mass-weighted mean of a quantity of one compliant body: its centre of mass (from the fixed centre), or the velocity
/// of that.
Vec2 mean_value(const Model& model, const Body& body, const Dofs& dofs);

}  // namespace pliant
