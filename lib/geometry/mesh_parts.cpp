#include "geometry/mesh_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace pliant {

namespace {

/// Sets of things that hang together.
class Clusters {
 public:
  explicit Clusters(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// The first of a set is its root.
  void join(std::size_t a, std::size_t b) {
    a = root(a), b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

template <class Visit>
void for_each_edge(const GmshMesh::Element& element, Visit&& visit) {
  const std::size_t n = element.nodes.size();
  for (std::size_t i = 0; i < (n == 2 ? 1 : n); ++i)
    visit(MeshEdge(std::minmax(element.nodes[i], element.nodes[(i + 1) % n])));
}

std::string name_of_group(const GmshMesh& mesh, int dimension, int tag) {
  if (tag == 0) return {};
  const auto found = mesh.group_names.find({dimension, tag});
  return found == mesh.group_names.end() ? fmt::format("group {}", tag) : found->second;
}

/// Surfaces hang together by edges within a group, lines by nodes.
Clusters clusters_of(const std::vector<GmshMesh::Element>& elements, bool surfaces) {
  Clusters clusters(elements.size());
  std::map<std::pair<int, MeshEdge>, std::size_t> first;
  const auto join = [&](int group, const MeshEdge& edge, std::size_t element) {
    const auto [found, is_new] = first.try_emplace({group, edge}, element);
    if (!is_new) clusters.join(found->second, element);
  };
  for (std::size_t e = 0; e < elements.size(); ++e) {
    if (surfaces) for_each_edge(elements[e], [&](const MeshEdge& edge) { join(elements[e].group, edge, e); });
    if (!surfaces)
      for (const int node : elements[e].nodes) join(0, {node, node}, e);
  }
  return clusters;
}

/// Numbers where a group has several parts, or there is none.
void name_parts(std::vector<MeshPart>& parts) {
  std::map<std::string, int> members, named;
  for (const MeshPart& part : parts) ++members[part.group];
  for (MeshPart& part : parts) {
    const int number = ++named[part.group];
    part.name = part.group.empty()         ? std::to_string(number)
                : members[part.group] == 1 ? part.group
                                           : fmt::format("{}.{}", part.group, number);
  }
}

}  // namespace

std::vector<MeshPart> parts_of(const GmshMesh& mesh) {
  const bool surfaces = !mesh.surfaces.empty();
  const std::vector<GmshMesh::Element>& elements = surfaces ? mesh.surfaces : mesh.lines;
  Clusters clusters = clusters_of(elements, surfaces);
  std::vector<MeshPart> parts;
  std::map<std::size_t, std::size_t> numbers;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const auto [found, is_new] = numbers.try_emplace(clusters.root(e), parts.size());
    const std::string group = name_of_group(mesh, surfaces ? 2 : 1, elements[e].group);
    if (is_new) parts.push_back({{}, group, {}});
    MeshPart& part = parts[found->second];
    part.elements.push_back(&elements[e]);
    if (part.group != group) part.group.clear();  // sides of a chain of lines that have groups of their own
  }
  name_parts(parts);
  return parts;
}

MeshPart whole_mesh(const GmshMesh& mesh) {
  MeshPart part;
  for (const GmshMesh::Element& element : mesh.surfaces.empty() ? mesh.lines : mesh.surfaces)
    part.elements.push_back(&element);
  return part;
}

MeshEdges edges_of(const MeshPart& part, const NodeNames& names) {
  const auto name = [&](int tag) {
    const auto found = names.find(tag);
    return found == names.end() ? tag : found->second;
  };
  MeshEdges edges;
  for (const GmshMesh::Element* element : part.elements)
    for_each_edge(*element, [&](const MeshEdge& edge) {
      const MeshEdge named = std::minmax(name(edge.first), name(edge.second));
      if (named.first != named.second) ++edges[named];
    });
  return edges;
}

NodeNames coinciding_nodes(const GmshMesh& mesh, const std::vector<int>& tags) {
  constexpr double tolerance = 1e-8;  // Geometry.Tolerance of gmsh
  NodeNames names;
  if (tags.empty()) return names;
  const auto position = [&](int tag) -> const Vec2& { return mesh.nodes.at(tag).position; };
  Vec2 low = position(tags[0]), high = low;
  for (const int tag : tags) low = low.cwiseMin(position(tag)), high = high.cwiseMax(position(tag));
  const double distance = tolerance * (high - low).norm();
  if (!(distance > 0) || !std::isfinite(distance)) return names;
  std::map<std::pair<std::int64_t, std::int64_t>, std::vector<int>> cells;  // those kept, by squares of that width
  for (const int tag : tags) {
    const Vec2 at = (position(tag) - low) / distance;
    const auto column = static_cast<std::int64_t>(at.x()), row = static_cast<std::int64_t>(at.y());
    const auto kept_near = [&]() -> const int* {
      for (auto c = column - 1; c <= column + 1; ++c)
        for (auto r = row - 1; r <= row + 1; ++r)
          if (const auto cell = cells.find({c, r}); cell != cells.end())
            for (const int& other : cell->second)
              if ((position(other) - position(tag)).norm() <= distance) return &other;
      return nullptr;
    };
    if (const int* other = kept_near())
      names[tag] = *other;
    else
      cells[{column, row}].push_back(tag);
  }
  return names;
}

std::vector<int> nodes_of(const MeshPart& part) {
  std::vector<int> tags;
  for (const GmshMesh::Element* element : part.elements)
    tags.insert(tags.end(), element->nodes.begin(), element->nodes.end());
  std::sort(tags.begin(), tags.end());
  tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
  return tags;
}

}  // namespace pliant
