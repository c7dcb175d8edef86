#pragma once

#include <string>
#include <vector>

namespace pliant {

/// A file that a scene names, and what its copy beside the scene file is called.
struct FileCopy {
  std::string what;  ///< "outline" or "table of grains"
  std::string file;  ///< as the scene names it, from the folder of the scene file
  std::string copy;  ///< "outline_SHAPE.csv" or ".msh", "packing_GRAINS.csv": names that no two share
};

/// A scene file that finds beside it what it names, and the state that it starts from, wherever it is put.
struct PortableScene {
  std::string text;  ///< as it was, but for the names of these files
  std::vector<FileCopy> files;
  bool starts_from_a_state = false;  ///< whose copy is called start.bin
};

/// What [start] from may name.
inline constexpr const char* start_allowed =
    "the output folder of a run that has come to its end, from the folder of this file, or its final.bin";

/// Where a key stands in the text of a valid scene file, as "12:8" of line and column; the key as scene_difference
/// names it, "grains 1.seed". Of one that is not there its table's; empty where that is not either.
std::string place_of_key(const std::string& text, const std::string& key);

/// Of the text of a valid scene file. A portable text stays as it is.
PortableScene portable_scene(const std::string& text);

}  // namespace pliant
