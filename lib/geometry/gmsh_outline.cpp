#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "core/errors.hpp"
#include "geometry/mesh_parts.hpp"
#include "geometry/outline_file.hpp"
#include "geometry/polygon_rules.hpp"
#include "scene/line_reader.hpp"
#include "scene/names.hpp"

namespace pliant {

namespace {

constexpr const char* how_to_merge = "merge them (in gmsh: Coherence, or Mesh > Remove duplicate nodes)";

/// Neighbours of each node along the boundary.
using Neighbours = std::map<int, std::vector<int>>;

class GmshOutlines {
 public:
  GmshOutlines(const std::string& file, const std::string& text) : file_(file), mesh_(read_gmsh_file(file, text)) {
    if (mesh_.surfaces.empty() && mesh_.lines.empty())
      fail_at_line(file_, 1, "no triangles, quadrangles or lines; allowed: a surface or its closed outline");
  }

  /// All as one body: nodes at one place are one.
  FilePoints merged() const {
    const MeshPart whole = whole_mesh(mesh_);
    return outline_of(whole, coinciding_nodes(mesh_, nodes_of(whole)));
  }

  std::vector<FilePoints> chosen(const std::string& choice) {
    const std::vector<MeshPart> parts = parts_of(mesh_);
    several_ = parts.size() > 1;
    if (choice.empty() && parts.size() > 1) fail_of_several(parts);
    std::vector<FilePoints> outlines;
    for (const MeshPart& part : parts)
      if (choice.empty() || choice == "all" || choice == part.name || choice == part.group)
        outlines.push_back(outline_of(part, {}));
    if (outlines.empty()) {
      std::vector<std::string> names{"all", "merged"};
      for (const MeshPart& part : parts) {
        const bool numbered = !part.group.empty() && part.name != part.group;
        if (numbered && std::find(names.begin(), names.end(), part.group) == names.end()) names.push_back(part.group);
        names.push_back(part.name);
      }
      throw PartsError(fmt::format("{}: no part \"{}\"; {}", file_, choice, allowed_names(choice, names)));
    }
    if (mesh_.surfaces.empty() && choice == "all") refuse_nested(outlines);
    return outlines;
  }

 private:
  Neighbours boundary(const MeshPart& part, const NodeNames& names) const {
    Neighbours neighbours;
    for (const auto& [edge, elements] : edges_of(part, names)) {
      if (elements != 1) continue;  // within, or lines of an inner border that are twice
      neighbours[edge.first].push_back(edge.second);
      neighbours[edge.second].push_back(edge.first);
    }
    return neighbours;
  }

  /// Two nodes at one place, of one part: its elements meet there, and are not joined.
  void refuse_coinciding(const MeshPart& part, const Neighbours& all) const {
    std::vector<int> tags;
    for (const auto& [tag, next] : all) tags.push_back(tag);
    const NodeNames names = coinciding_nodes(mesh_, tags);
    if (names.empty()) return;
    const auto& [second, first] = *names.begin();
    fail_at_line(file_, mesh_.nodes.at(second).line,
                 fmt::format("{} on the outline{} at the place of another one, the first, {}, at that of {}, ({:.6g}, "
                             "{:.6g}): the mesh is cut open there; {}, or take parts = \"merged\"",
                             names.size() == 1 ? "a node lies" : fmt::format("{} nodes lie", names.size()),
                             name_of(part), second, first, position(second).x(), position(second).y(), how_to_merge));
  }

  /// One closed loop of tags beginning with `start`; its nodes are taken out of `left`.
  FilePoints take_loop(const Neighbours& all, Neighbours& left, int start) const {
    FilePoints loop;
    for (int at = start, before = 0; loop.points.empty() || at != start;) {
      const std::vector<int>& next = all.at(at);
      if (next.size() != 2)
        fail_at_line(file_, mesh_.nodes.at(at).line,
                     fmt::format("node {}: {} edges of the outline meet there; allowed: 2, a closed outline that does "
                                 "not touch itself",
                                 at, next.size()));
      loop.points.push_back(position(at));
      loop.lines.push_back(mesh_.nodes.at(at).line);
      left.erase(at);
      const int to = next[0] == before && loop.points.size() > 1 ? next[1] : next[0];
      before = std::exchange(at, to);
    }
    return loop;
  }

  /// The one outline of a part: with a second one it has a hole, or does not hang together.
  FilePoints outline_of(const MeshPart& part, const NodeNames& names) const {
    const Neighbours all = boundary(part, names);
    if (all.empty())
      fail_at_line(file_, 1,
                   "elements that lie on each other and bound nothing; allowed: a surface or its closed outline");
    if (names.empty()) refuse_coinciding(part, all);
    Neighbours left = all;
    FilePoints first = take_loop(all, left, all.begin()->first);
    if (left.empty()) return first;
    const FilePoints second = take_loop(all, left, left.begin()->first);
    if (is_nested(first.points, second.points)) fail_of_hole(second, name_of(part));
    fail_at_line(
        file_, second.lines[0],
        "a second outline, of elements that share no border with the others; allowed: parts of one body, which "
        "share their nodes along borders");
  }

  static bool is_nested(const Points& a, const Points& b) { return is_inside(a, b[0]) || is_inside(b, a[0]); }

  [[noreturn]] void fail_of_hole(const FilePoints& inner, const std::string& name) const {
    fail_at_line(
        file_, inner.lines[0],
        fmt::format("the outline{} has a hole: bodies with holes cannot be used; fill it, or cut the body open", name));
  }

  void refuse_nested(const std::vector<FilePoints>& outlines) const {
    for (std::size_t i = 0; i < outlines.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (is_nested(outlines[j].points, outlines[i].points)) fail_of_hole(outlines[i], "");
  }

  bool is_closed(const MeshPart& part) const {
    const Neighbours all = boundary(part, {});
    return std::all_of(all.begin(), all.end(), [](const auto& entry) { return entry.second.size() == 2; });
  }

  /// Where parts touch each other, and what to do if they are one body.
  std::string told_of_borders(const std::vector<MeshPart>& parts) const {
    std::map<int, int> members;  // parts of each node
    std::vector<int> tags;
    for (const MeshPart& part : parts)
      for (const int tag : nodes_of(part)) ++members[tag];
    for (const auto& [tag, count] : members) tags.push_back(tag);
    const NodeNames twice = coinciding_nodes(mesh_, tags);
    std::set<int> doubled;
    for (const auto& [tag, other] : twice) ++members[other], doubled.insert(other);
    std::erase_if(members, [](const auto& entry) { return entry.second == 1; });
    if (members.empty()) return {};
    const Vec2& first = position(members.begin()->first);
    return fmt::format(
        "; they meet at {} node{}{}, the first at ({:.6g}, {:.6g}): if they are one body, {}take parts = "
        "\"merged\"",
        members.size(), members.size() == 1 ? "" : "s",
        doubled.empty() ? "" : fmt::format(", {} of which the mesh has twice", doubled.size()), first.x(), first.y(),
        doubled.empty() ? "" : fmt::format("{}, or ", how_to_merge));
  }

  [[noreturn]] void fail_of_several(const std::vector<MeshPart>& parts) const {
    constexpr std::size_t most_shown = 8;
    if (mesh_.surfaces.empty() && std::all_of(parts.begin(), parts.end(), [&](auto& one) { return is_closed(one); })) {
      std::vector<FilePoints> outlines;
      for (const MeshPart& part : parts) outlines.push_back(outline_of(part, {}));
      refuse_nested(outlines);
    }
    std::vector<std::string> names;
    for (const MeshPart& part : parts)
      if (names.size() < most_shown) names.push_back(fmt::format("\"{}\"", part.name));
    if (names.size() < parts.size()) names.emplace_back("...");
    fail_at_line(file_, mesh_.nodes.at(parts[1].elements[0]->nodes[0]).line,
                 fmt::format("{} parts, {}; allowed: one, chosen by its name, as in parts = {}, or each a shape of its "
                             "own, parts = \"all\"{}",
                             parts.size(), fmt::join(names, ", "), names[0], told_of_borders(parts)));
  }

  const Vec2& position(int tag) const { return mesh_.nodes.at(tag).position; }

  /// Of a part, in messages.
  std::string name_of(const MeshPart& part) const {
    return several_ ? fmt::format(" of part \"{}\"", part.name) : std::string();
  }

  const std::string& file_;
  GmshMesh mesh_;
  bool several_ = false;
};

}  // namespace

std::vector<FilePoints> read_gmsh_outlines(const std::string& file, const std::string& text, const std::string& parts) {
  GmshOutlines outlines(file, text);
  if (parts == "merged") return {outlines.merged()};
  return outlines.chosen(parts);
}

}  // namespace pliant
