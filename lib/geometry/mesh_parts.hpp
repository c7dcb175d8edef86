#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "geometry/gmsh_file.hpp"

namespace pliant {

/// Nodes by what they are taken for: those at one place may be one.
using NodeNames = std::map<int, int>;

using MeshEdge = std::pair<int, int>;  ///< tags of its nodes, the smaller first
/// How many elements each edge belongs to.
using MeshEdges = std::map<MeshEdge, int>;

/// One body of a mesh: surface elements of one physical group that hang together by their edges, or, in a mesh without
/// surfaces, a chain of lines.
struct MeshPart {
  std::string name;   ///< of its group; with ".1", ".2", ... where the group has several; "1", "2", ... without groups
  std::string group;  ///< name of its physical group, "group 7" for one without; empty: it has none
  std::vector<const GmshMesh::Element*> elements;  ///< of the mesh, in the order of the file
};

/// In the order of the file.
std::vector<MeshPart> parts_of(const GmshMesh& mesh);

/// All elements as one part.
MeshPart whole_mesh(const GmshMesh& mesh);

MeshEdges edges_of(const MeshPart& part, const NodeNames& names);

/// Nodes that lie at the place of another one of these, by tag, with that one: the distance of the two is below 1e-8 of
/// the diagonal around them, the tolerance by which gmsh itself removes duplicates.
NodeNames coinciding_nodes(const GmshMesh& mesh, const std::vector<int>& tags);

/// Tags of a part's nodes, each once, growing.
std::vector<int> nodes_of(const MeshPart& part);

}  // namespace pliant
