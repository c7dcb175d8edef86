#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/vec2.hpp"

namespace pliant {

/// Where grains lie and how large they are, one a line of a file.
struct GrainFile {
  Points positions;               ///< [grains], m
  std::vector<double> scales;     ///< [grains] or empty: sizes over that of the shape
  std::vector<double> diameters;  ///< [grains] or empty: of the circles of the grains' areas, m
  std::vector<double> angles;     ///< [grains] or empty: counter-clockwise, rad
  std::vector<int> lines;         ///< [grains], from 1
  std::string doubt{};            ///< "file:line: ..." of an angle that seems to be in degrees; empty: none
};

/// Reads a text file of columns x and y, then as its first line names them: scale, diameter or radius, and angle, in
/// any order, each with its unit, as in "x [mm], y [mm], diameter [um], angle [deg]". The first line may be a comment,
/// "# x [mm], y [mm]". Columns are separated as those of outlines. `unit`: such as "mm", of the lengths in a file that
/// does not say theirs; empty: m. Angles without a unit are in rad. Throws
/// InputError with file and line, also for lengths and scales beyond 1e12 or sizes below 1e-12.
GrainFile read_grain_file(const std::filesystem::path& file, const std::string& unit, std::size_t most_grains);

}  // namespace pliant
