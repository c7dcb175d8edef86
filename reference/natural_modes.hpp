#pragma once

#include <filesystem>

#include "reference/bodies.hpp"

namespace pliant::reference {

/// Largest number of nodes of a body for natural frequencies, as its matrices are dense.
inline constexpr int most_modal_nodes = 1500;

/// Angular natural frequencies of a compliant body at its start, ascending, rad/s, from its tangent and mass matrix.
/// Those of rigid motions are zero within rounding. [2 nodes]. Throws InputError for more than most_modal_nodes.
Vector natural_frequencies(const Bodies& bodies, const Body& body, MassMatrix kind);

/// Writes the natural frequencies of the compliant bodies of a scene, once for each shape, size and material, without
/// rigid motions, as JSON with the keys of `pliant modes --json`. Throws InputError for scenes without compliant
/// bodies.
void write_modes(const Scene& scene, MassMatrix kind, const std::filesystem::path& file);

}  // namespace pliant::reference
