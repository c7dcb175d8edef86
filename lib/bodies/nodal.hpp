#pragma once

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"

namespace pliant {

/// A quantity of one compliant body at its field nodes, [nodes]: u(X_k) = sum phi_i(X_k) q_i. Positions count from the
/// body's fixed centre.
Points nodal_values(const Model& model, const Body& body, const Dofs& dofs);
/// The same at its outline nodes, [outline nodes].
Points outline_values(const Model& model, const Body& body, const Dofs& dofs);

/// The degrees of freedom themselves, [nodes]: no shape functions applied.
Points dof_values(const Model& model, const Body& body, const Dofs& dofs);

/// Mean of a quantity over the mass of one compliant body: where its centre of mass is (from the fixed centre), or the
/// velocity of it.
Vec2 mean_value(const Model& model, const Body& body, const Dofs& dofs);

}  // namespace pliant
