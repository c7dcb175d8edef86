#include "reference/bodies.hpp"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <map>
#include <set>

#include "core/located.hpp"

namespace pliant::reference {
namespace {

/// D (2 D - M)^-1 D: inverse of the engine's inverse mass 2 D^-1 - D^-1 M D^-1. It is dense: all nodes of a body are
/// coupled.
Eigen::MatrixXd corrected_mass(const Space& space) {
  const Eigen::MatrixXd lumped = space.lumped.asDiagonal();
  return lumped * (2 * lumped - Eigen::MatrixXd(space.consistent)).ldlt().solve(lumped);
}

/// D plus, for each outline node of mass m and the nearest of the inner nodes that share a triangle with it, if any,
/// (s - 1) m (v_outline - v_inner)^2 / 2 of kinetic energy. Of nodes equally near, to 1e-9, the first counts.
Eigen::MatrixXd scaled_mass(const Space& space, double scaling) {
  Eigen::MatrixXd mass = space.lumped.asDiagonal();
  const int outline = int(space.outline.size());
  for (int o = 0; o < outline; ++o) {
    const auto distance = [&](int i) { return (space.mesh.nodes[i] - space.mesh.nodes[o]).norm(); };
    std::set<int> beside;
    for (const Triangle& t : space.mesh.triangles)
      if (t[0] == o || t[1] == o || t[2] == o) beside.insert(t.begin(), t.end());
    beside.erase(beside.begin(), beside.lower_bound(outline));
    if (beside.empty()) continue;
    int nearest = *beside.begin();
    for (const int i : beside)
      if (distance(i) < distance(nearest) * (1 - 1e-9)) nearest = i;
    Vector difference = Vector::Zero(mass.rows());
    difference[o] = 1, difference[nearest] = -1;
    mass += (scaling - 1) * space.lumped[o] * difference * difference.transpose();
  }
  return mass;
}

Eigen::MatrixXd unit_mass(const Space& space, MassMatrix kind, double scaling) {
  if (kind == MassMatrix::scaled) return scaled_mass(space, scaling);
  if (kind == MassMatrix::corrected) return corrected_mass(space);
  if (kind == MassMatrix::consistent) return Eigen::MatrixXd(space.consistent);
  return space.lumped.asDiagonal();
}

}  // namespace

double mean_spacing(const Points& outline, double turn_shift) {
  double total = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const bool last = i + 1 == outline.size();
    total += (outline[last ? 0 : i + 1] + Vec2(last ? turn_shift : 0, 0) - outline[i]).norm();
  }
  return total / static_cast<double>(outline.size());
}

Vec2 interpolated(const Row& row, const Vector& values, int first) {
  Vec2 at(0, 0);
  for (std::size_t e = 0; e < row.node.size(); ++e) at += row.value[e] * values.segment<2>(first + 2 * row.node[e]);
  return at;
}

Bodies::Bodies(const Scene& scene) : scene_(scene) {
  const std::vector<PlacedBody> placed = place_bodies(scene_);
  meshes_ = same_topology_meshes(scene_, placed);
  std::map<std::string, int> known;
  for (const PlacedBody& one : placed)
    if (!one.wall) {
      Body body{.placed = one, .outline = {}};
      one.kind == BodyKind::compliant ? add_compliant(std::move(body), known) : add_rigid(std::move(body));
    }
  for (const PlacedBody& one : placed)
    if (one.wall) add_wall(Body{.placed = one, .outline = {}});
}

void Bodies::place(Body body, int dofs) {
  body.first_dof = dofs_, body.dofs = dofs;
  body.first_outline = outline_nodes_;
  dofs_ += dofs;
  outline_nodes_ += static_cast<int>(body.outline.size());
  bodies_.push_back(std::move(body));
}

void Bodies::add_compliant(Body body, std::map<std::string, int>& known) {
  const ShapeSpec& shape = scene_.shapes[body.placed.shape];
  const auto [found, is_new] = known.try_emplace(shape.name, static_cast<int>(spaces_.size()));
  const auto shared = meshes_.find(shape.name);
  if (is_new)
    spaces_.push_back(located(shape.where, [&] {
      return make_space(shared == meshes_.end() ? make_field_mesh(shape) : shared->second.mesh, scene_.discretisation);
    }));
  body.space = found->second;
  const FieldMesh& mesh = space_of(body).mesh;
  for (int k = 0; k < mesh.outline_count; ++k) body.outline.push_back(body.placed.scale * mesh.nodes[k]);
  body.mass = material_of(body).density * polygon_properties(body.outline).area;
  finest_spacing_ = std::min(finest_spacing_, mean_spacing(body.outline, 0));
  place(std::move(body), 2 * static_cast<int>(mesh.nodes.size()));
}

void Bodies::add_rigid(Body body) {
  for (const Vec2& p : make_outline(scene_.shapes[body.placed.shape])) body.outline.push_back(body.placed.scale * p);
  const PolygonProperties properties = polygon_properties(body.outline);
  body.mass = material_of(body).density * properties.area;
  body.inertia = material_of(body).density * properties.polar_moment;
  finest_spacing_ = std::min(finest_spacing_, mean_spacing(body.outline, 0));
  place(std::move(body), 3);
}

void Bodies::add_wall(Body body) {
  const Wall& wall = scene_.walls[body.placed.number_of_wall];
  const double period = *scene_.period;
  body.outline = wall_points(scene_, wall, finest_spacing_);
  body.turn_shift = wall.solid == Wall::Solid::below ? -period : period;
  body.mass = body.inertia = material_of(body).density * period * wall.thickness;  // its angle is fixed
  place(std::move(body), 3);
}

Vector Bodies::initial_positions() const {
  Vector q(dofs_);
  for (const Body& body : bodies_) {
    const PlacedBody& placed = body.placed;
    if (!body.compliant()) {
      q.segment<3>(body.first_dof) << placed.centre, placed.angle;
      continue;
    }
    const Points& nodes = space_of(body).mesh.nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      q.segment<2>(body.first_dof + 2 * static_cast<int>(i)) =
          placed.centre + Eigen::Rotation2Dd(placed.angle) * (placed.scale * nodes[i]);
  }
  return q;
}

Vector Bodies::initial_velocities() const {
  const Vector q = initial_positions();
  Vector v = Vector::Zero(dofs_);
  for (const Body& body : bodies_) {
    if (body.placed.wall) continue;
    const InitialVelocity& field = scene_.grains[body.placed.grains].velocity;
    // The centre of a cell's motion is that of its grain.
    const Vec2 grain_centre = body.placed.centre - body.placed.offset;
    if (!body.compliant())
      v.segment<3>(body.first_dof) << field.uniform + field.rotation * turned_left(body.placed.offset), field.rotation;
    for (int i = 0; body.compliant() && i < body.dofs; i += 2) {
      const Vec2 r = q.segment<2>(body.first_dof + i) - grain_centre;
      v.segment<2>(body.first_dof + i) = field.uniform + field.rotation * turned_left(r) + field.gradient * r;
    }
  }
  return v;
}

SparseMatrix Bodies::mass(MassMatrix kind) const {
  std::vector<Eigen::MatrixXd> unit;
  for (const Space& space : spaces_) unit.push_back(unit_mass(space, kind, scene_.discretisation.mass_scaling));
  Triplets entries;
  for (const Body& body : bodies_) {
    const int d = body.first_dof;
    if (!body.compliant()) {
      entries.emplace_back(d, d, body.mass), entries.emplace_back(d + 1, d + 1, body.mass);
      entries.emplace_back(d + 2, d + 2, body.inertia);
      continue;
    }
    const Eigen::MatrixXd& own = unit[static_cast<std::size_t>(body.space)];
    const double density = material_of(body).density * body.placed.scale * body.placed.scale;
    for (int i = 0; i < own.rows(); ++i)
      for (int j = 0; j < own.cols(); ++j)
        for (int c = 0; own(i, j) != 0 && c < 2; ++c)
          entries.emplace_back(d + 2 * i + c, d + 2 * j + c, density * own(i, j));
  }
  SparseMatrix matrix(dofs_, dofs_);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Vector Bodies::lumped_mass() const { return mass(MassMatrix::lumped).diagonal(); }

Vector Bodies::arms() const {
  Vector arms = Vector::Ones(dofs_);
  for (const Body& body : bodies_) {
    if (body.compliant()) continue;
    double& arm = arms[body.first_dof + 2] = 0;
    for (const Vec2& p : body.outline) arm = std::max(arm, p.norm());
  }
  return arms;
}

Points Bodies::outline_positions(const Vector& q) const {
  Points x;
  for (const Body& body : bodies_) {
    if (!body.compliant()) {
      const Vec2 centre = q.segment<2>(body.first_dof);
      const Eigen::Rotation2Dd turn(q[body.first_dof + 2]);
      for (const Vec2& p : body.outline) x.push_back(centre + turn * p);
      continue;
    }
    for (const Row& row : space_of(body).outline) x.push_back(interpolated(row, q, body.first_dof));
  }
  return x;
}

SparseMatrix Bodies::outline_jacobian(const Vector& q) const {
  Triplets entries;
  for (const Body& body : bodies_) {
    const int d = body.first_dof;
    for (std::size_t k = 0; k < body.outline.size(); ++k) {
      const int at = 2 * (body.first_outline + static_cast<int>(k));
      if (body.compliant()) {
        const Row& row = space_of(body).outline[k];
        for (std::size_t e = 0; e < row.node.size(); ++e)
          for (int c = 0; c < 2; ++c) entries.emplace_back(at + c, d + 2 * row.node[e] + c, row.value[e]);
        continue;
      }
      const Vec2 sweep = turned_left(Eigen::Rotation2Dd(q[d + 2]) * body.outline[k]);
      for (int c = 0; c < 2; ++c)
        entries.emplace_back(at + c, d + c, 1.0), entries.emplace_back(at + c, d + 2, sweep[c]);
    }
  }
  SparseMatrix jacobian(2 * outline_nodes_, dofs_);
  jacobian.setFromTriplets(entries.begin(), entries.end());
  return jacobian;
}

void Bodies::add_turning(const Vector& q, const Vector& residual, Triplets& tangent) const {
  for (const Body& body : bodies_) {
    if (body.compliant()) continue;
    const Eigen::Rotation2Dd turn(q[body.first_dof + 2]);
    double stiffness = 0;  // the second derivative of a rotated arm is minus the arm
    for (std::size_t k = 0; k < body.outline.size(); ++k)
      stiffness -= residual.segment<2>(2 * (body.first_outline + static_cast<int>(k))).dot(turn * body.outline[k]);
    tangent.emplace_back(body.first_dof + 2, body.first_dof + 2, stiffness);
  }
}

std::vector<ContactOutline> Bodies::contact_outlines() const {
  std::vector<ContactOutline> outlines;
  for (const Body& body : bodies_) {
    const std::string& name = body.placed.wall ? body.placed.name : scene_.grains[body.placed.grains].name;
    outlines.push_back({.first = body.first_outline,
                        .count = static_cast<int>(body.outline.size()),
                        .turn_shift = body.turn_shift,
                        .reference = body.outline,
                        .material = material_of(body).name,
                        .name = name,
                        .wall = body.placed.wall,
                        .kind = body.compliant() ? BodyKind::compliant : BodyKind::rigid});
  }
  return outlines;
}

}  // namespace pliant::reference
