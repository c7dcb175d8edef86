#include "results/scene_files.hpp"

#include <fmt/format.h>

#include "core/errors.hpp"
#include "files/atomic_file.hpp"
#include "scene/portable_scene.hpp"
#include "scene/text_file.hpp"

namespace pliant {
namespace {

namespace fs = std::filesystem;
constexpr const char* an_outline = "an outline (.csv or .msh)";

}  // namespace

SceneFiles::SceneFiles(const fs::path& scene_file) {
  const PortableScene scene = portable_scene(read_text_file(scene_file, "a scene file (.toml)"));
  text_ = scene.text;
  for (const OutlineCopy& outline : scene.outlines) {
    const fs::path file = scene_file.parent_path() / outline.file;
    outlines_.push_back({file, outline.copy, read_text_file(file, an_outline)});
  }
}

void SceneFiles::compare(const fs::path& folder) const {
  for (const Outline& outline : outlines_)
    if (const fs::path copy = folder / outline.copy;
        fs::exists(copy) && read_text_file(copy, an_outline) != outline.content)
      throw InputError(
          fmt::format("{}: not the outline that the checkpoint's run began with, which is {}; a run cannot change "
                      "its shapes",
                      outline.file.string(), copy.string()));
}

std::set<std::string> SceneFiles::names() const {
  std::set<std::string> names{"scene.toml"};
  for (const Outline& outline : outlines_) names.insert(outline.copy);
  return names;
}

void SceneFiles::write(const fs::path& folder) const {
  write_file_atomically(folder / "scene.toml", text_);
  for (const Outline& outline : outlines_) write_file_atomically(folder / outline.copy, outline.content);
}

}  // namespace pliant
