#include "dynamics/contact_frequency.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

#include "core/lanes.hpp"
#include "core/parallel.hpp"

namespace pliant {
namespace {

/// Rounds that improve the bound of contact, and the share of the previous vector that each round keeps. The vector
/// must remain positive.
constexpr int bound_rounds = 5;
constexpr double blend = 0.1;

/// product = C D^-1 |K| x at the field nodes. K = Phi^T S Phi is the stiffness that springs S, [outline nodes], N/m2,
/// give them, D the mass at density 1. C is that of scaled mass, otherwise I.
void multiply_absolute(const CompliantShape& shape, const Lanes* stiffness, const std::vector<Lanes>& x,
                       std::vector<Lanes>& product) {
  const ShapeRows& rows = shape.space.outline_rows;
  std::ranges::fill(product, Lanes{});
  for (std::size_t k = 0; k + 1 < rows.start.size(); ++k) {
    Lanes absolute{};
    for (int e = rows.start[k]; e < rows.start[k + 1]; ++e) absolute += std::abs(rows.value[e]) * x[rows.node[e]];
    absolute *= stiffness[k];
    for (int e = rows.start[k]; e < rows.start[k + 1]; ++e) product[rows.node[e]] += std::abs(rows.value[e]) * absolute;
  }
  for (std::size_t i = 0; i < x.size(); ++i) product[i] *= shape.inverse_mass_at_unit_density[i];
  if (!shape.space.reciprocal_mass_averages) return;
  thread_local std::vector<Lanes> lumped;  // memory is allocated once
  lumped = product;
  const ShapeRows& c = shape.space.reciprocal_mass;
  for (std::size_t i = 0; i < product.size(); ++i) {
    product[i] = Lanes{};
    for (int e = c.start[i]; e < c.start[i + 1]; ++e) product[i] += c.value[e] * lumped[c.node[e]];
  }
}

/// Bounds of w^2, 1/s2, of eight bodies of a shape, of density 1, with springs of these stiffnesses, [outline nodes],
/// N/m2. For any x > 0 the largest ratio of C D^-1 |K| x to x bounds the eigenvalues of C D^-1 K if C has no negative
/// entries (Collatz 1942, Wielandt 1950). Otherwise the bound on the eigenvalues of C multiplies that for C = I. The
/// least of all rounds counts.
Lanes contact_frequencies(const CompliantShape& shape, const Lanes* stiffness) {
  thread_local std::vector<Lanes> x, product;  // memory is allocated once
  x.assign(static_cast<std::size_t>(shape.nodes()), broadcast(1));
  product.resize(x.size());
  Lanes least = broadcast(std::numeric_limits<double>::infinity());
  for (int round = 0; round < bound_rounds; ++round) {
    multiply_absolute(shape, stiffness, x, product);
    Lanes largest{};
    for (std::size_t i = 0; i < x.size(); ++i) largest = max(largest, product[i] / x[i]);
    least = min(least, largest);
    const Lanes inverse = 1.0 / select(largest > 0.0, largest, broadcast(1));
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = blend * x[i] + product[i] * inverse;
  }
  return shape.space.reciprocal_mass_bound * least;
}

/// Largest w^2 of a rigid body whose outline nodes are tied by springs of equal normal and tangential stiffness. It
/// does not depend on the angle.
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

/// Up to eight compliant bodies of one shape.
struct Eight {
  int count = 0, body[lane_count];
};

std::vector<Eight> in_eights(const Model& model, const std::vector<int>& bodies) {
  std::vector<Eight> eights;
  std::vector<int> open(model.shapes.size(), -1);  // [shapes] the group with room, if any
  for (const int b : bodies) {
    if (model.bodies[b].kind != BodyKind::compliant) continue;
    int& eight = open[model.bodies[b].compliant_shape];
    if (eight < 0 || eights[eight].count == lane_count) {
      eight = static_cast<int>(eights.size());
      eights.emplace_back();
    }
    eights[eight].body[eights[eight].count++] = b;
  }
  return eights;
}

}  // namespace

double contact_frequency(const Model& model, const Body& body, const double* stiffness) {
  const OutlineShape& outline = model.outlines[body.outline];
  if (body.kind == BodyKind::rigid) return rigid_frequency(model.rigid_bodies[body.rigid], outline, stiffness);
  std::vector<Lanes> springs(static_cast<std::size_t>(outline.count));
  for (std::size_t i = 0; i < springs.size(); ++i) springs[i] = broadcast(stiffness[i]);
  return contact_frequencies(model.shape_of(body), springs.data())[0] / model.batches[body.batch].density[body.lane];
}

void find_contact_frequencies(const Model& model, const std::vector<int>& bodies, const AddStiffness& add_stiffness,
                              std::vector<double>& frequencies) {
  const std::vector<Eight> eights = in_eights(model, bodies);
  parallel_for(static_cast<int>(eights.size()), [&](int e) {
    const Eight& eight = eights[e];
    thread_local std::vector<Lanes> stiffness;  // memory is allocated once
    const Body& first = model.bodies[eight.body[0]];
    stiffness.assign(static_cast<std::size_t>(model.outlines[first.outline].count), Lanes{});
    for (int lane = 0; lane < eight.count; ++lane)
      add_stiffness(eight.body[lane], reinterpret_cast<double*>(stiffness.data()) + lane, lane_count);
    const Lanes found = contact_frequencies(model.shape_of(first), stiffness.data());
    for (int lane = 0; lane < eight.count; ++lane) {
      const Body& body = model.bodies[eight.body[lane]];
      frequencies[eight.body[lane]] = found[lane] / model.batches[body.batch].density[body.lane];
    }
  });
  parallel_for(static_cast<int>(bodies.size()), [&](int i) {
    const Body& body = model.bodies[bodies[i]];
    if (body.kind != BodyKind::rigid) return;
    thread_local std::vector<double> stiffness;
    stiffness.assign(static_cast<std::size_t>(model.outlines[body.outline].count), 0.0);
    add_stiffness(bodies[i], stiffness.data(), 1);
    frequencies[bodies[i]] = contact_frequency(model, body, stiffness.data());
  });
}

}  // namespace pliant
