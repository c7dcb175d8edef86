#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/vec2.hpp"

namespace pliant {

/// Points of a chain as they follow in a file, and the line that each stands on.
struct FilePoints {
  Points points;           ///< [points], in the unit of the file
  std::vector<int> lines;  ///< [points], from 1
  double unit = 0;         ///< m; 0: the file does not say
};

/// The outline in a text file of two columns x, y, separated by commas, semicolons, blanks or tabs; a first line may
/// name them and their unit, as in "x [mm], y [mm]"; "#" begins a comment. The last point may repeat the first.
FilePoints read_csv_outline(const std::string& file, const std::string& text);

/// The outline in a gmsh file, format 2.2 or 4.1, ASCII: the boundary of its triangles and quadrangles, or, where it
/// has none, its chain of lines. All of first order and in one plane z.
FilePoints read_gmsh_outline(const std::string& file, const std::string& text);

/// The closed outline in a file (.msh: gmsh, else columns), counter-clockwise, m. `unit`: such as "mm", for a file that
/// does not say its own; empty: m. Throws InputError with file and line: holes, several loops, open or crossing
/// chains, points that coincide, fewer than three or more than `most_points`.
Points read_outline_file(const std::filesystem::path& file, const std::string& unit, std::size_t most_points);

}  // namespace pliant
