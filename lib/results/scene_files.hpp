#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace pliant {

/// What a run was asked, to be kept beside its results: the scene file, made independent of its place, and the outlines
/// that it names. Held in memory, as the folder that the run empties may hold the originals.
class SceneFiles {
 public:
  /// Reads a scene file, known to be valid, and its outlines. Throws InputError for what cannot be read.
  explicit SceneFiles(const std::filesystem::path& scene_file);
  const std::string& text() const { return text_; }
  /// Throws InputError when a copy in the folder holds another outline than the file that the scene names now.
  void compare(const std::filesystem::path& folder) const;
  /// Names of the files that write makes.
  std::set<std::string> names() const;
  /// scene.toml and the outlines beside it.
  void write(const std::filesystem::path& folder) const;

 private:
  struct Outline {
    std::filesystem::path file;
    std::string copy, content;
  };

  std::string text_;
  std::vector<Outline> outlines_;
};

}  // namespace pliant
