#include "geometry/gmsh_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <set>
#include <string_view>

#include "scene/line_reader.hpp"

namespace pliant {

namespace {

/// Reads the sections of a gmsh file, https://gmsh.info/doc/texinfo/gmsh.html#MSH-file-format (4.1) and
/// #MSH-file-format-version-2.
class GmshReader {
 public:
  GmshReader(const std::string& file, const std::string& text) : reader_(file, text) {}

  GmshMesh read() {
    while (reader_.next()) {
      const std::string section(reader_.line());
      if (section.empty()) continue;
      if (!section.starts_with('$')) reader_.fail("found text outside of a section; allowed: $MeshFormat first");
      if (section == "$MeshFormat") read_format();
      if (!format_known_) reader_.fail(fmt::format("found {}; allowed: $MeshFormat first", section));
      if (section == "$PhysicalNames") read_group_names();
      if (section == "$Entities" && blocks_) read_entities();
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

  void read_group_names() {
    const int count = integers(1)[0];
    for (int i = 0; i < count; ++i) {
      line();
      const std::vector<std::string_view> fields = fields_of(reader_.line(), ' ');
      int dimension = 0, tag = 0;
      const auto open = reader_.line().find('"'), close = reader_.line().rfind('"');
      if (fields.size() < 3 || !parse_number(fields[0], dimension) || !parse_number(fields[1], tag) || open >= close)
        reader_.fail("found no physical group; allowed: dimension tag \"name\"");
      mesh_.group_names[{dimension, tag}] = reader_.line().substr(open + 1, close - open - 1);
    }
  }

  /// Of format 4.1, whose elements have their groups from their curves and surfaces.
  void read_entities() {
    const std::vector<int> counts = integers(4);
    for (int dimension = 0; dimension < 3; ++dimension)
      for (int i = 0; i < counts[static_cast<std::size_t>(dimension)]; ++i) {
        line();
        const std::vector<std::string_view> fields = fields_of(reader_.line(), ' ');
        const std::size_t at = dimension == 0 ? 4 : 7;  // behind the tag and a point, or a box
        int tag = 0, groups = 0, group = 0;
        if (fields.size() <= at || !parse_number(fields[0], tag) || !parse_number(fields[at], groups) ||
            (groups > 0 && (fields.size() <= at + 1 || !parse_number(fields[at + 1], group))))
          reader_.fail("found no entity; allowed: tag, coordinates, number of physical groups and their tags");
        // Negative: of the opposite direction.
        entity_groups_[{dimension, tag}] = std::abs(std::max(group, -std::numeric_limits<int>::max()));
      }
  }

  void add_node(int tag, const std::vector<std::string_view>& coordinates) {
    GmshMesh::Node node;
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

  void add_element(int type, const std::vector<int>& numbers, std::size_t first, int group) {
    const std::size_t n = node_count(type);
    if (n == 0) return;
    if (numbers.size() != first + n)
      reader_.fail(fmt::format("found {} numbers; allowed: {}, {} of them nodes", numbers.size(), first + n, n));
    GmshMesh::Element element{{numbers.begin() + static_cast<std::ptrdiff_t>(first), numbers.end()}, group};
    for (const int node : element.nodes)
      if (!mesh_.nodes.contains(node)) reader_.fail(fmt::format("unknown node {}", node));
    std::vector<int> sorted = element.nodes;
    std::sort(sorted.begin(), sorted.end());
    if (known_.insert(std::move(sorted)).second) (n == 2 ? mesh_.lines : mesh_.surfaces).push_back(std::move(element));
  }

  void read_elements() {
    const int count = integers(1)[0];
    for (int i = 0; i < count; ++i) {
      const std::vector<int> numbers = integers(3);
      if (numbers[2] < 0) reader_.fail(fmt::format("found {} tags; allowed: 0 or more", numbers[2]));
      const bool grouped = numbers[2] > 0 && numbers.size() > 3;  // the first tag is the physical group
      add_element(numbers[1], numbers, 3 + static_cast<std::size_t>(numbers[2]), grouped ? numbers[3] : 0);
    }
  }

  void read_element_blocks() {
    const int blocks = integers(4)[0];
    for (int b = 0; b < blocks; ++b) {
      const std::vector<int> block = integers(4);
      const auto group = entity_groups_.find({block[0], block[1]});
      const int tag = group == entity_groups_.end() ? 0 : group->second;
      for (int i = 0; i < block[3]; ++i) add_element(block[2], integers(1), 1, tag);
    }
  }

  LineReader reader_;
  bool format_known_ = false, blocks_ = false;
  std::map<std::pair<int, int>, int> entity_groups_;  // by dimension and tag
  std::set<std::vector<int>> known_;                  // elements, by their sorted nodes
  GmshMesh mesh_;
};

}  // namespace

GmshMesh read_gmsh_file(const std::string& file, const std::string& text) { return GmshReader(file, text).read(); }

}  // namespace pliant
