#include <algorithm>
#include <map>
#include <random>

#include <fmt/format.h>

#include "bodies/model.hpp"
#include "core/errors.hpp"
#include "geometry/mesh.hpp"
#include "materials/elastic_constants.hpp"

namespace pliant {
namespace {

int index_of_material(const Scene& scene, const std::string& name) {
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    if (scene.materials[i].name == name) return static_cast<int>(i);
  throw InputError(fmt::format("{}: unknown material '{}'", scene.file.string(), name));
}

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

  int add_outline(const Points& points, double turn_shift) {
    model_.outlines.push_back(make_outline_shape(points, turn_shift));
    return static_cast<int>(model_.outlines.size()) - 1;
  }

 private:
  Model& model_;
  std::map<std::string, int> compliant_, rigid_;
};

/// Entry of the mix that each grain gets: exact shares (largest remainder), randomly placed.
std::vector<int> assign_mix(const Grains& grains, int count, std::mt19937_64& random) {
  std::vector<int> choice;
  double share = 0;
  for (std::size_t m = 0; m < grains.mix.size(); ++m) {
    share += grains.mix[m].share;
    const bool last = m + 1 == grains.mix.size();
    const int upto = last ? count : static_cast<int>(std::lround(share * count));
    choice.resize(std::max<std::size_t>(choice.size(), static_cast<std::size_t>(upto)), static_cast<int>(m));
  }
  for (int i = count - 1; i > 0; --i) std::swap(choice[i], choice[random() % static_cast<std::uint64_t>(i + 1)]);
  return choice;
}

double uniform_angle(std::mt19937_64& random) { return 2 * M_PI * static_cast<double>(random() >> 11) * 0x1p-53; }

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

void drive(RigidDof& dof, const Drive& drive, double mass, double pressure_scale) {
  dof.mode = drive.mode;
  dof.history = drive.history;
  dof.force_scale = drive.mode == Drive::Mode::pressure ? pressure_scale : 1;
  dof.mass = mass;
  dof.inverse_mass = dof.imposed() ? 0 : 1 / mass;
}

/// Whether some force of the scene depends on velocities.
bool depends_on_rates(const Scene&) { return false; }

class Builder {
 public:
  explicit Builder(const Scene& scene) : store_(model_) { model_.scene = scene; }

  Model build() {
    for (std::size_t g = 0; g < model_.scene.grains.size(); ++g) add_grains(static_cast<int>(g));
    for (const Wall& wall : model_.scene.walls) add_wall(wall);
    make_batches();
    model_.corrected_mass = !model_.groups.empty() && model_.scene.discretisation.mass == Mass::corrected;
    model_.rates = depends_on_rates(model_.scene);
    return std::move(model_);
  }

 private:
  void add_grains(int index) {
    const Grains& grains = model_.scene.grains[index];
    const Points centres = packing_positions(grains.packing, model_.scene.period);
    const int count = static_cast<int>(centres.size());
    std::mt19937_64 random(grains.seed);
    const std::vector<int> choice = assign_mix(grains, count, random);
    for (int i = 0; i < count; ++i) {
      const MixEntry& entry = grains.mix[choice[i]];
      Body body;
      body.name = count == 1 ? grains.name : fmt::format("{} {}", grains.name, i);
      body.grains = index;
      body.kind = entry.body;
      body.material = index_of_material(model_.scene, entry.material);
      body.centre = centres[i];
      body.angle = grains.angle ? *grains.angle : uniform_angle(random);
      entry.body == BodyKind::compliant ? add_compliant(std::move(body), grains.shape)
                                        : add_rigid(std::move(body), grains.shape);
    }
  }

  void add_compliant(Body body, const std::string& shape_name) {
    const int shape = store_.compliant(shape_name);
    const Material& material = model_.scene.materials[body.material];
    body.outline = model_.shapes[shape].outline;
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
    body.outline = store_.rigid(shape_name);
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
    drive(rigid.dof[0], wall.x, body.mass, 0);
    drive(rigid.dof[1], wall.y, body.mass, below ? period : -period);
    drive(rigid.dof[2], Drive{}, body.mass, 0);
    model_.rigid_bodies.push_back(rigid);
    model_.bodies.push_back(std::move(body));
  }

  void make_batches() {
    for (std::size_t g = 0; g < model_.groups.size(); ++g) {
      const int count = static_cast<int>(model_.groups[g].bodies.size());
      for (int first = 0; first < count; first += lane_count)
        add_batch(static_cast<int>(g), first, std::min(lane_count, count - first));
    }
  }

  void add_batch(int group, int first, int count) {
    Batch batch{group, first, count, model_.compliant_size, {}, {}, {}, {}, {}, {}, {}};
    const CompliantGroup& members = model_.groups[group];
    for (int lane = 0; lane < lane_count; ++lane) {
      Body& body = model_.bodies[members.bodies[first + std::min(lane, count - 1)]];
      const Material& material = model_.scene.materials[body.material];
      const LameConstants lame = lame_constants(material.young, material.poisson);
      batch.mu[lane] = lame.mu;
      batch.lambda[lane] = lame.lambda;
      batch.density[lane] = material.density;
      batch.inverse_density[lane] = 1 / material.density;
      batch.weight[lane] = lane < count ? 1 : 0;
      batch.centre_x[lane] = body.centre.x();
      batch.centre_y[lane] = body.centre.y();
      if (lane < count) body.batch = static_cast<int>(model_.batches.size()), body.lane = lane;
    }
    model_.compliant_size += static_cast<std::size_t>(2 * model_.shapes[members.shape].nodes());
    model_.batches.push_back(batch);
  }

  Model model_;
  ShapeStore store_;
};

}  // namespace

Model build_model(const Scene& scene) { return Builder(scene).build(); }

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
