#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/vec2.hpp"

namespace pliant {

/// What counts here of a mesh that gmsh wrote.
struct GmshMesh {
  struct Node {
    Vec2 position;  ///< in the unit of the file
    double z = 0;   ///< the same for all
    int line = 0;   ///< of the file
  };
  struct Element {
    std::vector<int> nodes;  ///< tags: 2 of a line, 3 or 4 of a surface element, in order around it
    int group = 0;           ///< tag of its physical group, the first of several; 0: it has none
  };
  std::map<int, Node> nodes;  ///< by tag
  std::vector<Element> lines, surfaces;
  std::map<std::pair<int, int>, std::string> group_names;  ///< by dimension and tag; not all groups have one
};

/// Reads a file of format 2.2 or 4.1, ASCII, with elements of first order in one plane z. Elements that stand there
/// once for each of their groups are taken once. Throws InputError with file and line.
GmshMesh read_gmsh_file(const std::string& file, const std::string& text);

}  // namespace pliant
