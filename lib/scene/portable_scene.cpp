#include "scene/portable_scene.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <filesystem>
#include <map>

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

}  // namespace

PortableScene portable_scene(const std::string& text) {
  PortableScene result{text, {}};
  const toml::table scene = toml::parse(text);
  std::map<std::size_t, std::string> names;  // by the place of the file's name
  if (const toml::table* shapes = scene["shapes"].as_table())
    for (const auto& [shape, node] : *shapes) {
      const toml::table* table = node.as_table();
      const toml::node* file = table ? table->get("file") : nullptr;
      if (!file || !file->is_string()) continue;
      const std::string name = file->as_string()->get();
      const bool gmsh = std::filesystem::path(name).extension() == ".msh";
      result.outlines.push_back({name, fmt::format("outline_{}.{}", shape.str(), gmsh ? "msh" : "csv")});
      names[index_of(text, file->source().begin)] = result.outlines.back().copy;
    }
  for (auto name = names.rbegin(); name != names.rend(); ++name)
    result.text.replace(name->first, quoted_length(text, name->first), fmt::format("\"{}\"", name->second));
  return result;
}

}  // namespace pliant
