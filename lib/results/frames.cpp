#include "results/frames.hpp"

#include <algorithm>
#include <limits>

#include "results/body_motion.hpp"
#include "results/contact_network.hpp"

namespace pliant {
namespace {

using Values = std::vector<std::vector<float>>;  ///< of the fields of a part

enum Kind { compliant_kind = 0, rigid_kind = 1, wall_kind = 2 };

float kind_of(const Body& body) {
  return body.wall ? wall_kind : body.kind == BodyKind::compliant ? compliant_kind : rigid_kind;
}

/// Bodies in a part of a frame: the whole of one may be as large as a state.
constexpr std::size_t bodies_of_part = 256;

Field described(const FrameField& field) {
  const auto centre = field.centre == FrameField::Centre::point ? Field::Centre::point : Field::Centre::cell;
  return {field.name, centre, field.components};
}

Grid empty_grid(const char* name, int cell_size) {
  return {name, 0, cell_size, 0, {{"kind", Field::Centre::cell, 1}, {"body", Field::Centre::cell, 1}}, {}};
}

/// `first`: number of the body's first node.
template <std::size_t size>
void add_cell(GridTopology& part, int first, const std::array<int, size>& nodes, const Body& body, std::size_t index) {
  for (int node : nodes) part.cells.push_back(first + node);
  part.values[0].push_back(kind_of(body));
  part.values[1].push_back(static_cast<float>(index));
}

/// Calls add(part, body) for each body, and hands over the part of so many; `empty`: what it begins with.
template <class Part, class Add>
void give_in_parts(std::size_t bodies, const Part& empty, const std::function<void(const Part&)>& take, Add&& add) {
  for (std::size_t first = 0; first < bodies; first += bodies_of_part) {
    Part part = empty;
    for (std::size_t b = first; b < std::min(bodies, first + bodies_of_part); ++b) add(part, b);
    take(part);
  }
}

constexpr const char* cell_name = "cell";

/// The table of a cell with two periods, of one row: the vectors of its periods, m.
FrameTable cell_vectors(const Snapshot& snapshot) {
  FrameTable table{cell_name, {{"a", 2, {}}, {"b", 2, {}}}};
  append(snapshot.outlines().lattice.a(), table.columns[0].values);
  append(snapshot.outlines().lattice.b(), table.columns[1].values);
  return table;
}

}  // namespace

FrameRecorder::FrameRecorder(const Model& model, const std::filesystem::path& folder, Opening opening)
    : model_(model), period_(model.scene.frames.period), rigid_meshes_(model.outlines.size()) {
  if (period_ == 0) return;
  for (const Body& body : model.bodies)
    if (!body.wall && body.kind == BodyKind::rigid && rigid_meshes_[body.outline].nodes.empty())
      rigid_meshes_[body.outline] = make_rigid_mesh(model.scene.shapes[body.shape]);
  choose_fields();
  std::vector<std::string> tables;
  if (model.scene.frames.contacts) tables.emplace_back(contact_network_name);
  if (model.scene.cell) tables.emplace_back(cell_name);
  file_ = std::make_unique<FrameFile>(folder, std::vector{bodies_grid(), outlines_grid()},
                                      std::vector{bodies_topology(), outlines_topology()}, opening, std::move(tables));
}

void FrameRecorder::choose_fields() {
  for (const std::string& name : model_.scene.frames.fields) {
    const FrameField& field = frame_field(name);
    if (field.grid == FrameField::Grid::outlines)
      outline_fields_.push_back({field, outline_field(name)});
    else if (field.constant)
      constant_fields_.push_back({field, constant_field(name)});
    else
      body_fields_.push_back({field, body_field(name)});
  }
}

const FieldMesh& FrameRecorder::mesh_of(const Body& body) const {
  return body.kind == BodyKind::compliant ? model_.shape_of(body).space.mesh : rigid_meshes_[body.outline];
}

Grid FrameRecorder::bodies_grid() const {
  Grid grid = empty_grid("bodies", 3);
  for (const auto& [field, value] : constant_fields_) grid.constant_fields.push_back(described(field));
  for (const auto& [field, function] : body_fields_) grid.fields.push_back(described(field));
  for (const Body& body : model_.bodies) {
    if (body.wall) continue;
    grid.points += static_cast<int>(mesh_of(body).nodes.size());
    grid.cells += static_cast<int>(mesh_of(body).triangles.size());
  }
  return grid;
}

Parts<GridTopology> FrameRecorder::bodies_topology() const {
  return [this](const std::function<void(const GridTopology&)>& take) {
    int points = 0;
    const auto add = [&](GridTopology& part, std::size_t b) {
      const Body& body = model_.bodies[b];
      if (body.wall) return;
      const FieldMesh& mesh = mesh_of(body);
      for (const Triangle& triangle : mesh.triangles) add_cell(part, points, triangle, body, b);
      for (std::size_t f = 0; f < constant_fields_.size(); ++f)
        part.values[2 + f].insert(part.values[2 + f].end(), mesh.triangles.size(), constant_fields_[f].function(body));
      points += static_cast<int>(mesh.nodes.size());
    };
    give_in_parts(model_.bodies.size(), GridTopology{{}, Values(2 + constant_fields_.size())}, take, add);
  };
}

int FrameRecorder::segments_of(const Body& body) const {
  return model_.outlines[body.outline].count - (body.wall ? 1 : 0);
}

Grid FrameRecorder::outlines_grid() const {
  Grid grid = empty_grid("outlines", 2);
  for (const auto& [field, function] : outline_fields_) grid.fields.push_back(described(field));
  for (const Body& body : model_.bodies)
    grid.points += model_.outlines[body.outline].count, grid.cells += segments_of(body);
  return grid;
}

Parts<GridTopology> FrameRecorder::outlines_topology() const {
  return [this](const std::function<void(const GridTopology&)>& take) {
    int points = 0;
    const auto add = [&](GridTopology& part, std::size_t b) {
      const Body& body = model_.bodies[b];
      const int count = model_.outlines[body.outline].count;
      for (int i = 0; i < segments_of(body); ++i) add_cell<2>(part, points, {i, (i + 1) % count}, body, b);
      points += count;
    };
    give_in_parts(model_.bodies.size(), GridTopology{{}, Values(2)}, take, add);
  };
}

double FrameRecorder::next_time() const { return file_ ? count_ * period_ : std::numeric_limits<double>::infinity(); }

bool FrameRecorder::record_due(Simulation& simulation) {
  const bool due = simulation.state().time >= next_time() * (1 - 1e-12);
  if (due) record(simulation);
  return due;
}

void FrameRecorder::record_last(Simulation& simulation) {
  if (file_ && simulation.state().time > (count_ - 1) * period_ * (1 + 1e-12)) record(simulation);
}

void FrameRecorder::record(Simulation& simulation) {
  const Snapshot snapshot(simulation);
  std::vector<FrameTable> tables;
  if (model_.scene.frames.contacts) tables.push_back(contact_network(snapshot));
  if (model_.scene.cell) tables.push_back(cell_vectors(snapshot));
  file_->append(simulation.state().time, {bodies_frame(snapshot), outlines_frame(snapshot)}, tables);
  ++count_;
}

Parts<GridFrame> FrameRecorder::bodies_frame(const Snapshot& snapshot) const {
  return [&](const std::function<void(const GridFrame&)>& take) {
    const auto add = [&](GridFrame& part, std::size_t b) {
      const Body& body = model_.bodies[b];
      if (body.wall) return;
      for (const Vec2& x : positions_at(snapshot, body, mesh_of(body).nodes)) append(x, part.positions);
      FramedBody framed(snapshot, static_cast<int>(b), mesh_of(body));
      for (std::size_t f = 0; f < body_fields_.size(); ++f) body_fields_[f].function(framed, part.values[f]);
    };
    give_in_parts(model_.bodies.size(), GridFrame{{}, Values(body_fields_.size())}, take, add);
  };
}

Parts<GridFrame> FrameRecorder::outlines_frame(const Snapshot& snapshot) const {
  return [&](const std::function<void(const GridFrame&)>& take) {
    std::vector<std::vector<double>> values;
    for (const auto& [field, function] : outline_fields_) values.push_back(function(snapshot));
    const auto add = [&](GridFrame& part, std::size_t b) {
      const int body = static_cast<int>(b);
      for (int i = model_.outline_offset[body]; i < model_.outline_end(body); ++i) {
        append(snapshot.outlines().at(i), part.positions);
        for (std::size_t f = 0; f < values.size(); ++f) part.values[f].push_back(static_cast<float>(values[f][i]));
      }
    };
    give_in_parts(model_.bodies.size(), GridFrame{{}, Values(values.size())}, take, add);
  };
}

}  // namespace pliant
