#include "results/scene_files.hpp"

#include <fmt/format.h>

#include "core/errors.hpp"
#include "files/atomic_file.hpp"
#include "scene/line_reader.hpp"
#include "scene/scene.hpp"

namespace pliant {
namespace {

namespace fs = std::filesystem;
/// What the user should name there.
std::string kind_of(const FileCopy& file) {
  return file.what == "outline" ? "an outline (.csv or .msh)" : "a " + file.what;
}

}  // namespace

SceneFiles::SceneFiles(const fs::path& scene_file) {
  const PortableScene scene = portable_scene(read_text_file(scene_file, "a scene file (.toml)"));
  text_ = scene.text;
  starts_from_a_state_ = scene.starts_from_a_state;
  for (const FileCopy& one : scene.files) {
    const fs::path file = scene_file.parent_path() / one.file;
    files_.push_back({file, one, read_text_file(file, kind_of(one))});
  }
}

void SceneFiles::compare(const fs::path& folder) const {
  for (const File& file : files_)
    if (const fs::path copy = folder / file.as.copy;
        fs::exists(copy) && read_text_file(copy, kind_of(file.as)) != file.content)
      throw InputError(fmt::format(
          "{}: not the {} that the earlier run began with, which is {}; a run cannot change its {}", file.path.string(),
          file.as.what, copy.string(), file.as.what == "outline" ? "shapes" : "packings"));
}

std::set<std::string> SceneFiles::names() const {
  std::set<std::string> names{"scene.toml"};
  for (const File& file : files_) names.insert(file.as.copy);
  if (starts_from_a_state_) names.insert(start_copy_name);
  return names;
}

void SceneFiles::write(const fs::path& folder) const {
  write_file_atomically(folder / "scene.toml", text_);
  for (const File& file : files_) write_file_atomically(folder / file.as.copy, file.content);
}

}  // namespace pliant
