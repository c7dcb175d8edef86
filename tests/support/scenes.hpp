#pragma once

#include <string>

#include "geometry/mesh.hpp"
#include "scene/scene.hpp"
#include "support/random.hpp"

/// Scenes put together in code, in units of order one: E = 1, density 1, bodies of size one.
namespace pliant::testing {

inline Scene bare_scene() {
  Scene scene;
  scene.name = "test";
  scene.materials = {{"soft", MaterialLaw::neo_hookean, 1, 1, 0.4}, {"hard", MaterialLaw::rigid, 1, 0, 0}};
  return scene;
}

inline ContactRule frictionless(double stiffness) {
  ContactRule rule;
  rule.first = rule.second = "all";
  rule.law = ContactLawKind::frictionless;
  rule.stiffness = stiffness;
  return rule;
}

inline ContactRule mohr_coulomb(double stiffness, double friction, double cohesion = 0, double tension = 0) {
  ContactRule rule = frictionless(stiffness);
  rule.law = ContactLawKind::mohr_coulomb;
  rule.friction = friction;
  rule.cohesion = cohesion;
  rule.tension = tension;
  return rule;
}

inline ContactRule cohesive(double stiffness, double strength, double range, double shear_strength) {
  ContactRule rule = frictionless(stiffness);
  rule.law = ContactLawKind::cohesive;
  rule.strength = strength;
  rule.shear_strength = shear_strength;
  rule.range = range;
  return rule;
}

inline ContactRule cohesive_fatigue(double stiffness, double strength, double range, double shear_ratio,
                                    double bond_gap) {
  ContactRule rule = frictionless(stiffness);
  rule.law = ContactLawKind::cohesive_fatigue;
  rule.strength = strength;
  rule.range = range;
  rule.shear_ratio = shear_ratio;
  rule.bond_gap = bond_gap;
  return rule;
}

inline ContactRule smoothed(ContactRule rule, double share) {
  rule.smoothing = share;
  return rule;
}

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

inline ShapeSpec disc_shape(const std::string& name, double diameter, int outline_nodes,
                            std::optional<int> nodes = {}) {
  ShapeSpec shape;
  shape.name = name;
  shape.diameter = diameter;
  shape.nodes = nodes;
  shape.outline_nodes = outline_nodes;
  return shape;
}

/// Adds one grain of a shape that the scene already has.
inline void add_grain(Scene& scene, const std::string& shape, BodyKind kind, const Vec2& centre, double angle = 0,
                      const std::string& material = {}) {
  Grains grains;
  grains.name = "grain" + std::to_string(scene.grains.size());
  grains.shape = shape;
  grains.packing.positions = {centre};
  grains.mix = {{kind, !material.empty() ? material : kind == BodyKind::rigid ? "hard" : "soft", 1}};
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

/// A flat wall; `free`: it may move in x and y without load.
inline Wall flat_wall(const std::string& name, Wall::Solid solid, double level, double spacing, bool free = false) {
  Wall wall;
  wall.name = name;
  wall.material = "hard";
  wall.solid = solid;
  wall.level = level;
  wall.spacing = spacing;
  wall.thickness = 1;
  if (free) wall.x.mode = wall.y.mode = Drive::Mode::free;
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

}  // namespace pliant::testing
