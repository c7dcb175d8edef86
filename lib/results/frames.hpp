#pragma once

#include <filesystem>
#include <memory>

#include "dynamics/simulation.hpp"
#include "files/frame_file.hpp"

namespace pliant {

/// frames.h5 and frames.xdmf: grid "bodies" (triangles of all grains) and grid "outlines" (segments of all bodies).
/// Positions are not wrapped into the period.
class FrameRecorder {
 public:
  FrameRecorder(const Model& model, const std::filesystem::path& folder);
  double next_time() const;  ///< infinite without frames
  void record_due(const Simulation& simulation);
  int count() const { return count_; }

 private:
  GridFrame bodies_frame(const Simulation& simulation) const;
  GridFrame outlines_frame(const Simulation& simulation) const;
  bool wants(const char* field) const;

  const Model& model_;
  double period_;
  int count_ = 0;
  std::vector<FieldMesh> rigid_meshes_;  ///< [outline shapes], empty where no rigid grain has it
  std::unique_ptr<FrameFile> file_;
};

}  // namespace pliant
