#include <algorithm>
#include <map>
#include <random>

#include <fmt/format.h>

#include "bodies/apply_conditions.hpp"
#include "bodies/model.hpp"
#include "bodies/spread_shape.hpp"
#include "core/errors.hpp"
#include "core/random.hpp"
#include "geometry/mesh.hpp"
#include "geometry/placement.hpp"
#include "materials/elastic_constants.hpp"

namespace pliant {
namespace {

int index_of_material(const Scene& scene, const std::string& name) {
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    if (scene.materials[i].name == name) return static_cast<int>(i);
  throw InputError(fmt::format("{}: unknown material '{}'", scene.file.string(), name));
}

/// Batches of at most so many bodies are spread: a spread body costs 0.6 of a batch of eight at 1,000 nodes and 0.5 at 4,000, and threads can share
/// it.
constexpr int sparse_bodies = 2;

/// Shapes met so far, each discretised once as compliant and once as rigid at most.
class ShapeStore {
 public:
  explicit ShapeStore(Model& model) : model_(model) {}

  int compliant(const std::string& name) {
    if (const auto found = compliant_.find(name); found != compliant_.end()) return found->second;
    CompliantShape shape;
    shape.space = discretise(make_field_mesh(model_.scene.shape(name)), model_.scene.discretisation);
    for (double m : shape.space.unit_mass) shape.inverse_unit_mass.push_back(1 / m);
    const FieldMesh& mesh = shape.space.mesh;
    shape.outline = add_outline(Points(mesh.nodes.begin(), mesh.nodes.begin() + mesh.outline_count), 0);
    model_.shapes.push_back(std::move(shape));
    return compliant_[name] = static_cast<int>(model_.shapes.size()) - 1;
  }

  int rigid(const std::string& name) {
    if (const auto found = rigid_.find(name); found != rigid_.end()) return found->second;
    return rigid_[name] = add_outline(make_outline(model_.scene.shape(name)), 0);
  }

  /// The outline of that number for bodies of another size; bodies of one size share it.
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

  /// Index of the spread layout of a compliant shape.
  int spread(int shape) {
    const auto [found, is_new] = spread_.try_emplace(shape, static_cast<int>(model_.spread_shapes.size()));
    if (is_new) model_.spread_shapes.push_back(make_spread_shape(model_.shapes[shape].space));
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
  std::map<int, int> spread_;
};

/// Entry of the mix that each grain gets: exact shares (largest remainder), randomly placed.
std::vector<int> assign_mix(const Grains& grains, int count, std::mt19937_64& random) {
  std::vector<double> shares;
  for (const MixEntry& entry : grains.mix) shares.push_back(entry.share);
  return assign_shares(shares, count, random);
}

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
    for (std::size_t g = 0; g < model_.scene.grains.size(); ++g) add_grains(static_cast<int>(g));
    for (const Wall& wall : model_.scene.walls) add_wall(wall);
    make_batches();
    model_.corrected_mass = !model_.groups.empty() && model_.scene.discretisation.mass == Mass::corrected;
    apply_conditions(model_);
    model_.outline_rates |= depends_on_rates(model_.scene);
    model_.rates |= model_.outline_rates;
    return std::move(model_);
  }

 private:
  void add_grains(int index) {
    const Grains& grains = model_.scene.grains[index];
    const int count = static_cast<int>(grains.packing.grain_count());
    std::mt19937_64 random(grains.seed);
    const std::vector<int> choice = assign_mix(grains, count, random);
    Packed packed = place_grains(model_.scene, grains, random);
    for (ShapeSpec& shape : packed.fitted) model_.scene.shapes.push_back(std::move(shape));
    for (int i = 0; i < count; ++i) {
      const MixEntry& entry = grains.mix[choice[i]];
      const Placement& grain = packed.grains[i];
      Body body;
      body.name = count == 1 ? grains.name : fmt::format("{} {}", grains.name, i);
      body.grains = index;
      body.shape = grain.shape;
      body.kind = entry.body;
      body.material = index_of_material(model_.scene, entry.material);
      body.centre = grain.centre;
      body.angle = grain.angle;
      body.scale = grain.scale;
      if (!options_.scales.empty()) body.scale = options_.scales.at(model_.bodies.size());
      const std::string& shape = model_.scene.shapes[grain.shape].name;
      entry.body == BodyKind::compliant ? add_compliant(std::move(body), shape) : add_rigid(std::move(body), shape);
    }
  }

  void add_compliant(Body body, const std::string& shape_name) {
    const int shape = store_.compliant(shape_name);
    const Material& material = model_.scene.materials[body.material];
    body.outline = store_.scaled(model_.shapes[shape].outline, body.scale);
    body.area = polygon_properties(model_.outlines[body.outline].points).area;
    body.mass = body.area * material.density;
    const auto group = std::find_if(model_.groups.begin(), model_.groups.end(),
                                    [&](const CompliantGroup& g) { return g.shape == shape && g.law == material.law; });
    CompliantGroup& target =
        group != model_.groups.end() ? *group : model_.groups.emplace_back(CompliantGroup{shape, material.law, {}});
    target.bodies.push_back(static_cast<int>(model_.bodies.size()));
    model_.bodies.push_back(std::move(body));
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

  double finest_spacing() const {
    double finest = 1e300;
    for (const OutlineShape& outline : model_.outlines)
      if (outline.turn_shift == 0) finest = std::min(finest, outline.spacing);
    return finest;
  }

  void add_wall(const Wall& wall) {
    const double period = *model_.scene.period;
    const double spacing = wall.spacing > 0 ? wall.spacing : finest_spacing();
    constexpr double most_nodes = 1e6;
    if (period / spacing > most_nodes)
      throw InputError(fmt::format(
          "{}: wall '{}' has the finest outline spacing of the grains, {:.3g} m, and so {:.3g} nodes; allowed: at "
          "most {:.0g}; give its spacing, or take fewer very small grains",
          model_.scene.file.string(), wall.name, spacing, period / spacing, most_nodes));
    const bool below = wall.solid == Wall::Solid::below;
    Points points = wall_outline(wall, period, std::min(spacing, period / 8));
    for (Vec2& p : points) p.y() -= wall.level;
    Body body;
    body.name = wall.name;
    body.wall = true;
    body.material = index_of_material(model_.scene, wall.material);
    body.centre = Vec2(0, wall.level);
    body.outline = store_.add_outline(points, below ? -period : period);
    body.rigid = static_cast<int>(model_.rigid_bodies.size());
    body.area = period * wall.thickness;
    body.mass = body.area * model_.scene.materials[body.material].density;
    RigidBody rigid;
    rigid.body = static_cast<int>(model_.bodies.size());
    rigid.outline = body.outline;
    rigid.driven = true;
    apply_drive(rigid.dof[0], wall.x, body.mass, 0);
    apply_drive(rigid.dof[1], wall.y, body.mass, below ? period : -period);
    apply_drive(rigid.dof[2], Drive{}, body.mass, 0);
    model_.rigid_bodies.push_back(rigid);
    model_.bodies.push_back(std::move(body));
  }

  void make_batches() {
    const bool spread = sparse_nodes() >= std::max(1, options_.least_sparse_nodes);
    std::vector<std::pair<int, int>> alone;  // group and index in it of bodies to be spread
    for (std::size_t g = 0; g < model_.groups.size(); ++g) {
      const int count = static_cast<int>(model_.groups[g].bodies.size());
      for (int first = 0; first < count; first += lane_count) {
        const int bodies = std::min(lane_count, count - first);
        if (!spread || bodies > sparse_bodies)
          add_batch(static_cast<int>(g), first, bodies, Layout::shared);
        else
          for (int i = 0; i < bodies; ++i) alone.emplace_back(g, first + i);
      }
    }
    model_.lane_batches = static_cast<int>(model_.batches.size());
    for (const auto& [group, body] : alone) add_batch(group, body, 1, Layout::spread);
  }

  /// Nodes of bodies that would leave most of their lanes empty.
  int sparse_nodes() const {
    int nodes = 0;
    for (const CompliantGroup& group : model_.groups)
      if (const int rest = static_cast<int>(group.bodies.size()) % lane_count; rest <= sparse_bodies)
        nodes += rest * model_.shapes[group.shape].nodes();
    return nodes;
  }

  void add_batch(int group, int first, int count, Layout layout) {
    const CompliantGroup& members = model_.groups[group];
    Batch batch{};
    batch.group = group, batch.first = first, batch.count = count;
    batch.offset = model_.compliant_size;
    batch.layout = layout;
    for (int lane = 0; lane < lane_count; ++lane) {
      const bool used = lane < count;
      Body& body = model_.bodies[members.bodies[first + std::min(lane, count - 1)]];
      set_constants(batch, lane, body, used || layout == Layout::spread);
      if (used) body.batch = static_cast<int>(model_.batches.size()), body.lane = lane;
    }
    batch.viscous = largest(batch.viscosity) > 0;
    batch.mass_damped = largest(batch.mass_damping) > 0;
    if (layout == Layout::spread) batch.tables = store_.spread(members.shape);
    batch.slots =
        layout == Layout::spread ? model_.spread_shape_of(batch).slots() : model_.shapes[members.shape].nodes();
    model_.compliant_size += 2 * static_cast<std::size_t>(batch.slots);
    add_regions(batch);
    model_.batches.push_back(batch);
  }

  void set_constants(Batch& batch, int lane, const Body& body, bool counts) const {
    const Material& material = model_.scene.materials[body.material];
    const LameConstants lame = lame_constants(material.young, material.poisson);
    batch.mu[lane] = lame.mu;
    batch.lambda[lane] = lame.lambda;
    batch.density[lane] = material.density * body.scale * body.scale;
    batch.inverse_density[lane] = 1 / batch.density[lane];
    batch.scale[lane] = body.scale;
    batch.inverse_scale[lane] = 1 / body.scale;
    batch.scaled |= body.scale != 1;
    batch.weight[lane] = counts ? body.scale * body.scale : 0;
    batch.viscosity[lane] = material.viscosity;
    batch.mass_damping[lane] = material.mass_damping;
    batch.centre_x[lane] = body.centre.x();
    batch.centre_y[lane] = body.centre.y();
  }

  void add_regions(Batch& batch) {
    const int number = static_cast<int>(model_.batches.size());
    batch.first_region = static_cast<int>(model_.regions.size());
    if (batch.layout != Layout::spread) return model_.regions.push_back({number, 0, 0, batch.slots});
    const auto cut = [&](int total, int step, auto add) {
      for (int first = 0; first < total; first += step) add(first, std::min(total, first + step));
    };
    cut(batch.slots, SpreadShape::region_slots, [&](int first, int last) {
      model_.regions.push_back({number, first / SpreadShape::region_slots, first, last});
    });
    batch.regions = static_cast<int>(model_.regions.size()) - batch.first_region;
    cut(model_.spread_shape_of(batch).points(), SpreadShape::chunk_points,
        [&](int first, int last) { model_.point_chunks.push_back({number, first, last}); });
    cut(model_.outlines[model_.shape_of(batch).outline].count, SpreadShape::chunk_nodes,
        [&](int first, int last) { model_.outline_chunks.push_back({number, first, last}); });
  }

  BuildOptions options_;
  Model model_;
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
