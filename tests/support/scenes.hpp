#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "geometry/mesh.hpp"
#include "scene/scene.hpp"
#include "support/random.hpp"

/// Scenes put together in code, and what they are made of, in units of order one.
namespace pliant::testing {

// ---- materials and motions

inline History constant(double value) { return {{0}, {value}}; }

inline Material elastic(const std::string& name = "soft") {
  return {name, MaterialLaw::neo_hookean, 1.0, 2.8, 0.4};  // E = 2 mu (1 + nu)
}

inline Material rigid_material(double density = 1, const std::string& name = "hard") {
  return {name, MaterialLaw::rigid, density, 0, 0};
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

// ---- contact rules

inline constexpr double kn = 100;  ///< stiffness of contact in many tests, Pa/m

inline ContactRule contact_rule(ContactLawKind law, double stiffness, double friction = 0) {
  ContactRule rule;
  rule.first = rule.second = "all";
  rule.law = law;
  rule.stiffness = stiffness;
  rule.friction = friction;
  return rule;
}

inline ContactRule frictionless(double stiffness) { return contact_rule(ContactLawKind::frictionless, stiffness); }

inline ContactRule mohr_coulomb(double stiffness, double friction, double cohesion = 0, double tension = 0) {
  ContactRule rule = contact_rule(ContactLawKind::mohr_coulomb, stiffness, friction);
  rule.cohesion = cohesion;
  rule.tension = tension;
  return rule;
}

inline ContactRule cohesive(double stiffness, double strength, double range, double shear_strength) {
  ContactRule rule = contact_rule(ContactLawKind::cohesive, stiffness);
  rule.strength = strength;
  rule.shear_strength = shear_strength;
  rule.range = range;
  return rule;
}

inline ContactRule smoothed(ContactRule rule, double share) {
  rule.smoothing = share;
  return rule;
}

// ---- shapes, grains and walls

/// An outline of exactly these corners; with `nodes` also a compliant body of that many field nodes.
inline ShapeSpec outline_shape(const std::string& name, const Points& points, std::optional<int> nodes = {}) {
  ShapeSpec shape;
  shape.name = name;
  shape.kind = ShapeKind::polygon;
  shape.points = points;
  shape.nodes = nodes;
  shape.outline_nodes = static_cast<int>(points.size());
  return shape;
}

/// Of so many field nodes, which give the outline its own.
inline ShapeSpec disc_shape(const std::string& name, double diameter, int nodes) {
  ShapeSpec shape;
  shape.name = name;
  shape.diameter = diameter;
  shape.nodes = nodes;
  return shape;
}

/// A disc of so many sides; with `nodes` also a compliant body of that many field nodes.
inline ShapeSpec polygonal_disc(const std::string& name, double diameter, int sides, std::optional<int> nodes = {}) {
  ShapeSpec shape;
  shape.name = name;
  shape.diameter = diameter;
  shape.nodes = nodes;
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
  result.species = {{kind, kind == BodyKind::compliant ? "soft" : "hard", 1}};
  result.velocity = velocity;
  return result;
}

/// Adds one grain of a shape that the scene already has.
inline void add_grain(Scene& scene, const std::string& shape, BodyKind kind, const Vec2& centre, double angle = 0,
                      const std::string& material = {}) {
  Grains grains;
  grains.name = "grain" + std::to_string(scene.grains.size());
  grains.shape = shape;
  grains.packing.positions = {centre};
  grains.species = {{kind, !material.empty() ? material : kind == BodyKind::rigid ? "hard" : "soft", 1}};
  grains.angle = angle;
  scene.grains.push_back(grains);
}

/// Adds a body of its own shape; returns its index.
inline int add_body(Scene& scene, ShapeSpec shape, BodyKind kind, const Vec2& centre, double angle = 0) {
  shape.name = "shape" + std::to_string(scene.shapes.size());
  scene.shapes.push_back(shape);
  add_grain(scene, shape.name, kind, centre, angle);
  return static_cast<int>(scene.grains.size()) - 1;
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

/// It may move in x and y, without load.
inline Wall free_wall(const std::string& name, Wall::Solid solid, double level, double spacing) {
  Wall wall = flat_wall(name, solid, level, spacing);
  wall.x.mode = wall.y.mode = AxisCondition::Mode::free;
  return wall;
}

// ---- outlines, counter-clockwise

inline Points regular(int count, double radius, double start = 0) {
  Points points;
  for (int k = 0; k < count; ++k) {
    const double angle = start + 2 * M_PI * k / count;
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return points;
}

/// Random angles of at least a fifth of the mean distance, on an ellipse.
inline Points random_convex(Random& random, int count, double a, double b) {
  std::vector<double> steps;
  double total = 0;
  for (int k = 0; k < count; ++k) total += steps.emplace_back(random.uniform(0.2, 1.8));
  Points points;
  double angle = random.uniform(0, 1);
  for (int k = 0; k < count; ++k) {
    points.emplace_back(a * std::cos(angle), b * std::sin(angle));
    angle += 2 * M_PI * steps[k] / total;
  }
  return points;
}

/// Star-shaped about the origin, with radii between `inner` and 1: concave and sharp corners.
inline Points random_star(Random& random, int count, double inner) {
  Points points;
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * M_PI * (k + random.uniform(-0.3, 0.3)) / count, radius = random.uniform(inner, 1);
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return points;
}

/// Each edge in segments of at most `spacing`.
inline Points refined(const Points& corners, double spacing) {
  Points points;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 a = corners[i], b = corners[(i + 1) % corners.size()];
    const int n = std::max(1, static_cast<int>(std::ceil((b - a).norm() / spacing - 1e-9)));
    for (int k = 0; k < n; ++k) points.push_back(a + static_cast<double>(k) / n * (b - a));
  }
  return points;
}

inline Points rectangle(double width, double height, double spacing) {
  return refined({{0, 0}, {width, 0}, {width, height}, {0, height}}, spacing);
}

// ---- scenes

/// Materials alone, of E = 1 and density 1.
inline Scene bare_scene() {
  Scene scene;
  scene.name = "test";
  scene.materials = {{"soft", MaterialLaw::neo_hookean, 1, 1, 0.4}, {"hard", MaterialLaw::rigid, 1, 0, 0}};
  return scene;
}

/// The same with contact at nodes, also where outlines have corners.
inline Scene nodal_scene() {
  Scene scene = bare_scene();
  scene.contact.quadrature = ContactQuadrature::nodes;
  return scene;
}

/// Materials of mu = rho = 1, lambda = 4, and a contact rule; the caller adds shapes and bodies.
inline Scene empty_scene(double end) {
  Scene scene;
  scene.name = scene.title = "test";
  scene.file = "test.toml";
  scene.time.end = end;
  scene.materials = {elastic(), rigid_material()};
  scene.contacts = {frictionless(100)};
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
  scene.contacts = {frictionless(300)};
  scene.time.tolerance = tolerance;
  return scene;
}

/// dt is set by `safety` alone: no error makes a step rejected.
inline void without_error_control(Scene& scene, double safety) {
  scene.time.tolerance = 1e300;
  scene.time.safety = safety;
}

/// A compliant disc of six cells that flies and spins so fast that its bonds tear, with friction between the pieces.
inline Scene bursting_disc(double end) {
  Scene scene = empty_scene(end);
  scene.shapes = {disc_shape("disc", 2, 300)};
  scene.grains = {grains("disc", "disc", BodyKind::compliant, {{0, 0}}, moving({0.1, 0}, 0.5))};
  scene.grains[0].cells.assign(6, 1.0), scene.grains[0].seed = 1;
  scene.contacts = {mohr_coulomb(100, 0.3)};
  BondRule bonds;
  bonds.first = bonds.second = "all";
  bonds.strength = 0.05, bonds.fracture_energy = 0.001;
  bonds.weibull_modulus = 5, bonds.seed = 1;
  scene.bonds = {bonds};
  return scene;
}

/// Compliant and rigid discs of radius 1, cohesive, in a periodic layer between a fixed wall and one that presses and
/// shears.
inline Scene small_third_body(double end) {
  Scene scene = empty_scene(end);
  scene.period = 6;
  scene.shapes = {disc_shape("disc", 2, 60)};
  Grains layer = grains("layer", "disc", BodyKind::compliant, {});
  layer.packing = {PackingKind::grid, 3, 4, 2.0, 2.01, {1, 0}, {}};
  layer.species = {{BodyKind::compliant, "soft", 0.5}, {BodyKind::rigid, "hard", 0.5}};
  layer.seed = 3;
  layer.angle.reset();
  scene.grains = {layer};
  scene.walls = {flat_wall("lower", Wall::Solid::below, -1.02, 0.25),
                 flat_wall("upper", Wall::Solid::above, 7.05, 0.25)};
  scene.walls[1].x = {AxisCondition::Mode::velocity, {{0, 1}, {0, 0.1}}};
  scene.walls[1].y = {AxisCondition::Mode::pressure, {{0, 2}, {0, 0.1}}};
  scene.contacts = {contact_rule(ContactLawKind::cohesive, 0)};
  scene.contacts[0].stiffness.reset();
  scene.contacts[0].strength = 0.1;
  return scene;
}

}  // namespace pliant::testing
