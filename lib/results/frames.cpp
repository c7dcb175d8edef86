#include "results/frames.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "bodies/internal_forces.hpp"
#include "bodies/mass_correction.hpp"
#include "bodies/nodal.hpp"
#include "materials/with_material.hpp"

namespace pliant {
namespace {

enum Kind { compliant_kind = 0, rigid_kind = 1, wall_kind = 2 };

float kind_of(const Body& body) {
  return body.wall ? wall_kind : body.kind == BodyKind::compliant ? compliant_kind : rigid_kind;
}

void append(const Points& values, const Vec2& offset, std::vector<float>& out) {
  for (const Vec2& value : values)
    for (double x : {offset.x() + value.x(), offset.y() + value.y()}) out.push_back(static_cast<float>(x));
}

/// Stresses of one cell, averaged over its integration points by weight.
struct CellState {
  double weight = 0, von_mises = 0, jacobian = 0, pressure = 0;
};

std::vector<CellState> cell_states(const Model& model, const Body& body, const Dofs& position) {
  const Batch& batch = model.batches[body.batch];
  const CompliantShape& shape = model.shape_of(body);
  const double mu = batch.mu[body.lane], lambda = batch.lambda[body.lane];
  const std::vector<Tensor<double>> F = deformation_gradients(model, body, position);
  std::vector<CellState> cells(shape.space.mesh.triangles.size());
  with_material(model.groups[batch.group].law, [&](auto law) {
    using Law = decltype(law);
    for (std::size_t g = 0; g < F.size(); ++g) {
      const auto [P, J] = Law::template stress<double>(F[g], mu, lambda);
      const double sxx = (P.xx * F[g].xx + P.xy * F[g].xy) / J, syy = (P.yx * F[g].yx + P.yy * F[g].yy) / J;
      const double sxy = (P.xx * F[g].yx + P.xy * F[g].yy) / J, szz = Law::sigma_zz(F[g], mu, lambda);
      const double w = shape.space.table.weight[g];
      const double von_mises = std::sqrt(
          0.5 * ((sxx - syy) * (sxx - syy) + (syy - szz) * (syy - szz) + (szz - sxx) * (szz - sxx)) + 3 * sxy * sxy);
      for (const int cell : shape.space.table.cells[g]) {
        cells[cell].weight += w;
        cells[cell].von_mises += w * von_mises;
        cells[cell].jacobian += w * J;
        cells[cell].pressure -= w * (sxx + syy + szz) / 3;
      }
    }
  });
  return cells;
}

}  // namespace

FrameRecorder::FrameRecorder(const Model& model, const std::filesystem::path& folder)
    : model_(model), period_(model.scene.frames.period), rigid_meshes_(model.outlines.size()) {
  if (period_ == 0) return;
  GridTopology bodies{"bodies", 0, 3, {}, {{"kind", Field::Centre::cell, 1, {}}, {"body", Field::Centre::cell, 1, {}}}};
  GridTopology lines{"outlines", 0, 2, {}, bodies.constant_fields};
  const auto add = [](GridTopology& grid, const Body& body, std::size_t index, auto cell) {
    for (int node : cell) grid.cells.push_back(grid.points + node);
    grid.constant_fields[0].values.push_back(kind_of(body));
    grid.constant_fields[1].values.push_back(static_cast<float>(index));
  };
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const OutlineShape& outline = model.outlines[body.outline];
    const int segments = outline.count - (body.wall ? 1 : 0);
    for (int i = 0; i < segments; ++i) add(lines, body, b, std::array<int, 2>{i, (i + 1) % outline.count});
    lines.points += outline.count;
    if (body.wall) continue;
    if (body.kind == BodyKind::rigid && rigid_meshes_[body.outline].nodes.empty())
      rigid_meshes_[body.outline] = make_rigid_mesh(model.scene.shape(model.scene.grains[body.grains].shape));
    const FieldMesh& mesh =
        body.kind == BodyKind::compliant ? model.shape_of(body).space.mesh : rigid_meshes_[body.outline];
    for (const Triangle& t : mesh.triangles) add(bodies, body, b, t);
    bodies.points += static_cast<int>(mesh.nodes.size());
  }
  file_ = std::make_unique<FrameFile>(folder, std::vector<GridTopology>{std::move(bodies), std::move(lines)});
}

double FrameRecorder::next_time() const { return file_ ? count_ * period_ : std::numeric_limits<double>::infinity(); }

void FrameRecorder::record_due(const Simulation& simulation) {
  if (!file_ || simulation.state().time < next_time() * (1 - 1e-12)) return;
  file_->append(simulation.state().time, {bodies_frame(simulation), outlines_frame(simulation)});
  ++count_;
}

bool FrameRecorder::wants(const char* field) const {
  const auto& fields = model_.scene.frames.fields;
  return std::find(fields.begin(), fields.end(), field) != fields.end();
}

GridFrame FrameRecorder::bodies_frame(const Simulation& simulation) const {
  const State& state = simulation.state();
  GridFrame frame;
  const Dofs velocities = material_velocity(model_, state.velocity);
  Field velocity{"velocity", Field::Centre::point, 2, {}};
  Field von_mises{"von_mises", Field::Centre::cell, 1, {}}, jacobian{"jacobian", Field::Centre::cell, 1, {}},
      pressure{"pressure", Field::Centre::cell, 1, {}};
  for (const Body& body : model_.bodies) {
    if (body.wall) continue;
    if (body.kind == BodyKind::compliant) {
      append(nodal_values(model_, body, state.position), body.centre, frame.positions);
      append(nodal_values(model_, body, velocities), Vec2(0, 0), velocity.values);
      for (const CellState& cell : cell_states(model_, body, state.position)) {
        von_mises.values.push_back(static_cast<float>(cell.von_mises / cell.weight));
        jacobian.values.push_back(static_cast<float>(cell.jacobian / cell.weight));
        pressure.values.push_back(static_cast<float>(cell.pressure / cell.weight));
      }
      continue;
    }
    const FieldMesh& mesh = rigid_meshes_[body.outline];
    const double* q = &state.position.rigid[3 * static_cast<std::size_t>(body.rigid)];
    const double* v = &state.velocity.rigid[3 * static_cast<std::size_t>(body.rigid)];
    const Eigen::Rotation2Dd turn(q[2]);
    for (const Vec2& node : mesh.nodes) {
      const Vec2 arm = turn * node;
      for (double x : {q[0] + arm.x(), q[1] + arm.y()}) frame.positions.push_back(static_cast<float>(x));
      for (double x : {v[0] - v[2] * arm.y(), v[1] + v[2] * arm.x()}) velocity.values.push_back(static_cast<float>(x));
    }
    von_mises.values.insert(von_mises.values.end(), mesh.triangles.size(), 0.0f);
    jacobian.values.insert(jacobian.values.end(), mesh.triangles.size(), 1.0f);
    pressure.values.insert(pressure.values.end(), mesh.triangles.size(), 0.0f);
  }
  for (Field* field : {&velocity, &von_mises, &jacobian, &pressure})
    if (wants(field->name.c_str())) frame.fields.push_back(std::move(*field));
  return frame;
}

/// Contact pressure at an outline node: the normal part of its contact force over its reference tributary length.
GridFrame FrameRecorder::outlines_frame(const Simulation& simulation) const {
  const Outlines& o = simulation.forces().outlines();
  GridFrame frame;
  Field pressure{"contact_pressure", Field::Centre::point, 1, {}};
  for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
    const OutlineShape& shape = model_.outlines[o.shape[b]];
    const double* x = &o.x[o.offset[b]];
    const double* y = &o.y[o.offset[b]];
    for (int i = 0; i < shape.count; ++i) {
      frame.positions.push_back(static_cast<float>(x[i]));
      frame.positions.push_back(static_cast<float>(y[i]));
      const double x_before = i > 0 ? x[i - 1] : x[shape.count - 1] - shape.turn_shift,
                   y_before = i > 0 ? y[i - 1] : y[shape.count - 1];
      const Vec2 along = Vec2(x[i + 1] - x_before, y[i + 1] - y_before).normalized();
      const double inward = -along.y() * o.force_x[o.offset[b] + i] + along.x() * o.force_y[o.offset[b] + i];
      pressure.values.push_back(static_cast<float>(inward / shape.tributary_length[i]));
    }
  }
  if (wants("contact_pressure")) frame.fields.push_back(std::move(pressure));
  return frame;
}

}  // namespace pliant
