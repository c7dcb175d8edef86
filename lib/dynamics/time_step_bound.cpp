#include "dynamics/time_step_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include "bodies/internal_forces.hpp"
#include "bodies/mass_correction.hpp"
#include "core/parallel.hpp"

namespace pliant {
namespace {

/// Power iterations approach w_b^2 from below.
constexpr double internal_margin = 1.05;
constexpr int start_iterations = 60;
/// Finite-difference step of the internal forces over the nodal distance.
constexpr double probe_size = 1e-6;

/// sum over nodes of a_i b_i w_i in each lane.
Lanes weighted_dot(const Lanes* a, const Lanes* b, const std::vector<double>& weight) {
  Lanes total{};
  for (std::size_t i = 0; i < weight.size(); ++i)
    total += weight[i] * (a[2 * i] * b[2 * i] + a[2 * i + 1] * b[2 * i + 1]);
  return total;
}

/// D C D^-1 of a force, so that the division by the lumped mass that follows makes it the acceleration W f.
std::vector<Lanes> corrected(const CompliantShape& shape, std::vector<Lanes> force) {
  std::vector<Lanes> result(force.size());
  for (std::size_t i = 0; i < force.size(); ++i) force[i] *= shape.inverse_unit_mass[i / 2];
  correct_velocity(shape, force.data(), result.data());
  for (std::size_t i = 0; i < force.size(); ++i) result[i] *= shape.space.unit_mass[i / 2];
  return result;
}

/// Largest w^2 of a rigid body whose outline nodes are tied by springs of equal normal and tangential stiffness. It does not depend on the angle.
double rigid_frequency(const RigidBody& rigid, const OutlineShape& outline, const double* stiffness) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  for (int k = 0; k < outline.count; ++k) {
    const Vec2& r = outline.points[k];
    Eigen::Matrix<double, 2, 3> motion;
    motion << 1, 0, -r.y(), 0, 1, r.x();
    matrix += stiffness[k] * motion.transpose() * motion;
  }
  Eigen::Vector3d scale;
  for (int c = 0; c < 3; ++c) scale[c] = std::sqrt(rigid.dof[c].inverse_mass);
  matrix = scale.asDiagonal() * matrix * scale.asDiagonal();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix, Eigen::EigenvaluesOnly);
  return std::max(0.0, solver.eigenvalues()[2]);
}

}  // namespace

TimeStepBound::TimeStepBound(const Model& model, const ContactLaws& laws) : model_(model) {
  std::mt19937_64 random(1);
  direction_.resize(model.compliant_size);
  for (Lanes& d : direction_)
    for (int lane = 0; lane < lane_count; ++lane) d[lane] = static_cast<double>(random() >> 11) * 0x1p-53 - 0.5;
  internal_.assign(model.batches.size(), Lanes{});
  contact_.assign(model.bodies.size(), 0.0);
  for (const Body& body : model.bodies)
    compliance_.push_back(contact_frequency(body, model.outlines[body.outline].tributary_length.data()));
  contact_floor_.assign(model.bodies.size(), 0.0);
  if (model.bodies.size() < 2) return;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const int* laws_of_class = &laws.pair_law[laws.body_class[b] * laws.classes];
    for (int other = 0; other < laws.classes; ++other)
      contact_floor_[b] = std::max(contact_floor_[b], compliance_[b] * stiffness_of(laws.laws[laws_of_class[other]]));
  }
}

double TimeStepBound::contact_frequency(const Body& body, const double* stiffness) const {
  const OutlineShape& outline = model_.outlines[body.outline];
  if (body.kind == BodyKind::rigid) return rigid_frequency(model_.rigid_bodies[body.rigid], outline, stiffness);
  const CompliantShape& shape = model_.shape_of(model_.batches[body.batch]);
  const ShapeRows& rows = shape.space.outline_rows;
  std::vector<double> row_sum(static_cast<std::size_t>(shape.nodes()), 0.0);
  for (int k = 0; k < outline.count; ++k) {
    double absolute = 0;
    for (int e = rows.start[k]; e < rows.start[k + 1]; ++e) absolute += std::abs(rows.value[e]);
    for (int e = rows.start[k]; e < rows.start[k + 1]; ++e)
      row_sum[rows.node[e]] += stiffness[k] * std::abs(rows.value[e]) * absolute;
  }
  double largest = 0;
  for (int i = 0; i < shape.nodes(); ++i) largest = std::max(largest, row_sum[i] * shape.inverse_unit_mass[i]);
  return shape.space.correction_bound * largest / model_.scene.materials[body.material].density;
}

void TimeStepBound::iterate_batch(const Batch& batch, const Lanes* position, int iterations) {
  const CompliantShape& shape = model_.shape_of(batch);
  const std::size_t size = 2 * static_cast<std::size_t>(shape.nodes());
  std::vector<Lanes> at_rest(size, Lanes{}), probe(size), response(size);
  Lanes* u = &direction_[batch.offset];
  add_internal_forces(model_, batch, position, at_rest.data());
  const double step = probe_size * shape.space.nodal_distance[0];
  for (int iteration = 0; iteration < iterations; ++iteration) {
    Lanes scale = broadcast(1e-300);
    for (std::size_t i = 0; i < size; ++i) scale = max(scale, abs(u[i]));
    for (std::size_t i = 0; i < size; ++i) {
      u[i] /= scale;
      probe[i] = position[i] + step * u[i];
    }
    std::fill(response.begin(), response.end(), Lanes{});
    add_internal_forces(model_, batch, probe.data(), response.data());
    for (std::size_t i = 0; i < size; ++i) response[i] = (at_rest[i] - response[i]) / step;
    if (model_.corrected_mass) response = corrected(shape, response);
    const Lanes before = weighted_dot(u, u, shape.space.unit_mass);
    const Lanes after = weighted_dot(response.data(), response.data(), shape.inverse_unit_mass);
    Lanes& w2 = internal_[&batch - model_.batches.data()];
    w2 = sqrt(after / before) * batch.inverse_density;
    for (std::size_t i = 0; i < size; ++i) u[i] = response[i] * shape.inverse_unit_mass[i / 2] * batch.inverse_density;
  }
}

void TimeStepBound::update_internal(const Dofs& position, int iterations) {
  const bool first = !internal_.empty() && internal_[0][0] == 0;
  parallel_for(static_cast<int>(model_.batches.size()), [&](int b) {
    const Batch& batch = model_.batches[b];
    iterate_batch(batch, &position.compliant[batch.offset], first ? start_iterations : iterations);
  });
}

void TimeStepBound::update_contact(Forces& forces) {
  const std::vector<double> stiffness = forces.stiffness_bound(compliance_);
  parallel_for(static_cast<int>(model_.bodies.size()), [&](int b) {
    contact_[b] =
        std::max(contact_floor_[b], contact_frequency(model_.bodies[b], &stiffness[forces.outlines().offset[b]]));
  });
}

double TimeStepBound::total(std::size_t b, double contact_factor) const {
  const Body& body = model_.bodies[b];
  return contact_factor * contact_[b] +
         (body.kind == BodyKind::compliant ? internal_margin * internal_[body.batch][body.lane] : 0.0);
}

std::size_t TimeStepBound::limiting_body(double contact_factor) const {
  std::size_t worst = 0;
  for (std::size_t b = 1; b < model_.bodies.size(); ++b)
    if (total(b, contact_factor) > total(worst, contact_factor)) worst = b;
  return worst;
}

double TimeStepBound::largest_dt(double contact_factor) const {
  const double w2 = total(limiting_body(contact_factor), contact_factor);
  return w2 > 0 ? model_.scene.time.safety * 2 / std::sqrt(w2) : std::numeric_limits<double>::infinity();
}

std::string TimeStepBound::governing() const {
  const std::size_t b = limiting_body();
  const double w2 = total(b);
  return fmt::format("{} (contact {:.0f} % of w^2)", model_.bodies[b].name, w2 > 0 ? 100 * contact_[b] / w2 : 0.0);
}

}  // namespace pliant
