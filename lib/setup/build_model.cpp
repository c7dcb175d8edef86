#include "setup/build_model.hpp"

#include <algorithm>
#include <map>

#include "bodies/make_batches.hpp"
#include "boundary/apply_conditions.hpp"
#include "core/located.hpp"
#include "geometry/assembly.hpp"
#include "geometry/mesh.hpp"
#include "geometry/shape_families.hpp"

namespace pliant {
namespace {

/// Shapes found so far, each discretised at most once as compliant and once as rigid.
class ShapeStore {
 public:
  explicit ShapeStore(Model& model) : model_(model) {}

  int compliant(const std::string& name) {
    if (const auto found = compliant_.find(name); found != compliant_.end()) return found->second;
    const auto found = same_topology_.find(name);
    const bool alone = found == same_topology_.end();
    CompliantShape shape;
    const ShapeSpec& spec = model_.scene.shape(name);
    shape.space = located(spec.where, [&] {
      return discretise(alone ? make_field_mesh(spec) : found->second.mesh, model_.scene.discretisation);
    });
    if (!alone) shape.family = found->second.family;
    for (double m : shape.space.mass_at_unit_density) shape.inverse_mass_at_unit_density.push_back(1 / m);
    const FieldMesh& mesh = shape.space.mesh;
    shape.outline = add_outline(Points(mesh.nodes.begin(), mesh.nodes.begin() + mesh.outline_count), 0);
    model_.shapes.push_back(std::move(shape));
    return compliant_[name] = static_cast<int>(model_.shapes.size()) - 1;
  }

  int rigid(const std::string& name) {
    if (const auto found = rigid_.find(name); found != rigid_.end()) return found->second;
    const ShapeSpec& spec = model_.scene.shape(name);
    return rigid_[name] = add_outline(located(spec.where, [&] { return make_outline(spec); }), 0);
  }

  /// Sets meshes that replace the shapes' own.
  void set_meshes(std::map<std::string, SharedTopologyMesh> meshes) { same_topology_ = std::move(meshes); }

  /// Outline of that index for bodies of another size; bodies of one size share it.
  int scaled(int outline, double scale) {
    if (scale == 1) return outline;
    const auto [found, is_new] = scaled_.try_emplace({outline, scale}, 0);
    if (is_new) {
      Points points = model_.outlines[outline].points;
      for (Vec2& p : points) p *= scale;
      found->second = add_outline(points, 0);
    }
    return found->second;
  }

  int add_outline(const Points& points, double turn_shift) {
    model_.outlines.push_back(make_outline_shape(points, turn_shift));
    return static_cast<int>(model_.outlines.size()) - 1;
  }

 private:
  Model& model_;
  std::map<std::string, int> compliant_, rigid_;
  std::map<std::pair<int, double>, int> scaled_;
  std::map<std::string, SharedTopologyMesh> same_topology_;
};

RigidBody make_rigid_body(int body, int outline, const OutlineShape& shape, double density) {
  const PolygonProperties properties = polygon_properties(shape.points);
  RigidBody rigid;
  rigid.body = body;
  rigid.outline = outline;
  for (const Vec2& p : shape.points) rigid.max_radius = std::max(rigid.max_radius, p.norm());
  const double mass = density * properties.area;
  const double masses[3] = {mass, mass, density * properties.polar_moment};
  for (int c = 0; c < 3; ++c) {
    rigid.dof[c].mass = masses[c];
    rigid.dof[c].inverse_mass = 1 / masses[c];
  }
  return rigid;
}

/// Whether some force between outlines depends on velocities.
bool depends_on_rates(const Scene& scene) {
  return std::any_of(scene.contacts.begin(), scene.contacts.end(),
                     [](const ContactRule& rule) { return rule.restitution.value_or(1) < 1; });
}

class Builder {
 public:
  Builder(const Scene& scene, const BuildOptions& options) : options_(options), store_(model_) { model_.scene = scene; }

  Model build() {
    const std::vector<PlacedBody> placed = place_bodies(model_.scene);
    for (const PlacedBody& body : placed)
      if (!body.wall) add_grain(body);
    if (options_.unite_topologies)
      store_.set_meshes(same_topology_meshes(model_.scene, placed, options_.least_sparse_nodes));
    build_compliant();
    for (const PlacedBody& body : placed)
      if (body.wall) add_wall(body);
    make_batches(model_, options_.least_sparse_nodes);
    lay_out_outlines();
    const DiscretisationSettings& space = model_.scene.discretisation;
    model_.has_reciprocal_mass = !model_.groups.empty() && (space.mass == Mass::corrected || space.mass_scaling > 1);
    apply_conditions(model_);
    model_.outline_rates |= depends_on_rates(model_.scene);
    model_.rates |= model_.outline_rates;
    return std::move(model_);
  }

 private:
  void add_grain(const PlacedBody& placed) {
    Body body{placed};
    if (!options_.scales.empty()) body.scale = options_.scales.at(model_.bodies.size());
    const std::string& shape = model_.scene.shapes[body.shape].name;
    body.kind == BodyKind::compliant ? add_compliant(std::move(body), shape) : add_rigid(std::move(body), shape);
  }

  /// The body's shape is discretised later, when all bodies are known.
  void add_compliant(Body body, const std::string& shape) {
    compliant_.push_back({static_cast<int>(model_.bodies.size()), shape});
    model_.bodies.push_back(std::move(body));
  }

  void build_compliant() {
    for (const auto& [number, name] : compliant_) {
      Body& body = model_.bodies[number];
      const int shape = body.compliant_shape = store_.compliant(name);
      const Material& material = model_.scene.materials[body.material];
      body.outline = store_.scaled(model_.shapes[shape].outline, body.scale);
      body.area = polygon_properties(model_.outlines[body.outline].points).area;
      body.mass = body.area * material.density;
      group_for(shape, material.law).bodies.push_back(number);
    }
  }

  CompliantGroup& group_for(int shape, MaterialLaw law) {
    const int family = model_.shapes[shape].family;
    for (CompliantGroup& group : model_.groups)
      if (group.law == law && (group.shape == shape || (family >= 0 && model_.shapes[group.shape].family == family)))
        return group;
    return model_.groups.emplace_back(CompliantGroup{shape, law, {}});
  }

  void add_rigid(Body body, const std::string& shape_name) {
    body.outline = store_.scaled(store_.rigid(shape_name), body.scale);
    body.rigid = static_cast<int>(model_.rigid_bodies.size());
    const double density = model_.scene.materials[body.material].density;
    const OutlineShape& outline = model_.outlines[body.outline];
    model_.rigid_bodies.push_back(
        make_rigid_body(static_cast<int>(model_.bodies.size()), body.outline, outline, density));
    body.mass = model_.rigid_bodies.back().dof[0].mass;
    body.area = body.mass / density;
    model_.bodies.push_back(std::move(body));
  }

  /// Finest outline spacing of all grains, m.
  double finest_spacing() const {
    double finest = 1e300;
    for (const Body& body : model_.bodies)
      if (!body.wall) finest = std::min(finest, model_.outlines[body.outline].spacing);
    return finest;
  }

  void add_wall(const PlacedBody& placed) {
    const Wall& wall = model_.scene.walls[placed.number_of_wall];
    const double period = *model_.scene.period;
    const bool below = wall.solid == Wall::Solid::below;
    Body body{placed};
    body.outline = store_.add_outline(wall_points(model_.scene, wall, finest_spacing()), below ? -period : period);
    body.rigid = static_cast<int>(model_.rigid_bodies.size());
    body.area = period * wall.thickness;
    body.mass = body.area * model_.scene.materials[body.material].density;
    RigidBody rigid;
    rigid.body = static_cast<int>(model_.bodies.size());
    rigid.outline = body.outline;
    rigid.driven = true;
    apply_axis_condition(rigid.dof[0], wall.x, body.mass, 0);
    apply_axis_condition(rigid.dof[1], wall.y, body.mass, below ? period : -period);
    apply_axis_condition(rigid.dof[2], AxisCondition{}, body.mass, 0);
    model_.rigid_bodies.push_back(rigid);
    model_.bodies.push_back(std::move(body));
  }

  void lay_out_outlines() {
    int next = 0;
    for (const Body& body : model_.bodies) {
      model_.outline_offset.push_back(next);
      next += model_.outlines[body.outline].count + lane_count;
    }
    model_.outline_offset.push_back(next);
  }

  BuildOptions options_;
  Model model_;
  std::vector<std::pair<int, std::string>> compliant_;  ///< bodies and their shapes
  ShapeStore store_;
};

}  // namespace

Model build_model(const Scene& scene, const BuildOptions& options) { return Builder(scene, options).build(); }

int Model::dof_count() const {
  int count = 3 * static_cast<int>(rigid_bodies.size());
  for (const CompliantGroup& group : groups)
    count += 2 * shapes[group.shape].nodes() * static_cast<int>(group.bodies.size());
  return count;
}

int Model::node_count() const {
  int count = 0;
  for (const CompliantGroup& group : groups)
    count += shapes[group.shape].nodes() * static_cast<int>(group.bodies.size());
  for (const RigidBody& rigid : rigid_bodies) count += outlines[rigid.outline].count;
  return count;
}

}  // namespace pliant
