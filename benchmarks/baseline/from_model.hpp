#pragma once

#include <vector>

#include "benchmarks/baseline/bodies.hpp"
#include "benchmarks/baseline/contact.hpp"
#include "bodies/dofs.hpp"
#include "bodies/model.hpp"
#include "contact/contact.hpp"

namespace pliant::baseline {

/// The bodies of a model where the engine has them; velocities are 0.
std::vector<Body> bodies_of(const Model& model, const Dofs& position);
/// The same bodies elsewhere.
void move_to(const Model& model, const Dofs& position, std::vector<Body>& bodies);

/// The laws of a model, and the engine's skin; the bodies get their groups. Throws std::invalid_argument for laws that
/// the lists do not know.
Contact contact_of(const Model& model, const ContactSystem& contact, std::vector<Body>& bodies);

}  // namespace pliant::baseline
