#pragma once

#include <string>
#include <vector>

#include "bodies/outline.hpp"
#include "core/lanes.hpp"
#include "discretisation/table.hpp"
#include "scene/scene.hpp"

namespace pliant {

/// A shape as compliant bodies use it: one table whatever the number of grains.
struct CompliantShape {
  Discretisation space;
  std::vector<double> inverse_unit_mass;  ///< [nodes], 1/m2
  int outline = 0;                        ///< index of its outline shape
  int nodes() const { return static_cast<int>(space.mesh.nodes.size()); }
};

/// Compliant bodies of one shape and one form of law, stored eight bodies a batch, one a lane (DESIGN 4).
struct CompliantGroup {
  int shape = 0;  ///< index of the compliant shape
  MaterialLaw law = MaterialLaw::neo_hookean;
  std::vector<int> bodies;  ///< [bodies], global index of the body in each lane; padding lanes are absent
};

/// Eight bodies of a group. Padding lanes carry a copy of a resting body and weight 0.
struct Batch {
  int group = 0;
  int first = 0;                               ///< index within the group of the body in lane 0
  int count = 0;                               ///< bodies, 1 to 8
  std::size_t offset = 0;                      ///< of node 0, x, in Dofs::compliant
  Lanes mu, lambda, density, inverse_density;  ///< material constants a lane
  Lanes weight;                                ///< 1 for a body, 0 for padding
  Lanes centre_x, centre_y;                    ///< fixed centres: positions are stored relative to them
};

/// One degree of freedom of a rigid body and what moves it.
struct RigidDof {
  Drive::Mode mode = Drive::Mode::free;
  History history;          ///< velocity, force or pressure
  double force_scale = 1;   ///< force = history x force_scale: signed period for a pressure
  double mass = 0;          ///< kg/m, or kg m for the angle
  double inverse_mass = 0;  ///< 0 when the motion is imposed
  bool imposed() const { return mode == Drive::Mode::fixed || mode == Drive::Mode::velocity; }
};

struct RigidBody {
  int body = 0;     ///< global index
  int outline = 0;  ///< index of its outline shape
  double max_radius = 0;
  RigidDof dof[3];      ///< x, y, angle
  bool driven = false;  ///< some degree of freedom is imposed or loaded
};

struct Body {
  std::string name;  ///< "grains 17", or the wall's name
  BodyKind kind = BodyKind::rigid;
  bool wall = false;
  int grains = -1;            ///< index in Scene::grains; -1 for a wall
  int material = 0;           ///< index in Scene::materials
  int batch = -1, lane = -1;  ///< compliant
  int rigid = -1;             ///< rigid: index in Model::rigid_bodies
  int outline = 0;            ///< index of its outline shape
  Vec2 centre{0, 0};          ///< initial centre, m
  double angle = 0;           ///< initial angle, rad
  double scale = 1;           ///< size over that of its shape as the scene gives it
  double area = 0;            ///< m2
  double mass = 0;            ///< kg/m
};

/// Bodies and tables: built once from the scene, immutable.
struct Model {
  Scene scene;
  std::vector<OutlineShape> outlines;
  std::vector<CompliantShape> shapes;
  std::vector<CompliantGroup> groups;
  std::vector<Batch> batches;
  std::vector<RigidBody> rigid_bodies;
  std::vector<Body> bodies;        ///< grains in the scene's order, then walls
  std::size_t compliant_size = 0;  ///< length of Dofs::compliant
  bool corrected_mass = false;     ///< states hold momentum over lumped mass: see mass_correction.hpp
  bool rates = false;              ///< some force depends on velocities: only then are rates formed

  const CompliantShape& shape_of(const Batch& batch) const { return shapes[groups[batch.group].shape]; }
  const CompliantShape& shape_of(const Body& body) const { return shape_of(batches[body.batch]); }
  int dof_count() const;
  int node_count() const;  ///< field nodes of compliant bodies and outline nodes of rigid ones
};

/// Builds bodies, tables and masses. Throws InputError for what the scene reader cannot see (shapes that cannot be meshed).
Model build_model(const Scene& scene);

}  // namespace pliant
