#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "files/frame_file.hpp"

namespace pliant {

/// The light data beside a frame file: one temporal collection a grid, as ParaView's XDMF readers take it. All heavy
/// data are whole datasets `heavy:/path`, so that readers of version 2 and 3 both find them.
class XdmfDocument {
 public:
  /// `heavy` is the name of the HDF5 file, relative to the XDMF file.
  XdmfDocument(const std::filesystem::path& heavy, const std::vector<Grid>& grids);
  /// Adds frame `index` of all grids.
  void add(int index, double time, const std::vector<Grid>& grids);
  std::string text() const;
  /// [grids] what it says of the frames so far.
  std::vector<std::string>& frames() { return frames_; }

 private:
  std::string attribute(const Field& field, const std::string& folder, const Grid& grid) const;
  std::string item(const std::string& path, const char* type, int rows, int columns) const;

  std::string heavy_;
  std::vector<std::string> names_;
  std::vector<std::string> constants_;  ///< what every frame of a grid repeats: topology and constant fields
  std::vector<std::string> frames_;     ///< the frames of a grid so far
};

/// Components of a field as stored: ParaView knows vectors of three components only.
int stored_components(const Field& field);

/// Group of one frame: "/bodies/000012".
std::string frame_group(const std::string& grid, int index);

}  // namespace pliant
