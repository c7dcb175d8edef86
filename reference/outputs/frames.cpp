#include "reference/outputs/frames.hpp"

#include <functional>
#include <limits>
#include <map>
#include <utility>

#include "scene/quantities.hpp"

namespace pliant::reference {
namespace {

std::vector<Field> described(const std::vector<std::string>& names) {
  std::vector<Field> result;
  for (const std::string& name : names) {
    const FrameField& field = frame_field(name);
    const auto centre = field.centre == FrameField::Centre::point ? Field::Centre::point : Field::Centre::cell;
    result.push_back({name, centre, field.components});
  }
  return result;
}

void append(const Points& points, std::vector<float>& values) {
  for (const Vec2& p : points)
    for (const double x : {p.x(), p.y()}) values.push_back(static_cast<float>(x));
}

using AtPoint = double (*)(const PointStress&);

/// Fields in the cells of compliant bodies, and their value in rigid ones.
const std::map<std::string, std::pair<AtPoint, double>>& cell_fields() {
  static const std::map<std::string, std::pair<AtPoint, double>> all{
      {"von_mises", {von_mises, 0}},
      {"pressure", {[](const PointStress& s) { return -(s.xx + s.yy + s.zz) / 3; }, 0}},
      {"jacobian", {[](const PointStress& s) { return s.jacobian; }, 1}},
      {"strain_energy_density", {[](const PointStress& s) { return s.energy; }, 0}},
      {"plastic_strain", {[](const PointStress& s) { return s.plastic_strain; }, 0}},
      {"stress_xx", {[](const PointStress& s) { return s.xx; }, 0}},
      {"stress_yy", {[](const PointStress& s) { return s.yy; }, 0}},
      {"stress_xy", {[](const PointStress& s) { return s.xy; }, 0}},
      {"stress_zz", {[](const PointStress& s) { return s.zz; }, 0}}};
  return all;
}

using NodeField = std::function<Points(const View&, const Body&)>;

const std::map<std::string, NodeField>& node_fields() {
  static const std::map<std::string, NodeField> all{
      {"velocity", [](const View& view, const Body& body) { return view.velocities_of(body); }},
      {"acceleration", [](const View& view, const Body& body) { return view.accelerations_of(body); }},
      {"displacement", [](const View& view, const Body& body) {
         Points points = view.positions_of(body);
         const Points start = view.start_of(body);
         for (std::size_t k = 0; k < points.size(); ++k) points[k] -= start[k];
         return points;
       }}};
  return all;
}

/// [triangles] mean over the points that represent each.
std::vector<double> cell_values(const View& view, const Body& body, const FieldMesh& mesh, AtPoint at, double rigid) {
  std::vector<double> sum(mesh.triangles.size(), body.compliant() ? 0.0 : rigid), whole(mesh.triangles.size(), 1);
  if (!body.compliant()) return sum;
  std::fill(whole.begin(), whole.end(), 0.0);
  const std::vector<PointStress> stresses = view.stresses_of(body);
  const std::vector<Point>& points = view.bodies().space_of(body).points;
  for (std::size_t g = 0; g < points.size(); ++g)
    for (const int t : points[g].triangles) sum[t] += points[g].weight * at(stresses[g]), whole[t] += points[g].weight;
  for (std::size_t t = 0; t < sum.size(); ++t) sum[t] /= whole[t];
  return sum;
}

/// [outline nodes] normal part of the contact force over the tributary length, Pa.
std::vector<double> contact_pressures(const View& view) {
  const Points forces = view.contact_forces(), x = view.bodies().outline_positions(view.positions());
  std::vector<double> pressures(forces.size(), 0.0);
  for (const Body& body : view.bodies().all()) {
    const std::size_t n = body.outline.size(), first = static_cast<std::size_t>(body.first_outline);
    for (std::size_t k = 0; k < n; ++k) {
      const bool starts = k == 0, ends = k + 1 == n;
      const Vec2 shift(body.turn_shift, 0);
      const Vec2 along = (x[first + (ends ? 0 : k + 1)] + (ends ? shift : Vec2(0, 0))) -
                         (x[first + (starts ? n - 1 : k - 1)] - (starts ? shift : Vec2(0, 0)));
      const auto& at = body.outline;
      const double length = 0.5 * ((at[ends ? 0 : k + 1] + (ends ? shift : Vec2(0, 0)) - at[k]).norm() +
                                   (at[k] - at[starts ? n - 1 : k - 1] + (starts ? shift : Vec2(0, 0))).norm());
      const Vec2 inward = Vec2(-along.y(), along.x()).normalized();
      pressures[first + k] = forces[first + k].dot(inward) / length;
    }
  }
  return pressures;
}

constexpr const char* periods_name = "cell";

/// Vectors of the periods of a cell, m: a table of one row.
FrameTable periods_table(const Periods& periods) {
  FrameTable table{periods_name, {{"a", 2, {}}, {"b", 2, {}}}};
  for (const int i : {0, 1})
    append(Points{periods.vectors().col(i)}, table.columns[static_cast<std::size_t>(i)].values);
  return table;
}

float kind_of(const Body& body) { return body.placed.wall ? 2 : body.compliant() ? 0 : 1; }

}  // namespace

/// Grid to which bodies are added one by one.
struct FrameOutput::NewGrid {
  Grid grid;
  GridTopology topology{{}, {{}, {}}};

  NewGrid(const char* name, int cell_size, const std::vector<std::string>& fields)
      : grid{name,
             0,
             cell_size,
             0,
             {{"kind", Field::Centre::cell, 1}, {"body", Field::Centre::cell, 1}},
             described(fields)} {}

  template <class Nodes>
  void add_cell(const Body& body, std::size_t number, const Nodes& nodes) {
    for (const int node : nodes) topology.cells.push_back(grid.points + node);
    topology.values[0].push_back(kind_of(body));
    topology.values[1].push_back(static_cast<float>(number));
    ++grid.cells;
  }
};

FrameOutput::FrameOutput(const Bodies& bodies, const std::filesystem::path& folder)
    : bodies_(bodies), period_(bodies.scene().frames.period) {
  if (period_ == 0) return;
  for (const Body& body : bodies.all())
    meshes_.push_back(body.placed.wall || body.compliant() ? FieldMesh{}
                                                           : make_rigid_mesh(bodies.scene().shapes[body.placed.shape]));
  for (const std::string& name : bodies.scene().frames.fields) {
    if (cell_fields().contains(name) || node_fields().contains(name))
      body_fields_.push_back(name);
    else if (name == "contact_pressure")
      outline_fields_.push_back(name);
    else
      left_out_.push_back(name);
  }
  const NewGrid grains = bodies_grid(), outlines = outlines_grid();
  std::vector<std::string> tables;
  if (bodies.scene().cell) tables.emplace_back(periods_name);
  file_ = std::make_unique<FrameFile>(folder, std::vector{grains.grid, outlines.grid},
                                      std::vector{whole(grains.topology), whole(outlines.topology)}, Opening::create,
                                      std::move(tables));
}

const FieldMesh& FrameOutput::mesh_of(std::size_t body) const {
  const Body& b = bodies_.all()[body];
  return b.compliant() ? bodies_.space_of(b).mesh : meshes_[body];
}

FrameOutput::NewGrid FrameOutput::bodies_grid() const {
  NewGrid result("bodies", 3, body_fields_);
  for (std::size_t b = 0; b < bodies_.all().size(); ++b) {
    if (bodies_.all()[b].placed.wall) continue;
    for (const Triangle& triangle : mesh_of(b).triangles) result.add_cell(bodies_.all()[b], b, triangle);
    result.grid.points += static_cast<int>(mesh_of(b).nodes.size());
  }
  return result;
}

FrameOutput::NewGrid FrameOutput::outlines_grid() const {
  NewGrid result("outlines", 2, outline_fields_);
  for (std::size_t b = 0; b < bodies_.all().size(); ++b) {
    const Body& body = bodies_.all()[b];
    const int count = static_cast<int>(body.outline.size()), segments = count - (body.placed.wall ? 1 : 0);
    for (int i = 0; i < segments; ++i) result.add_cell(body, b, std::array<int, 2>{i, (i + 1) % count});
    result.grid.points += count;
  }
  return result;
}

double FrameOutput::next_time() const {
  return file_ ? static_cast<double>(count_) * period_ : std::numeric_limits<double>::infinity();
}

void FrameOutput::record_due(const View& view) {
  if (!file_ || view.run().motion().time < next_time() * (1 - 1e-12)) return;
  GridFrame grains{{}, std::vector<std::vector<float>>(body_fields_.size())}, outlines;
  for (std::size_t b = 0; b < bodies_.all().size(); ++b) {
    const Body& body = bodies_.all()[b];
    if (body.placed.wall) continue;
    append(view.positions_of(body), grains.positions);
    for (std::size_t f = 0; f < body_fields_.size(); ++f) {
      std::vector<float>& values = grains.values[f];
      if (const auto node = node_fields().find(body_fields_[f]); node != node_fields().end()) {
        append(node->second(view, body), values);
        continue;
      }
      const auto& [at, rigid] = cell_fields().at(body_fields_[f]);
      for (const double value : cell_values(view, body, mesh_of(b), at, rigid))
        values.push_back(static_cast<float>(value));
    }
  }
  append(bodies_.outline_positions(view.positions()), outlines.positions);
  for (std::size_t f = 0; f < outline_fields_.size(); ++f) {  // contact_pressure, if any
    const std::vector<double> pressures = contact_pressures(view);
    outlines.values.emplace_back(pressures.begin(), pressures.end());
  }
  const double time = view.run().motion().time;
  std::vector<FrameTable> tables;
  if (bodies_.scene().cell) tables.push_back(periods_table(view.system().periods(time)));
  file_->append(time, {whole(grains), whole(outlines)}, tables);
  ++count_;
}

}  // namespace pliant::reference
