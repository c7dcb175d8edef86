#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "files/frame_file.hpp"
#include "reference/outputs/view.hpp"

namespace pliant::reference {

/// Writes frames.h5 on the engine's grids, with the fields that this solver has.
class FrameOutput {
 public:
  FrameOutput(const Bodies& bodies, const std::filesystem::path& folder);

  double next_time() const;
  void record_due(const View& view);
  const std::vector<std::string>& left_out() const { return left_out_; }

 private:
  struct NewGrid;
  NewGrid bodies_grid() const;
  NewGrid outlines_grid() const;
  const FieldMesh& mesh_of(std::size_t body) const;

  const Bodies& bodies_;
  double period_;
  long count_ = 0;
  std::vector<FieldMesh> meshes_;  ///< [bodies] of rigid bodies; else empty
  std::vector<std::string> body_fields_, outline_fields_, left_out_;
  std::unique_ptr<FrameFile> file_;
};

}  // namespace pliant::reference
