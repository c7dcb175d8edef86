#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/vec2.hpp"

namespace pliant {

/// What the user asked for, validated and in SI units (per metre of thickness). Immutable after reading.
/// Numbers that the scene may leave open carry their default here; `auto` values are std::nullopt.

enum class MaterialLaw {
  neo_hookean,
  neo_hookean_quadratic,
  melody,
  linear_elastic,
  neo_hookean_maxwell,
  von_mises,
  drucker_prager,
  rigid
};
enum class BodyKind { compliant, rigid };
enum class ShapeKind { disc, polygon, curve };
enum class PackingKind { hexagonal, grid, positions, random, fourier_voronoi };
enum class Mass { lumped, corrected };
enum class DiscretisationMethod { mls, mls_gauss, t3, es_t3, rpim };
enum class ContactLawKind { frictionless, mohr_coulomb, cohesive };
enum class ContactLength { reference, current };
/// Where the tractions of contact are evaluated: at nodes, or integrated over segments (docs/method.md 4).
/// `automatic`: over segments where an outline of the pair has corners, else at nodes.
enum class ContactQuadrature { automatic, nodes, segments };
enum class Integrator { verlet, step_doubling };
/// Properties of an integrator on which other parts depend.
struct IntegratorTraits {
  bool is_bounded;       ///< a stability bound limits its steps, not the error alone
  bool corrects_energy;  ///< it knows the work of forces in a step, from which contacts correct their energy
  int evaluations;       ///< force evaluations a step
};
constexpr IntegratorTraits traits_of(Integrator integrator) {
  switch (integrator) {
    case Integrator::verlet:
      return {true, true, 1};
    case Integrator::step_doubling:
      return {false, false, 2};
  }
  return {};
}
enum class Reduction { mean, sum, min, max };

/// Piecewise linear function of time, constant beyond its ends. One entry: a constant.
struct History {
  std::vector<double> time;   ///< [entries], s, strictly increasing
  std::vector<double> value;  ///< [entries]
  double at(double t) const;
  double integral(double t0, double t1) const;  ///< exact integral of value over [t0, t1]
  double slope(double t) const;                 ///< 1/s; at a kink that of the piece after it
  double largest() const;                       ///< absolute value at all times
};

/// When something acts: from <= t < until, s.
struct Window {
  double from = -std::numeric_limits<double>::infinity(), until = std::numeric_limits<double>::infinity();
  bool contains(double t) const { return from <= t && t < until; }
  bool always() const { return std::isinf(from) && std::isinf(until); }
};

/// Cell with two periods that is deformed homogeneously (docs/method.md 10). The vectors of its periods are F times
/// those at the start of the run.
struct CellSettings {
  Vec2 periods{0, 0};                                ///< at the start of the scene, along x and y, m
  std::array<std::array<History, 2>, 2> gradient{};  ///< F: [row][column]; empty: that of the identity
  /// Cauchy stress of the cell, Pa, tension positive, in place of a component of F; nullopt: F is given.
  std::array<std::array<std::optional<History>, 2>, 2> stress{};
  double mass = 1;       ///< of the cell where stress moves it, over that of the matter in it spread evenly
  double damping = 0.8;  ///< share of the force on the cell that acts against its motion
  Eigen::Matrix2d gradient_at(double time) const;
  bool is_stress_controlled() const {
    return std::ranges::any_of(stress, [](const auto& row) { return row[0] || row[1]; });
  }
};

struct Material {
  std::string name;
  MaterialLaw law = MaterialLaw::neo_hookean;
  double density = 0;            ///< kg/m3
  double young = 0;              ///< Pa; 0 for `rigid`
  double poisson = 0;            ///< [0, 0.5); 0 for `rigid`
  double viscosity = 0;          ///< Kelvin-Voigt, of compliant bodies: second Piola stress 2 viscosity E_dot, Pa s
  double mass_damping = 0;       ///< of grains: force - mass_damping m v, 1/s
  double branch_modulus = 0;     ///< shear modulus of a Maxwell branch, Pa; 0 for laws without
  double relaxation_time = 0;    ///< of the branch, s
  double yield = 0;              ///< yield stress, Pa; 0 for laws without
  double hardening = 0;          ///< of the yield stress or cohesion by the equivalent plastic strain, Pa
  double saturation = 0;         ///< yield stress that saturating hardening tends to, Pa; 0: none
  double saturation_rate = 0;    ///< of that hardening, by the equivalent plastic strain
  double viscoplastic_time = 0;  ///< Perzyna's time, s
  double friction_angle = 0, dilatancy_angle = 0;  ///< of Mohr and Coulomb, rad; 0 for laws without
  double heat_capacity = 0;                        ///< J/(kg K); 0: temperatures are not followed
  double taylor_quinney = 0.9;                     ///< share of the plastic loss that becomes heat
  double cohesion = 0;                             ///< likewise, Pa
};

struct ShapeSpec {
  std::string name;  ///< of a family of variants: "pebble.1", "pebble.2", ...
  ShapeKind kind = ShapeKind::disc;
  double diameter = 0;               ///< disc: diameter of the circle whose area the polygon has, m
  Points points;                     ///< polygon: its corners; curve: many points on it; counter-clockwise, m
  std::optional<int> nodes;          ///< field nodes of a compliant body of this shape ...
  std::optional<double> spacing;     ///< ... or their distance, m: exactly one of the two is given
  std::optional<int> outline_nodes;  ///< overrides the number of outline nodes
  std::string family;                ///< what all variants of a shape are called; empty: it has none
  std::vector<double> descriptors;   ///< of a Fourier grain that each cell of a packing fits to itself; else empty
  bool in_place = false;             ///< its points say where it lies: those of a polygon, or of a file at its own size
  std::string where{};               ///< file, line and column of its table, for messages
};

/// Sizes of grains, relative to their shape as it is defined, between `low` and `high`.
struct SizeDistribution {
  enum class Kind { list, uniform, normal, lognormal } kind = Kind::list;
  double low = 1, high = 1;        ///< limits; beyond them a distribution is cut off
  double centre = 1;               ///< mean of a normal, median of a lognormal distribution before the cut
  double deviation = 0;            ///< standard deviation, of the size or of its natural logarithm, before the cut
  std::vector<double> factors{1};  ///< list: the sizes ...
  std::vector<double> shares{1};   ///< ... and the share of the grains that has each, sum 1
};

struct Packing {
  PackingKind kind = PackingKind::positions;
  int columns = 0, rows = 0;
  double pitch = 0;      ///< distance of columns, m
  double row_pitch = 0;  ///< distance of rows, m
  Vec2 origin{0, 0};     ///< centre of the first grain (column 0, row 0), m
  Points positions;      ///< kind positions: centres, m
  // Of kind positions, [positions] each; empty: as the rest of the table says.
  std::vector<double> scales{};     ///< sizes over that of the shape ...
  std::vector<double> diameters{};  ///< ... or diameters of the circles of the grains' areas, m
  std::vector<double> angles{};     ///< rad
  std::vector<int> shapes{};        ///< indices in Scene::shapes
  // Kinds random and fourier_voronoi fill the period, or random a box, between two levels.
  double bottom = 0, top = 0;  ///< m
  double left = 0, right = 0;  ///< of the box; without a period only, m
  int count = 0;               ///< grains
  std::optional<double> solid_fraction =
      std::nullopt;  ///< of all grains in the region; nullopt: that of `count` grains
  std::int64_t grain_count() const;
};

/// A shape, or a family of variants, and how many of the grains have it.
struct ShapeShare {
  std::string shape;
  double share = 1;  ///< all shares sum to 1
};

struct Species {
  BodyKind body = BodyKind::compliant;
  std::string material;
  double share = 1;  ///< shares of all species sum to 1; 0: no grain, as at the end of a row of studies
};

/// How grains get their species.
enum class SpeciesOrder {
  random,
  in_turn,  ///< up each column of a lattice, column after column; given positions as listed
};

/// v(r) = uniform + rotation x r + gradient r, r from the grain's own centre.
struct InitialVelocity {
  Vec2 uniform{0, 0};                                  ///< m/s
  double rotation = 0;                                 ///< rad/s, counter-clockwise
  Eigen::Matrix2d gradient = Eigen::Matrix2d::Zero();  ///< 1/s; compliant bodies only
};

struct Grains {
  std::string name;                ///< default "grains", "grains2", ...
  std::string shape;               ///< a shape or a family of variants; empty: see `shapes`
  std::vector<ShapeShare> shapes;  ///< of grains of several shapes
  SizeDistribution size;
  Packing packing;
  std::vector<Species> species;  ///< one entry when the scene gives `body` and `material` directly
  SpeciesOrder species_order = SpeciesOrder::random;
  std::uint64_t seed = 0;
  std::optional<double> angle = 0.0;  ///< rad; nullopt: each grain turned by a random angle
  InitialVelocity velocity;
  std::vector<double> cells{};  ///< relative areas of the cells that each grain is cut into; empty: it is one body
  std::string where{};          ///< file, line and column of its table, for messages
  std::int64_t body_count() const {
    return packing.grain_count() * static_cast<std::int64_t>(std::max<std::size_t>(cells.size(), 1));
  }
};

/// What moves one degree of freedom of a wall or a rigid grain, or what the soft support of an outline follows.
struct AxisCondition {
  enum class Mode { fixed, velocity, force, pressure, free, displacement } mode = Mode::fixed;
  History history;     ///< m/s (rad/s), N/m (N for a moment), m, or Pa: on period x thickness, towards the grains
  double damping = 0;  ///< of a dashpot beside a load: force - damping v, in the load's unit over m/s (rad/s)
  Window window{};     ///< of conditions with a history: free outside

  static AxisCondition none() {
    AxisCondition prescribed;
    prescribed.mode = Mode::free;
    return prescribed;
  }
};

/// Half-round bumps of discs on a wall, one column after another across the period, joined by straight segments.
struct Asperities {
  double diameter = 0;
  int count = 0;                    ///< over the period: pitch = period / count
  double first = 0;                 ///< x of the first asperity's centre, m
  std::vector<double> heights;      ///< cyclic: height of the asperity centres above `level` towards the grains, m
  std::vector<double> half_angles;  ///< cyclic: arc kept on either side of the wall's normal, rad, in (0, pi/2)
};

/// A wall spans the period in x; its outline is an open line that continues periodically.
struct Wall {
  std::string name;
  std::string material;
  enum class Solid { below, above } solid = Solid::below;  ///< on which side of the line the wall is solid
  double level = 0;      ///< y of the flat line, or of the asperity centres of height 0, m
  double spacing = 0;    ///< outline spacing; 0: the finest outline of the grains
  double thickness = 0;  ///< mass = density x period x thickness; m
  std::optional<Asperities> asperities;
  AxisCondition x, y;   ///< rotation is blocked
  std::string where{};  ///< file, line and column of its table, for messages
};

/// Part of an outline: the segments whose middle lies there at the start.
struct OutlinePart {
  enum class Kind { all, angles, box, side } kind = Kind::all;
  double first = 0, second = 0;  ///< angles: directions from the body's centre, counter-clockwise, rad
  Vec2 low{0, 0}, high{0, 0};    ///< box, m
  Vec2 side{0, 0};               ///< side: outward normals less than 45 degrees from this direction
};

/// What acts on grains from outside: motions and loads of rigid ones, pressures and soft supports on parts of outlines
/// (docs/method.md 5).
struct BoundaryCondition {
  enum class Kind { axes, pressure, support } kind = Kind::axes;
  std::string grains;                                         ///< name of a set of grains ...
  std::optional<int> number;                                  ///< ... and the one of them, or all
  AxisCondition x = AxisCondition::none(), y = x, angle = x;  ///< axes; support (fixed, free, velocity, displacement)
  OutlinePart part;                                           ///< pressure, support
  Window window;                                              ///< pressure, support
  History pressure;                                           ///< Pa, positive: pushes
  bool following = true;            ///< on the present outline along its normal; else on the one at the start
  std::optional<Vec2> direction;    ///< not following: unit vector of the traction; nullopt: against the first normal
  std::optional<double> stiffness;  ///< support: Pa/m; nullopt: 8 E/h as in contacts
  double damping = 0;               ///< support: Pa s/m
  std::string where{};              ///< file, line and column of its table, for messages
};

/// What holds between two sorts of bodies (docs/method.md 4). Which rule a pair gets: scene/contact_rules.hpp.
struct ContactRule {
  std::string first, second;  ///< names of materials, grains or walls; "all": any
  ContactLawKind law = ContactLawKind::frictionless;
  std::optional<double> stiffness;        ///< kn, Pa/m; nullopt: auto
  std::optional<double> shear_stiffness;  ///< kt, Pa/m; nullopt: equal to kn
  double friction = 0;                    ///< mohr-coulomb
  double cohesion = 0;                    ///< mohr-coulomb, Pa
  double tension = 0;                     ///< mohr-coulomb tensile cut-off, Pa
  double smoothing = 0;                   ///< frictionless, mohr-coulomb: quadratic start of the pressure, over h
  std::optional<double> restitution;      ///< frictionless, mohr-coulomb: of rigid pairs; nullopt: elastic
  bool pull = false;                      ///< the dashpot of the restitution may pull
  double strength = 0;                    ///< cohesive: normal strength, Pa
  std::optional<double> shear_strength;   ///< cohesive: nullopt: equal to strength
  std::optional<double> range;            ///< cohesive: g_max, m; nullopt: auto (0.12 h)
};

/// Bonds between the outlines of bodies (docs/method.md 11). Names as in ContactRule.
struct BondRule {
  std::string first, second;
  double from = 0;                              ///< time when they are made, s
  double gap = 0;                               ///< widest gap that cement bridges, m; 0: what touches is bonded
  std::optional<double> stiffness;              ///< kn, Pa/m; nullopt: that of contact
  std::optional<double> shear_stiffness;        ///< kt, Pa/m; nullopt: equal to kn
  double strength = 0;                          ///< tensile strength, Pa
  std::optional<double> cohesion;               ///< shear strength without pressure, Pa; nullopt: the tensile strength
  std::optional<double> friction;               ///< tan(phi) of whole bonds; nullopt: that of contact
  double fracture_energy = 0;                   ///< G_I, J/m2
  std::optional<double> shear_fracture_energy;  ///< G_II, J/m2; nullopt: G_I
  double fatigue_threshold = 0;                 ///< stress above which each loading damages, Pa
  double fatigue_rate = 0;                      ///< damage per tensile stress at the strength, 1/Pa
  double shear_fatigue_rate = 0;                ///< the same in shear, 1/Pa
  std::optional<double> weibull_modulus;        ///< of the strengths, by pairs of bodies; nullopt: all are equal
  std::uint64_t seed = 0;
  std::string where{};  ///< file, line and column of its table, for messages
};

/// Settings of contact that hold for the whole scene; the skin stands in Scene.
struct ContactSettings {
  ContactQuadrature quadrature = ContactQuadrature::automatic;
  ContactLength length = ContactLength::reference;  ///< what the pressure on a node acts on
  int refresh_steps = 0;                            ///< rebuild candidates every so many steps; 0: when needed
  double refresh_period = 0;                        ///< the same in time, s
  bool self_contact = false;                        ///< compliant bodies may touch themselves
  bool energy_consistent = true;                    ///< see Scene::corrects_energy
};

/// A rectangle.
struct ProbeBox {
  Vec2 low{0, 0}, high{0, 0};  ///< opposite corners, m
};

/// One measurement; scene/quantities.hpp lists the quantities and which of these settings each takes. `of` and `with`
/// name a wall, grains, one of them ("grains 17"), or "compliant", "rigid" or "all" grains.
struct Probe {
  std::string name;
  std::string quantity;
  std::string of;                    ///< empty for the whole scene
  double period = 0;                 ///< s
  std::string with;                  ///< partners of contacts; empty: all
  std::optional<int> node;           ///< of the one body that `of` names
  std::optional<Reduction> reduce;   ///< over bodies, points or contacts; nullopt: the quantity's own
  std::vector<std::string> between;  ///< the two walls that bound the region, or none
  std::optional<ProbeBox> box;       ///< the region
};

struct Frames {
  double period = 0;                ///< s; 0: no frames
  std::vector<std::string> fields;  ///< names of frame_fields(); kind and body are always there
  bool contacts = false;            ///< all pairs in touch with their forces: results/contact_network.hpp
};

struct TimeSettings {
  double end = 0;  ///< s
  Integrator integrator = Integrator::verlet;
  double tolerance = 1e-2;  ///< verlet: free error estimate, per step, relative to the nodal distance
  double target = 1e-4;     ///< step-doubling
  double alpha = 2;         ///< step-doubling: reject above alpha x target
  double beta = 0.2;        ///< step-doubling: controller exponent
  double safety = 0.8;      ///< verlet: share of the stability bound
  /// Whether steps end at outputs; else these look at shorter steps of their own, and change nothing.
  bool stop_at_outputs = false;
};

struct DiscretisationSettings {
  DiscretisationMethod method = DiscretisationMethod::mls;
  int support = 8;       ///< nodal support radius = distance to the support-th nearest node
  int gauss_points = 3;  ///< mls-gauss, rpim: 1, 3 or 6
  Mass mass = Mass::lumped;
  double mass_scaling = 1;  ///< of outline nodes with their inner neighbours, so that contact allows longer steps
};

struct Scene {
  std::string name;  ///< file name without folder and extension
  std::string title;
  std::filesystem::path file;
  std::optional<double> period;            ///< of a domain with one period, along x, m
  std::optional<CellSettings> cell{};      ///< of a domain with two periods
  Vec2 gravity{0, 0};                      ///< m/s2; with a history that of t = 0
  std::vector<History> gravity_history{};  ///< its x and y; empty: constant
  double skin = 0.5;                       ///< contact skin over the finest outline spacing
  ContactSettings contact;
  TimeSettings time;
  DiscretisationSettings discretisation;
  std::vector<Material> materials;
  std::vector<ShapeSpec> shapes;
  std::vector<Grains> grains;
  std::vector<Wall> walls;
  std::vector<BoundaryCondition> boundary;
  std::vector<ContactRule> contacts;
  std::vector<BondRule> bonds{};
  std::vector<Probe> probes;
  Frames frames;
  std::optional<double> checkpoint_period = 600.0;  ///< wall time between checkpoints, s; nullopt: "never"
  std::filesystem::path start_from{};               ///< file with the last state of a run to start from; empty: none
  std::vector<std::string> warnings{};              ///< of values that are allowed but hardly meant, with their place

  Vec2 gravity_at(double time) const;
  bool is_periodic() const { return period || cell; }
  /// The shortest period, m; 0 without one.
  double shortest_period() const { return cell ? cell->periods.minCoeff() : period.value_or(0); }
  /// Contacts correct the energy that steps gain or lose (contact/energy_correction.hpp): those that have an energy, of
  /// steps whose work is known.
  bool corrects_energy() const {
    return contact.energy_consistent && contact.length == ContactLength::reference &&
           traits_of(time.integrator).corrects_energy;
  }
  const Material& material(const std::string& name) const;  ///< throws InputError for an unknown name
  const ShapeSpec& shape(const std::string& name) const;
  /// Shapes that a set of grains is made of, as indices in `shapes` with their shares; families as their variants.
  std::vector<std::pair<int, double>> shape_shares(const Grains& grains) const;
};

/// What a finished run leaves in its folder for others to start from, and what it is called beside their scenes.
inline constexpr const char *start_file_name = "final.bin", *start_copy_name = "start.bin";

}  // namespace pliant
