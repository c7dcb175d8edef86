#include "results/frames.hpp"

#include <limits>

#include "results/body_motion.hpp"
#include "results/contact_network.hpp"

namespace pliant {
namespace {

enum Kind { compliant_kind = 0, rigid_kind = 1, wall_kind = 2 };

float kind_of(const Body& body) {
  return body.wall ? wall_kind : body.kind == BodyKind::compliant ? compliant_kind : rigid_kind;
}

Field empty_field(const FrameField& field) {
  const auto centre = field.centre == FrameField::Centre::point ? Field::Centre::point : Field::Centre::cell;
  return {field.name, centre, field.components, {}};
}

/// Room for a grid's frame, so that it does not grow beyond.
void reserve(GridFrame& frame, std::size_t points, std::size_t cells) {
  frame.positions.reserve(2 * points);
  for (Field& field : frame.fields)
    field.values.reserve((field.centre == Field::Centre::point ? points : cells) * field.components);
}

GridTopology empty_grid(const char* name, int cell_size) {
  return {{name, 0, cell_size}, {}, {{"kind", Field::Centre::cell, 1, {}}, {"body", Field::Centre::cell, 1, {}}}};
}

template <std::size_t size>
void add_cell(GridTopology& grid, const Body& body, std::size_t index, const std::array<int, size>& nodes) {
  for (int node : nodes) grid.cells.push_back(grid.points + node);
  grid.constant_fields[0].values.push_back(kind_of(body));
  grid.constant_fields[1].values.push_back(static_cast<float>(index));
}

}  // namespace

FrameRecorder::FrameRecorder(const Model& model, const std::filesystem::path& folder, Opening opening)
    : model_(model), period_(model.scene.frames.period), rigid_meshes_(model.outlines.size()) {
  if (period_ == 0) return;
  for (const Body& body : model.bodies)
    if (!body.wall && body.kind == BodyKind::rigid && rigid_meshes_[body.outline].nodes.empty())
      rigid_meshes_[body.outline] = make_rigid_mesh(model.scene.shapes[body.shape]);
  choose_fields();
  std::vector<GridTopology> grids;  // moved, not copied: they are as large as all the rest
  grids.push_back(bodies_grid());
  grids.push_back(outlines_grid());
  std::vector<std::string> tables;
  if (model.scene.frames.contacts) tables.emplace_back(contact_network_name);
  file_ = std::make_unique<FrameFile>(folder, std::move(grids), opening, std::move(tables));
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

GridTopology FrameRecorder::bodies_grid() const {
  GridTopology grid = empty_grid("bodies", 3);
  std::size_t cells = 0;
  for (const Body& body : model_.bodies)
    if (!body.wall) cells += mesh_of(body).triangles.size();
  grid.cells.reserve(3 * cells);
  for (Field& field : grid.constant_fields) field.values.reserve(cells);
  for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
    const Body& body = model_.bodies[b];
    if (body.wall) continue;
    for (const Triangle& triangle : mesh_of(body).triangles) add_cell(grid, body, b, triangle);
    grid.points += static_cast<int>(mesh_of(body).nodes.size());
  }
  for (const auto& [field, value] : constant_fields_) {
    grid.constant_fields.push_back(empty_field(field));
    for (const float body : grid.constant_fields[1].values)
      grid.constant_fields.back().values.push_back(value(model_.bodies[static_cast<std::size_t>(body)]));
  }
  return grid;
}

GridTopology FrameRecorder::outlines_grid() const {
  GridTopology grid = empty_grid("outlines", 2);
  for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
    const Body& body = model_.bodies[b];
    const int count = model_.outlines[body.outline].count, segments = count - (body.wall ? 1 : 0);
    for (int i = 0; i < segments; ++i) add_cell<2>(grid, body, b, {i, (i + 1) % count});
    grid.points += count;
  }
  return grid;
}

double FrameRecorder::next_time() const { return file_ ? count_ * period_ : std::numeric_limits<double>::infinity(); }

void FrameRecorder::record_due(Simulation& simulation) {
  if (simulation.state().time >= next_time() * (1 - 1e-12)) record(simulation);
}

void FrameRecorder::record_last(Simulation& simulation) {
  if (file_ && simulation.state().time > (count_ - 1) * period_ * (1 + 1e-12)) record(simulation);
}

void FrameRecorder::record(Simulation& simulation) {
  const Snapshot snapshot(simulation);
  std::vector<FrameTable> tables;
  if (model_.scene.frames.contacts) tables.push_back(contact_network(snapshot));
  std::vector<GridFrame> frames;  // moved, not copied: they are as large as a state
  frames.push_back(bodies_frame(snapshot));
  frames.push_back(outlines_frame(snapshot));
  file_->append(simulation.state().time, frames, tables);
  ++count_;
}

GridFrame FrameRecorder::bodies_frame(const Snapshot& snapshot) const {
  GridFrame frame;
  for (const auto& [field, function] : body_fields_) frame.fields.push_back(empty_field(field));
  std::size_t points = 0, cells = 0;
  for (const Body& body : model_.bodies)
    if (!body.wall) points += mesh_of(body).nodes.size(), cells += mesh_of(body).triangles.size();
  reserve(frame, points, cells);
  for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
    const Body& body = model_.bodies[b];
    if (body.wall) continue;
    for (const Vec2& x : positions_at(snapshot, body, mesh_of(body).nodes)) append(x, frame.positions);
    FramedBody body_frame(snapshot, static_cast<int>(b), mesh_of(body));
    for (std::size_t f = 0; f < body_fields_.size(); ++f) body_fields_[f].function(body_frame, frame.fields[f].values);
  }
  return frame;
}

GridFrame FrameRecorder::outlines_frame(const Snapshot& snapshot) const {
  GridFrame frame;
  std::vector<std::vector<double>> values;
  for (const auto& [field, function] : outline_fields_) {
    frame.fields.push_back(empty_field(field));
    values.push_back(function(snapshot));
  }
  std::size_t nodes = 0;
  for (const Body& body : model_.bodies) nodes += static_cast<std::size_t>(model_.outlines[body.outline].count);
  reserve(frame, nodes, 0);
  for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b)
    for (int i = model_.outline_offset[b]; i < model_.outline_end(b); ++i) {
      append(snapshot.outlines().at(i), frame.positions);
      for (std::size_t f = 0; f < values.size(); ++f)
        frame.fields[f].values.push_back(static_cast<float>(values[f][i]));
    }
  return frame;
}

}  // namespace pliant
