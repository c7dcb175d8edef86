#pragma once

#include <string>
#include <vector>

namespace pliant {

/// An outline file that a scene names, and what its copy beside the scene file is called.
struct OutlineCopy {
  std::string file;  ///< as the scene names it, from the folder of the scene file
  std::string copy;  ///< "outline_SHAPE.csv" or ".msh": file names that no two shapes share
};

/// A scene file that finds its outlines beside it, wherever it is put.
struct PortableScene {
  std::string text;  ///< as it was, but for the names of outline files
  std::vector<OutlineCopy> outlines;
};

/// Of the text of a valid scene file. A portable text stays as it is.
PortableScene portable_scene(const std::string& text);

}  // namespace pliant
