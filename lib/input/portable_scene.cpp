#include "input/portable_scene.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "input/old_keys.hpp"
#include "scene/names.hpp"
#include "scene/scene.hpp"

namespace pliant {
namespace {

/// Index of a position in a text; columns count characters, which may have several bytes in UTF-8.
std::size_t index_of(const std::string& text, const toml::source_position& position) {
  std::size_t at = 0;
  for (toml::source_index line = 1; line < position.line; ++line) at = text.find('\n', at) + 1;
  const auto continues = [&](std::size_t i) { return i < text.size() && (text[i] & 0xc0) == 0x80; };
  for (toml::source_index column = 1; column < position.column; ++column) {
    ++at;
    while (continues(at)) ++at;
  }
  return at;
}

/// Length of the TOML string that begins there, with its quotes.
std::size_t quoted_length(const std::string& text, std::size_t begin) {
  const char quote = text[begin];
  const std::string triple(3, quote), mark = text.compare(begin, 3, triple) == 0 ? triple : std::string(1, quote);
  std::size_t at = begin + mark.size();
  while (text.compare(at, mark.size(), mark) != 0) at += quote == '"' && text[at] == '\\' ? 2 : 1;
  return at + mark.size() - begin;
}

/// Collects what a scene names.
class FileNames {
 public:
  explicit FileNames(const std::string& text) : text_(text) {}

  /// The file of a table that has one: `name` is its copy's, without the ending.
  void look_at(const toml::node* node, const char* what, const std::string& name) {
    const toml::table* table = node ? node->as_table() : nullptr;
    const toml::node* file = table ? table->get("file") : nullptr;
    if (!file || !file->is_string()) return;
    const std::string original = file->as_string()->get();
    const bool gmsh = std::filesystem::path(original).extension() == ".msh";
    files_.push_back({what, original, fmt::format("{}.{}", name, gmsh ? "msh" : "csv")});
    copies_[index_of(text_, file->source().begin)] = files_.back().copy;
  }

  /// That the run starts from.
  void look_at_state(const toml::node& from) {
    starts_from_a_state_ = true;
    copies_[index_of(text_, from.source().begin)] = start_copy_name;
  }

  PortableScene result() const {
    PortableScene scene{text_, files_, starts_from_a_state_};
    for (auto copy = copies_.rbegin(); copy != copies_.rend(); ++copy)
      scene.text.replace(copy->first, quoted_length(text_, copy->first), fmt::format("\"{}\"", copy->second));
    return scene;
  }

 private:
  const std::string& text_;
  std::vector<FileCopy> files_;
  std::map<std::size_t, std::string> copies_;  // by the place of the file's name
  bool starts_from_a_state_ = false;
};

}  // namespace

std::string place_of_key(const std::string& text, const std::string& key) {
  toml::table scene = toml::parse(text);
  rename_old_keys(scene, "the scene");
  const toml::node* at = &scene;
  std::string place;
  for (std::size_t begin = 0; begin < key.size();) {
    const std::size_t end = std::min(key.find('.', begin), key.size());
    const std::string part = key.substr(begin, end - begin);
    const std::size_t blank = part.find(' ');
    const toml::table* table = at->as_table();
    at = table ? table->get(part.substr(0, blank)) : nullptr;
    if (at && blank != part.npos)
      at = at->is_array() ? at->as_array()->get(std::stoul(part.substr(blank)) - 1) : nullptr;
    if (!at) break;
    if (at->source().begin) place = fmt::format("{}:{}", at->source().begin.line, at->source().begin.column);
    begin = end + 1;
  }
  return place;
}

PortableScene portable_scene(const std::string& text) {
  FileNames names(text);
  const toml::table scene = toml::parse(text);
  if (const toml::table* shapes = scene["shapes"].as_table())
    for (const auto& [shape, node] : *shapes) names.look_at(&node, "outline", fmt::format("outline_{}", shape.str()));
  if (const toml::array* all = scene["grains"].as_array())
    for (std::size_t i = 0; i < all->size(); ++i) {
      const toml::table* grains = all->get(i)->as_table();
      if (!grains) continue;
      const std::string name = (*grains)["name"].value_or(default_grains_name(i + 1));
      names.look_at(grains->get("packing"), "table of grains", "packing_" + name);
    }
  if (const toml::node* from = scene["start"]["from"].node()) names.look_at_state(*from);
  return names.result();
}

}  // namespace pliant
