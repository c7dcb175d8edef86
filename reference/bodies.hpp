#pragma once

#include <Eigen/SparseCore>
#include <map>
#include <string>
#include <vector>

#include "geometry/assembly.hpp"
#include "geometry/shape_families.hpp"
#include "reference/contact/contacts.hpp"
#include "reference/discretisation/space.hpp"
#include "scene/scene.hpp"

namespace pliant::reference {

using Vector = Eigen::VectorXd;
using SparseMatrix = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;

/// Mass matrix of compliant bodies (docs/method.md 2).
enum class MassMatrix {
  lumped,     ///< row sums, the engine's default
  scaled,     ///< selective mass scaling: row sums D, with L from outline nodes to their nearest inner nodes
  corrected,  ///< inverse of the engine's 2 D^-1 - D^-1 M D^-1
  consistent
};

/// v turned to the left by a right angle.
inline Vec2 turned_left(const Vec2& v) { return {-v.y(), v.x()}; }

/// Body with its range of the vector of degrees of freedom: absolute positions of the field nodes, or x, y, angle.
struct Body {
  PlacedBody placed;
  int space = -1;         ///< compliant: index in Bodies::spaces
  Points outline;         ///< [outline nodes], relative to the centre, in its own size and at angle 0, m
  double turn_shift = 0;  ///< x offset of a wall's outline after one turn
  int first_dof = 0, dofs = 0;
  int first_outline = 0;         ///< index of its first node in the list of all outline nodes
  double mass = 0, inertia = 0;  ///< kg/m, kg m
  bool compliant() const { return !placed.wall && placed.kind == BodyKind::compliant; }
};

/// All bodies of a scene: their degrees of freedom, masses and outlines.
class Bodies {
 public:
  /// Throws InputError for bodies that cannot be meshed or discretised.
  explicit Bodies(const Scene& scene);

  const Scene& scene() const { return scene_; }
  const std::vector<Body>& all() const { return bodies_; }
  const Space& space_of(const Body& body) const { return spaces_[static_cast<std::size_t>(body.space)]; }
  const Material& material_of(const Body& body) const { return scene_.materials[body.placed.material]; }
  int dofs() const { return dofs_; }
  int outline_nodes() const { return outline_nodes_; }
  double finest_spacing() const { return finest_spacing_; }  ///< mean segment of the finest outline, m

  Vector initial_positions() const;
  Vector initial_velocities() const;
  SparseMatrix mass(MassMatrix kind) const;  ///< [dofs x dofs]
  Vector lumped_mass() const;                ///< [dofs]
  Vector arms() const;  ///< [dofs], largest displacement of an outline per unit: 1, for angles in m

  Points outline_positions(const Vector& q) const;  ///< [outline nodes], m
  SparseMatrix outline_jacobian(
      const Vector& q) const;  ///< [2 outline nodes x dofs]: velocities of the outline by those of the bodies
  /// Adds the contribution of rotating rigid outlines to the tangent of constant outline forces: `residual` [2 outline
  /// nodes], N/m.
  void add_turning(const Vector& q, const Vector& residual, Triplets& tangent) const;
  std::vector<ContactOutline> contact_outlines() const;

 private:
  void add_compliant(Body body, std::map<std::string, int>& known);
  void add_rigid(Body body);
  void add_wall(Body body);
  void place(Body body, int dofs);

  Scene scene_;
  std::map<std::string, SharedTopologyMesh> meshes_;  ///< of shapes without their own
  std::vector<Space> spaces_;
  std::vector<Body> bodies_;
  int dofs_ = 0, outline_nodes_ = 0;
  double finest_spacing_ = 1e300;
};

/// Sum of a row's values times the vectors of its nodes; `first`: index of those of node 0 in `values`.
Vec2 interpolated(const Row& row, const Vector& values, int first);

/// Mean segment length of an outline, m.
double mean_spacing(const Points& outline, double turn_shift);

}  // namespace pliant::reference
