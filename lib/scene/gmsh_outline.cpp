#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "scene/outline_file.hpp"
#include "scene/polygon_rules.hpp"
#include "scene/text_file.hpp"

namespace pliant {

namespace {

struct GmshNode {
  Vec2 position;
  double z = 0;
  int line = 0;  ///< of the file
};

using Edge = std::pair<int, int>;  // tags of its nodes, the smaller first

/// What counts of a mesh: edges of its lines, and how many surface elements each edge belongs to.
struct Mesh {
  std::map<int, GmshNode> nodes;
  std::map<Edge, int> line_edges, surface_edges;
};

Edge edge_of(int a, int b) { return std::minmax(a, b); }

/// Reads the sections of a gmsh file, https://gmsh.info/doc/texinfo/gmsh.html#MSH-file-format (4.1) and
/// #MSH-file-format-version-2.
class GmshReader {
 public:
  GmshReader(const std::string& file, const std::string& text) : reader_(file, text) {}

  Mesh read() {
    while (reader_.next()) {
      const std::string section(reader_.line());
      if (section.empty()) continue;
      if (!section.starts_with('$')) reader_.fail("found text outside of a section; allowed: $MeshFormat first");
      if (section == "$MeshFormat") read_format();
      if (!format_known_) reader_.fail(fmt::format("found {}; allowed: $MeshFormat first", section));
      if (section == "$Nodes") blocks_ ? read_node_blocks() : read_nodes();
      if (section == "$Elements") blocks_ ? read_element_blocks() : read_elements();
      skip_to("$End" + section.substr(1));
    }
    return std::move(mesh_);
  }

 private:
  void line() {
    if (!reader_.next()) reader_.fail("the file ends within a section");
  }

  /// The next line as integers, at least `least` of them.
  std::vector<int> integers(std::size_t least) {
    line();
    std::vector<int> numbers;
    for (const std::string_view field : fields_of(reader_.line(), ' ')) {
      int number = 0;
      if (!parse_number(field, number)) reader_.fail(fmt::format("found \"{}\"; allowed: integers", field));
      numbers.push_back(number);
    }
    if (numbers.size() < least)
      reader_.fail(fmt::format("found {} numbers; allowed: at least {}", numbers.size(), least));
    return numbers;
  }

  void skip_to(const std::string& end) {
    while (reader_.line() != end) line();
  }

  void read_format() {
    line();
    const std::vector<std::string_view> fields = fields_of(reader_.line(), ' ');
    int binary = 0;
    if (fields.size() < 3 || (fields[0] != "2.2" && fields[0] != "4.1") || !parse_number(fields[1], binary))
      reader_.fail(fmt::format("found the format \"{}\"; allowed: gmsh 2.2 or 4.1", reader_.line()));
    if (binary != 0) reader_.fail("a binary file; allowed: ASCII (in gmsh: Mesh.Binary = 0)");
    blocks_ = fields[0] == "4.1";
    format_known_ = true;
  }

  void add_node(int tag, const std::vector<std::string_view>& coordinates) {
    GmshNode node;
    if (coordinates.size() < 3 || !parse_number(coordinates[0], node.position.x()) ||
        !parse_number(coordinates[1], node.position.y()) || !parse_number(coordinates[2], node.z))
      reader_.fail("found no node; allowed: three coordinates");
    node.line = reader_.number();
    if (!mesh_.nodes.empty() && mesh_.nodes.begin()->second.z != node.z)
      reader_.fail(
          fmt::format("a node at z = {}, others at {}; allowed: one plane", node.z, mesh_.nodes.begin()->second.z));
    if (!mesh_.nodes.emplace(tag, node).second) reader_.fail(fmt::format("a second node {}", tag));
  }

  void read_nodes() {
    const int count = integers(1)[0];
    for (int i = 0; i < count; ++i) {
      line();
      std::vector<std::string_view> fields = fields_of(reader_.line(), ' ');
      int tag = 0;
      if (fields.empty() || !parse_number(fields[0], tag)) reader_.fail("found no node; allowed: tag x y z");
      add_node(tag, {fields.begin() + 1, fields.end()});
    }
  }

  void read_node_blocks() {
    const int blocks = integers(4)[0];
    for (int b = 0; b < blocks; ++b) {
      const int count = integers(4)[3];
      std::vector<int> tags;
      for (int i = 0; i < count; ++i) tags.push_back(integers(1)[0]);
      for (const int tag : tags) {
        line();
        add_node(tag, fields_of(reader_.line(), ' '));
      }
    }
  }

  /// Nodes of an element of first order; 0: one that bounds nothing here (a point).
  std::size_t node_count(int type) const {
    switch (type) {
      case 15:
        return 0;
      case 1:
        return 2;
      case 2:
        return 3;
      case 3:
        return 4;
      default:
        reader_.fail(
            fmt::format("an element of type {}; allowed: points (15), lines (1), triangles (2) and quadrangles (3) of "
                        "first order, in two dimensions",
                        type));
    }
  }

  void add_element(int type, const std::vector<int>& numbers, std::size_t first) {
    const std::size_t n = node_count(type);
    if (n == 0) return;
    if (numbers.size() != first + n)
      reader_.fail(fmt::format("found {} numbers; allowed: {}, {} of them nodes", numbers.size(), first + n, n));
    for (std::size_t i = first; i < numbers.size(); ++i)
      if (!mesh_.nodes.contains(numbers[i])) reader_.fail(fmt::format("unknown node {}", numbers[i]));
    if (n == 2) {
      ++mesh_.line_edges[edge_of(numbers[first], numbers[first + 1])];
      return;
    }
    for (std::size_t i = 0; i < n; ++i)
      ++mesh_.surface_edges[edge_of(numbers[first + i], numbers[first + (i + 1) % n])];
  }

  void read_elements() {
    const int count = integers(1)[0];
    for (int i = 0; i < count; ++i) {
      const std::vector<int> numbers = integers(3);
      if (numbers[2] < 0) reader_.fail(fmt::format("found {} tags; allowed: 0 or more", numbers[2]));
      add_element(numbers[1], numbers, 3 + static_cast<std::size_t>(numbers[2]));
    }
  }

  void read_element_blocks() {
    const int blocks = integers(4)[0];
    for (int b = 0; b < blocks; ++b) {
      const std::vector<int> block = integers(4);
      for (int i = 0; i < block[3]; ++i) add_element(block[2], integers(1), 1);
    }
  }

  LineReader reader_;
  bool format_known_ = false, blocks_ = false;
  Mesh mesh_;
};

/// Neighbours of each node along the boundary.
using Neighbours = std::map<int, std::vector<int>>;

Neighbours boundary(const Mesh& mesh) {
  Neighbours neighbours;
  const bool surface = !mesh.surface_edges.empty();
  for (const auto& [edge, elements] : surface ? mesh.surface_edges : mesh.line_edges) {
    if (surface && elements != 1) continue;
    neighbours[edge.first].push_back(edge.second);
    neighbours[edge.second].push_back(edge.first);
  }
  return neighbours;
}

/// One closed loop of tags beginning with `start`; its nodes are taken out of `left`.
std::vector<int> take_loop(const std::string& file, const Mesh& mesh, const Neighbours& all, Neighbours& left,
                           int start) {
  std::vector<int> loop;
  for (int at = start, before = 0; loop.empty() || at != start;) {
    const std::vector<int>& next = all.at(at);
    if (next.size() != 2)
      fail_at_line(file, mesh.nodes.at(at).line,
                   fmt::format("node {}: {} edges of the outline meet there; allowed: 2, a closed outline that does "
                               "not touch itself",
                               at, next.size()));
    loop.push_back(at);
    left.erase(at);
    const int to = next[0] == before && loop.size() > 1 ? next[1] : next[0];
    before = std::exchange(at, to);
  }
  return loop;
}

FilePoints points_of(const Mesh& mesh, const std::vector<int>& loop) {
  FilePoints found;
  for (const int tag : loop) {
    found.points.push_back(mesh.nodes.at(tag).position);
    found.lines.push_back(mesh.nodes.at(tag).line);
  }
  return found;
}

/// A second loop within the first, or the first within it, is a hole.
bool encloses(const Points& outer, const Points& inner) {
  const auto box = [](const Points& points) {
    std::pair<Vec2, Vec2> result{points[0], points[0]};
    for (const Vec2& p : points) result = {result.first.cwiseMin(p), result.second.cwiseMax(p)};
    return result;
  };
  const auto [low, high] = box(outer);
  const auto [inner_low, inner_high] = box(inner);
  return (low.array() <= inner_low.array()).all() && (high.array() >= inner_high.array()).all();
}

}  // namespace

FilePoints read_gmsh_outline(const std::string& file, const std::string& text) {
  const Mesh mesh = GmshReader(file, text).read();
  const Neighbours all = boundary(mesh);
  if (all.empty())
    fail_at_line(file, 1, "no triangles, quadrangles or lines; allowed: a surface or its closed outline");
  Neighbours left = all;
  const FilePoints first = points_of(mesh, take_loop(file, mesh, all, left, all.begin()->first));
  if (left.empty()) return first;
  const FilePoints second = points_of(mesh, take_loop(file, mesh, all, left, left.begin()->first));
  const bool hole = encloses(first.points, second.points) || encloses(second.points, first.points);
  fail_at_line(file, second.lines[0],
               hole ? "the outline has a hole: bodies with holes cannot be used; fill it, or cut the body open"
                    : "a second outline; allowed: one body a file");
}

}  // namespace pliant
