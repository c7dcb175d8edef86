#pragma once

#include <memory>
#include <optional>

#include "geometry/mesh.hpp"

namespace pliant {

/// Mesh of a disc that is mapped to other smooth shapes with as many outline nodes: the triangles are the same, so that
/// tables of these shapes share their connectivity. The interior first follows its outline by the discrete harmonic map
/// (weights of Pinkall and Polthier 1993, positive for a Delaunay mesh). This keeps triangles from overlapping where
/// the outline is convex or nearly so. The mesh is then smoothed: triangles keep the template's angles and areas as
/// well as they can together.
class MeshTemplate {
 public:
  MeshTemplate(int nodes, int outline_nodes);
  ~MeshTemplate();
  MeshTemplate(MeshTemplate&&) noexcept;

  /// The mesh with another outline, [outline nodes]; none if some triangle's angle falls below 20 degrees.
  std::optional<FieldMesh> mapped(const Points& outline) const;

 private:
  void smooth(FieldMesh& mesh) const;

  struct Laplacian;
  FieldMesh mesh_;
  std::unique_ptr<Laplacian> laplacian_;
};

/// Least angle of all triangles, rad; negative if one is inverted.
double least_angle(const FieldMesh& mesh);

}  // namespace pliant
