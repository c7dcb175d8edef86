#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "core/vec2.hpp"

namespace pliant {

/// Points of a chain as they follow in a file, and the line that each stands on.
struct FilePoints {
  Points points;           ///< [points], in the unit of the file
  std::vector<int> lines;  ///< [points], from 1
  double unit = 0;         ///< m; 0: the file does not say
};

/// The outline in a text file of two columns x, y, separated by commas, semicolons, blanks or tabs; a first line may
/// name them and their unit, as in "x [mm], y [mm]"; "#" begins a comment, which may be that first line. The last
/// point may repeat the first.
FilePoints read_csv_outline(const std::string& file, const std::string& text);

/// The file has no such part; the message says which it has, the reader of the scene adds the place.
struct PartsError : InputError {
  using InputError::InputError;
};

/// Outlines in a gmsh file, format 2.2 or 4.1, ASCII, of first order in one plane z: the boundary of each of its parts,
/// which are triangles and quadrangles of one physical group that share edges, or, without any of these, chains of
/// lines. `parts`: which, in the order of the file: the only one (empty), "all", or one or several by the name of the
/// part or of the group; "merged": all as one body, with nodes at one place joined. Throws InputError with the line.
std::vector<FilePoints> read_gmsh_outlines(const std::string& file, const std::string& text, const std::string& parts);

/// The closed outlines in a file (.msh: gmsh, else one in columns), counter-clockwise, m. `unit`: such as "mm", for a
/// file that does not say its own; empty: m. `parts`: as above. Throws InputError with file and line: holes, several
/// loops in one part, open or crossing chains, coordinates beyond 1e12 m, points that coincide, fewer than three or
/// more than `most_points`.
std::vector<Points> read_outline_file(const std::filesystem::path& file, const std::string& unit,
                                      const std::string& parts, std::size_t most_points);

}  // namespace pliant
