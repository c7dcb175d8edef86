#include "benchmarks/kernels/scenes.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <random>
#include <utility>

#include "bodies/body_view.hpp"
#include "bodies/initial_state.hpp"
#include "bodies/place_outlines.hpp"
#include "geometry/curves.hpp"
#include "input/read_scene.hpp"
#include "run/checkpoint.hpp"
#include "setup/build_model.hpp"

namespace pliant::kernels {
namespace {

constexpr double diameter = 1e-6, pitch = 1.5e-6;
constexpr int nodes = 168;

Scene bare(DiscretisationMethod method) {
  Scene scene;
  scene.name = scene.title = "grains";
  scene.time.end = 1;
  scene.discretisation.method = method;
  scene.materials = {{"soft", MaterialLaw::neo_hookean, 1200, 2e9, 0.4}};
  scene.contacts.emplace_back();
  scene.contacts[0].first = scene.contacts[0].second = "all";
  return scene;
}

/// Grains of one shape on a square grid, turned at random.
void add_grains(Scene& scene, const ShapeSpec& shape, int columns, int rows, const Vec2& origin) {
  scene.shapes.push_back(shape);
  Grains grains;
  grains.name = grains.shape = shape.name;
  grains.packing = {PackingKind::grid, columns, rows, pitch, pitch, origin, {}};
  grains.species = {{BodyKind::compliant, "soft", 1}};
  grains.angle.reset();
  grains.seed = 1;
  scene.grains.push_back(grains);
}

ShapeSpec disc(int field_nodes) {
  ShapeSpec shape;
  shape.name = "disc";
  shape.diameter = diameter;
  shape.nodes = field_nodes;
  return shape;
}

Model same_topology_model() {
  constexpr int count = 200, columns = 20;
  Scene scene = bare(DiscretisationMethod::mls);
  for (int i = 0; i < count; ++i) {
    ShapeSpec shape;
    shape.name = "grain" + std::to_string(i);
    shape.kind = ShapeKind::curve;
    shape.points = fourier_grain(diameter, {0.08, 0.03}, i + 1);
    shape.nodes = nodes;
    shape.outline_nodes = 50;
    add_grains(scene, shape, 1, 1, pitch * Vec2(i % columns, static_cast<double>(i / columns)));
  }
  return build_model(scene, {.least_sparse_nodes = 0, .unite_topologies = true, .scales = {}});
}

/// Every body strained otherwise, some percent, with a little noise.
void deform(const Model& model, Dofs& q) {
  std::mt19937_64 random(1);
  const auto uniform = [&](double size) { return size * (static_cast<double>(random() >> 11) * 0x1p-52 - 1); };
  for (const Body& body : model.bodies) {
    const double a = uniform(0.05), b = uniform(0.05), c = uniform(0.05);
    const BodyOffsets offsets(model, body);
    for (int i = 0; i < model.shape_of(body).nodes(); ++i) {
      const auto node = static_cast<std::size_t>(i);
      const Vec2 x = BodyView(model, body, q)[node];
      const double noise_x = uniform(1e-4 * diameter), noise_y = uniform(1e-4 * diameter);
      set_node(offsets, node, x + Vec2(a * x.x() + b * x.y() + noise_x, c * x.x() - a * x.y() + noise_y), q);
    }
  }
  fill_padding(model, q);
}

const std::optional<Checkpoint>& checkpoint() {
  static const std::optional<Checkpoint> found = []() -> std::optional<Checkpoint> {
    const char* folder = std::getenv("PLIANT_BENCH_FROM");
    if (!folder) return {};
    return Checkpoint(folder);
  }();
  return found;
}

Model with_law(Model model, ContactLawKind law, ContactQuadrature quadrature) {
  model.scene.contact.quadrature = quadrature;
  for (ContactRule& rule : model.scene.contacts) {
    if (rule.law == law) continue;
    ContactRule other;
    other.first = rule.first, other.second = rule.second;
    other.law = law;
    other.stiffness = rule.stiffness;
    if (law == ContactLawKind::mohr_coulomb) other.friction = 0.3;
    if (law == ContactLawKind::cohesive) other.strength = 400e6;
    rule = other;
  }
  return model;
}

}  // namespace

Cloud::Cloud(Model built) : model(std::move(built)), forces(model) {
  state.position = initial_positions(model);
  deform(model, state.position);
  state.reduced_momentum = zero_dofs(model);
  state.force = zero_dofs(model);
  state.memory = initial_memory(model);
  find_forces(forces, state);
  verlet = std::make_unique<Verlet>(forces, state);
}

Cloud& grains_of(DiscretisationMethod method) {
  static std::map<DiscretisationMethod, std::unique_ptr<Cloud>> clouds;
  std::unique_ptr<Cloud>& cloud = clouds[method];
  if (!cloud) {
    Scene scene = bare(method);
    add_grains(scene, disc(nodes), 40, 25, {0, 0});
    cloud = std::make_unique<Cloud>(build_model(scene));
  }
  return *cloud;
}

Cloud& grains_with(MaterialLaw law, double yield) {
  static std::map<std::pair<MaterialLaw, double>, std::unique_ptr<Cloud>> clouds;
  std::unique_ptr<Cloud>& cloud = clouds[{law, yield}];
  if (!cloud) {
    Scene scene = bare(DiscretisationMethod::mls);
    Material& soft = scene.materials[0];
    soft.law = law;
    soft.branch_modulus = 1e9, soft.relaxation_time = 1e-6;
    soft.yield = soft.cohesion = yield, soft.saturation = 2 * yield, soft.saturation_rate = 10;
    soft.friction_angle = 0.5, soft.dilatancy_angle = 0.1;
    add_grains(scene, disc(nodes), 40, 25, {0, 0});
    cloud = std::make_unique<Cloud>(build_model(scene));
  }
  return *cloud;
}

Cloud& same_topology() {
  static Cloud cloud(same_topology_model());
  return cloud;
}

Cloud& large_body() {
  static Cloud cloud([] {
    Scene scene = bare(DiscretisationMethod::mls);
    add_grains(scene, disc(10'000), 1, 1, {0, 0});
    return build_model(scene);
  }());
  return cloud;
}

Simulation& third_body() {
  static const Model model =
      build_model(read_scene(checkpoint() ? std::filesystem::path(std::getenv("PLIANT_BENCH_FROM")) / "scene.toml"
                                          : std::filesystem::path(PLIANT_SOURCE_DIR "/cases/third_body.toml")));
  static Simulation simulation(model);
  if (simulation.state().steps > 0) return simulation;
  if (checkpoint()) {
    const std::filesystem::path scratch = std::filesystem::temp_directory_path() / "pliant_bench";
    std::filesystem::remove_all(scratch);
    std::filesystem::copy(std::getenv("PLIANT_BENCH_FROM"), scratch);
    {
      Recorder recorder(model, scratch, true, Opening::resume);
      checkpoint()->restore(simulation, recorder);
    }
    std::filesystem::remove_all(scratch);
  }
  for (int i = 0; i < 300; ++i) simulation.step(1e300);
  return simulation;
}

ContactScene::ContactScene(ContactLawKind law, ContactQuadrature quadrature)
    : model(with_law(third_body().model(), law, quadrature)), before(third_body().state().position), contact(model) {
  Simulation& simulation = third_body();
  at_first = simulation.state().outlines;
  for (int i = 0; i < 5; ++i) simulation.step(1e300);
  now = simulation.state().position;
  outlines = simulation.state().outlines;
  contact.find_candidates(at_first, history);
  contact.forces(at_first, history, trial, force);
  std::swap(history, trial);
  contact.forces(outlines, history, trial, force);
}

ContactScene& third_body_with(ContactLawKind law, ContactQuadrature quadrature) {
  static std::map<std::pair<ContactLawKind, ContactQuadrature>, std::unique_ptr<ContactScene>> scenes;
  std::unique_ptr<ContactScene>& scene = scenes[{law, quadrature}];
  if (!scene) scene = std::make_unique<ContactScene>(law, quadrature);
  return *scene;
}

const char* name_of(ContactLawKind law) {
  switch (law) {
    case ContactLawKind::frictionless:
      return "frictionless";
    case ContactLawKind::mohr_coulomb:
      return "mohr-coulomb";
    case ContactLawKind::cohesive:
      return "cohesive";
  }
  return "";
}

}  // namespace pliant::kernels
