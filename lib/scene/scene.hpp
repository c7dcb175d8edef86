#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/vec2.hpp"

namespace pliant {

/// What the user asked for, validated and in SI units (per metre of thickness). Immutable after reading.
/// Numbers that the scene may leave open carry their default here; `auto` values are std::nullopt.

enum class MaterialLaw { neo_hookean, neo_hookean_quadratic, melody, rigid };
enum class BodyKind { compliant, rigid };
enum class ShapeKind { disc, polygon, curve };
enum class PackingKind { hexagonal, grid, positions };
enum class Mass { lumped, corrected };
enum class Recipe { mls, mls_gauss, t3, es_t3, rpim };
enum class ContactLawKind { frictionless, mohr_coulomb, cohesive };
enum class Integrator { verlet, step_doubling };
enum class ProbeQuantity { force, friction_factor, position, velocity, diameter, energy };

/// Piecewise linear function of time, constant beyond its ends. One entry: a constant.
struct History {
  std::vector<double> time;   ///< [entries], s, strictly increasing
  std::vector<double> value;  ///< [entries]
  double at(double t) const;
  double integral(double t0, double t1) const;  ///< exact integral of value over [t0, t1]
};

struct Material {
  std::string name;
  MaterialLaw law = MaterialLaw::neo_hookean;
  double density = 0;  ///< kg/m3
  double young = 0;    ///< Pa; 0 for `rigid`
  double poisson = 0;  ///< [0, 0.5); 0 for `rigid`
};

struct ShapeSpec {
  std::string name;
  ShapeKind kind = ShapeKind::disc;
  double diameter = 0;               ///< disc: diameter of the circle whose area the polygon has, m
  Points points;                     ///< polygon: its corners; curve: many points on it; counter-clockwise, m
  std::optional<int> nodes;          ///< field nodes of a compliant body of this shape ...
  std::optional<double> spacing;     ///< ... or their distance, m: exactly one of the two is given
  std::optional<int> outline_nodes;  ///< overrides the number of outline nodes
};

struct Packing {
  PackingKind kind = PackingKind::positions;
  int columns = 0, rows = 0;
  double pitch = 0;      ///< distance of columns, m
  double row_pitch = 0;  ///< distance of rows, m
  Vec2 origin{0, 0};     ///< centre of the first grain (column 0, row 0), m
  Points positions;      ///< kind positions: centres, m
};

struct MixEntry {
  BodyKind body = BodyKind::compliant;
  std::string material;
  double share = 1;  ///< shares of a mix sum to 1
};

/// v(r) = uniform + rotation x r + gradient r, r from the body's own centre.
struct InitialVelocity {
  Vec2 uniform{0, 0};                                  ///< m/s
  double rotation = 0;                                 ///< rad/s, counter-clockwise
  Eigen::Matrix2d gradient = Eigen::Matrix2d::Zero();  ///< 1/s; compliant bodies only
};

struct Grains {
  std::string name;  ///< default "grains", "grains2", ...
  std::string shape;
  Packing packing;
  std::vector<MixEntry> mix;  ///< one entry when the scene gives `body` and `material` directly
  std::uint64_t seed = 0;
  std::optional<double> angle = 0.0;  ///< rad; nullopt: each grain turned by a random angle
  InitialVelocity velocity;
};

/// What moves one degree of freedom of a wall.
struct Drive {
  enum class Mode { fixed, velocity, force, pressure, free } mode = Mode::fixed;
  History history;  ///< m/s, N/m or Pa; pressure acts on period x thickness and is positive towards the grains
};

/// Half-round bumps of discs on a wall, one column after another across the period, joined by straight segments.
struct Caps {
  double diameter = 0;
  int count = 0;                    ///< over the period: pitch = period / count
  double first = 0;                 ///< x of the first cap's centre, m
  std::vector<double> heights;      ///< cyclic: height of the cap centres above `level` towards the grains, m
  std::vector<double> half_angles;  ///< cyclic: arc kept on either side of the wall's normal, rad, in (0, pi/2)
};

/// A wall spans the period in x; its outline is an open line that continues periodically.
struct Wall {
  std::string name;
  std::string material;
  enum class Solid { below, above } solid = Solid::below;  ///< on which side of the line the wall is solid
  double level = 0;                                        ///< y of the flat line, or of the cap centres of height 0, m
  double spacing = 0;                                      ///< outline spacing; 0: the finest outline of the grains
  double thickness = 0;                                    ///< mass = density x period x thickness; m
  std::optional<Caps> caps;
  Drive x, y;  ///< rotation is blocked
};

struct ContactRule {
  std::string first, second;  ///< material names; both "all" for the rule that applies where no other does
  ContactLawKind law = ContactLawKind::frictionless;
  std::optional<double> stiffness;        ///< kn, Pa/m; nullopt: auto
  std::optional<double> shear_stiffness;  ///< kt, Pa/m; nullopt: equal to kn
  double friction = 0;                    ///< mohr-coulomb
  double cohesion = 0;                    ///< mohr-coulomb, Pa
  double tension = 0;                     ///< mohr-coulomb tensile cut-off, Pa
  double strength = 0;                    ///< cohesive: normal strength, Pa
  std::optional<double> shear_strength;   ///< cohesive: nullopt: equal to strength
  std::optional<double> range;            ///< cohesive: g_max, m; nullopt: auto (0.12 h)
};

struct Probe {
  std::string name;
  ProbeQuantity quantity = ProbeQuantity::energy;
  std::string of;     ///< wall name, grains name (mean over its bodies), or "compliant" / "rigid"; empty for energy
  double period = 0;  ///< s
};

struct Frames {
  double period = 0;                ///< s; 0: no frames
  std::vector<std::string> fields;  ///< of: velocity, von_mises, jacobian, pressure, contact_pressure; kind always
};

struct TimeSettings {
  double end = 0;  ///< s
  Integrator integrator = Integrator::verlet;
  double tolerance = 1e-2;  ///< verlet: free error estimate, per step, relative to the nodal distance
  double target = 1e-4;     ///< step-doubling
  double alpha = 2;         ///< step-doubling: reject above alpha x target
  double beta = 0.2;        ///< step-doubling: controller exponent
  double safety = 0.8;      ///< verlet: share of the stability bound
};

struct DiscretisationSettings {
  Recipe recipe = Recipe::mls;
  int support = 8;       ///< nodal support radius = distance to the support-th nearest node
  int gauss_points = 3;  ///< mls-gauss, rpim: 1, 3 or 6
  Mass mass = Mass::lumped;
};

struct Scene {
  std::string name;  ///< file name without folder and extension
  std::string title;
  std::filesystem::path file;
  std::optional<double> period;  ///< m
  Vec2 gravity{0, 0};            ///< m/s2
  double skin = 0.5;             ///< contact skin over the finest outline spacing
  TimeSettings time;
  DiscretisationSettings discretisation;
  std::vector<Material> materials;
  std::vector<ShapeSpec> shapes;
  std::vector<Grains> grains;
  std::vector<Wall> walls;
  std::vector<ContactRule> contacts;
  std::vector<Probe> probes;
  Frames frames;

  const Material& material(const std::string& name) const;  ///< throws InputError for an unknown name
  const ShapeSpec& shape(const std::string& name) const;
  /// The contact rule of a pair of materials: its own, else the one for all; nullptr when there is none.
  const ContactRule* rule(const std::string& first_material, const std::string& second_material) const;
};

/// Reads and validates a scene file. Throws InputError with file, line and column, what was found, what is
/// allowed and the nearest name. Nothing is written.
Scene read_scene(const std::filesystem::path& file);

}  // namespace pliant
