#pragma once

#include <string>
#include <vector>

#include "bodies/layouts.hpp"
#include "bodies/outline_conditions.hpp"
#include "bodies/outline_fields.hpp"
#include "core/lanes.hpp"
#include "discretisation/table.hpp"
#include "geometry/assembly.hpp"
#include "geometry/shape_families.hpp"
#include "materials/with_law.hpp"
#include "scene/scene.hpp"

namespace pliant {

/// Shape of compliant bodies: one table for any number of grains.
struct CompliantShape {
  Discretisation space;
  std::vector<double> inverse_mass_at_unit_density;  ///< [nodes], 1/m2
  int outline = 0;                                   ///< index of its outline shape
  int family = -1;  ///< number of a family of shapes that share a mesh topology; -1: none
  int nodes() const { return static_cast<int>(space.mesh.nodes.size()); }
};

/// Compliant bodies of one shape, or of one family of shapes of one topology, with one form of law. They are stored
/// eight per batch, one per lane (docs/design.md 4).
struct CompliantGroup {
  int shape = 0;  ///< index of the compliant shape, or of the first of its family
  MaterialLaw law = MaterialLaw::neo_hookean;
  std::vector<int> bodies;  ///< [bodies], global index of the body in each lane; padding lanes are absent
};

/// Eight bodies of a group, or one body vectorised over its nodes. Padding lanes hold a copy of a resting body with
/// weight 0. Degrees of freedom are stored in units of each body's scale s: positions q/s, velocities, and forces f/s.
/// Thus F, stresses and nodal distances are those of the shape itself, and only constants differ: m/s^2 and f/s give
/// q/s, and energies are those of s = 1 times s^2.
struct Batch {
  int group = 0;
  int first = 0;           ///< index within the group of the body in lane 0
  int count = 0;           ///< bodies, 1 to 8; 1 when nodewise
  std::size_t offset = 0;  ///< index of slot 0, x, in Dofs::compliant
  int slots = 0;           ///< [slots x 2] entries there
  Layout layout = Layout::shared;
  int shape = 0;  ///< index of the compliant shape; for one topology that of lane 0
  /// nodewise, same_topology: index in Model::nodewise_shapes or same_topology_shapes
  int tables = -1;
  int first_region = 0, regions = 1;  ///< in Model::regions
  LawConstants constants;             ///< of the group's law, by lanes
  Lanes mu, lambda;                   ///< instantaneous Lame constants of small strain, Pa
  std::size_t memory = 0;             ///< first entry in Memory::material, [variables x points]
  int points = 0;                     ///< integration points; for a nodewise body rounded up to whole lanes
  Lanes density, inverse_density;     ///< density x s^2: with masses at unit density it gives the mass for f/s and q/s
  Lanes scale, inverse_scale;         ///< s; all 1 unless `scaled`
  bool scaled = false;
  Lanes weight;                               ///< s^2 for a body, 0 for padding
  Lanes centre_x, centre_y;                   ///< fixed centres, m: positions are stored relative to them
  Lanes viscosity{}, mass_damping{};          ///< of Material
  bool viscous = false, mass_damped = false;  ///< nonzero in some lane
};

/// One degree of freedom of a rigid body and its condition.
struct RigidDof {
  AxisCondition::Mode mode = AxisCondition::Mode::free;
  History history;          ///< velocity, force or pressure
  double force_scale = 1;   ///< force = history x force_scale: signed period for a pressure
  double damping = 0;       ///< of the dashpot beside the load, N s/m2 (N s)
  double mass_damping = 0;  ///< of the material, 1/s
  Window window;            ///< interval in which the mode applies; free outside
  double mass = 0;          ///< kg/m, or kg m for the angle
  double inverse_mass = 0;  ///< 0 if the motion is imposed at all times
  bool imposed() const {
    return mode == AxisCondition::Mode::fixed || mode == AxisCondition::Mode::velocity;
  }  ///< at some time
  bool imposed(double time) const { return imposed() && window.contains(time); }

  // Motion in a step that begins at `time`: the imposed motion, with the exact integral of its history, or else the
  // free motion that the caller gives.
  double position_after(double time, double dt, double x, double free) const {
    if (!imposed(time)) return free;
    return mode == AxisCondition::Mode::velocity ? x + history.integral(time, time + dt) : x;
  }
  double velocity_after(double time, double end, double free) const {
    return imposed(time) ? imposed_velocity(end) : free;
  }
  double acceleration_of(double time, double force) const {
    if (!imposed(time)) return inverse_mass * force;
    return mode == AxisCondition::Mode::velocity ? history.slope(time) : 0;
  }
  /// Acceleration per unit force: 0 while the motion is imposed.
  double inverse_mass_at(double time) const { return imposed(time) ? 0 : inverse_mass; }
  double imposed_velocity(double time) const { return mode == AxisCondition::Mode::velocity ? history.at(time) : 0; }
};

struct RigidBody {
  int body = 0;     ///< global index
  int outline = 0;  ///< index of its outline shape
  double max_radius = 0;
  RigidDof dof[3];      ///< x, y, angle
  bool driven = false;  ///< whether some degree of freedom is imposed or loaded
};

struct Body : PlacedBody {
  int compliant_shape = -1;   ///< compliant: index in Model::shapes
  int batch = -1, lane = -1;  ///< compliant; a nodewise body has lane 0
  int rigid = -1;             ///< rigid: index in Model::rigid_bodies
  int outline = 0;            ///< index of its outline shape
  double area = 0;            ///< m2
  double mass = 0;            ///< kg/m
};

/// Bodies that a process advances, by their numbers in Model, ascending.
struct OwnBodies {
  std::vector<int> batches;  ///< those of several bodies first
  int lane_batches = 0;      ///< number of batches of several bodies
  std::vector<int> regions, rigid_bodies, bodies;
};

class Halo;

/// Bodies and tables: built once from the scene, then immutable.
struct Model {
  Scene scene;
  std::vector<OutlineShape> outlines;
  std::vector<CompliantShape> shapes;
  std::vector<CompliantGroup> groups;
  std::vector<Batch> batches;  ///< batches of several bodies first, then nodewise ones
  int lane_batches = 0;        ///< batches of several bodies, [0, lane_batches); each is the region of the same number
  std::vector<Region> regions;
  std::vector<SameTopologyShapes> same_topology_shapes;  ///< [batches of one topology]
  std::vector<NodewiseShape> nodewise_shapes;
  std::vector<Chunk> point_chunks, outline_chunks;  ///< of all nodewise bodies
  std::vector<RigidBody> rigid_bodies;
  std::vector<int> driven;          ///< indices of the driven rigid bodies
  std::vector<Body> bodies;         ///< grains in the scene's order, then walls
  std::vector<int> outline_offset;  ///< [bodies + 1], first node of each body in an OutlineField
  std::size_t compliant_size = 0;   ///< length of Dofs::compliant
  std::size_t material_memory = 0;  ///< length of Memory::material: 0 without internal variables
  /// mass is corrected or scaled: states hold momentum over lumped mass (reciprocal_mass.hpp)
  bool has_reciprocal_mass = false;
  /// some force except mass damping (damping_forces.hpp) depends on velocities: else no rates are formed
  bool rates = false;
  bool outline_rates = false;  ///< likewise, on velocities of outline nodes
  std::vector<OutlinePressure> pressures;
  std::vector<OutlineSupport> supports;
  std::vector<double> switch_times;  ///< ascending, s: points of histories, and ends of windows; steps end there

  OwnBodies own;         ///< all, unless there is a halo
  Halo* halo = nullptr;  ///< communication with processes that advance other bodies (contact/halo.hpp); null: none

  const OutlineShape& outline_of(int body) const { return outlines[bodies[body].outline]; }
  int outline_end(int body) const { return outline_offset[body] + outline_of(body).count; }  ///< without cyclic copies
  const CompliantShape& shape_of(const Batch& batch) const { return shapes[batch.shape]; }
  const CompliantShape& shape_of(const Body& body) const { return shapes[body.compliant_shape]; }
  const NodewiseShape& nodewise_shape_of(const Batch& batch) const { return nodewise_shapes[batch.tables]; }
  int dof_count() const;
  int node_count() const;  ///< field nodes of compliant bodies and outline nodes of rigid ones
};

}  // namespace pliant
