#pragma once

#include "benchmarks/kernels/meter.hpp"
#include "bodies/model.hpp"
#include "bonds/bond_system.hpp"
#include "contact/contact.hpp"

namespace pliant::kernels {

/// What kernels have to do in a model, from their loops (meter.hpp). Bodies alone count: padding lanes do not.

double integration_points(const Model& model);
double field_nodes(const Model& model);        ///< of compliant bodies
double outline_nodes(const Model& model);      ///< of all bodies
double records(const ContactSystem& contact);  ///< slave nodes of all contact pairs, without padding

namespace work {
Work internal_forces(const Model& model);
Work place_outlines(const Model& model);
Work gather_outline_forces(const Model& model);
Work update(const Model& model);
Work contact_forces(const Model& model, const ContactSystem& contact);
Work bond_forces(const BondSystem& bonds);
}  // namespace work

}  // namespace pliant::kernels
