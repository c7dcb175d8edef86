#pragma once

#include <filesystem>

#include "reference/bodies.hpp"

namespace pliant::reference {

/// Most nodes of a body whose frequencies are asked for: its matrices are dense.
inline constexpr int most_modal_nodes = 1500;

/// Angular natural frequencies of a compliant body at its start, growing, rad/s: those of its tangent and mass matrix.
/// Those of rigid motions are zero within rounding. [2 nodes]. Throws InputError for more than most_modal_nodes.
Vector natural_frequencies(const Bodies& bodies, const Body& body, MassMatrix kind);

/// Writes those of the compliant bodies of a scene, once for each shape, size and material, without rigid motions, as
/// JSON with the keys that `pliant modes --json` has. Throws InputError for scenes without compliant bodies.
void write_modes(const Scene& scene, MassMatrix kind, const std::filesystem::path& file);

}  // namespace pliant::reference
