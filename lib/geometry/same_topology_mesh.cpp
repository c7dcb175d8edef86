#include "geometry/same_topology_mesh.hpp"

#include <Eigen/LU>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace pliant {
namespace {

/// Smoothing ends when a step reduces the distortion by less than this share of it.
constexpr double settled_energy = 1e-5;
constexpr int most_smoothing_steps = 200;
constexpr double least_angle_allowed = 20 * std::numbers::pi / 180;

ShapeSpec disc(int nodes, int outline_nodes) {
  ShapeSpec shape;
  shape.name = "template";
  shape.diameter = std::sqrt(static_cast<double>(nodes));  // gives about unit node distance
  shape.nodes = nodes;
  shape.outline_nodes = outline_nodes;
  return shape;
}

}  // namespace

/// Factorised Laplacian of the interior nodes, and their coupling to the outline.
struct MeshTemplate::Laplacian {
  Eigen::SparseMatrix<double> to_outline;  ///< [interior x outline], weights
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> interior;

  explicit Laplacian(const FieldMesh& mesh) {
    const int outline = mesh.outline_count, inner = static_cast<int>(mesh.nodes.size()) - outline;
    std::vector<Eigen::Triplet<double>> own, other;
    const auto add = [&](int i, int j, double weight) {
      if (i < outline) return;
      own.emplace_back(i - outline, i - outline, weight);
      j < outline ? other.emplace_back(i - outline, j, weight) : own.emplace_back(i - outline, j - outline, -weight);
    };
    for (const Triangle& t : mesh.triangles)
      for (int corner = 0; corner < 3; ++corner) {
        const int i = t[(corner + 1) % 3], j = t[(corner + 2) % 3];
        const Vec2 a = mesh.nodes[i] - mesh.nodes[t[corner]], b = mesh.nodes[j] - mesh.nodes[t[corner]];
        const double half_cotangent = 0.5 * a.dot(b) / cross(a, b);
        add(i, j, half_cotangent);
        add(j, i, half_cotangent);
      }
    Eigen::SparseMatrix<double> matrix(inner, inner);
    matrix.setFromTriplets(own.begin(), own.end());
    interior.compute(matrix);
    to_outline.resize(inner, outline);
    to_outline.setFromTriplets(other.begin(), other.end());
  }
};

MeshTemplate::MeshTemplate(int nodes, int outline_nodes)
    : mesh_(make_field_mesh(disc(nodes, outline_nodes))), laplacian_(std::make_unique<Laplacian>(mesh_)) {}
MeshTemplate::~MeshTemplate() = default;
MeshTemplate::MeshTemplate(MeshTemplate&&) noexcept = default;

namespace {

/// Distortion of a mesh relative to its template, by triangles with the linear map F between them:
/// |F|^2 / (2 J) + (J + 1/J) / 2. It is least if angles and areas are kept, and infinite if a triangle loses its area.
class Distortion {
 public:
  /// `scale`: lengths of the mesh over the template's.
  Distortion(const FieldMesh& from, double scale) {
    for (const Triangle& t : from.triangles) {
      Eigen::Matrix2d edges;
      edges << from.nodes[t[1]] - from.nodes[t[0]], from.nodes[t[2]] - from.nodes[t[0]];
      weight_.push_back(edges.determinant() / 2);
      inverse_.push_back((scale * edges).inverse());
    }
  }

  /// The energy, and its gradient by the interior nodes' positions, [interior x 2], if requested.
  double operator()(const FieldMesh& mesh, Eigen::MatrixX2d* gradient = nullptr) const {
    if (gradient) gradient->setZero(static_cast<Eigen::Index>(mesh.nodes.size()) - mesh.outline_count, 2);
    double energy = 0;
    for (std::size_t n = 0; n < mesh.triangles.size(); ++n) {
      const Triangle& t = mesh.triangles[n];
      Eigen::Matrix2d edges;
      edges << mesh.nodes[t[1]] - mesh.nodes[t[0]], mesh.nodes[t[2]] - mesh.nodes[t[0]];
      const Eigen::Matrix2d F = edges * inverse_[n];
      const double J = F.determinant();
      if (!(J > 0)) return std::numeric_limits<double>::infinity();
      energy += weight_[n] * (0.5 * F.squaredNorm() / J + 0.5 * (J + 1 / J));
      if (!gradient) continue;
      const Eigen::Matrix2d cofactor = (Eigen::Matrix2d() << F(1, 1), -F(1, 0), -F(0, 1), F(0, 0)).finished();
      const Eigen::Matrix2d P = F / J + (0.5 - 0.5 * (F.squaredNorm() + 1) / (J * J)) * cofactor;
      const Eigen::Matrix2d of_edges = weight_[n] * P * inverse_[n].transpose();
      const Vec2 parts[3] = {-of_edges.col(0) - of_edges.col(1), of_edges.col(0), of_edges.col(1)};
      for (int corner = 0; corner < 3; ++corner)
        if (t[corner] >= mesh.outline_count) gradient->row(t[corner] - mesh.outline_count) += parts[corner].transpose();
    }
    return energy;
  }

 private:
  std::vector<double> weight_;
  std::vector<Eigen::Matrix2d> inverse_;
};

void move_interior(FieldMesh& mesh, const Eigen::MatrixX2d& by, double factor) {
  for (Eigen::Index i = 0; i < by.rows(); ++i) mesh.nodes[mesh.outline_count + i] += factor * by.row(i).transpose();
}

Points outline_of(const FieldMesh& mesh) { return {mesh.nodes.begin(), mesh.nodes.begin() + mesh.outline_count}; }

}  // namespace

/// Steepest descent in the norm of the Laplacian, until a step gains very little.
void MeshTemplate::smooth(FieldMesh& mesh) const {
  const double scale =
      std::sqrt(polygon_properties(outline_of(mesh)).area / polygon_properties(outline_of(mesh_)).area);
  const Distortion distortion(mesh_, scale);
  Eigen::MatrixX2d gradient;
  double energy = distortion(mesh, &gradient), length = 1;
  for (int step = 0; step < most_smoothing_steps && std::isfinite(energy); ++step) {
    const Eigen::MatrixX2d direction = -scale * scale * laplacian_->interior.solve(gradient);
    const double slope = (gradient.array() * direction.array()).sum();
    FieldMesh trial = mesh;
    for (length *= 2;; length /= 2) {
      trial.nodes = mesh.nodes;
      move_interior(trial, direction, length);
      if (distortion(trial) <= energy + 0.3 * length * slope) break;
      if (length < 1e-6) return;
    }
    const double before = energy;
    mesh.nodes = trial.nodes;
    energy = distortion(mesh, &gradient);
    if (before - energy < settled_energy * before) return;
  }
}

std::optional<FieldMesh> MeshTemplate::mapped(const Points& outline) const {
  Eigen::MatrixX2d fixed(outline.size(), 2);
  for (std::size_t k = 0; k < outline.size(); ++k) fixed.row(k) = outline[k].transpose();
  const Eigen::MatrixX2d inner = laplacian_->interior.solve(laplacian_->to_outline * fixed);
  FieldMesh mesh = mesh_;
  std::copy(outline.begin(), outline.end(), mesh.nodes.begin());
  for (Eigen::Index i = 0; i < inner.rows(); ++i) mesh.nodes[outline.size() + i] = inner.row(i).transpose();
  smooth(mesh);
  if (!(least_angle(mesh) >= least_angle_allowed)) return std::nullopt;
  return mesh;
}

double least_angle(const FieldMesh& mesh) {
  double least = std::numbers::pi;
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const Vec2 a = mesh.nodes[t[(k + 1) % 3]] - mesh.nodes[t[k]], b = mesh.nodes[t[(k + 2) % 3]] - mesh.nodes[t[k]];
      least = std::min(least, std::atan2(cross(a, b), a.dot(b)));
    }
  return least;
}

}  // namespace pliant
