#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "input/portable_scene.hpp"

namespace pliant {

/// What a run was asked, to be kept beside its results: the scene file, made independent of its place, and the outlines
/// and tables of grains that it names; the state that it starts from is kept by the run. Held in memory, as the folder
/// that the run empties may hold the originals.
class SceneFiles {
 public:
  /// Reads a scene file, known to be valid, and what it names. Throws InputError for what cannot be read.
  explicit SceneFiles(const std::filesystem::path& scene_file);
  const std::string& text() const { return text_; }
  /// Throws InputError when a copy in the folder is not the same as the file that the scene names now.
  void compare(const std::filesystem::path& folder) const;
  /// Names of the files that write makes.
  std::set<std::string> names() const;
  /// scene.toml and the other files beside it.
  void write(const std::filesystem::path& folder) const;

 private:
  struct File {
    std::filesystem::path path;
    FileCopy as;
    std::string content;
  };

  std::string text_;
  std::vector<File> files_;
  bool starts_from_a_state_;
};

}  // namespace pliant
