#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/simulation.hpp"
#include "scene/scene.hpp"

/// Small scenes in motion, and what tests read from a simulation. Units of compliant bodies: mu = R = rho = 1, lambda
/// = 4.
namespace pliant::dynamics_tests {

inline History constant(double value) { return {{0}, {value}}; }

inline Material elastic(const std::string& name = "soft") {
  return {name, MaterialLaw::neo_hookean, 1.0, 2.8, 0.4};  // E = 2 mu (1 + nu)
}

inline Material rigid_material(double density = 1, const std::string& name = "hard") {
  return {name, MaterialLaw::rigid, density, 0, 0};
}

inline ShapeSpec disc_shape(const std::string& name, double diameter, int nodes) {
  ShapeSpec shape;
  shape.name = name;
  shape.diameter = diameter;
  shape.nodes = nodes;
  return shape;
}

/// For rigid bodies: a disc of so many sides.
inline ShapeSpec many_sided_disc(const std::string& name, double diameter, int sides) {
  ShapeSpec shape = disc_shape(name, diameter, 7);
  shape.outline_nodes = sides;
  return shape;
}

/// Rectangle about the origin.
inline ShapeSpec box_shape(const std::string& name, double width, double height, double spacing) {
  ShapeSpec shape;
  shape.name = name;
  shape.kind = ShapeKind::polygon;
  const double x = width / 2, y = height / 2;
  shape.points = {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
  shape.spacing = spacing;
  return shape;
}

inline Grains grains(const std::string& name, const std::string& shape, BodyKind kind, const Points& centres,
                     const InitialVelocity& velocity = {}) {
  Grains result;
  result.name = name;
  result.shape = shape;
  result.packing.positions = centres;
  result.mix = {{kind, kind == BodyKind::compliant ? "soft" : "hard", 1}};
  result.velocity = velocity;
  return result;
}

inline InitialVelocity moving(const Vec2& uniform, double rotation = 0) {
  InitialVelocity velocity;
  velocity.uniform = uniform;
  velocity.rotation = rotation;
  return velocity;
}

/// v = rate (X, -Y): stretches in x, shortens in y.
inline InitialVelocity stretching(double rate) {
  InitialVelocity velocity;
  velocity.gradient << rate, 0, 0, -rate;
  return velocity;
}

inline Wall flat_wall(const std::string& name, Wall::Solid solid, double level, double spacing, double thickness = 1) {
  Wall wall;
  wall.name = name;
  wall.material = "hard";
  wall.solid = solid;
  wall.level = level;
  wall.spacing = spacing;
  wall.thickness = thickness;
  return wall;
}

inline ContactRule contact_rule(ContactLawKind law, double stiffness, double friction = 0) {
  ContactRule result;
  result.first = result.second = "all";
  result.law = law;
  result.stiffness = stiffness;
  result.friction = friction;
  return result;
}

inline ContactRule smooth(double stiffness) { return contact_rule(ContactLawKind::frictionless, stiffness); }
inline ContactRule rough(double stiffness, double friction) {
  return contact_rule(ContactLawKind::mohr_coulomb, stiffness, friction);
}

/// Both materials and a contact rule; the caller adds shapes and bodies.
inline Scene empty_scene(double end) {
  Scene scene;
  scene.name = scene.title = "test";
  scene.file = "test.toml";
  scene.time.end = end;
  scene.materials = {elastic(), rigid_material()};
  scene.contacts = {smooth(100)};
  return scene;
}

/// One compliant disc of radius 1 at the origin, nothing to touch.
inline Scene free_disc(int nodes, double end, const InitialVelocity& velocity = {}) {
  Scene scene = empty_scene(end);
  scene.shapes = {disc_shape("disc", 2, nodes)};
  scene.grains = {grains("disc", "disc", BodyKind::compliant, {{0, 0}}, velocity)};
  return scene;
}

/// A floor at y = 0 below a period of `period`, under gravity.
inline Scene on_a_floor(double end, double period, double spacing, const Vec2& gravity) {
  Scene scene = empty_scene(end);
  scene.period = period;
  scene.gravity = gravity;
  scene.walls = {flat_wall("floor", Wall::Solid::below, 0, spacing)};
  return scene;
}

/// A compliant disc that flies freely and then hits a fixed wall.
inline Scene flight_and_impact(double tolerance) {
  Scene scene = on_a_floor(8, 8, 0.25, {0, 0});
  scene.shapes = {disc_shape("disc", 2, 60)};
  scene.grains = {grains("disc", "disc", BodyKind::compliant, {{4, 1.5}}, moving({0, -0.2}))};
  scene.contacts = {smooth(300)};
  scene.time.tolerance = tolerance;
  return scene;
}

/// dt is set by `safety` alone: no error makes a step rejected.
inline void without_error_control(Scene& scene, double safety) {
  scene.time.tolerance = 1e300;
  scene.time.safety = safety;
}

/// Compliant and rigid discs of radius 1, cohesive, in a periodic layer between a fixed wall and one that presses and
/// shears.
inline Scene small_third_body(double end) {
  Scene scene = empty_scene(end);
  scene.period = 6;
  scene.shapes = {disc_shape("disc", 2, 60)};
  Grains layer = grains("layer", "disc", BodyKind::compliant, {});
  layer.packing = {PackingKind::grid, 3, 4, 2.0, 2.01, {1, 0}, {}};
  layer.mix = {{BodyKind::compliant, "soft", 0.5}, {BodyKind::rigid, "hard", 0.5}};
  layer.seed = 3;
  layer.angle.reset();
  scene.grains = {layer};
  scene.walls = {flat_wall("lower", Wall::Solid::below, -1.02, 0.25),
                 flat_wall("upper", Wall::Solid::above, 7.05, 0.25)};
  scene.walls[1].x = {Drive::Mode::velocity, {{0, 1}, {0, 0.1}}};
  scene.walls[1].y = {Drive::Mode::pressure, {{0, 2}, {0, 0.1}}};
  scene.contacts = {contact_rule(ContactLawKind::cohesive, 0)};
  scene.contacts[0].stiffness.reset();
  scene.contacts[0].strength = 0.1;
  return scene;
}

inline void advance(Simulation& simulation, double until) {
  while (simulation.state().time < until) simulation.step(until);
}

/// Position, or velocity, of a rigid body: x, y, angle.
inline Eigen::Vector3d rigid(const Dofs& dofs, int index) {
  return {dofs.rigid[3 * static_cast<std::size_t>(index)], dofs.rigid[3 * static_cast<std::size_t>(index) + 1],
          dofs.rigid[3 * static_cast<std::size_t>(index) + 2]};
}

/// A node's degrees of freedom in a compliant body; positions are relative to the body's centre.
inline Vec2 node_value(const Model& model, const Body& body, const Dofs& dofs, int node) {
  const std::size_t at = model.batches[body.batch].offset + 2 * static_cast<std::size_t>(node);
  return {dofs.compliant[at][body.lane], dofs.compliant[at + 1][body.lane]};
}

/// Lumped masses of a compliant body, kg/m a node.
inline std::vector<double> node_masses(const Model& model, const Body& body) {
  std::vector<double> masses = model.shape_of(model.batches[body.batch]).space.unit_mass;
  for (double& m : masses) m *= model.scene.materials[body.material].density;
  return masses;
}

/// Mean over a compliant body's nodes, weighted by mass: of positions the centre (relative to body.centre), of
/// velocities its velocity.
inline Vec2 mass_mean(const Model& model, const Body& body, const Dofs& dofs) {
  const std::vector<double> masses = node_masses(model, body);
  Vec2 total(0, 0);
  double mass = 0;
  for (int i = 0; i < static_cast<int>(masses.size()); ++i) {
    total += masses[i] * node_value(model, body, dofs, i);
    mass += masses[i];
  }
  return total / mass;
}

/// Contact force on a body.
inline Vec2 contact_force(const Simulation& simulation, int body) {
  const Model& model = simulation.model();
  Vec2 total(0, 0);
  for (int i = model.outline_offset[body]; i < model.outline_end(body); ++i)
    total += simulation.state().contact_force.at(i);
  return total;
}

/// Order of convergence seen from the errors at steps h and h/ratio.
inline double observed_order(double coarse, double fine, double ratio = 2) {
  return std::log(std::abs(coarse) / std::abs(fine)) / std::log(ratio);
}

}  // namespace pliant::dynamics_tests
