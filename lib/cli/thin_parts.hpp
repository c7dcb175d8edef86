#pragma once

#include <optional>
#include <string>

#include "bodies/model.hpp"

namespace pliant {

/// Where a compliant shape is a limb: its faces lie across from each other for at least twice the distance between
/// them.
struct ThinPart {
  double thickness = 0;        ///< m, of the unscaled shape
  double segments_across = 0;  ///< thickness over the mean segment of these faces
  Vec2 position{0, 0};         ///< m, on the outline in the middle of the limb
};

/// The limb with the fewest segments across; nothing where a shape has none. `outline`: closed, counter-clockwise.
std::optional<ThinPart> thinnest_part(const Points& outline);

/// How much further than a beam a strip bends that has so many segments of the outline across, relative; below 0: less
/// far. Between those measured by straight lines in 1/n^2, of more by that power, of fewer than one that of one.
/// Nothing of methods that were not measured.
std::optional<double> bending_error(DiscretisationMethod method, double segments_across);

/// From this share on bending is worth a word.
inline constexpr double worth_a_warning = 0.05;

/// Of the scene's worst limb: what it bends wrongly, and how many segments across would do. Empty where no limb is off
/// by worth_a_warning.
std::string describe_bending(const Model& model);

}  // namespace pliant
