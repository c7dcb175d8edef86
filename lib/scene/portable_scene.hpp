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

/// Of the text of a valid scene file. A portable text stays as it is.
PortableScene portable_scene(const std::string& text);

}  // namespace pliant
