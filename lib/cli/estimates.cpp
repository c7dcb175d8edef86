#include "cli/estimates.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "scene/quantities.hpp"

namespace pliant {
namespace {

/// Share of a frame that is left after compression: in the scenes of cases/ 0.45 (rigid grains) to 0.76 (a deformed
/// disc).
constexpr double compressed_share = 0.7;
/// Measured on the same: HDF5's index of a dataset, its groups of a frame, the topology's groups; XDMF's text; a cell
/// or row of a CSV file.
constexpr double dataset_bytes = 2600, frame_groups_bytes = 1600, file_bytes = 100'000;
constexpr double xdmf_dataset_bytes = 240, xdmf_frame_bytes = 1300;
/// Pairs in touch of a dense packing of equal discs, and the columns of results/contact_network.hpp.
constexpr double pairs_a_body = 3, contact_values = 8;
constexpr double probe_cell_bytes = 17, step_row_bytes = 75;

/// Points and cells of the grids of a frame.
struct GridSize {
  double points = 0, cells = 0, outline_points = 0;
};

double values_of(const FrameField& field, const GridSize& size) {
  if (field.constant) return 0;
  const double entries = field.grid == FrameField::Grid::outlines   ? size.outline_points
                         : field.centre == FrameField::Centre::cell ? size.cells
                                                                    : size.points;
  return entries * (field.components == 2 ? 3 : field.components);
}

GridSize grid_size(const Model& model) {
  GridSize size;
  for (const Body& body : model.bodies) {
    const double n = model.outlines[body.outline].count;
    size.outline_points += n;
    if (body.wall) continue;
    const bool compliant = body.kind == BodyKind::compliant;
    const FieldMesh* mesh = compliant ? &model.shape_of(body).space.mesh : nullptr;
    size.points += mesh ? static_cast<double>(mesh->nodes.size()) : n;
    size.cells += mesh ? static_cast<double>(mesh->triangles.size()) : n - 2;
  }
  return size;
}

/// 1/m of a body's outline where it is round all over or in its asperities; 0 where it may lie flat.
double curvature_of(const Model& model, const Body& body) {
  if (!body.wall) {
    const ShapeSpec& shape = model.scene.shapes[body.shape];
    return shape.kind == ShapeKind::disc ? 2 / (body.scale * shape.diameter) : 0;
  }
  for (const Wall& wall : model.scene.walls)
    if (wall.name == body.name && wall.asperities) return 2 / wall.asperities->diameter;
  return 0;
}

std::string material_label(const Model& model, const Body& body) {
  const Material& material = model.scene.materials[body.material];
  if (body.wall) return "wall of " + material.name;
  const bool could_be_compliant = body.kind == BodyKind::rigid && material.law != MaterialLaw::rigid;
  return could_be_compliant ? material.name + " (rigid)" : material.name;
}

/// Outlines made alike differ by rounding.
bool same(double a, double b) { return std::abs(a - b) <= 1e-3 * std::max(std::abs(a), std::abs(b)); }

bool alike(const PairEstimate& a, const PairEstimate& b) {
  const bool names = a.first == b.first && a.second == b.second;
  return names && a.friction == b.friction && same(a.stiffness, b.stiffness) && same(a.spacing, b.spacing) &&
         same(a.curvature, b.curvature);
}

PairEstimate make_pair_of(const Model& model, const LawTable& laws, int first, int second) {
  const Body &a = model.bodies[first], &b = model.bodies[second];
  const ContactLaw law = laws.between(first, second);
  PairEstimate pair;
  pair.first = material_label(model, a), pair.second = material_label(model, b);
  if (!b.wall && (a.wall || pair.second < pair.first)) std::swap(pair.first, pair.second);
  pair.law = std::visit([](const auto& l) { return l.name; }, law);
  pair.automatic = laws.automatic_stiffness(first, second);
  std::visit([&](const auto& l) { pair.stiffness = l.normal_stiffness; }, law);
  std::visit([&](const auto& l) { pair.shear_stiffness = l.has_shear ? l.shear_stiffness : 0; }, law);
  const auto find_strength = [&](const auto& l) {
    if constexpr (requires { l.strength; }) pair.strength = l.strength;
  };
  std::visit(find_strength, law);
  const auto find_friction = [&](const auto& l) {
    if constexpr (requires { l.friction; }) pair.friction = l.friction;
  };
  std::visit(find_friction, law);
  pair.reach = reach_of(law);
  pair.spacing = std::min(model.outlines[a.outline].spacing, model.outlines[b.outline].spacing);
  if (a.kind == BodyKind::compliant || b.kind == BodyKind::compliant) return pair;
  const double of_a = curvature_of(model, a), of_b = curvature_of(model, b);
  pair.curvature = of_a + of_b;
  if (pair.curvature > 0) pair.width = 2 / std::max(of_a, of_b);
  return pair;
}

/// Of the bodies of each group, grains and walls apart, the one with the finest outline, another, and the one with the
/// coarsest.
std::vector<std::vector<int>> representatives(const Model& model, const LawTable& laws) {
  std::map<std::pair<int, bool>, std::vector<int>> groups;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
    groups[{laws.group(b), model.bodies[b].wall}].push_back(b);
  std::vector<std::vector<int>> result;
  for (auto& [group, members] : groups) {
    std::stable_sort(members.begin(), members.end(), [&](int a, int b) { return laws.spacing(a) < laws.spacing(b); });
    if (members.size() > 3) members = {members[0], members[1], members.back()};
    result.push_back(members);
  }
  return result;
}

/// Of its outline, whichever way it turns, m.
double width_of(const Model& model, const Body& body) {
  double square = 0;
  for (const Vec2& p : model.outlines[body.outline].points) square = std::max(square, p.squaredNorm());
  return 2 * std::sqrt(square);
}

double largest_until(const History& history, double end) {
  double largest = std::max(std::abs(history.at(0)), std::abs(history.at(end)));
  for (std::size_t i = 0; i < history.time.size() && history.time[i] <= end; ++i)
    largest = std::max(largest, std::abs(history.value[i]));
  return largest;
}

}  // namespace

double largest_pressure(const Scene& scene) {
  double largest = 0;
  for (const Wall& wall : scene.walls) {
    const double load = largest_until(wall.y.history, scene.time.end);
    if (wall.y.mode == AxisCondition::Mode::pressure) largest = std::max(largest, load);
    if (wall.y.mode == AxisCondition::Mode::force) largest = std::max(largest, load / *scene.period);
  }
  return largest;
}

double PairEstimate::penetration(double pressure) const {
  if (curvature == 0) return pressure / stiffness;
  return std::pow(3 * pressure * width / (4 * stiffness * std::sqrt(2 / curvature)), 2.0 / 3.0);
}

std::vector<PairEstimate> pair_estimates(const Model& model, const LawTable& laws) {
  const std::vector<std::vector<int>> groups = representatives(model, laws);
  std::vector<PairEstimate> pairs;
  const auto is_known = [&](const PairEstimate& pair) {
    return std::any_of(pairs.begin(), pairs.end(), [&](const PairEstimate& other) { return alike(other, pair); });
  };
  const auto add = [&](int first, int second) {
    const Body &a = model.bodies[first], &b = model.bodies[second];
    if (a.wall && b.wall) return;
    // A body as wide as the period touches its own image.
    if (first == second && !(model.scene.is_periodic() && width_of(model, a) >= model.scene.shortest_period())) return;
    const PairEstimate pair = make_pair_of(model, laws, first, second);
    if (!is_known(pair)) pairs.push_back(pair);
  };
  for (auto i = groups.begin(); i != groups.end(); ++i)
    for (auto j = i; j != groups.end(); ++j)
      for (const int first : *i)
        for (const int second : *j) add(first, second);
  return pairs;
}

std::int64_t output_count(double period, double end) {
  constexpr double rounding = 1e-9;
  return period > 0 ? static_cast<std::int64_t>(std::floor(end / period * (1 + rounding))) + 1 : 0;
}

double frame_bytes(const Model& model) {
  const GridSize size = grid_size(model);
  double values = 2 * size.points + 2 * size.outline_points;
  for (const std::string& field : model.scene.frames.fields) values += values_of(frame_field(field), size);
  if (model.scene.frames.contacts) values += pairs_a_body * contact_values * static_cast<double>(model.bodies.size());
  return sizeof(float) * values;
}

OutputSize output_size(const Model& model, double steps) {
  const Scene& scene = model.scene;
  OutputSize size;
  size.frames = output_count(scene.frames.period, scene.time.end);
  const double frames = static_cast<double>(size.frames),
               datasets = 2 + static_cast<double>(scene.frames.fields.size()) + (scene.frames.contacts ? 5 : 0);
  if (size.frames > 0) {
    size.frames_h5 =
        file_bytes + frames * (compressed_share * frame_bytes(model) + datasets * dataset_bytes + frame_groups_bytes);
    size.frames_xdmf = frames * (xdmf_frame_bytes + datasets * xdmf_dataset_bytes);
  }
  double cells = 1;
  for (const Probe& probe : scene.probes) {
    size.probe_rows = std::max(size.probe_rows, output_count(probe.period, scene.time.end));
    cells += static_cast<double>(probe_quantity(probe.quantity).columns.size());
  }
  size.probes_csv = static_cast<double>(size.probe_rows) * cells * probe_cell_bytes;
  constexpr double all = 200'000, thinned = 10;  // of StepLog
  size.step_rows = static_cast<std::int64_t>(std::min(steps, all) + std::max(0.0, steps - all) / thinned);
  size.steps_csv = static_cast<double>(size.step_rows) * step_row_bytes;
  return size;
}

double least_steps(const Scene& scene, double time, double largest_dt) {
  double period = time;
  if (scene.time.stop_at_outputs) {
    if (scene.frames.period > 0) period = std::min(period, scene.frames.period);
    for (const Probe& probe : scene.probes) period = std::min(period, probe.period);
  }
  return time > 0 ? time / period * std::ceil(period / largest_dt) : 0;
}

}  // namespace pliant
