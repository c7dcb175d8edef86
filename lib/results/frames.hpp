#pragma once

#include <filesystem>
#include <memory>

#include "files/frame_file.hpp"
#include "results/frame_fields.hpp"

namespace pliant {

/// frames.h5 and frames.xdmf: grid "bodies" (triangles of all grains) and grid "outlines" (segments of all bodies),
/// with the fields that the scene asks for and no others, and the table "contacts" if it does. Positions are not
/// wrapped into the period.
class FrameRecorder {
 public:
  FrameRecorder(const Model& model, const std::filesystem::path& folder, Opening opening = Opening::create);
  double next_time() const;                 ///< infinite without frames
  bool record_due(Simulation& simulation);  ///< whether a frame was due
  /// One of now, unless the last one is.
  void record_last(Simulation& simulation);
  int count() const { return count_; }
  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("count", count_);
    if (file_) visitor("file", *file_);
  }

 private:
  void record(Simulation& simulation);

  template <class Function>
  struct Wanted {
    FrameField field;
    Function function;
  };

  void choose_fields();
  const FieldMesh& mesh_of(const Body& body) const;
  int segments_of(const Body& body) const;
  Grid bodies_grid() const;
  Grid outlines_grid() const;
  Parts<GridTopology> bodies_topology() const;
  Parts<GridTopology> outlines_topology() const;
  Parts<GridFrame> bodies_frame(const Snapshot& snapshot) const;
  Parts<GridFrame> outlines_frame(const Snapshot& snapshot) const;

  const Model& model_;
  double period_;
  int count_ = 0;
  std::vector<FieldMesh> rigid_meshes_;  ///< [outline shapes], empty where no rigid grain has it
  std::vector<Wanted<ConstantField>> constant_fields_;
  std::vector<Wanted<BodyField>> body_fields_;
  std::vector<Wanted<OutlineFunction>> outline_fields_;
  std::unique_ptr<FrameFile> file_;
};

}  // namespace pliant
